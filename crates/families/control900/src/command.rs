//! What a write does: keys of the operator, modes, start and stop, answers of the PLC [002:3606-3816].
//!
//! Decision: A change to HAND breaks the program off, whose place is kept for a restart [002:4156-4193]
//!
//! Decision: Of P8706 counts the write of a value other than 0; while nothing waits it does nothing

use bahn_system900::{AxisParameter, ChannelParameter, Meaning, Place, Together};

use crate::channel::Mode;
use crate::machine::Machine;

/// Values of P8682 [002:3613-3619].
const KEY_STOP: i64 = 1;
const KEY_START: i64 = 2;

impl Machine {
    /// A parameter was written by somebody else than the control.
    pub(crate) fn notice(&mut self, place: Place) {
        match self.memory.meaning(place) {
            Meaning::OfChannel(number, parameter) => self.notice_channel(number, parameter),
            Meaning::OfAxis(physical, parameter) => self.notice_axis(physical, parameter),
            Meaning::Override(number) => self.memory.show_override(number),
            Meaning::Nothing => {}
        }
    }

    fn notice_axis(&mut self, physical: u8, parameter: AxisParameter) {
        match parameter {
            AxisParameter::GoRelative | AxisParameter::GoAbsolute => self.position(physical, parameter),
            AxisParameter::Reference => self.seek(physical),
            _ => {}
        }
    }

    fn notice_channel(&mut self, number: u8, parameter: ChannelParameter) {
        let value = self.memory.of_channel(number, parameter).whole();
        let is_set = value.is_some_and(|value| value != 0);
        match parameter {
            ChannelParameter::StartKey => self.press(number, value.unwrap_or(0)),
            ChannelParameter::ModeRequest => self.ask_mode(number, value.unwrap_or(0)),
            ChannelParameter::StartRequest => self.answers.ask_start(number),
            ChannelParameter::Mode => self.take_mode(number, value.unwrap_or(0)),
            ChannelParameter::Start => self.take_start(number, value == Some(1)),
            ChannelParameter::Abort if value == Some(1) => {
                self.together(number, Together::Abort, |machine, k| {
                    if let Some(channel) = machine.channels.get_mut(k) {
                        channel.wanted.abort = true;
                    }
                })
            }
            ChannelParameter::BlockRelease if is_set => self.release(number),
            ChannelParameter::Acknowledge => self.acknowledge(number),
            ChannelParameter::SystemMessage
            | ChannelParameter::HighMessage
            | ChannelParameter::LowMessage
            | ChannelParameter::DisplayMessage => self.order_message(number, parameter),
            ChannelParameter::ManualMove => self.begin_by_hand(number),
            ChannelParameter::NextStep if value == Some(1) => self.next_step(number),
            _ => {}
        }
    }

    /// Does something for a channel and all that its networks do it with.
    fn together(&mut self, number: u8, what: Together, mut act: impl FnMut(&mut Machine, usize)) {
        let channels = self.memory.together(number, what);
        for k in (0..self.channels.len()).filter(|k| channels >> k & 1 != 0) {
            act(self, k);
        }
    }

    /// P8682: the keys of the operator write P8684; STOP stops the whole network.
    fn press(&mut self, number: u8, key: i64) {
        match key {
            KEY_START => self.request_start(number, 1),
            KEY_STOP => self.together(number, Together::Stop, |machine, k| {
                machine.request_start(k as u8 + 1, 0)
            }),
            _ => {}
        }
    }

    fn request_start(&mut self, number: u8, start: i64) {
        self.memory
            .set_channel(number, ChannelParameter::StartRequest, start);
        self.answers.ask_start(number);
    }

    /// P8683: the mode is asked for in the whole network.
    fn ask_mode(&mut self, number: u8, mode: i64) {
        self.together(number, Together::Mode, |machine, k| {
            let number = k as u8 + 1;
            machine
                .memory
                .set_channel(number, ChannelParameter::ModeRequest, mode);
            machine.answers.ask_mode(number);
            if Mode::of(mode) == Some(Mode::Hand) && !machine.memory.acknowledges_apart(number) {
                machine.acknowledge(number);
            }
        });
    }

    /// P8703: the channel goes over to a mode.
    fn take_mode(&mut self, number: u8, mode: i64) {
        let Some(mode) = Mode::of(mode) else { return };
        let k = usize::from(number) - 1;
        let Some(channel) = self.channels.get_mut(k) else {
            return;
        };
        let before = std::mem::replace(&mut channel.mode, mode);
        match (before, mode) {
            (Mode::Hand, Mode::Hand) => {}
            // Definitions of M functions take effect with the change from HAND to AUTO [002:2088-2089].
            (Mode::Hand, _) => channel.m.read(&self.memory, number),
            (_, Mode::Hand) => channel.wanted.abort = true,
            _ => {}
        }
        self.memory
            .set_channel(number, ChannelParameter::Mode, mode.number());
    }

    /// P8704: start, where nothing is in its way, or stop.
    fn take_start(&mut self, number: u8, start: bool) {
        let k = usize::from(number) - 1;
        let may = self.may_start(number);
        let Some(channel) = self.channels.get_mut(k) else {
            return;
        };
        match start {
            true if may => channel.wanted.start = true,
            true => self.memory.set_channel(number, ChannelParameter::Start, 0),
            false => channel.wanted.stop = true,
        }
    }

    /// The mode is AUTO, the axes are enabled and referenced, and there is a program.
    pub(crate) fn may_start(&self, number: u8) -> bool {
        let Some(channel) = self.channels.get(usize::from(number) - 1) else {
            return false;
        };
        let is_set = |parameter| self.memory.of_channel(number, parameter).whole() == Some(1);
        channel.mode != Mode::Hand
            && channel.program.is_some()
            && is_set(ChannelParameter::AxesEnabled)
            && is_set(ChannelParameter::Referenced)
    }

    /// P8706: M functions with stop are done; else a branch that waits is confirmed.
    fn release(&mut self, number: u8) {
        let Some(channel) = self.channels.get_mut(usize::from(number) - 1) else {
            return;
        };
        if std::mem::take(&mut channel.waits_for_m) {
            self.transfers.acknowledge(number, self.now_us);
            self.memory.set_channel(number, ChannelParameter::WaitsForM, 0);
        } else if let Some(branch) = channel.branch.take() {
            channel.jump = Some(branch);
            self.transfers.branch(number, self.now_us);
        }
    }

    /// P8508, or the change to HAND: what is shown is acknowledged.
    fn acknowledge(&mut self, number: u8) {
        self.messages.acknowledge(number, self.now_us);
        self.core.emergency.clear();
    }
}
