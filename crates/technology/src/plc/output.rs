//! What goes to the PLC, and what comes back.

use super::window::WindowRange;

/// Number of a function in the channel.
pub(super) type Id = u64;

/// A function as it is output.
pub(crate) struct Output<'a> {
    pub(crate) id: Id,
    /// What scripts call its range.
    pub(crate) names: &'a [String],
    /// Letter and number: `M25`.
    pub(crate) label: &'a str,
    pub(crate) range: WindowRange,
    /// `M`, `H` or `S`, and its number.
    pub(crate) letter: u8,
    pub(crate) number: u16,
    /// Additive value, or speed in 0.001 rpm.
    pub(crate) value: Option<i32>,
    pub(crate) process_s: f64,
    /// Time since the path was at the place, µs, of MOS_TS.
    pub(crate) offset_us: Option<f64>,
    /// Its acknowledgement is waited for.
    pub(crate) waits: bool,
}

/// What a PLC answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    Fetched,
    Acknowledged,
}
