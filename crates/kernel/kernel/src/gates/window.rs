//! Micro Joints: functions that are output at a place within a block, which is split for it [004:111-147].
//!
//! Decision: The entry velocity of a Micro Joint is the feed of a piece of 10 nm; DEC and ACC of `#VECTOR LIMIT` are
//! one, the lesser
//!
//! Decision: Blocks without a motion do not count in the window of Micro Joints

use std::collections::VecDeque;

use super::held::{Held, SAME_MM};
use super::leg::{Leg, VectorLimit};
use super::places::{Action, Places};

/// Length of the piece at whose feed the path enters a joint (`E=`), mm.
const ENTRY: f64 = 1e-5;

/// Elements and actions that are kept at most.
const MOST: usize = 4000;

/// What is decoded and may still be split.
#[derive(Debug)]
pub struct Window<T, O> {
    pieces: VecDeque<Piece<T, O>>,
    legs: usize,
    /// Distance along the path to its end, mm.
    distance_mm: f64,
    /// Nothing is output before this, mm.
    barrier_mm: f64,
    /// How the next joint is driven.
    pub next: Option<JointFeed>,
}

#[allow(
    clippy::large_enum_variant,
    reason = "most are legs, and they are moved on once"
)]
#[derive(Debug)]
enum Piece<T, O> {
    Leg(Leg),
    Action(Action<T, O>),
}

/// How a joint is driven, as `#CHANNEL SET [M_PRE_OUTPUT ..]` says [004:138].
#[derive(Clone, Copy, Debug)]
pub struct JointFeed {
    /// Feed with which the path enters it, mm/min.
    pub entry_mm_min: Option<f64>,
    /// Feed after it, mm/min.
    pub feed_mm_min: Option<f64>,
    /// Without the limits of the path itself.
    pub vector_limit_off: bool,
}

/// Where a function is output that comes before its place.
#[derive(Clone, Copy, Debug)]
pub struct Planned {
    /// Distance along the path, mm.
    pub real_mm: f64,
    /// How far that is after where it was planned, mm.
    pub deviation_mm: f64,
    /// What kept it from going out where it was planned.
    pub held: Held,
}

impl<T, O> Default for Window<T, O> {
    fn default() -> Window<T, O> {
        Window {
            pieces: VecDeque::new(),
            legs: 0,
            distance_mm: 0.0,
            barrier_mm: 0.0,
            next: None,
        }
    }
}

impl<T: Copy, O> Window<T, O> {
    /// What is known of the path begins here.
    pub fn begin(&mut self, distance: f64) {
        *self = Window {
            distance_mm: distance,
            barrier_mm: distance,
            ..Window::default()
        };
    }

    /// Distance along the path to its end, mm.
    pub fn distance(&self) -> f64 {
        self.distance_mm
    }

    /// What is done at its end.
    pub fn action(&mut self, action: Action<T, O>) {
        self.pieces.push_back(Piece::Action(action));
    }

    /// An element comes; more than so many are not kept.
    pub fn leg(&mut self, mut leg: Leg, most: usize, track: &mut Places<T, O>) {
        leg.from_mm = self.distance_mm;
        self.distance_mm += leg.length_mm;
        self.pieces.push_back(Piece::Leg(leg));
        self.legs += 1;
        while self.legs > most {
            self.release_one(track);
        }
    }

    /// Nothing in it can be split, or it has no room for more.
    pub fn is_full(&self) -> bool {
        self.legs == 0 || self.pieces.len() > MOST
    }

    /// Nothing is output before its end as it is now.
    pub fn bar(&mut self) {
        self.barrier_mm = self.distance_mm;
    }

    fn release_one(&mut self, track: &mut Places<T, O>) {
        match self.pieces.pop_front() {
            Some(Piece::Leg(leg)) => {
                self.legs -= 1;
                track.push_leg(leg);
            }
            Some(Piece::Action(action)) => track.push_action(action),
            None => self.legs = 0,
        }
    }

    /// All that is kept goes on.
    pub fn release(&mut self, track: &mut Places<T, O>) {
        while !self.pieces.is_empty() {
            self.release_one(track);
        }
    }

    /// Where a function is output that belongs to the end of what is kept and has a lead, mm; `farthest` is how far back
    /// it may be, mm.
    pub fn plan(&self, lead: f64, farthest: f64) -> Planned {
        let first = self.pieces.iter().find_map(|piece| match piece {
            Piece::Leg(leg) => Some(leg.from_mm),
            Piece::Action(_) => None,
        });
        let window = first.unwrap_or(self.distance_mm).max(self.distance_mm - farthest);
        let planned = self.distance_mm - lead;
        let floor = window.max(self.barrier_mm);
        let real = planned.max(floor);
        let held = if real <= planned + SAME_MM {
            Held::No
        } else if window > self.barrier_mm + SAME_MM {
            Held::LookAhead
        } else {
            Held::Barrier
        };
        let real = if held == Held::No { planned } else { real };
        Planned {
            real_mm: real,
            deviation_mm: real - planned,
            held,
        }
    }

    /// Puts what is to be done at a place, which is after all that stands there already. Where an element is split for
    /// it, `after` is done at the end of its block, otherwise at once. The joint goes on to the end of what is kept.
    pub fn insert(&mut self, real: f64, actions: Vec<Action<T, O>>, after: Option<Action<T, O>>) {
        let joint = self.next.take();
        let at = self
            .pieces
            .iter()
            .position(|piece| matches!(piece, Piece::Leg(leg) if leg.to() > real + SAME_MM));
        let Some(mut at) = at else {
            self.pieces
                .extend(actions.into_iter().chain(after).map(Piece::Action));
            return;
        };
        let mut after = after;
        if let Some(Piece::Leg(leg)) = self.pieces.get(at)
            && leg.from_mm < real - SAME_MM
        {
            let (unit, (first, second)) = (leg.unit, leg.split(real - leg.from_mm));
            self.pieces[at] = Piece::Leg(first);
            at += 1;
            self.pieces.insert(at, Piece::Leg(second));
            self.legs += 1;
            if let Some(gate) = after.take() {
                let of_block = |piece: &Piece<T, O>| matches!(piece, Piece::Leg(leg) if leg.unit == unit);
                let last = self.pieces.iter().rposition(of_block).unwrap_or(at);
                self.pieces.insert(last + 1, Piece::Action(gate));
            }
        }
        for action in actions.into_iter().chain(after) {
            self.pieces.insert(at, Piece::Action(action));
            at += 1;
        }
        if let Some(joint) = joint {
            self.drive(at, joint);
        }
    }

    /// Drives the elements from one on as a joint.
    fn drive(&mut self, at: usize, joint: JointFeed) {
        for piece in self.pieces.range_mut(at..) {
            let Piece::Leg(leg) = piece else { continue };
            if joint.vector_limit_off {
                leg.driving.limit = VectorLimit::NONE;
            }
            if let Some(feed) = joint.feed_mm_min.filter(|_| !leg.driving.rapid) {
                leg.driving.feed_mm_min = feed;
            }
        }
        if let (Some(entry), Some(Piece::Leg(leg))) = (joint.entry_mm_min, self.pieces.get(at))
            && leg.length_mm > 2.0 * ENTRY
        {
            let (mut first, second) = leg.split(ENTRY);
            first.driving.rapid = false;
            first.driving.feed_mm_min = entry;
            self.pieces[at] = Piece::Leg(first);
            self.pieces.insert(at + 1, Piece::Leg(second));
            self.legs += 1;
        }
    }

    /// Splits the last element at a place, mm, with what is to be done there.
    pub fn split_last(&mut self, place: f64, actions: Vec<Action<T, O>>) {
        let last = |piece: &Piece<T, O>| matches!(piece, Piece::Leg(_));
        let Some(mut at) = self.pieces.iter().rposition(last) else {
            return;
        };
        let Some(Piece::Leg(leg)) = self.pieces.get(at) else {
            return;
        };
        if place >= leg.to() - SAME_MM {
            self.pieces.extend(actions.into_iter().map(Piece::Action));
            return;
        }
        if place > leg.from_mm + SAME_MM {
            let (first, second) = leg.split(place - leg.from_mm);
            self.pieces[at] = Piece::Leg(first);
            at += 1;
            self.pieces.insert(at, Piece::Leg(second));
            self.legs += 1;
        }
        for action in actions {
            self.pieces.insert(at, Piece::Action(action));
            at += 1;
        }
    }
}
