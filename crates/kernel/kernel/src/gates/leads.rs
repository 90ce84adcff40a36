//! Functions that are output ahead of the place where they are synchronised, `MEP_*` and `MET_*` [004:81-90].

use std::collections::VecDeque;

use bahn_path::Ahead;

use super::held::{Held, SAME_MM};

/// A function that is still to be output ahead.
#[derive(Clone, Copy, Debug)]
pub struct Pending<T> {
    /// The ticket by which its family knows it.
    pub id: T,
    /// Count of executed blocks.
    pub unit: u64,
    /// How far ahead it goes out.
    pub lead: Ahead,
    /// Distance along the path to the place where it is synchronised, mm.
    pub point_mm: f64,
    /// It is not output before this, mm: the look-ahead reaches no farther back.
    pub earliest_mm: f64,
    /// Why not before that.
    pub held: Held,
    /// Where it was output last, mm.
    output_mm: f64,
}

impl<T> Pending<T> {
    /// Distance along the path to where it is output, mm, for a lead along the path.
    pub fn place(&self) -> f64 {
        match self.lead {
            Ahead::Distance(distance) => (self.point_mm - distance).max(self.earliest_mm),
            Ahead::Time(_) => self.earliest_mm,
        }
    }
}

/// A function that was output ahead of its place.
#[derive(Clone, Copy, Debug)]
pub struct Promise<T> {
    /// The function, with the lead that was asked for.
    pub ahead: Pending<T>,
    /// When it was output, s.
    pub output_s: f64,
    /// How long the path was to take to its place then, s.
    pub planned_s: f64,
}

/// All that are still to be output ahead, in the order of their blocks.
#[derive(Debug)]
pub struct Leads<T> {
    /// The look-ahead turns to the next place when it has passed the one before (P-CHAN-00212).
    pub one_by_one: bool,
    queue: VecDeque<Pending<T>>,
    /// Those that were output and whose places are not passed yet.
    pub promises: VecDeque<Promise<T>>,
    /// Those that were output, by their places: for backward motion.
    taken: VecDeque<Pending<T>>,
    /// Distances to the starts of the last blocks, as many as the look-ahead takes.
    blocks: VecDeque<f64>,
    /// Nothing is output before this, mm: the path was to come to rest here.
    barrier_mm: f64,
    /// Where the last one was output, or had to be passed for the next one, mm.
    pub floor_mm: f64,
    /// The place that was turned to last, mm, and its functions (P-CHAN-00212).
    active_mm: Option<f64>,
    active: Vec<T>,
}

impl<T: Copy + Ord> Leads<T> {
    /// Nothing is to be output ahead, on a path that begins.
    pub fn new(one_by_one: bool) -> Leads<T> {
        Leads {
            one_by_one,
            queue: VecDeque::new(),
            promises: VecDeque::new(),
            taken: VecDeque::new(),
            blocks: VecDeque::new(),
            barrier_mm: 0.0,
            floor_mm: 0.0,
            active_mm: None,
            active: Vec::new(),
        }
    }

    /// Nothing is to be output ahead.
    pub fn is_empty(&self) -> bool {
        self.queue.is_empty()
    }

    /// A block with a movement begins at a distance along the path, mm; so many blocks are looked at.
    pub fn block(&mut self, distance: f64, most: usize) {
        self.blocks.push_back(distance);
        while self.blocks.len() > most {
            self.blocks.pop_front();
        }
    }

    /// Nothing is output across this place, mm.
    pub fn bar(&mut self, distance: f64) {
        self.barrier_mm = distance;
        self.blocks.clear();
    }

    /// A function of a block is to be output a lead ahead of a place, mm along the path.
    pub fn push(&mut self, id: T, unit: u64, lead: Ahead, point: f64) {
        let first = self.blocks.front().copied().unwrap_or(point);
        let held = if first > self.barrier_mm + SAME_MM {
            Held::LookAhead
        } else {
            Held::Barrier
        };
        self.queue.push_back(Pending {
            id,
            unit,
            lead,
            point_mm: point,
            earliest_mm: first.max(self.barrier_mm).min(point),
            held,
            output_mm: point,
        });
        // Wherever one goes from here, it needs no memory then.
        let count = self.count();
        self.queue.reserve(count - self.queue.len());
        self.taken.reserve(count - self.taken.len());
        self.promises.reserve(count.saturating_sub(self.promises.len()));
        self.active.reserve(count.saturating_sub(self.active.len()));
    }

    /// How many there are, whether they were output or not.
    pub fn count(&self) -> usize {
        self.queue.len() + self.taken.len()
    }

    /// How many of them, from the first one on, may be output now: those of the first block that has any. One by one not
    /// before the place before is passed: `passed` says so of it and its functions.
    pub fn ready(&self, passed: impl Fn(f64, &[T]) -> bool) -> usize {
        let Some(first) = self.queue.front() else {
            return 0;
        };
        let is_ahead = |point: f64| first.point_mm > point + SAME_MM && !passed(point, &self.active);
        if self.one_by_one && self.active_mm.is_some_and(is_ahead) {
            return 0;
        }
        let of_block = self.queue.iter().take_while(|ahead| ahead.unit == first.unit);
        of_block.count()
    }

    /// One that is still to be output.
    pub fn get(&self, index: usize) -> Option<Pending<T>> {
        self.queue.get(index).copied()
    }

    /// One of them is output, at a distance along the path, mm.
    pub fn take(&mut self, index: usize, output: f64) {
        let Some(ahead) = self.queue.remove(index) else {
            return;
        };
        let at = self
            .taken
            .partition_point(|other| other.point_mm <= ahead.point_mm);
        self.taken.insert(
            at,
            Pending {
                output_mm: output,
                ..ahead
            },
        );
        if let Some(point) = self.active_mm.filter(|_| self.one_by_one)
            && ahead.point_mm > point + SAME_MM
        {
            self.floor_mm = self.floor_mm.max(point);
        }
        let is_same = |point: f64| (point - ahead.point_mm).abs() <= SAME_MM;
        if !self.active_mm.is_some_and(is_same) {
            self.active_mm = Some(ahead.point_mm);
            self.active.clear();
        }
        self.active.push(ahead.id);
    }

    /// One that is output does so at this place of the path, mm.
    pub fn output_at(&mut self, id: T, distance: f64) {
        self.floor_mm = distance;
        if let Some(ahead) = self.taken.iter_mut().rev().find(|ahead| ahead.id == id) {
            ahead.output_mm = distance;
        }
    }

    /// Where one that is output was so, mm.
    pub fn placed(&self, id: T) -> Option<f64> {
        let taken = self.taken.iter().rev().find(|ahead| ahead.id == id);
        taken.map(|ahead| ahead.output_mm)
    }

    /// The functions that were output and belong to a place, mm.
    pub fn of_place(&self, distance: f64) -> impl Iterator<Item = T> {
        let first = self
            .taken
            .partition_point(|ahead| ahead.point_mm < distance - SAME_MM);
        let here = self
            .taken
            .range(first..)
            .take_while(move |ahead| ahead.point_mm <= distance + SAME_MM);
        here.map(|ahead| ahead.id)
    }

    /// The path has turned at a distance along the path, mm, and goes forward again from another one. What it comes over is still to be output:
    /// the place of a function, or where it was output. They are handed `on`.
    pub fn repeat(&mut self, turned: f64, from: f64, mut on: impl FnMut(T)) {
        for _ in 0..self.taken.len() {
            let Some(ahead) = self.taken.pop_front() else {
                break;
            };
            let of_point = ahead.point_mm <= turned + SAME_MM && ahead.point_mm >= from - SAME_MM;
            if !of_point && ahead.output_mm < from - SAME_MM {
                self.taken.push_back(ahead);
                continue;
            }
            on(ahead.id);
            self.queue.push_back(ahead);
            self.active_mm = None;
        }
        self.floor_mm = self.floor_mm.min(from);
        self.queue
            .make_contiguous()
            .sort_unstable_by_key(|ahead| (ahead.unit, ahead.id));
    }

    /// Their tickets are others now.
    pub fn rename(&mut self, new: impl Fn(&mut T)) {
        self.queue.iter_mut().for_each(|ahead| new(&mut ahead.id));
    }

    /// Nobody goes back to what lies before this distance along the path, mm; the first function that may still be asked for.
    pub fn forget_before(&mut self, distance: f64) -> Option<T> {
        self.taken.retain(|ahead| ahead.point_mm >= distance);
        self.taken.iter().map(|ahead| ahead.id).min()
    }

    /// The path begins anew.
    pub fn begin(&mut self, distance: f64) {
        *self = Leads {
            barrier_mm: distance,
            floor_mm: distance,
            ..Leads::new(self.one_by_one)
        };
    }
}
