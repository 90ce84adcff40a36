//! The channel: blocks become a path with places where functions are output and waited for; a cycle loop drives along it.
//!
//! `take` (in `prepare`) turns a block into elements and deeds; `gates` does what is to be done where the path is, `leads`
//! what is to be done ahead of that, `drive` is a cycle of the path. `programs` runs one program behind the other.

mod backward;
mod drive;
mod fault;
mod gates;
mod in_force;
mod kept;
mod leads;
mod order;
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

use bahn_motion::{Interpolator, Limits, PointToPoint};
use bahn_path::Position;

use crate::bounds::Bounds;
use crate::plc::{Plc, PlcMemory, Script};
use crate::report::{Fault, Skipped};
use crate::settings::ChannelSettings;
use backward::Backward;
use drive::LOOK_AHEAD;
use in_force::InForce;
use leads::Leads;
use order::Orders;
use prepare::Decoding;
use ranges::Ranges;
use record::{Moment, Record};
use single::Single;
use track::Track;
use window::Window;

/// All of a channel.
struct Channel<'a> {
    limits: &'a Limits,
    settings: &'a ChannelSettings,
    cycle_s: f64,
    /// Cycles of the run that are over.
    cycle: u64,
    /// Settings as the program has left them.
    in_force: InForce,
    decoding: Decoding,
    window: Window,
    leads: Leads,
    track: Track,
    orders: Orders,
    ranges: Ranges,
    plc: Plc<'a>,
    record: Record,
    path: Interpolator<()>,
    /// Number of the element that the interpolator is given next.
    fed: u64,
    /// So much of it is executed already, mm.
    part: Option<f64>,
    /// Greatest path acceleration that it was given last, mm/s².
    acceleration: f64,
    /// The place at which deeds are done next, and which of them.
    cursor: (u64, usize),
    /// The place that the path has come to or stands at.
    reached: u64,
    /// Places before this one do not stop the path.
    open_to: u64,
    /// The cycle in which a dwell ends.
    dwell: Option<u64>,
    /// Way along the path before the last cycle, mm.
    way_before: f64,
    /// The path stood still in the last cycle.
    still: bool,
    /// That was said.
    stands: bool,
    /// It stands because it is held.
    held: bool,
    /// Resets that were done.
    reset_count: usize,
    /// Where axes stand that moved on their own.
    ended_at: Position,
    /// Axes that move on their own.
    independent: Vec<(bahn_din::Independent, PointToPoint)>,
    backward: Backward,
    single: Single,
    /// What was passed over before the block with which the run began.
    skipped: Option<Vec<Skipped>>,
    /// File of the program that runs.
    program: String,
    /// Functions are simulated.
    simulated: bool,
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
        let mut path = Interpolator::new(limits, LOOK_AHEAD);
        path.set_position(start);
        // The interpolator has the same bounds.
        let cycle_s = if limits.cycle_s.is_nan() {
            0.0001
        } else {
            limits.cycle_s.clamp(0.0001, 1.0)
        };
        let mut channel = Channel {
            limits,
            settings,
            cycle_s,
            cycle: 0,
            in_force: InForce::new(settings),
            decoding: Decoding::default(),
            window: Window::default(),
            leads: Leads::default(),
            track: Track::new(start, 1, 0.0),
            orders: Orders::default(),
            ranges: Ranges::default(),
            plc: Plc::new(script, memory, cycle_s),
            record: Record::default(),
            path,
            fed: 1,
            part: None,
            acceleration: f64::INFINITY,
            cursor: (1, 0),
            reached: 1,
            open_to: 1,
            dwell: None,
            way_before: 0.0,
            still: true,
            stands: true,
            held: false,
            reset_count: 0,
            ended_at: Position::UNKNOWN,
            independent: Vec::new(),
            backward: Backward::default(),
            single: Single::default(),
            skipped: None,
            program: String::new(),
            simulated: false,
            fault: None,
            ended: false,
            bounds: Bounds::default(),
        };
        channel.window.begin(0.0);
        channel
    }

    /// Time of the run, s.
    fn t(&self) -> f64 {
        self.cycle as f64 * self.cycle_s
    }

    /// Way along the path, mm.
    fn way(&self) -> f64 {
        self.way_of(&self.path)
    }

    /// Way along the path of an interpolator on it, mm.
    fn way_of(&self, path: &Interpolator<()>) -> f64 {
        if let Some(way) = self.way_back(path) {
            return way;
        }
        let Some(element) = path.element() else {
            return self.track.way(self.reached);
        };
        match self.track.leg(element.sequence) {
            Some(leg) => leg.to() - path.rest_mm(),
            None => self.track.way(self.reached),
        }
    }

    /// Now, and where the path is.
    fn now(&self) -> Moment {
        let mut position = self.path.position();
        // Before it moves, the path does not know where axes stand that are programmed first.
        let place = self.track.position(self.reached);
        for axis in place.known().iter() {
            position[axis] = position.get(axis).unwrap_or(place[axis]);
        }
        for axis in self.ended_at.known().iter() {
            position[axis] = self.ended_at[axis];
        }
        for (independent, axis) in &self.independent {
            position[independent.axis] = axis.position();
        }
        Moment {
            t: self.t(),
            position,
            speed_mm_s: self.speed(),
        }
    }
}
