//! Functions that are output ahead of the place where they are synchronised, MEP_* and MET_* [004:81-90].

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

use super::order::{Lead, OrderId};

/// Places nearer together than this are one, mm.
pub(super) const SAME: f64 = 1e-7;

/// A function that is still to be output ahead.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    pub(super) id: OrderId,
    /// Count of executed blocks.
    pub(super) unit: u64,
    pub(super) lead: Lead,
    /// Distance along the path to the place where it is synchronised, mm.
    pub(super) point: f64,
    /// It is not output before this, mm: the look-ahead reaches no farther back.
    pub(super) earliest: f64,
    /// Why not before that.
    pub(super) held: Held,
    /// Where it was output last, mm.
    output: f64,
}

/// What holds a function back that is to be output ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Held {
    /// The path begins there, or was to come to rest there.
    Barrier,
    /// No more blocks are looked at (P-CHAN-00274).
    LookAhead,
}

impl Ahead {
    /// Distance along the path to where it is output, mm, for a lead along the path.
    pub(super) fn place(&self) -> f64 {
        match self.lead {
            Lead::Distance(distance) => (self.point - distance).max(self.earliest),
            Lead::None => self.point,
            Lead::Time(_) => self.earliest,
        }
    }
}

/// A function that was output ahead of its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Promise {
    pub(super) ahead: Ahead,
    /// When it was output, s, and how long the path was to take to its place then, s.
    pub(super) output_s: f64,
    pub(super) planned_s: f64,
}

/// Functions that were output ahead, until the path passes their places.
#[derive(Debug, Default)]
pub(super) struct Watched {
    pub(super) promises: VecDeque<Promise>,
    /// What was reported: a block that comes again is reported once.
    pub(super) reported: BTreeSet<(String, Arc<str>, u32)>,
}

impl Watched {
    /// The path turns: it passes their places otherwise.
    pub(super) fn clear(&mut self) {
        self.promises.clear();
    }
}

/// All that are still to be output ahead, in the order of their blocks.
#[derive(Debug, Default)]
pub(super) struct Leads {
    pub(super) queue: VecDeque<Ahead>,
    /// Those that were output and whose places are not passed yet.
    pub(super) watched: Watched,
    /// Those that were output, by their places: for backward motion.
    taken: VecDeque<Ahead>,
    /// Distances to the starts of the last blocks, as many as the look-ahead takes.
    blocks: VecDeque<f64>,
    /// Nothing is output before this, mm: the path was to come to rest here.
    barrier: f64,
    /// Where the last one was output, or had to be passed for the next one, mm.
    pub(super) floor: f64,
    /// The place that was turned to last, and its functions (P-CHAN-00212).
    active: Option<(f64, Vec<OrderId>)>,
}

impl Leads {
    /// A block with a movement begins at a distance along the path, mm; so many blocks are looked at.
    pub(super) fn block(&mut self, distance: f64, most: usize) {
        self.blocks.push_back(distance);
        while self.blocks.len() > most {
            self.blocks.pop_front();
        }
    }

    /// Nothing is output across this place, mm.
    pub(super) fn bar(&mut self, distance: f64) {
        self.barrier = distance;
        self.blocks.clear();
    }

    pub(super) fn push(&mut self, id: OrderId, unit: u64, lead: Lead, point: f64) {
        let first = self.blocks.front().copied().unwrap_or(point);
        let held = if first > self.barrier + SAME {
            Held::LookAhead
        } else {
            Held::Barrier
        };
        self.queue.push_back(Ahead {
            id,
            unit,
            lead,
            point,
            earliest: first.max(self.barrier).min(point),
            held,
            output: point,
        });
    }

    /// The functions that may be output now: those of the first block that has any. With `one_by_one` not before the
    /// place before is passed: `passed` says so of it and its functions.
    pub(super) fn next(
        &self,
        one_by_one: bool,
        passed: impl Fn(f64, &[OrderId]) -> bool,
    ) -> impl Iterator<Item = (usize, &Ahead)> {
        let first = self.queue.front();
        let held = one_by_one
            && match (first, &self.active) {
                (Some(first), Some((point, ids))) => first.point > point + SAME && !passed(*point, ids),
                _ => false,
            };
        let unit = first.map(|ahead| ahead.unit);
        self.queue
            .iter()
            .enumerate()
            .take_while(move |(_, ahead)| Some(ahead.unit) == unit && !held)
    }

    /// One of them is output, at a distance along the path, mm.
    pub(super) fn take(&mut self, index: usize, one_by_one: bool, output: f64) {
        let Some(ahead) = self.queue.remove(index) else {
            return;
        };
        let at = self.taken.partition_point(|other| other.point <= ahead.point);
        self.taken.insert(at, Ahead { output, ..ahead });
        if let Some((point, _)) = self.active.as_ref().filter(|_| one_by_one)
            && ahead.point > point + SAME
        {
            self.floor = self.floor.max(*point);
        }
        match &mut self.active {
            Some((point, ids)) if (*point - ahead.point).abs() <= SAME => ids.push(ahead.id),
            active => *active = Some((ahead.point, vec![ahead.id])),
        }
    }

    /// One that is output does so at this place of the path, mm.
    pub(super) fn output_at(&mut self, id: OrderId, distance: f64) {
        self.floor = distance;
        if let Some(ahead) = self.taken.iter_mut().rev().find(|ahead| ahead.id == id) {
            ahead.output = distance;
        }
    }

    /// Where one that is output was so, mm.
    pub(super) fn placed(&self, id: OrderId) -> Option<f64> {
        let taken = self.taken.iter().rev().find(|ahead| ahead.id == id);
        taken.map(|ahead| ahead.output)
    }

    /// The functions that were output and belong to a place, mm.
    pub(super) fn of_place(&self, distance: f64) -> impl Iterator<Item = OrderId> {
        let first = self.taken.partition_point(|ahead| ahead.point < distance - SAME);
        let here = self
            .taken
            .range(first..)
            .take_while(move |ahead| ahead.point <= distance + SAME);
        here.map(|ahead| ahead.id)
    }

    /// The path has turned at a distance along the path, mm, and goes forward again from another one. What it comes over is still to be output:
    /// the place of a function, or where it was output. They are handed on.
    pub(super) fn repeat(&mut self, turned: f64, from: f64) -> Vec<OrderId> {
        let (again, over): (Vec<Ahead>, Vec<Ahead>) = self.taken.drain(..).partition(|ahead| {
            let of_point = ahead.point <= turned + SAME && ahead.point >= from - SAME;
            of_point || ahead.output >= from - SAME
        });
        self.taken = over.into();
        if !again.is_empty() {
            self.active = None;
        }
        self.floor = self.floor.min(from);
        let ids = again.iter().map(|ahead| ahead.id).collect();
        self.queue = again.into_iter().chain(self.queue.drain(..)).collect();
        self.queue
            .make_contiguous()
            .sort_by_key(|ahead| (ahead.unit, ahead.id));
        ids
    }

    /// Their orders are others now.
    pub(super) fn rename(&mut self, new: impl Fn(&mut OrderId)) {
        self.queue.iter_mut().for_each(|ahead| new(&mut ahead.id));
    }

    /// Nobody goes back to what lies before this distance along the path, mm; the first order that may still be asked for.
    pub(super) fn forget_before(&mut self, distance: f64) -> Option<OrderId> {
        self.taken.retain(|ahead| ahead.point >= distance);
        self.taken.iter().map(|ahead| ahead.id).min()
    }

    /// The path begins anew.
    pub(super) fn begin(&mut self, distance: f64) {
        *self = Leads {
            barrier: distance,
            floor: distance,
            ..Leads::default()
        };
    }
}
