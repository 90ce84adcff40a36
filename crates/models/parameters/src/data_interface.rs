//! What a data interface can be set to.

use std::fmt;
use std::str::FromStr;

/// Baud rates of the data interfaces, by the values of MP5040 [003:7043] [000:17560-17566].
pub const BAUD_RATES: [u32; 10] = [110, 150, 300, 600, 1200, 2400, 4800, 9600, 19_200, 38_400];

/// Baud rates that the two interfaces cannot have together [000:15617] [000:17552-17554].
const NOT_TOGETHER: [u32; 2] = [19_200, 38_400];

/// Whether one interface cannot have this rate while the other one has that.
///
/// ```
/// use bahn_parameters::interfaces::rates_exclude_each_other;
/// assert!(rates_exclude_each_other(19_200, 38_400) && rates_exclude_each_other(38_400, 19_200));
/// assert!(!rates_exclude_each_other(38_400, 38_400) && !rates_exclude_each_other(9_600, 38_400));
/// ```
pub fn rates_exclude_each_other(one: u32, other: u32) -> bool {
    one != other && [one, other].iter().all(|rate| NOT_TOGETHER.contains(rate))
}

/// What is connected to a port [000:17220-17230].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Magnetic tape unit: standard protocol, never EOT.
    Me,
    /// Floppy disk unit or its like, which is asked for its directory by an escape sequence. So a port is set up at first
    /// [000:10011].
    #[default]
    Fe1,
    /// The same without that sequence.
    Fe2,
    /// Freely configurable, index 0 of its machine parameters.
    Ext1,
    /// Freely configurable, index 1.
    Ext2,
}

impl Mode {
    /// All modes with how they are written.
    pub const ALL: [(&str, Mode); 5] = [
        ("me", Mode::Me),
        ("fe1", Mode::Fe1),
        ("fe2", Mode::Fe2),
        ("ext1", Mode::Ext1),
        ("ext2", Mode::Ext2),
    ];
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Mode::ALL.iter().find(|(_, mode)| mode == self);
        f.pad(name.map_or("", |(name, _)| name))
    }
}

impl FromStr for Mode {
    type Err = ();

    fn from_str(text: &str) -> Result<Mode, ()> {
        let found = Mode::ALL.iter().find(|(name, _)| name.eq_ignore_ascii_case(text));
        found.map(|(_, mode)| *mode).ok_or(())
    }
}
