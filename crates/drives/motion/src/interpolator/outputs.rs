//! The functions that are output within an element.

use std::collections::VecDeque;

use bahn_path::{At, TechnologyFunction};

use crate::clone_within::clone_within;
use crate::drive::{FunctionOutput, Passed, Place};
use crate::gate::{Gate, place};
use crate::item::Item;

#[derive(Debug, Default)]
pub(super) struct Outputs {
    queue: VecDeque<FunctionOutput>,
    /// Functions along the current element up to this length are output, mm.
    to: f64,
    /// Ends of elements that the cycle came to.
    passed: Vec<Passed>,
}

clone_within!(Outputs { queue, to, passed });

impl Outputs {
    /// For so many elements without functions: within them nothing allocates.
    pub(super) fn with_capacity(capacity: usize) -> Outputs {
        Outputs {
            passed: Vec::with_capacity(capacity),
            ..Outputs::default()
        }
    }

    /// Room for so many more, and for the ends of so many elements: within it nothing allocates.
    pub(super) fn reserve(&mut self, count: usize, ends: usize) {
        self.queue.reserve(count);
        // Those that are there are of the cycle before.
        self.passed.reserve(ends.saturating_sub(self.passed.len()));
    }

    /// Forgets which elements were passed in the cycle before.
    pub(super) fn begin_cycle(&mut self) {
        self.passed.clear();
    }

    /// The path comes to the end of an element, so long before the end of the cycle, s, at a speed, mm/s.
    pub(super) fn pass(&mut self, sequence: u64, left_s: f64, speed_mm_s: f64) {
        self.passed.push(Passed {
            sequence,
            left_s,
            speed_mm_s,
        });
    }

    pub(super) fn passed(&self) -> &[Passed] {
        &self.passed
    }

    pub(super) fn clear(&mut self) {
        self.queue.clear();
    }

    pub(super) fn next(&mut self) -> Option<FunctionOutput> {
        self.queue.pop_front()
    }

    /// Begins an element: none of its functions is output.
    pub(super) fn begin(&mut self) {
        self.to = f64::NEG_INFINITY;
    }

    pub(super) fn to(&self) -> f64 {
        self.to
    }

    /// Puts out what an element of this number has at a place.
    pub(super) fn put(&mut self, item: &Item, number: u64, place: Place, waits: bool) {
        self.queue.push_back(FunctionOutput {
            element: number,
            block: item.element.block,
            sequence: item.element.sequence,
            place,
            waits,
        });
    }

    /// Outputs the functions along an element that were passed, with so much of it to go, mm.
    pub(super) fn along(&mut self, item: &Item, number: u64, rest: f64, feed: f64) {
        let to = if rest > 0.0 {
            item.length - rest
        } else {
            f64::INFINITY
        };
        let passed = self.to..to;
        for (index, function) in item.element.functions().iter().enumerate() {
            let length = match function.at {
                _ if place(function).is_some() => continue,
                At::Length(length) if length > 0.0 => length.min(f64::MAX),
                At::Length(_) => 0.0,
                At::BeforeEnd(lead_s) => place_before_end(item, feed, lead_s),
                At::Start | At::End | At::Ahead(_) => continue,
            };
            if passed.contains(&length) {
                self.put(item, number, Place::Along(index), false);
            }
        }
        self.to = to;
    }
}

/// Of the functions of an element those at a place.
pub(super) fn at(
    wanted: Place,
    functions: &[TechnologyFunction],
) -> impl Iterator<Item = &TechnologyFunction> {
    functions
        .iter()
        .enumerate()
        .filter(move |(index, function)| match wanted {
            Place::Start => place(function) == Some(Gate::Start),
            Place::End => place(function) == Some(Gate::End),
            Place::Along(along) => *index == along,
        })
        .map(|(_, function)| function)
}

/// The path length of an element from which its movement still takes a time, s; at the latest that at which it begins
/// to brake, for in tapping the spindle follows a feed ramp that is flatter than its own [000:6070].
fn place_before_end(item: &Item, feed: f64, time_s: f64) -> f64 {
    let braking = item.braking_s(feed);
    let distance = item.peak(feed) * (0.5 * braking + (time_s - braking).max(0.0));
    (item.length - distance).max(0.0)
}
