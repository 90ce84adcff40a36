//! One seed on a TNC: a window of a program in which things happen, then everything is put back, and the run goes on.

use bahn_exchange::{Bit, BitArea};
use bahn_parameters::fault::Reaction;
use bahn_servo::OUTPUTS;
use bahn_tnc::{Command, Control, Mode, Remembered, RunState};

use super::axes::{Axes, Moment};
use super::bench::TncBench;
use super::led::{self, Leading};
use super::medium::Medium;
use super::messages::{Messages, is_fatal};
use super::ways::Ways;
use crate::torture::catalogue::{Catalogue, Kind};
use crate::torture::plan::{Happening, Plan};
use crate::torture::rule::{Rule, Violation};
use crate::torture::trial::Trial;
use bahn_host::{Action, Answer, Source};
use bahn_host::{Next, Reader};
use bahn_host::{Notice, Stamped};

/// The path of a disturbed run may be so far from that of the undisturbed one, mm or degrees.
const CONTOUR: f64 = 1e-4;
/// Cycles between two looks at all outputs.
const OUTPUTS_EVERY: u32 = 7;

/// A trial on its way.
pub(super) struct Course<'a> {
    pub bench: &'a mut TncBench,
    pub catalogue: &'a Catalogue,
    notices: Reader<Stamped>,
    judges: Judges,
    pub power: Power,
    paths: Paths,
    pub trial: Trial,
    /// Messages that the undisturbed run does not say.
    pub unusual: usize,
    cycles: u32,
}

/// What looks after axes, ways and messages in every cycle.
#[derive(Default)]
struct Judges {
    axes: Axes,
    ways: Ways,
    messages: Messages,
}

impl Judges {
    /// The control begins anew, or is off.
    fn restart(&mut self) {
        self.axes.restart();
        self.ways.restart();
    }
}

/// What is known of the supply, and of what survives without it.
pub(super) struct Power {
    /// What was written before.
    medium: Medium,
    /// What was remembered when the supply went.
    remembered: Option<(Vec<Remembered>, Vec<u8>)>,
    starts: u32,
    /// The supply of the control was off: there is no run any more.
    pub anew: bool,
}

impl Power {
    fn of(control: &Control) -> Power {
        Power {
            medium: Medium::of(control),
            remembered: None,
            starts: control.starts(),
            anew: false,
        }
    }

    /// The control has begun anew since it was asked last.
    fn begins(&mut self, control: &Control) -> bool {
        let begins = std::mem::replace(&mut self.starts, control.starts()) != control.starts();
        self.anew |= begins;
        begins
    }
}

/// What the channels follow.
struct Paths {
    /// The contour of each channel is that of the undisturbed run, and where it was last.
    contours: Vec<(bool, usize)>,
    /// What leads each of them.
    leading: Vec<Leading>,
    /// How many axes belong to channels.
    owners: usize,
}

impl Paths {
    fn of(control: &Control) -> Paths {
        Paths {
            contours: vec![(true, 0); control.channels()],
            leading: vec![Leading::default(); control.channels()],
            owners: count_axes(control),
        }
    }
}

/// Tries a plan, or a part of what happens in it.
pub(super) fn run(
    bench: &mut TncBench,
    catalogue: &Catalogue,
    plan: &Plan,
    happenings: &[Happening],
) -> Trial {
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
        judges: Judges::default(),
        power: Power::of(control),
        paths: Paths::of(control),
        trial: Trial::default(),
        unusual: 0,
        cycles: 0,
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
    pub(super) fn control(&self) -> &Control {
        self.bench.host.control()
    }

    pub(super) fn now(&self) -> u64 {
        self.control().time_us()
    }

    pub(super) fn breaks(&self, rule: Rule, values: impl Into<String>) -> Violation {
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
    pub(super) fn give(&mut self, kind: Kind, what: &str) -> Result<(), Violation> {
        let happening = Happening {
            time_us: self.now(),
            kind,
            what: what.to_owned(),
        };
        self.judges
            .messages
            .happens(&happening, self.bench.host.control());
        self.trial.done.push(happening);
        for part in what.split(',') {
            let action = match Action::parse(part.trim()) {
                Ok(action) => action,
                Err(error) => return Err(self.breaks(Rule::Alive, format!("{part}: {error}"))),
            };
            let powers = matches!(action, Action::Command(_, Command::Power(_)));
            if powers && !self.control().is_off() {
                self.power.remembered = Some(self.remember());
                let failed = self.power.medium.fails(self.control(), self.now());
                failed.map_err(|values| self.breaks(Rule::Retained, values))?;
            }
            let answer = self.bench.host.act(Source::Script, action);
            match answer {
                Ok(Answer::Impossible(why)) => return Err(self.breaks(Rule::Alive, format!("{what}: {why}"))),
                Ok(_) => {}
                Err(error) => return Err(self.breaks(Rule::Alive, format!("{what}: {error}"))),
            }
            if powers && !self.control().is_off() {
                self.judges.restart();
                if let Some(before) = self.power.remembered.take()
                    && before != self.remember()
                {
                    let (control, plc) = self.remember();
                    let values = match before.0 == control {
                        true => {
                            let cell = before.1.iter().zip(&plc).position(|(before, now)| before != now);
                            format!("retained cell {cell:?} of the PLC is another one after the power-off")
                        }
                        false => format!("{:?} is {control:?} after the power-off", before.0),
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

    /// A contour cycle, and what must be so after it.
    pub(super) fn cycle(&mut self) -> Result<(), Violation> {
        if let Err(error) = self.bench.host.step() {
            return Err(self.breaks(Rule::Alive, error.to_string()));
        }
        self.cycles += 1;
        if self.cycles.is_multiple_of(64) {
            self.bench.host.drop_path();
        }
        self.listen()?;
        let control = self.bench.host.control();
        self.judges.messages.cycle(control)?;
        let moment = self.moment();
        let (control, plant) = (self.bench.host.control(), self.bench.host.plant());
        if self.judges.messages.fatal_since == Some(moment.time_us) {
            self.judges.axes.brake(plant);
        }
        if moment.on {
            for number in 0..control.channels() {
                if let Some(channel) = control.channel(number) {
                    self.judges.axes.channel(channel, &moment)?;
                    self.judges.ways.channel(channel, plant, &moment)?;
                }
            }
            self.judges.axes.distance(plant, &moment)?;
        } else {
            self.judges.restart();
        }
        self.follow_contours(&moment)?;
        if self.cycles.is_multiple_of(OUTPUTS_EVERY) {
            self.look_at_writers()?;
        }
        Ok(())
    }

    fn moment(&mut self) -> Moment {
        let control = self.bench.host.control();
        let anew = self.power.begins(control);
        Moment {
            time_us: control.time_us(),
            cycle_s: f64::from(control.cycle_us()) * 1e-6,
            on: !control.is_off() && !anew,
            loops_closed: control.loops_closed(),
            fatal: is_fatal(control),
            broken: self.judges.messages.is_broken(),
            unbraked: self.judges.messages.is_unbraked(),
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
                self.unusual += usize::from(!usual);
                self.judges.messages.shown(&shown, usual, control)?;
                let reaction = shown.fault().row().reaction;
                if matches!(reaction, Reaction::Ramp | Reaction::RampThenOpen) {
                    self.judges.ways.stops(shown.channel, control.channels());
                }
            }
        }
        Ok(())
    }

    /// As long as the run of the undisturbed program goes on, its path is on that program's contour.
    fn follow_contours(&mut self, moment: &Moment) -> Result<(), Violation> {
        let (control, plant) = (self.bench.host.control(), self.bench.host.plant());
        let undisturbed = self.bench.contours.iter().zip(&self.bench.led);
        let own = self.paths.contours.iter_mut().zip(&mut self.paths.leading);
        for (number, ((contour, undisturbed), ((same, hint), leading))) in undisturbed.zip(own).enumerate() {
            let Some(channel) = control.channel(number) else {
                continue;
            };
            leading.cycle(&channel, plant, undisturbed, moment);
            if let Some((off, most)) = leading
                .out_of_step(&channel, moment)
                .filter(|(off, most)| off > most)
            {
                let values = format!("the thread is {off:.4} mm from its spindle, at most {most:.4}");
                return Err(Violation::new(Rule::Contour, control.time_us(), values));
            }
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
            let place = led::place(&channel);
            let tolerance = CONTOUR + leading.moved;
            let away = contour.distance(&place, element.block, tolerance, leading.reach_mm(), hint);
            if away > tolerance && !leading.holds(undisturbed, element.block, &place, tolerance) {
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
        if count_axes(control) != self.paths.owners {
            return Err(self.breaks(
                Rule::Writer,
                format!("{} axes of {}", count_axes(control), self.paths.owners),
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

    pub(super) fn wait(&mut self, time_us: u64) -> Result<(), Violation> {
        let end_us = self.now() + time_us;
        while self.now() < end_us {
            self.cycle()?;
        }
        Ok(())
    }
}
