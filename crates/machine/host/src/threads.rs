//! Threads as the plant cuts them: how deep the tool comes, and how far its axis is from where the spindle says.

use bahn_machine::Machine;
use bahn_path::{Axis, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Position};
use bahn_tnc::{ChannelView, Signal};

/// Threads that are listed at most.
const THREADS_MAX: usize = 1000;

/// A thread that was cut, or begun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreadCut {
    /// Block whose cycle cuts it.
    pub block: BlockRef,
    /// Number of the cycle: 2, 17 or 18.
    pub cycle: u8,
    /// Depth from where the tool axis begins, mm, as it is commanded.
    pub depth_mm: f64,
    /// The depth that the plant reaches, mm.
    pub reached_mm: f64,
    /// Largest distance of the tool from where the angle of the spindle says, mm; in cycle 2 what the floating holder
    /// takes.
    pub off_mm: f64,
    /// Time from its call until its path moved, s: what the orientation of the spindle takes.
    pub prepared_s: f64,
    /// Time of its path, s.
    pub path_s: f64,
}

/// Follows the threads of a channel.
#[derive(Clone, Debug, Default)]
pub struct Threads {
    /// Those that are over, the first 1000.
    pub done: Vec<ThreadCut>,
    /// How many were cut beside those that are listed.
    pub not_listed: u64,
    now: Option<Cut>,
    before: Option<Place>,
}

/// Where the plant is.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Its linear axes, mm.
    axes: Position,
    /// What they lag behind as the control sees it, mm.
    lag: Position,
    /// Turns of its spindle.
    turns: f64,
}

/// A thread that is being cut.
#[derive(Clone, Debug)]
struct Cut {
    block: BlockRef,
    sequence: u64,
    cycle: u8,
    /// The direction of the axes into the thread, of length 1.
    direction: Position,
    pitch_mm: f64,
    depth_mm: f64,
    /// Where tool axis and spindle stand when it begins.
    begin: Place,
    /// The path has begun to move.
    moves: bool,
    reached_mm: f64,
    prepared_s: f64,
    path_s: f64,
    /// The largest distance for a spindle that turns one way or the other into the thread.
    off_mm: [f64; 2],
}

impl Threads {
    /// Takes a contour cycle of a running program, s.
    pub fn cycle(&mut self, channel: ChannelView, plant: &Machine, cycle_s: f64) {
        let place = Place::look(channel, plant);
        let before = self.before.replace(place).unwrap_or(place);
        let element = channel.element();
        let goes_on = |cut: &Cut| element.is_some_and(|element| element.sequence == cut.sequence);
        if !self.now.as_ref().is_some_and(goes_on) {
            self.end();
        }
        let tapping = element.and_then(|element| Some((element, cycle_of(element)?)));
        if let (Some((element, cycle)), None) = (tapping, &self.now) {
            self.now = Some(Cut::begin(element, cycle, before, channel));
        }
        if let Some(cut) = &mut self.now {
            cut.moves |= channel.observe(&Signal::PathSpeed) != 0.0;
            if cut.moves {
                cut.path_s += cycle_s;
                cut.look(&place, tapping.is_some());
            } else {
                cut.prepared_s += cycle_s;
                cut.begin = place;
            }
        }
    }

    /// No program runs any more, or another block: a thread that was begun counts.
    pub fn end(&mut self) {
        let Some(cut) = self.now.take().filter(|cut| cut.moves) else {
            return;
        };
        if self.done.len() >= THREADS_MAX {
            self.not_listed += 1;
            return;
        }
        self.done.push(ThreadCut {
            block: cut.block,
            cycle: cut.cycle,
            depth_mm: cut.depth_mm,
            reached_mm: cut.reached_mm,
            off_mm: cut.off_mm[0].min(cut.off_mm[1]),
            prepared_s: cut.prepared_s,
            path_s: cut.path_s,
        });
    }
}

impl Place {
    fn look(channel: ChannelView, plant: &Machine) -> Place {
        let (mut axes, mut lag) = (Position::UNKNOWN, Position::UNKNOWN);
        for following in channel.followings() {
            if let Some(position) = plant.position(following.axis.letter()) {
                axes[following.axis] = position;
                lag[following.axis] = following.lag;
            }
        }
        // Each channel has a spindle of its own.
        let spindle = plant.spindles().nth(channel.number());
        let turns = spindle.map_or(0.0, |spindle| spindle.angle_deg / 360.0);
        Place { axes, lag, turns }
    }
}

impl Cut {
    fn begin(element: &PathElement, cycle: u8, begin: Place, channel: ChannelView) -> Cut {
        let pitch_mm = match (&element.override_law, element.feed) {
            (OverrideLaw::Spindle(thread), _) => thread.pitch_mm,
            // In cycle 2 feed and speed make it.
            (_, FeedRate::Programmed(feed)) => feed / channel.snapshot().spindle.programmed_rpm,
            (_, FeedRate::Rapid) => 0.0,
        };
        Cut {
            block: element.block,
            sequence: element.sequence,
            cycle,
            direction: direction(element),
            pitch_mm: if pitch_mm.is_finite() { pitch_mm } else { 0.0 },
            depth_mm: element.length(),
            begin,
            moves: false,
            prepared_s: 0.0,
            path_s: 0.0,
            reached_mm: 0.0,
            off_mm: [0.0; 2],
        }
    }

    /// Looks how deep it is, and in an element that taps how far from the spindle.
    fn look(&mut self, place: &Place, taps: bool) {
        let along = |way: &dyn Fn(Axis) -> f64| -> f64 {
            let moved = linear().filter(|axis| self.direction[*axis] != 0.0);
            moved.map(|axis| way(axis) * self.direction[axis]).sum()
        };
        let way = along(&|axis| place.axes[axis] - self.begin.axes[axis]);
        let lag = along(&|axis| self.begin.lag[axis]);
        // An axis that lagged behind when it began has the lag before it, too.
        self.reached_mm = self.reached_mm.max(way - lag);
        if taps {
            let turned = self.pitch_mm * (place.turns - self.begin.turns);
            for (off, turned) in self.off_mm.iter_mut().zip([turned, -turned]) {
                *off = off.max((way - turned).abs());
            }
        }
    }
}

/// The cycle of an element that taps.
fn cycle_of(element: &PathElement) -> Option<u8> {
    match &element.override_law {
        OverrideLaw::Tapping { .. } if element.curve != Curve::Hold => Some(2),
        OverrideLaw::Spindle(thread) if element.curve != Curve::Hold => match thread.retracts {
            true => Some(17),
            false => Some(18),
        },
        _ => None,
    }
}

/// The direction of an element in the machine, of length 1: 0 for an axis that it does not move.
fn direction(element: &PathElement) -> Position {
    let nose = |path: &Position| match &element.placement {
        Some(placement) => placement.to_nose(path),
        None => *path,
    };
    let (from, to) = (nose(&element.start), nose(&element.end));
    let way = |axis: Axis| {
        Some(to[axis] - from[axis])
            .filter(|way| way.is_finite())
            .unwrap_or(0.0)
    };
    let length = linear().map(|axis| way(axis).powi(2)).sum::<f64>().sqrt();
    let mut direction = Position::UNKNOWN;
    for axis in linear() {
        direction[axis] = if length > 0.0 { way(axis) / length } else { 0.0 };
    }
    direction
}

fn linear() -> impl Iterator<Item = Axis> {
    Axis::ALL.into_iter().filter(|axis| !axis.is_rotary())
}
