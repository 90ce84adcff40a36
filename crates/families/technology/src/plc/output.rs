//! What goes to the PLC, and what comes back.

/// Number of the first spindle among the ranges.
const FIRST_SPINDLE: usize = 64;

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

/// A range by its number in the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WindowRange {
    Channel,
    /// An axis, from 0 on.
    Axis(usize),
    /// A spindle, from 0 on.
    Spindle(usize),
}

impl WindowRange {
    pub(super) fn number(self) -> u8 {
        let number = match self {
            WindowRange::Channel => 0,
            WindowRange::Axis(index) => 1 + index,
            WindowRange::Spindle(index) => FIRST_SPINDLE + index,
        };
        u8::try_from(number).unwrap_or(u8::MAX)
    }
}
