//! The path of the channel: its elements, and between them what is to be done where the path is then.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_path::{BlockRef, Curve, FeedRate, PathElement, Position};

use super::order::OrderId;
use crate::report::Fault;

/// What is done at a place of the path, one after the other.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// The spindle is commanded.
    Command(OrderId),
    /// A function is output.
    Output(OrderId),
    /// The path stands until all of these are done.
    Gate(Box<[OrderId]>),
    /// The path comes to a standstill here in any case, for a function.
    Stand(OrderId),
    /// The path stands for a time, s.
    Dwell(f64),
    /// A programmed block with a motion ends: in single block the path stands here until the next start.
    BlockEnd,
    /// An axis starts on its own.
    Independent(Box<bahn_din::Independent>),
    /// The path stands until all axes have ended that move on their own.
    AllEnded,
    /// The program cannot go on.
    Fault(Box<Fault>),
    /// The program ends.
    End,
}

/// How a movement is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Driving {
    pub(crate) rapid: bool,
    pub(crate) feed_mm_min: f64,
    pub(crate) limit: VectorLimit,
}

/// `#VECTOR LIMIT`: infinite where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VectorLimit {
    pub(crate) velocity_mm_min: f64,
    /// Both slopes have the lesser of ACC and DEC.
    pub(crate) acceleration_mm_s2: f64,
}

impl VectorLimit {
    pub(crate) const NONE: VectorLimit = VectorLimit {
        velocity_mm_min: f64::INFINITY,
        acceleration_mm_s2: f64::INFINITY,
    };
}

/// An element of the path.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub(crate) curve: Curve,
    pub(crate) start: Position,
    pub(crate) end: Position,
    pub(crate) driving: Driving,
    pub(crate) block: Arc<str>,
    /// Count of executed blocks.
    pub(crate) unit: u64,
    pub(crate) length: f64,
    /// Distance along the path to its start, mm.
    pub(crate) from: f64,
}

impl Leg {
    pub(crate) fn to(&self) -> f64 {
        self.from + self.length
    }

    /// The place so far along it, mm.
    pub(crate) fn place(&self, along: f64) -> Position {
        let part = if self.length > 0.0 {
            along / self.length
        } else {
            1.0
        };
        self.curve.position(&self.start, &self.end, part.clamp(0.0, 1.0))
    }

    /// Its parts before and after a place so far along it, mm.
    pub(crate) fn split(&self, along: f64) -> (Leg, Leg) {
        let at = along / self.length;
        let part = |from: f64, to: f64| {
            let (curve, start, end) = self.curve.part(&self.start, &self.end, from, to);
            Leg {
                curve,
                start,
                end,
                length: self.length * (to - from),
                from: self.from + self.length * from,
                ..self.clone()
            }
        };
        let (mut first, mut second) = (part(0.0, at), part(at, 1.0));
        (first.length, second.length) = (along, self.length - along);
        (second.from, second.end) = (self.from + along, self.end);
        first.end = second.start;
        (first, second)
    }

    /// What is left of it after a place so far along it, or, backward, what lies from there to its start.
    pub(crate) fn rest(&self, along: f64, backward: bool) -> Leg {
        let at = if self.length > 0.0 {
            along / self.length
        } else {
            1.0
        };
        if !backward {
            return self.split(along).1;
        }
        let (curve, start, end) = self.curve.part(&self.start, &self.end, 0.0, at);
        let curve = match curve {
            Curve::Arc(arc) => Curve::Arc(bahn_path::Arc {
                sweep_deg: -arc.sweep_deg,
                ..arc
            }),
            other => other,
        };
        Leg {
            curve,
            start: end,
            end: start,
            length: along,
            ..self.clone()
        }
    }

    /// As the planner takes it.
    pub(crate) fn element(&self, sequence: u64) -> PathElement {
        let Driving {
            rapid,
            feed_mm_min,
            limit,
        } = self.driving;
        let feed = if rapid {
            FeedRate::Rapid
        } else {
            FeedRate::Programmed(feed_mm_min)
        };
        let feed = feed.up_to(limit.velocity_mm_min);
        let ends = [self.start, self.end];
        PathElement::new(BlockRef::default(), sequence, self.curve, ends, feed)
    }
}

/// A place of the path and the element after it.
#[derive(Clone, Debug)]
struct Stretch {
    actions: Vec<Action>,
    leg: Leg,
}

/// Elements that were executed and are kept for backward motion.
const HISTORY: u64 = 10_000;

/// The path as far as it is known. Its places are numbered: place `n` is that before element `n`, the last one is where
/// the path ends as far as it is known.
#[derive(Debug)]
pub(crate) struct Track {
    /// Number of the first element that is kept.
    first: u64,
    stretches: VecDeque<Stretch>,
    /// What is to be done where it ends.
    tail: Vec<Action>,
    distance: f64,
    end: Position,
    block: Arc<str>,
}

impl Track {
    /// A path that starts somewhere, with its first element numbered so.
    pub(crate) fn new(start: Position, first: u64, distance: f64) -> Track {
        Track {
            first,
            stretches: VecDeque::new(),
            tail: Vec::new(),
            distance,
            end: start,
            block: "".into(),
        }
    }

    /// The place where it ends as far as it is known.
    pub(crate) fn last(&self) -> u64 {
        self.first + self.stretches.len() as u64
    }

    fn index(&self, number: u64) -> Option<usize> {
        usize::try_from(number.checked_sub(self.first)?).ok()
    }

    pub(crate) fn leg(&self, number: u64) -> Option<&Leg> {
        self.stretches
            .get(self.index(number)?)
            .map(|stretch| &stretch.leg)
    }

    /// What is to be done at a place.
    pub(crate) fn actions(&self, place: u64) -> &[Action] {
        let stretch = self.index(place).and_then(|index| self.stretches.get(index));
        match stretch {
            Some(stretch) => &stretch.actions,
            None if place == self.last() => &self.tail,
            None => &[],
        }
    }

    /// The actions of a place, to change them.
    pub(crate) fn actions_mut(&mut self, place: u64) -> &mut [Action] {
        let last = self.last();
        let index = self.index(place);
        match index.and_then(|index| self.stretches.get_mut(index)) {
            Some(stretch) => &mut stretch.actions,
            None if place == last => &mut self.tail,
            None => &mut [],
        }
    }

    /// The first element that is kept.
    pub(crate) fn first(&self) -> u64 {
        self.first
    }

    /// Where a place lies.
    pub(crate) fn position(&self, place: u64) -> Position {
        self.leg(place).map_or(self.end, |leg| leg.start)
    }

    /// The distance along the path to a place, mm.
    pub(crate) fn distance(&self, place: u64) -> f64 {
        self.leg(place).map_or(self.distance, |leg| leg.from)
    }

    /// The block that leads to a place.
    pub(crate) fn block_before(&self, place: u64) -> Arc<str> {
        let before = place.checked_sub(1).and_then(|before| self.leg(before));
        before.map_or_else(|| self.block.clone(), |leg| leg.block.clone())
    }

    /// Where the path is so far along it, mm, looked for from an element backwards.
    pub(crate) fn position_at(&self, distance: f64, from: u64) -> Position {
        let mut number = from.min(self.last());
        while let Some(leg) = number.checked_sub(1).and_then(|before| self.leg(before)) {
            if self.leg(number).is_some_and(|leg| leg.from <= distance) {
                break;
            }
            number -= 1;
            if leg.from <= distance {
                break;
            }
        }
        self.leg(number)
            .map_or(self.end, |leg| leg.place(distance - leg.from))
    }

    /// It ends elsewhere, for axes moved on their own.
    pub(crate) fn set_end(&mut self, position: Position) {
        self.end = position;
    }

    pub(crate) fn push_action(&mut self, action: Action) {
        self.tail.push(action);
    }

    /// So many actions where the path ends are done: blocks without a movement may go on for ever.
    pub(crate) fn forget_done(&mut self, count: usize) {
        self.tail.drain(..count.min(self.tail.len()));
    }

    pub(crate) fn push_leg(&mut self, mut leg: Leg) {
        leg.from = self.distance;
        self.distance += leg.length;
        self.end = leg.end;
        self.block = leg.block.clone();
        self.stretches.push_back(Stretch {
            actions: std::mem::take(&mut self.tail),
            leg,
        });
    }

    /// Forgets what lies so far behind a place that nobody goes back to it; the first order that may still be asked for.
    pub(crate) fn forget_before(&mut self, place: u64) -> Option<OrderId> {
        while self.first + HISTORY < place && self.stretches.pop_front().is_some() {
            self.first += 1;
        }
        let first = self.stretches.iter().map(|stretch| &stretch.actions);
        first
            .chain([&self.tail])
            .flatten()
            .find_map(|action| match action {
                Action::Command(id) | Action::Output(id) | Action::Stand(id) => Some(*id),
                Action::Gate(ids) => ids.first().copied(),
                _ => None,
            })
    }
}
