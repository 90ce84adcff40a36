//! The channel: blocks become a path with places where functions are output and waited for; a cycle loop drives along it.
//!
//! `take` (in `prepare`) turns a block into elements and actions; `gates` does what is to be done where the path is, `leads`
//! what is to be done ahead of that, `drive` is a cycle of the path. `programs` runs one program after the other.

mod back;
mod backward;
mod decoding;
mod drive;
mod fault;
mod gates;
mod in_force;
mod kept;
mod leads;
mod motion;
mod order;
mod plan;
mod planned;
mod prepare;
mod programs;
mod ranges;
mod record;
mod resolve;
mod single;
mod skipped;
mod track;
mod window;

use bahn_motion::{Interpolator, Limits};
use bahn_path::Position;

use crate::bounds::Bounds;
use crate::plc::{Plc, PlcMemory, Script};
use crate::report::{Fault, Skipped};
use crate::settings::ChannelSettings;
use back::Backward;
use motion::Motion;
use plan::Plan;
use record::{Moment, Record};
use single::Single;

/// A channel: what is planned, what moves along it, and what is done where that is.
struct Channel<'a> {
    cycle_s: f64,
    /// Cycles of the run that are over.
    cycle: u64,
    plan: Plan<'a>,
    plc: Plc<'a>,
    record: Record,
    motion: Motion<'a>,
    gates: Gates,
    backward: Backward,
    single: Single,
    progress: Progress,
}

/// Where actions are done next, and where the path has to stop.
struct Gates {
    /// The place at which actions are done next, and which of them.
    cursor: (u64, usize),
    /// Places before this one do not stop the path.
    open_to: u64,
    /// The cycle in which a dwell ends.
    dwell: Option<u64>,
    /// Simulated forward motion: functions are output as MOS.
    simulated: bool,
}

/// How far the run is.
#[derive(Default)]
struct Progress {
    /// File of the program that runs.
    program: String,
    /// Resets that were done.
    reset_count: usize,
    /// What was passed over before the block with which the run began.
    skipped: Option<Vec<Skipped>>,
    /// Why the run cannot go on.
    fault: Option<Fault>,
    /// The program has ended.
    ended: bool,
    /// How far the run goes at most.
    bounds: Bounds,
}

impl<'a> Channel<'a> {
    fn new(
        settings: &'a ChannelSettings,
        limits: &'a Limits,
        script: Option<&'a Script>,
        memory: Option<&'a mut (dyn PlcMemory + 'a)>,
        start: Position,
    ) -> Channel<'a> {
        // The interpolator has the same bounds.
        let cycle_s = if limits.cycle_s.is_nan() {
            0.0001
        } else {
            limits.cycle_s.clamp(0.0001, 1.0)
        };
        Channel {
            cycle_s,
            cycle: 0,
            plan: Plan::new(settings, start),
            plc: Plc::new(script, memory, cycle_s),
            record: Record::default(),
            motion: Motion::new(limits, start),
            gates: Gates {
                cursor: (1, 0),
                open_to: 1,
                dwell: None,
                simulated: false,
            },
            backward: Backward::default(),
            single: Single::default(),
            progress: Progress::default(),
        }
    }

    /// Time of the run, s.
    fn t(&self) -> f64 {
        self.cycle as f64 * self.cycle_s
    }

    /// Distance along the path, mm.
    fn distance(&self) -> f64 {
        self.distance_of(&self.motion.path)
    }

    /// Distance along the path of an interpolator on it, mm.
    fn distance_of(&self, path: &Interpolator<()>) -> f64 {
        if let Some(distance) = self.backward_distance(path) {
            return distance;
        }
        let Some(element) = path.element() else {
            return self.plan.track.distance(self.motion.reached);
        };
        match self.plan.track.leg(element.sequence) {
            Some(leg) => leg.to() - path.rest_mm(),
            None => self.plan.track.distance(self.motion.reached),
        }
    }

    /// Now, and where the path is.
    fn now(&self) -> Moment {
        let mut position = self.motion.path.position();
        // Before it moves, the path does not know where axes stand that are programmed first.
        let place = self.plan.track.position(self.motion.reached);
        for axis in place.known().iter() {
            position[axis] = position.get(axis).unwrap_or(place[axis]);
        }
        for axis in self.motion.ended_at.known().iter() {
            position[axis] = self.motion.ended_at[axis];
        }
        for (independent, axis) in &self.motion.independent {
            position[independent.axis] = axis.position();
        }
        Moment {
            t: self.t(),
            position,
            speed_mm_s: self.motion.speed(),
        }
    }
}
