//! The elements to come, in a ring of fixed capacity, and how fast they may be driven.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_path::{PathElement, Placement, Position};

use crate::clone_within::clone_within;
use crate::connect::connect;
use crate::envelope::Envelope;
use crate::gate::Gates;
use crate::item::Item;
use crate::joints::Joints;
use crate::late::Late;
use crate::limits::{Dynamics, Limits};
use crate::motion::Motion;
use crate::stretch::Wish;

/// The element that is executed, the next one and a line to its start.
const LEAST_CAPACITY: usize = 3;

#[derive(Debug)]
pub(crate) struct Ring {
    dynamics: Dynamics,
    items: VecDeque<Item>,
    /// Items that were put aside; so many of them were executed.
    aside: VecDeque<Item>,
    executed_aside: usize,
    /// Segment by segment like the items.
    envelope: Envelope,
    joints: Joints,
    capacity: usize,
    /// Number of the first item.
    first: u64,
    /// Index of the item that is executed; those before it are only kept until `discard`.
    current: usize,
    /// Functions of all items.
    outputs: usize,
    late: Late,
    /// Items that wait for functions to be acknowledged.
    awaiting: usize,
    /// Where the path ends.
    end: Position,
    /// The placement in which that is.
    placement: Option<Arc<Placement>>,
}

clone_within!(Ring {
    dynamics,
    items,
    aside,
    executed_aside,
    envelope,
    joints,
    capacity,
    first,
    current,
    outputs,
    late,
    awaiting,
    end,
    placement,
});

impl Ring {
    /// Room for `capacity` elements, or the least that it works with.
    pub(crate) fn new(dynamics: Dynamics, capacity: usize) -> Ring {
        let capacity = capacity.max(LEAST_CAPACITY);
        Ring {
            dynamics,
            items: VecDeque::with_capacity(capacity),
            aside: VecDeque::with_capacity(capacity),
            executed_aside: 0,
            envelope: Envelope::with_capacity(capacity),
            joints: Joints::default(),
            capacity,
            first: 0,
            current: 0,
            outputs: 0,
            late: Late::default(),
            awaiting: 0,
            end: Position::UNKNOWN,
            placement: None,
        }
    }

    /// The item that is executed.
    #[inline]
    pub(crate) fn current(&self) -> Option<&Item> {
        self.items.get(self.current)
    }

    /// The item after it.
    #[inline]
    pub(crate) fn following(&self) -> Option<&Item> {
        self.items.get(self.current + 1)
    }

    /// Number of the item that is executed.
    #[inline]
    pub(crate) fn number(&self) -> u64 {
        self.first + self.current as u64
    }

    /// An item by its number, while it is kept.
    pub(crate) fn get(&self, number: u64) -> Option<&Item> {
        self.items
            .get(usize::try_from(number.checked_sub(self.first)?).ok()?)
    }

    /// The last item that is known.
    pub(crate) fn back(&self) -> Option<&Item> {
        self.items.back()
    }

    /// Number of the last item.
    pub(crate) fn last(&self) -> Option<u64> {
        Some(self.first + self.items.len().checked_sub(1)? as u64)
    }

    /// Functions of the items that are kept.
    pub(crate) fn outputs(&self) -> usize {
        self.outputs
    }

    /// Whether an item that is kept waits for functions to be acknowledged.
    pub(crate) fn awaits(&self) -> bool {
        self.awaiting > 0
    }

    /// Whether what is known, or comes after it, waits for functions to be acknowledged.
    pub(crate) fn is_late(&self) -> bool {
        self.awaits() || self.late.is_any()
    }

    /// What comes next waits for all functions that went out.
    pub(crate) fn await_all(&mut self) {
        self.late.begin(self.first);
    }

    /// Goes on to the next item.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.current += 1;
        self.envelope.advance();
    }

    /// Items from the current one on.
    pub(crate) fn ahead(&self) -> impl ExactSizeIterator<Item = &Item> {
        self.items.range(self.current.min(self.items.len())..)
    }

    /// The first item at whose end the path can stand when it brakes from a squared speed with so much of the current one to
    /// go, mm, and the distance that it takes, mm; the number after the last one when it cannot within what is known.
    pub(crate) fn standstill(&self, squared: f64, rest: f64) -> (u64, f64) {
        let (mut possible, mut distance, mut length) = (0.0, 0.0, rest);
        let mut following = self.ahead().skip(1);
        for (number, item) in (self.number()..).zip(self.ahead()) {
            let before = possible;
            possible += 2.0 * item.acceleration * length;
            if squared <= possible {
                let braking = (squared - before).max(0.0) / (2.0 * item.acceleration);
                return (number, distance + braking);
            }
            distance += length;
            length = following.next().map_or(0.0, |next| next.length);
        }
        (self.number() + self.ahead().len() as u64, distance)
    }

    /// Puts aside the item that is executed and those after it; nothing allocates.
    pub(crate) fn set_aside(&mut self) {
        if self.current < self.items.len() {
            std::mem::swap(&mut self.items, &mut self.aside);
            self.executed_aside = self.current;
            self.first += self.current as u64;
        } else {
            // What was put aside before is not wanted any more.
            self.executed_aside = self.aside.len();
        }
    }

    /// Takes out what was put aside.
    pub(crate) fn take_aside(&mut self) -> impl Iterator<Item = PathElement> + '_ {
        let executed = std::mem::take(&mut self.executed_aside);
        self.aside.drain(..).skip(executed).map(|item| item.element)
    }

    /// Drops the executed items, and what was put aside.
    pub(crate) fn discard(&mut self) {
        self.aside.clear();
        self.first += self.current as u64;
        for item in self.items.drain(..self.current) {
            self.outputs -= item.outputs();
            self.awaiting -= usize::from(!item.awaits.nothing());
        }
        self.current = 0;
        self.envelope.discard();
    }

    /// Whether an element fits in, and the line to its start that it may need.
    pub(crate) fn has_room(&self) -> bool {
        self.items.len() + 2 <= self.capacity
    }

    /// Drops everything; the path starts at a position, in a placement.
    pub(crate) fn clear(&mut self, position: Position, placement: Option<Arc<Placement>>) {
        self.placement = placement;
        self.first += self.items.len() as u64;
        self.items.clear();
        (self.outputs, self.awaiting) = (0, 0);
        self.late = Late::default();
        self.envelope.clear(self.first);
        self.current = 0;
        self.end = position;
        self.joints = Joints::default();
    }

    /// What is known ends in a stop for good.
    pub(crate) fn stop(&mut self) {
        self.joints.stop(&mut self.envelope);
        if let Some(last) = self.items.back_mut() {
            last.block_end = true;
        }
    }

    /// Puts an element at the end of the path. It starts where the path is: axes without a position at
    /// its start move from where they are.
    pub(crate) fn push(&mut self, mut element: PathElement) {
        if let Some(approach) = connect(&self.end, self.placement.as_ref(), &mut element) {
            self.append(approach);
        }
        self.append(element);
    }

    fn append(&mut self, element: PathElement) {
        let Ring {
            dynamics,
            envelope,
            joints,
            late,
            ..
        } = self;
        let gates = Gates::of(&element);
        let mut motion = Motion::of(&element, dynamics);
        let mut item = Item::new(element, motion.as_ref());
        item.awaits = late.follow(&item.element, self.first + self.items.len() as u64);
        self.awaiting += usize::from(!item.awaits.nothing());
        let greatest = item.greatest(dynamics);
        // Joints are found for the greatest speeds that the machine has; the feed is beside them.
        if let Some(motion) = &mut motion {
            motion.speed = greatest;
        }
        if let Some(last) = self.items.back_mut() {
            last.block_end = last.element.sequence != item.element.sequence;
            item.from = last.from + last.length;
        }
        joints.join(envelope, motion.as_ref(), gates, dynamics);
        let wish = motion.as_ref().map(|_| Wish::of(&item.element, item.slowest));
        envelope.push(item.energy(), greatest, wish);
        joints.follow(envelope, &item.element, motion, gates, dynamics);
        if gates.end {
            // The path may be there before anything comes after it.
            joints.settle(envelope);
        }
        self.end = item.element.end;
        if !Placement::is_same(self.placement.as_ref(), item.element.placement.as_ref()) {
            self.placement.clone_from(&item.element.placement);
        }
        self.outputs += item.outputs();
        self.items.push_back(item);
    }

    /// Other limits for what comes from now on, with overrides, %, and rapid traverse, mm/min, as they are.
    pub(crate) fn set_limits(&mut self, limits: &Limits, percent: [f64; 3], rapid_mm_min: f64) {
        let all_rapid = self.dynamics.all_rapid;
        self.dynamics = Dynamics::new(limits);
        self.dynamics.all_rapid = all_rapid;
        self.dynamics.set_overrides(percent);
        self.dynamics.set_rapid_limit(rapid_mm_min);
    }

    /// Other overrides, %: feed, rapid traverse, spindle.
    pub(crate) fn set_overrides(&mut self, percent: [f64; 3]) {
        self.dynamics.set_overrides(percent);
        self.envelope.forget_wanted();
    }

    /// Programmed feeds count as rapid traverse, or no more.
    pub(crate) fn set_all_rapid(&mut self, all: bool) {
        self.dynamics.all_rapid = all;
        self.envelope.forget_wanted();
    }

    /// No axis is faster than this from now on, mm/min.
    pub(crate) fn set_rapid_limit(&mut self, limit_mm_min: f64) {
        self.dynamics.set_rapid_limit(limit_mm_min);
        let current = self.current.min(self.items.len());
        let items = self.items.range(current..);
        self.envelope
            .set_greatest(items.map(|item| item.greatest(&self.dynamics)));
    }

    /// The path is to stop at the end of an item.
    pub(crate) fn set_stop(&mut self, number: Option<u64>) {
        self.envelope.set_stop(number);
    }

    /// Whether the stop at the end of an item is passed, or there is none.
    pub(crate) fn stop_is_passed(&self) -> bool {
        self.envelope.stop_is_passed()
    }

    /// Greatest path speed on the current item with the overrides as they are, mm/s.
    #[inline]
    pub(crate) fn feed(&self) -> f64 {
        self.current().map_or(0.0, |item| item.feed(&self.dynamics))
    }

    /// Greatest squared speed at the end of the current item.
    #[inline]
    pub(crate) fn exit(&mut self) -> f64 {
        self.envelope.exit(&self.dynamics)
    }

    /// Squared speed at the end of the current item that machine and path allow, whatever comes after it.
    #[inline]
    pub(crate) fn cap(&self) -> f64 {
        self.envelope.cap()
    }
}
