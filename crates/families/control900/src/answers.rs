//! The standard answers: what stands in the place of a PLC.

use crate::setup::StandardAnswers;

/// What is to be answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Answers {
    pub which: StandardAnswers,
    /// Channels whose mode, or start, was asked for: a bit each.
    pub modes: u8,
    pub starts: u8,
}

impl Answers {
    pub fn new(which: StandardAnswers) -> Answers {
        Answers {
            which,
            modes: 0,
            starts: 0,
        }
    }

    /// P8683 was written.
    pub fn ask_mode(&mut self, number: u8) {
        self.modes |= bit(number);
    }

    /// P8684 was written.
    pub fn ask_start(&mut self, number: u8) {
        self.starts |= bit(number);
    }
}

/// The bit of a channel.
pub(crate) fn bit(number: u8) -> u8 {
    1u8.checked_shl(u32::from(number.saturating_sub(1))).unwrap_or(0)
}
