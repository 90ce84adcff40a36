//! One seed on a System 900: a window of a run in which things happen, then everything is put back, and the run goes on.

use bahn_control900::Control900;
use bahn_host::{Answer, HostError, Source};
use bahn_path::Position;
use bahn_system900::ChannelParameter;

use super::action::action;
use super::axes::Axes;
use super::bench::Bench900;
use super::messages::Messages;
use crate::torture::catalogue::{Catalogue, Kind};
use crate::torture::plan::{Happening, Plan};
use crate::torture::rule::{Rule, Violation};
use crate::torture::trial::Trial;

/// The path of a disturbed run may be so far from that of the undisturbed one, mm or degrees.
const CONTOUR: f64 = 1e-4;
/// Cycles between two looks at what the path keeps.
const DROP_EVERY: u32 = 64;

/// A trial on its way.
pub(super) struct Course<'a> {
    pub bench: &'a mut Bench900,
    pub catalogue: &'a Catalogue,
    pub trial: Trial,
    axes: Axes,
    messages: Messages,
    /// Of each channel: its run is the undisturbed one, and where it was last on its contour.
    paths: Vec<(bool, usize)>,
    cycles: u32,
}

/// Tries a plan, or a part of what happens in it.
pub(super) fn run(
    bench: &mut Bench900,
    catalogue: &Catalogue,
    plan: &Plan,
    happenings: &[Happening],
) -> Trial {
    let Some(moment) = bench.moments.get(plan.moment) else {
        return Trial::default();
    };
    if let Err(error) = bench.host.restore(moment) {
        return Trial {
            violation: Some(Violation::new(Rule::Alive, 0, error.to_string())),
            ..Trial::default()
        };
    }
    let control = bench.host.control();
    let mut course = Course {
        messages: Messages::of(control),
        axes: Axes::default(),
        paths: vec![(true, 0); usize::from(control.channels())],
        trial: Trial::default(),
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

impl Course<'_> {
    pub fn control(&self) -> &Control900 {
        self.bench.host.control()
    }

    pub fn now(&self) -> u64 {
        self.control().now_us()
    }

    pub fn breaks(&self, rule: Rule, values: impl Into<String>) -> Violation {
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
        self.retained()?;
        self.put_back()?;
        self.go_on()
    }

    /// Does something between two cycles.
    pub fn give(&mut self, kind: Kind, what: &str) -> Result<(), Violation> {
        self.messages.happens(kind);
        self.trial.done.push(Happening {
            time_us: self.now(),
            kind,
            what: what.to_owned(),
        });
        for part in what.split(',').map(str::trim) {
            let action =
                action(part).map_err(|error| self.breaks(Rule::Alive, format!("{part}: {error}")))?;
            match self.bench.host.act(Source::Script, action) {
                Ok(Answer::Impossible(why)) => return Err(self.breaks(Rule::Alive, format!("{what}: {why}"))),
                Ok(_) => {}
                Err(error) => return Err(self.breaks(Rule::Alive, format!("{what}: {error}"))),
            }
        }
        Ok(())
    }

    /// An interpolation cycle, and what must be so after it.
    pub fn cycle(&mut self) -> Result<(), Violation> {
        if let Err(error) = self.bench.host.step() {
            return Err(self.breaks(Rule::Alive, HostError::to_string(&error)));
        }
        self.cycles += 1;
        if self.cycles.is_multiple_of(DROP_EVERY) {
            self.bench.host.drop_path();
        }
        let control = self.bench.host.control();
        self.trial.messages.extend(self.messages.take(control)?);
        Messages::reaction(control)?;
        self.axes.cycle(control)?;
        self.follow_contours()
    }

    /// As long as the run of the undisturbed program goes on, its path is on that program's contour.
    fn follow_contours(&mut self) -> Result<(), Violation> {
        let control = self.bench.host.control();
        let own = self.paths.iter_mut().zip(&self.bench.contours);
        for (channel, ((same, hint), contour)) in (1u8..).zip(own) {
            // What is begun anew begins from elsewhere.
            *same &= control.is_on_its_way(channel);
            let Some((element, _)) = control.executed(channel).filter(|_| *same) else {
                continue;
            };
            let feed = control.memory().of_channel(channel, ChannelParameter::ActualFeed);
            if feed.number().is_none_or(|feed| feed == 0.0) {
                continue;
            }
            // An axis that stands while its path goes on is beside it, too.
            let mut place = Position::UNKNOWN;
            for view in control.axes().filter(|view| view.channel == channel) {
                if let Some(axis) = view.on_path {
                    place[axis] = view.nominal;
                }
            }
            let away = contour.distance(&place, element.block, CONTOUR, 0.0, hint);
            if away > CONTOUR {
                let values = format!(
                    "channel {channel}: {away:.6} from the contour in block {}, at {place:?}",
                    element.block.block
                );
                return Err(Violation::new(Rule::Contour, control.now_us(), values));
            }
        }
        Ok(())
    }

    /// What survives power-off is read back as it was.
    fn retained(&self) -> Result<(), Violation> {
        let described = self.bench.described();
        let written = self.control().memory().differing(described);
        let read = described
            .with_kept(written.as_bytes())
            .map_err(|fault| self.breaks(Rule::Retained, fault.to_string()))?;
        match read.differing(described) == written {
            true => Ok(()),
            false => Err(self.breaks(Rule::Retained, "parameters are others after the power-off")),
        }
    }

    pub fn wait(&mut self, time_us: u64) -> Result<(), Violation> {
        let end_us = self.now() + time_us;
        while self.now() < end_us {
            self.cycle()?;
        }
        Ok(())
    }
}
