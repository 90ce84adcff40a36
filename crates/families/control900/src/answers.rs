//! The standard answers: what stands in the place of a PLC.

use bahn_system900::{ChannelParameter, Memory};

use crate::machine::Machine;
use crate::setup::StandardAnswers;

/// What is to be answered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Answers {
    which: StandardAnswers,
    /// Channels whose mode, or start, was asked for: a bit each.
    modes: u8,
    starts: u8,
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
fn bit(number: u8) -> u8 {
    1u8.checked_shl(u32::from(number.saturating_sub(1))).unwrap_or(0)
}

impl Machine {
    /// A cycle of the PLC: what was caused since the last one is answered.
    pub(crate) fn answer(&mut self) {
        let Answers { which, modes, starts } = self.answers;
        (self.answers.modes, self.answers.starts) = (0, 0);
        for k in 0..self.channels.len() {
            let number = k as u8 + 1;
            if which.enable {
                self.enable(number, k);
            }
            if which.mode && modes & bit(number) != 0 {
                self.copy(number, ChannelParameter::ModeRequest, ChannelParameter::Mode);
            }
            if which.start && starts & bit(number) != 0 {
                self.answer_start(number);
            }
            let waits = self.channels.get(k).is_some_and(|channel| channel.waits_for_m);
            if which.m && waits {
                self.plc(number, ChannelParameter::BlockRelease, 1);
            }
        }
    }

    /// P8700, P8701, P8709.
    fn enable(&mut self, number: u8, k: usize) {
        let referenced = i64::from(self.is_referenced(k));
        for (parameter, value) in [
            (ChannelParameter::LoopsEnabled, 1),
            (ChannelParameter::AxesEnabled, 1),
            (ChannelParameter::Referenced, referenced),
        ] {
            if self.memory.of_channel(number, parameter).whole() != Some(value) {
                self.plc(number, parameter, value);
            }
        }
    }

    /// A start is given where nothing is in its way; a stop always.
    fn answer_start(&mut self, number: u8) {
        let wanted = self
            .memory
            .of_channel(number, ChannelParameter::StartRequest)
            .whole();
        match wanted {
            Some(1) if !self.may_start(number) => self.memory.set_channel(number, ChannelParameter::Start, 0),
            _ => self.copy(number, ChannelParameter::StartRequest, ChannelParameter::Start),
        }
    }

    fn copy(&mut self, number: u8, from: ChannelParameter, to: ChannelParameter) {
        let value = self.memory.of_channel(number, from).whole().unwrap_or(0);
        self.plc(number, to, value);
    }

    /// The PLC writes a parameter of a channel.
    fn plc(&mut self, number: u8, parameter: ChannelParameter, value: i64) {
        self.memory.set_channel(number, parameter, value);
        if let Some(place) = Memory::channel_place(&self.memory, number, parameter) {
            self.notice(place);
        }
    }
}
