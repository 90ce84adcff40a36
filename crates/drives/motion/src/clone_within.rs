//! Copies within the memory that is there: whoever runs a path ahead in each cycle must not allocate.

/// A struct's `Clone` whose `clone_from` goes field by field, so that queues keep their memory.
macro_rules! clone_within {
    ($name:ident $(<$of:ident>)? { $($field:ident),+ $(,)? }) => {
        impl $(<$of: Clone>)? Clone for $name $(<$of>)? {
            fn clone(&self) -> Self {
                let Self { $($field),+ } = self;
                Self { $($field: $field.clone()),+ }
            }

            fn clone_from(&mut self, other: &Self) {
                let Self { $($field),+ } = other;
                $(self.$field.clone_from($field);)+
            }
        }
    };
}

pub(crate) use clone_within;
