//! The way back after the window of a seed: everything is put back, messages are cleared, what flashes is switched off
//! and on, and the run goes on, or begins anew where the supply was off.

use bahn_exchange::signal;
use bahn_tnc::{Mode, RunState, Signal};

use super::course::Course;
use super::messages::is_fatal;
use crate::torture::catalogue::Kind;
use crate::torture::rule::{Rule, Violation};

/// An operator presses START again when so long after it nothing moves: the PLC may have held it, as the mill does until the
/// tool is clamped, µs.
const START_AGAIN_US: u64 = 10_000_000;

/// After the repairs until messages are looked at, µs.
const SETTLE_US: u64 = 400_000;
/// Between two keys of the operator who puts everything back, µs.
const KEY_US: u64 = 250_000;
/// Messages that are cleared at most, and power-offs.
const ROUNDS: usize = 16;
/// So long a control may take from power-on to the end of the reference run, µs.
const REFERENCE_US: u64 = 240_000_000;
/// So long a run may take to go on, µs.
const GO_ON_US: u64 = 15_000_000;
/// So long a program that begins anew may take to its first movement: a tool change by hand is part of it, µs.
const BEGIN_US: u64 = 40_000_000;
/// So long a run that goes on is watched, µs.
const WATCH_US: u64 = 700_000;

impl Course<'_> {
    /// Everything is repaired and released; messages are cleared, and what flashes is switched off.
    pub(super) fn put_back(&mut self) -> Result<(), Violation> {
        for repair in self.catalogue.repairs.clone() {
            if repair != "power on" || self.control().is_off() {
                self.give(Kind::Use, &repair)?;
            }
        }
        self.wait(SETTLE_US)?;
        for _ in 0..ROUNDS {
            if is_fatal(self.control()) {
                self.give(Kind::Power, "power off")?;
                self.wait(KEY_US)?;
                // What was pushed coasts: nobody switches on before it stands.
                let until_us = self.now() + REFERENCE_US;
                while self.now() < until_us
                    && self
                        .bench
                        .host
                        .plant()
                        .axes()
                        .any(|axis| axis.speed_per_min != 0.0)
                {
                    self.cycle()?;
                }
                self.give(Kind::Power, "power on")?;
                self.wait(KEY_US)?;
            }
            if !self.bench.host.plant().limit_switches_clear() {
                // On a limit switch only a key of the machine builder helps.
                return Ok(());
            }
            if !self.comes_up()? {
                continue;
            }
            if self.control().shown().is_empty() {
                return Ok(());
            }
            self.give(Kind::Use, "ce")?;
            self.wait(KEY_US)?;
        }
        let shown: Vec<String> = self
            .control()
            .shown()
            .iter()
            .map(|shown| self.control().shown_text(shown))
            .collect();
        Err(self.breaks(Rule::Recovery, format!("cannot be cleared: {}", shown.join(", "))))
    }

    /// Waits for loops and reference run; `false` when a flashing message is in the way.
    fn comes_up(&mut self) -> Result<bool, Violation> {
        let until_us = self.now() + REFERENCE_US;
        let mut again_us = self.now() + START_AGAIN_US;
        let clear = |course: &Self| course.bench.host.plant().limit_switches_clear();
        while clear(self) && (!self.control().loops_closed() || self.mode() == Mode::Reference) {
            if is_fatal(self.control()) {
                return Ok(false);
            }
            if !self.control().shown().is_empty() {
                // EMERGENCY STOP, which CE clears now, or what stops the reference run.
                self.give(Kind::Use, "ce")?;
                self.wait(KEY_US)?;
            }
            if self.now() > until_us {
                let waits = match self.control().loops_closed() {
                    true => "the reference run does not end",
                    false => "the loops are not closed",
                };
                return Err(self.breaks(Rule::Recovery, waits));
            }
            if self.now() > again_us {
                // START that came while a message was shown has begun nothing.
                again_us += START_AGAIN_US;
                self.start_reference_runs()?;
            }
            self.cycle()?;
        }
        self.pass_marks()
    }

    /// START for each channel that stands before its reference marks.
    fn start_reference_runs(&mut self) -> Result<(), Violation> {
        for number in 0..self.control().channels() {
            let waits = self
                .channel(number)
                .is_some_and(|channel| channel.mode() == Mode::Reference);
            if waits && self.control().loops_closed() && self.stands(number) {
                self.press_start(number)?;
            }
        }
        Ok(())
    }

    /// Where another mode was chosen before the reference marks were passed, they are passed now; `false` when a flashing
    /// message is in the way, or the operator who stands by has chosen his mode meanwhile.
    fn pass_marks(&mut self) -> Result<bool, Violation> {
        for number in 0..self.control().channels() {
            if !self
                .channel(number)
                .is_some_and(|channel| channel.lacks_reference())
            {
                continue;
            }
            self.give(Kind::Use, &format!("{}mode reference", prefix(number)))?;
            self.wait(KEY_US)?;
            self.press_start(number)?;
            let until_us = self.now() + REFERENCE_US;
            let mut again_us = self.now() + START_AGAIN_US;
            while self
                .channel(number)
                .is_some_and(|channel| channel.mode() == Mode::Reference)
            {
                let stopped = is_fatal(self.control()) || !self.bench.host.plant().limit_switches_clear();
                if stopped || !self.control().shown().is_empty() {
                    return Ok(!is_fatal(self.control()));
                }
                if self.now() > until_us {
                    return Err(self.breaks(Rule::Recovery, "the reference run does not end"));
                }
                if self.now() > again_us {
                    again_us += START_AGAIN_US;
                    if self.stands(number) {
                        self.press_start(number)?;
                    }
                }
                self.cycle()?;
            }
            if self
                .channel(number)
                .is_some_and(|channel| channel.lacks_reference())
            {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// No axis of a channel moves.
    fn stands(&self, number: usize) -> bool {
        let channel = self.channel(number);
        channel.is_none_or(|channel| channel.watch().all(|axis| axis.speed_mm_s == 0.0))
    }

    fn press_start(&mut self, number: usize) -> Result<(), Violation> {
        let keys = &self.bench.start_keys;
        let key = keys.get(number).cloned().unwrap_or_default();
        self.give(Kind::Use, &format!("key {key} tap"))
    }

    fn mode(&self) -> Mode {
        let control = self.control();
        let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
        match channels.any(|channel| channel.mode() == Mode::Reference) {
            true => Mode::Reference,
            false => control.mode(),
        }
    }

    /// NC start: the runs go on, or a message says why they do not.
    pub(super) fn go_on(&mut self) -> Result<(), Violation> {
        if is_fatal(self.control()) || !self.bench.host.plant().limit_switches_clear() {
            return Ok(());
        }
        let channels: Vec<usize> = (0..self.control().channels())
            .filter(|number| self.is_interrupted(*number))
            .collect();
        for number in &channels {
            if self
                .channel(*number)
                .is_some_and(|channel| channel.mode() != Mode::FullSequence)
            {
                self.give(Kind::Use, &format!("{}mode full", prefix(*number)))?;
                self.wait(KEY_US)?;
            }
            if *number == 0 && self.control().memory().bit(signal::MANUAL_OPERATION_PRESSED) {
                self.give(Kind::Use, "restore-position")?;
                self.wait(KEY_US)?;
            }
        }
        if channels.is_empty() && self.power.anew {
            return self.begin_anew();
        }
        if channels.is_empty() {
            return self.wait(KEY_US);
        }
        self.start(&channels, GO_ON_US)
    }

    /// After power-off there is no run that could go on: the programs begin anew.
    fn begin_anew(&mut self) -> Result<(), Violation> {
        let programs = self.bench.programs.clone();
        let mut channels = Vec::new();
        for (number, program) in programs.into_iter().enumerate() {
            if let Some(program) = program {
                for command in ["mode full".to_owned(), format!("select {program}")] {
                    self.give(Kind::Use, &format!("{}{command}", prefix(number)))?;
                    self.wait(KEY_US)?;
                }
                channels.push(number);
            }
        }
        self.start(&channels, BEGIN_US)
    }

    /// NC start, again where it was not taken, until a path moves or the control says why it does not.
    fn start(&mut self, channels: &[usize], within_us: u64) -> Result<(), Violation> {
        let reported = self.reported();
        let (mut until_us, mut due_us) = (self.now() + within_us, self.now());
        while !self.goes_on() {
            if self.reported() > reported {
                // It is refused, and the control says so.
                return Ok(());
            }
            if self.now() > until_us {
                let control = self.control();
                let waits = control
                    .waiting()
                    .map_or_else(String::new, |waiting| format!(", waits for {waiting}"));
                let values = format!("{:?} after NC start{waits}", control.run_state());
                return Err(self.breaks(Rule::Recovery, values));
            }
            if self.now() >= due_us {
                for number in channels {
                    if self.is_interrupted(*number) || self.begins(*number) {
                        self.press_start(*number)?;
                    }
                }
                due_us = self.now() + 8 * KEY_US;
            }
            self.cycle()?;
            if self.returns() {
                // The way back to the contour takes its time.
                until_us = until_us.max(self.now() + GO_ON_US);
            }
        }
        self.trial.went_on = true;
        self.wait(WATCH_US)
    }

    fn channel(&self, number: usize) -> Option<bahn_tnc::ChannelView<'_>> {
        self.control().channel(number)
    }

    fn is_interrupted(&self, number: usize) -> bool {
        let state = self.channel(number).map(|channel| channel.run_state());
        matches!(
            state,
            Some(RunState::Interrupted | RunState::Stopped | RunState::BlockEnd)
        )
    }

    /// Messages that say why a run does not go on. One that begins anew says again what it says undisturbed: that a tool is
    /// to be changed is no reason.
    fn reported(&self) -> usize {
        match self.power.anew {
            true => self.unusual,
            false => self.trial.messages.len(),
        }
    }

    /// A program that begins anew is not on its way yet.
    fn begins(&self, number: usize) -> bool {
        let state = self.channel(number).map(|channel| channel.run_state());
        self.power.anew && state == Some(RunState::Idle)
    }

    /// A path moves, or has come to its end.
    fn goes_on(&self) -> bool {
        let control = self.control();
        let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
        channels.any(|channel| {
            channel.has_ended() && !self.power.anew
                || (channel.observe(&Signal::PathSpeed) != 0.0 || is_led(&channel)) && !channel.restores()
        })
    }

    /// Axes are on their way back to the contour.
    fn returns(&self) -> bool {
        let control = self.control();
        let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
        channels.any(|channel| channel.restores() && channel.watch().any(|axis| axis.speed_mm_s != 0.0))
    }
}

/// A probe leads its axes.
fn is_led(channel: &bahn_tnc::ChannelView) -> bool {
    channel.is_led_by_probe() && channel.watch().any(|axis| axis.on_path && axis.speed_mm_s != 0.0)
}

/// A command to a channel begins so.
fn prefix(channel: usize) -> String {
    match channel {
        0 => String::new(),
        number => format!("{}: ", number + 1),
    }
}
