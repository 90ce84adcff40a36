//! Whether something is switched on.

use std::fmt;

/// Something acts, or does not.
///
/// ```
/// use bahn_path::Switch;
/// assert_eq!(Switch::from(true), Switch::On);
/// assert_eq!((Switch::Off.is_on(), Switch::Off.to_string()), (false, "off".to_owned()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// It acts.
    On,
    /// It does not.
    Off,
}

impl Switch {
    /// Whether it acts.
    pub fn is_on(self) -> bool {
        self == Switch::On
    }
}

impl From<bool> for Switch {
    fn from(on: bool) -> Switch {
        if on { Switch::On } else { Switch::Off }
    }
}

impl fmt::Display for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.is_on() { "on" } else { "off" })
    }
}
