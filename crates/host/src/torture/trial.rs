//! One seed: a window of a program in which things happen, then everything is put back, and the run goes on.

use bahn_control::{Command, Control, Mode, Remembered, RunState, Signal};
use bahn_exchange::{Bit, BitArea, signal};
use bahn_servo::OUTPUTS;

use super::axes::{Axes, Moment};
use super::bench::Bench;
use super::catalogue::{Catalogue, Kind};
use super::messages::{Messages, is_fatal};
use super::plan::{Happening, Plan};
use super::rule::{Rule, Violation};
use crate::deed::{Answer, Deed, Source};
use crate::feed::{Next, Reader};
use crate::notice::{Notice, Stamped};

/// The path of a disturbed run may be so far from that of the undisturbed one, mm or degrees.
const CONTOUR: f64 = 1e-4;
/// Behind the repairs until messages are looked at, µs.
const SETTLE_US: u64 = 400_000;
/// Between two keys of the operator who puts everything back, µs.
const KEY_US: u64 = 250_000;
/// Messages that are cleared at most, and power-offs.
const ROUNDS: usize = 16;
/// So long a control may take from power-on to the end of the reference run, µs.
const REFERENCE_US: u64 = 240_000_000;
/// So long a run may take to go on, µs.
const GO_ON_US: u64 = 15_000_000;
/// So long a run that goes on is watched, µs.
const WATCH_US: u64 = 700_000;
/// Cycles between two looks at all outputs.
const OUTPUTS_EVERY: u32 = 7;

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
    /// The run went on behind it.
    pub went_on: bool,
}

/// A trial on its way.
struct Course<'a> {
    bench: &'a mut Bench,
    catalogue: &'a Catalogue,
    notices: Reader<Stamped>,
    axes: Axes,
    messages: Messages,
    trial: Trial,
    /// What was remembered when the supply went.
    remembered: Option<(Vec<Remembered>, Vec<u8>)>,
    starts: u32,
    cycles: u32,
    /// The contour of each channel is that of the undisturbed run, and where it was last.
    contours: Vec<(bool, usize)>,
    owners: usize,
}

/// Tries a plan, or a part of what happens in it.
pub(super) fn run(bench: &mut Bench, catalogue: &Catalogue, plan: &Plan, happenings: &[Happening]) -> Trial {
    let Some(moment) = bench.moments.get(plan.moment).cloned() else {
        return Trial::default();
    };
    if let Err(error) = bench.host.restore(&moment) {
        let violation = Violation::new(Rule::Alive, 0, error.to_string());
        return Trial {
            violation: Some(violation),
            ..Trial::default()
        };
    }
    let control = bench.host.control();
    let mut course = Course {
        notices: bench.host.notices(),
        axes: Axes::default(),
        messages: Messages::default(),
        trial: Trial::default(),
        remembered: None,
        starts: control.starts(),
        cycles: 0,
        contours: vec![(true, 0); control.channels()],
        owners: count_axes(control),
        catalogue,
        bench,
    };
    let from_us = course.now();
    let outcome = course.whole(plan.end_us, happenings);
    let machine_us = course.now().saturating_sub(from_us);
    Trial {
        violation: outcome.err(),
        machine_us,
        ..course.trial
    }
}

fn count_axes(control: &Control) -> usize {
    let channels = (0..control.channels()).filter_map(|number| control.channel(number));
    channels.map(|channel| channel.watch().count()).sum()
}

impl Course<'_> {
    fn control(&self) -> &Control {
        self.bench.host.control()
    }

    fn now(&self) -> u64 {
        self.control().time_us()
    }

    fn breaks(&self, rule: Rule, values: impl Into<String>) -> Violation {
        Violation::new(rule, self.now(), values.into())
    }

    /// The window, then the way back.
    fn whole(&mut self, end_us: u64, happenings: &[Happening]) -> Result<(), Violation> {
        for happening in happenings {
            while self.now() < happening.time_us {
                self.cycle()?;
            }
            self.give(happening.kind, &happening.what)?;
        }
        while self.now() < end_us {
            self.cycle()?;
        }
        self.put_back()?;
        self.go_on()
    }

    /// Does something between two cycles.
    fn give(&mut self, kind: Kind, what: &str) -> Result<(), Violation> {
        let happening = Happening {
            time_us: self.now(),
            kind,
            what: what.to_owned(),
        };
        self.messages.happens(&happening, self.bench.host.control());
        self.trial.done.push(happening);
        for part in what.split(',') {
            let deed = match Deed::parse(part.trim()) {
                Ok(deed) => deed,
                Err(error) => return Err(self.breaks(Rule::Alive, format!("{part}: {error}"))),
            };
            let powers = matches!(deed, Deed::Command(_, Command::Power(_)));
            if powers && !self.control().is_off() {
                self.remembered = Some(self.remember());
            }
            let answer = self.bench.host.act(Source::Script, deed);
            match answer {
                Ok(Answer::Impossible(why)) => return Err(self.breaks(Rule::Alive, format!("{what}: {why}"))),
                Ok(_) => {}
                Err(error) => return Err(self.breaks(Rule::Alive, format!("{what}: {error}"))),
            }
            if powers && !self.control().is_off() {
                self.axes.restart();
                if let Some(before) = self.remembered.take()
                    && before != self.remember()
                {
                    let (control, plc) = self.remember();
                    let values = match before.0 == control {
                        true => {
                            let cell = before.1.iter().zip(&plc).position(|(before, now)| before != now);
                            format!("retained cell {cell:?} of the PLC is another one behind the power-off")
                        }
                        false => format!("{:?} is {control:?} behind the power-off", before.0),
                    };
                    return Err(self.breaks(Rule::Retained, values));
                }
            }
        }
        Ok(())
    }

    /// What survives power-off: of the control, and the PLC's markers and bytes.
    fn remember(&self) -> (Vec<Remembered>, Vec<u8>) {
        let control = self.control();
        let others = (1..control.channels()).filter_map(|number| control.channel(number));
        let own = std::iter::once(control.remember()).chain(others.map(|channel| channel.remember()));
        (own.collect(), control.exchange().retained().collect())
    }

    /// A contour cycle, and what must be so behind it.
    fn cycle(&mut self) -> Result<(), Violation> {
        if let Err(error) = self.bench.host.step() {
            return Err(self.breaks(Rule::Alive, error.to_string()));
        }
        self.cycles += 1;
        if self.cycles.is_multiple_of(64) {
            self.bench.drop_path();
        }
        self.listen()?;
        let control = self.bench.host.control();
        self.messages.cycle(control)?;
        let moment = self.moment();
        let (control, plant) = (self.bench.host.control(), self.bench.host.plant());
        if self.messages.fatal_since == Some(moment.time_us) {
            self.axes.brake(plant);
        }
        if moment.on {
            for number in 0..control.channels() {
                if let Some(channel) = control.channel(number) {
                    self.axes.channel(channel, &moment)?;
                }
            }
            self.axes.distance(plant, &moment)?;
        } else {
            self.axes.restart();
        }
        self.follow_contours()?;
        if self.cycles.is_multiple_of(OUTPUTS_EVERY) {
            self.look_at_writers()?;
        }
        Ok(())
    }

    fn moment(&mut self) -> Moment {
        let control = self.bench.host.control();
        let anew = std::mem::replace(&mut self.starts, control.starts()) != control.starts();
        Moment {
            time_us: control.time_us(),
            cycle_s: f64::from(control.cycle_us()) * 1e-6,
            on: !control.is_off() && !anew,
            loops_closed: control.loops_closed(),
            fatal: is_fatal(control),
            broken: self.messages.is_broken(),
            unbraked: self.messages.is_unbraked(),
        }
    }

    /// What came up in the cycle.
    fn listen(&mut self) -> Result<(), Violation> {
        for next in self.notices.by_ref() {
            let Next::Item(Stamped { notice, .. }) = next else {
                continue;
            };
            if let Notice::Shown(shown) = notice {
                let control = self.bench.host.control();
                self.trial.messages.push(control.shown_text(&shown));
                let usual = self.bench.usual.contains(&shown.message);
                self.messages.shown(&shown, usual, control)?;
            }
        }
        Ok(())
    }

    /// As long as the run of the undisturbed program goes on, its path is on that program's contour.
    fn follow_contours(&mut self) -> Result<(), Violation> {
        let control = self.bench.host.control();
        let channels = self.bench.contours.iter().zip(&mut self.contours).enumerate();
        for (number, (contour, (same, hint))) in channels {
            let Some(channel) = control.channel(number) else {
                continue;
            };
            let state = channel.run_state();
            // What is begun anew begins from elsewhere.
            *same &= state != RunState::Idle && !channel.is_broken();
            let automatic = matches!(channel.mode(), Mode::SingleBlock | Mode::FullSequence);
            let runs = state == RunState::Running && automatic && !channel.restores();
            let Some(element) = channel.element().filter(|_| *same && runs) else {
                continue;
            };
            if !channel.watch().any(|axis| axis.on_path && axis.speed_mm_s != 0.0) {
                continue;
            }
            let mut place = channel.commanded();
            for slave in channel.watch().filter(|axis| axis.slave) {
                place[slave.axis] = f64::NAN;
            }
            let away = contour.distance(&place, element.block, CONTOUR, hint);
            if away > CONTOUR {
                let values = format!(
                    "channel {}: {away:.6} from the contour in block {}, at {place:?}",
                    number + 1,
                    element.block.block
                );
                return Err(Violation::new(Rule::Contour, control.time_us(), values));
            }
        }
        Ok(())
    }

    /// The PLC is the only one who writes outputs, and every axis belongs to one channel.
    fn look_at_writers(&self) -> Result<(), Violation> {
        let control = self.control();
        if count_axes(control) != self.owners {
            return Err(self.breaks(
                Rule::Writer,
                format!("{} axes of {}", count_axes(control), self.owners),
            ));
        }
        let outputs = self.bench.host.plant().outputs();
        let memory = control.memory();
        for (number, out) in outputs.iter().enumerate().take(OUTPUTS) {
            let bit = u16::try_from(number)
                .ok()
                .and_then(|number| Bit::new(BitArea::O, number));
            let Some(bit) = bit.filter(|_| control.plc_scans() > 1) else {
                continue;
            };
            let wanted = memory.bit(bit) && !control.is_off();
            // Off or stopped, nothing is put out that the PLC does not want.
            if *out && !wanted {
                return Err(self.breaks(Rule::Writer, format!("O{number} is on, the PLC has it off")));
            }
        }
        Ok(())
    }

    fn wait(&mut self, time_us: u64) -> Result<(), Violation> {
        let end_us = self.now() + time_us;
        while self.now() < end_us {
            self.cycle()?;
        }
        Ok(())
    }

    /// Everything is repaired and released; messages are cleared, and what flashes is switched off.
    fn put_back(&mut self) -> Result<(), Violation> {
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
            self.cycle()?;
        }
        Ok(true)
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
    fn go_on(&mut self) -> Result<(), Violation> {
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
        if channels.is_empty() {
            return self.wait(KEY_US);
        }
        let told = self.trial.messages.len();
        let (mut until_us, mut due_us) = (self.now() + GO_ON_US, self.now());
        while !self.goes_on() {
            if self.trial.messages.len() > told {
                // It is refused, and the control says so.
                return Ok(());
            }
            if self.now() > until_us {
                let control = self.control();
                let waits = control
                    .waiting()
                    .map_or_else(String::new, |waiting| format!(", waits for {waiting}"));
                let values = format!("{:?} behind NC start{waits}", control.run_state());
                return Err(self.breaks(Rule::Recovery, values));
            }
            if self.now() >= due_us {
                for number in &channels {
                    let key = self
                        .catalogue
                        .start_keys
                        .get(*number)
                        .cloned()
                        .unwrap_or_default();
                    if self.is_interrupted(*number) {
                        self.give(Kind::Use, &format!("key {key} tap"))?;
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

    fn channel(&self, number: usize) -> Option<bahn_control::ChannelView<'_>> {
        self.control().channel(number)
    }

    fn is_interrupted(&self, number: usize) -> bool {
        let state = self.channel(number).map(|channel| channel.run_state());
        matches!(
            state,
            Some(RunState::Interrupted | RunState::Stopped | RunState::BlockEnd)
        )
    }

    /// A path moves, or has come to its end.
    fn goes_on(&self) -> bool {
        let control = self.control();
        let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
        channels.any(|channel| {
            channel.has_ended() || channel.observe(&Signal::PathSpeed) != 0.0 && !channel.restores()
        })
    }

    /// Axes are on their way back to the contour.
    fn returns(&self) -> bool {
        let control = self.control();
        let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
        channels.any(|channel| channel.restores() && channel.watch().any(|axis| axis.speed_mm_s != 0.0))
    }
}

/// A command to a channel begins so.
fn prefix(channel: usize) -> String {
    match channel {
        0 => String::new(),
        number => format!("{}: ", number + 1),
    }
}
