//! What comes of a seed.

use super::plan::Happening;
use super::rule::Violation;

/// What came of a seed.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// The rule that did not hold.
    pub violation: Option<Violation>,
    /// Everything that was done, with what put everything back, in the order of time.
    pub done: Vec<Happening>,
    /// Machine time that it took, µs.
    pub machine_us: u64,
    /// The texts of the messages that came up.
    pub messages: Vec<String>,
    /// The run went on after it.
    pub went_on: bool,
}
