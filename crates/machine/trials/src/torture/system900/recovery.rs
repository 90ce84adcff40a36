//! Everything is put back: the operator acknowledges, passes reference points, starts again; the programs go on, or the control
//! says why not.

use bahn_control900::Mode;
use bahn_system900::{AxisParameter, ChannelParameter, Memory};

use super::course::Course;
use crate::torture::catalogue::Kind;
use crate::torture::rule::{Rule, Violation};

/// Relays and axes come to rest, µs.
const SETTLE_US: u64 = 1_000_000;
/// What somebody presses acts, µs.
const KEY_US: u64 = 200_000;
/// A drive to the reference point takes so long at most, µs.
const REFERENCE_US: u64 = 300_000_000;
/// Programs go on within this, µs: a tool may be changed first.
const GO_ON_US: u64 = 60_000_000;
/// The run that went on is watched, µs.
const WATCH_US: u64 = 1_000_000;
/// P12130: the reference point is sought in the direction plus.
const SEEK: &str = "$10001";

impl Course<'_> {
    /// Nothing is broken, nothing is locked, no message is left.
    pub(super) fn put_back(&mut self) -> Result<(), Violation> {
        for repair in self.catalogue.repairs.clone() {
            self.give(Kind::Thing, &repair)?;
        }
        self.wait(SETTLE_US)?;
        for channel in self.channels() {
            if self.control().pending_messages(channel).next().is_some() {
                self.write(channel, ChannelParameter::Acknowledge, "1")?;
                self.wait(KEY_US)?;
            }
            if let Some(message) = self.control().pending_messages(channel).next() {
                let text = format!("cannot be acknowledged: {message}");
                return Err(self.breaks(Rule::Recovery, text));
            }
        }
        self.pass_reference_points()
    }

    fn channels(&self) -> std::ops::RangeInclusive<u8> {
        1..=self.control().channels()
    }

    fn write(&mut self, channel: u8, parameter: ChannelParameter, value: &str) -> Result<(), Violation> {
        let memory = self.control().memory();
        let place = memory.channel_place(channel, parameter);
        let name = place.map(|place| memory.name_of(place).to_string());
        match name {
            Some(name) => self.give(Kind::Use, &format!("{name}={value}")),
            None => Ok(()),
        }
    }

    /// Axes that know their places no more seek their reference points in HAND.
    fn pass_reference_points(&mut self) -> Result<(), Violation> {
        for channel in self.channels() {
            let open: Vec<String> = self
                .control()
                .axes()
                .filter(|axis| axis.channel == channel && axis.on_path.is_some() && !axis.referenced)
                .filter_map(|axis| Memory::axis_place(axis.physical, AxisParameter::Reference))
                .map(|place| self.control().memory().name_of(place).to_string())
                .collect();
            if open.is_empty() {
                continue;
            }
            self.write(channel, ChannelParameter::ModeRequest, "1")?;
            self.wait(KEY_US)?;
            for name in open {
                self.give(Kind::Use, &format!("{name}={SEEK}"))?;
            }
            let until_us = self.now() + REFERENCE_US;
            let waits = |course: &Self| {
                let mut axes = course.control().axes();
                axes.any(|axis| axis.channel == channel && axis.on_path.is_some() && !axis.referenced)
            };
            while waits(self) {
                if self.now() > until_us {
                    return Err(self.breaks(Rule::Recovery, "an axis does not find its reference point"));
                }
                if self.control().pending_messages(channel).next().is_some() {
                    return Ok(());
                }
                self.cycle()?;
            }
        }
        Ok(())
    }

    /// START: the runs go on, or begin anew, or a message says why they do not.
    pub(super) fn go_on(&mut self) -> Result<(), Violation> {
        let channels: Vec<u8> = self
            .channels()
            .filter(|channel| self.control().has_program(*channel))
            .collect();
        if self.have_ended(&channels) {
            self.trial.went_on = true;
            return self.wait(KEY_US);
        }
        for channel in &channels {
            if self.control().mode(*channel) != Mode::Sequence {
                self.write(*channel, ChannelParameter::ModeRequest, "2")?;
                self.wait(KEY_US)?;
            }
        }
        let (count, until_us) = (self.control().message_count(), self.now() + GO_ON_US);
        let mut due_us = self.now();
        while !self.path_moves(&channels) && !self.have_ended(&channels) {
            if self.control().message_count() > count {
                // It is refused, and the control says so.
                return Ok(());
            }
            if self.now() > until_us {
                return Err(self.breaks(Rule::Recovery, self.state(&channels)));
            }
            if self.now() >= due_us {
                for channel in &channels {
                    let runs = self.control().memory();
                    let state = runs.of_channel(*channel, ChannelParameter::ProgramState);
                    if state.whole() != Some(2) {
                        self.write(*channel, ChannelParameter::StartKey, "2")?;
                    }
                }
                due_us = self.now() + 8 * KEY_US;
            }
            self.cycle()?;
        }
        self.trial.went_on = true;
        self.wait(WATCH_US)
    }

    /// What stands after START.
    fn state(&self, channels: &[u8]) -> String {
        let states = channels.iter().map(|channel| {
            let control = self.control();
            let number = |parameter| {
                let cell = control.memory().of_channel(*channel, parameter);
                cell.whole().unwrap_or(0)
            };
            format!(
                "channel {channel} in block {}: {:?}, {:?}, waits for M {}",
                number(ChannelParameter::ActualBlock),
                control.mode(*channel),
                control.run(*channel).0,
                number(ChannelParameter::WaitsForM)
            )
        });
        format!(
            "nothing goes on after START: {}",
            states.collect::<Vec<_>>().join("; ")
        )
    }

    fn have_ended(&self, channels: &[u8]) -> bool {
        channels.iter().all(|channel| self.control().run(*channel).1)
    }

    fn path_moves(&self, channels: &[u8]) -> bool {
        let mut axes = self.control().axes();
        axes.any(|axis| axis.is_led && axis.speed_mm_s != 0.0 && channels.contains(&axis.channel))
    }
}
