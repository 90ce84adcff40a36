//! Parameters that a running control knows by what they mean.

/// An enumeration of parameters with their numbers.
macro_rules! parameters {
    ($(#[$about:meta])* $kind:ident { $($(#[$doc:meta])* $name:ident = $number:literal,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum $kind {
            $($(#[$doc])* $name = $number,)*
        }

        impl $kind {
            /// Its number.
            pub const fn number(self) -> u32 {
                self as u32
            }

            /// The one of a number; `None` for those by which no control runs.
            pub const fn of_number(number: u32) -> Option<$kind> {
                match number {
                    $($number => Some($kind::$name),)*
                    _ => None,
                }
            }
        }
    };
}

pub(crate) use parameters;
