//! Functions that go out ahead of their element, while the path before it is executed [004:81-90].
//!
//! Decision: A function that goes out ahead by a time counts it as if the path stopped where it waits

use std::collections::VecDeque;

use bahn_path::{self as path, At, PathElement};

use super::outputs::Outputs;
use crate::clone_within::clone_within;
use crate::drive::Place;
use crate::item::Item;
use crate::ring::Ring;

/// Those of the known path that are still to go out.
#[derive(Debug, Default)]
pub(super) struct Ahead {
    queue: VecDeque<Entry>,
}

clone_within!(Ahead { queue });

#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Number of the element, and which of its functions.
    number: u64,
    index: usize,
    lead: path::Ahead,
}

impl Ahead {
    pub(super) fn clear(&mut self) {
        self.queue.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.queue.is_empty()
    }

    /// An element comes to the end of the path; allocates.
    pub(super) fn push(&mut self, element: &PathElement, number: u64) {
        for (index, function) in element.functions().iter().enumerate() {
            if let At::Ahead(lead) = function.at {
                self.queue.push_back(Entry { number, index, lead });
            }
        }
    }

    /// Number of the first element that has one.
    pub(super) fn first(&self) -> Option<u64> {
        self.queue.front().map(|entry| entry.number)
    }

    /// Puts out those whose place comes near, at a speed, mm/s, with so much of the current element to go, mm.
    pub(super) fn put(&mut self, ring: &Ring, speed: f64, rest: f64, outputs: &mut Outputs) {
        let Some(current) = ring.current() else {
            return;
        };
        let here = current.from + current.length - rest;
        self.queue.retain(|entry| {
            let Some(item) = ring.get(entry.number) else {
                return false;
            };
            let due = entry.is_due(item, item.from - here, speed);
            if due {
                outputs.put(item, entry.number, Place::Along(entry.index), false);
            }
            !due
        });
    }

    /// Takes those functions of an element away that went out already.
    pub(super) fn remainder(&self, element: &mut PathElement, number: u64) {
        let Some(functions) = element.functions.take() else {
            return;
        };
        let is_left = |index| {
            self.queue
                .iter()
                .any(|entry| (entry.number, entry.index) == (number, index))
        };
        let left = functions.into_iter().enumerate();
        let left = left.filter(|(index, one)| !matches!(one.at, At::Ahead(_)) || is_left(*index));
        let left: Box<[_]> = left.map(|(_, function)| function).collect();
        element.functions = (!left.is_empty()).then_some(left);
    }
}

impl Entry {
    /// Whether the place is as near as it is to be, at a distance, mm, at a speed, mm/s. A time is counted as if the
    /// path stopped there, when it waits there [004:87]: over the distance d with the deceleration a it takes
    /// d/v + v/2a.
    fn is_due(&self, item: &Item, distance: f64, speed: f64) -> bool {
        self.lead.is_due(distance, |_| {
            let braking = if item.awaits.ahead {
                0.5 * speed / item.acceleration
            } else {
                0.0
            };
            (speed > 0.0).then(|| distance / speed + braking)
        })
    }
}
