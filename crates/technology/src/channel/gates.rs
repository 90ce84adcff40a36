//! What is done where the path is, and where it has to stop.

use bahn_path::Synchronisation;

use super::Channel;
use super::order::{Order, OrderId, RangeId};
use super::record::Moment;
use super::track::Action;
use crate::plc::{self, Output, cycle_at};
use crate::report::EventKind;

/// What became of an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Done {
    Yes,
    /// The path stands here for it.
    NotYet,
}

impl Channel<'_> {
    /// PLC and spindles do what they do in this cycle. Whether anything happened.
    pub(super) fn plc(&mut self) -> bool {
        let mut any = false;
        self.plc.begin(self.cycle);
        if let Some(message) = self.plc.take_fault() {
            self.progress.fault = Some(super::fault::named(&self.here(), "plc", message));
        }
        while let Some(reaction) = self.plc.next(self.cycle) {
            any = true;
            let at = self.now();
            match reaction {
                plc::Reaction::Fetch(id) => {
                    self.plan.ranges.fetch(id, &mut self.plan.orders);
                    self.tell(EventKind::Fetch, id, at);
                }
                plc::Reaction::Acknowledge(id) => {
                    self.plan.ranges.acknowledge(id, &mut self.plan.orders);
                    self.tell(EventKind::Acknowledge, id, at);
                }
                plc::Reaction::Confirm(id) => {
                    if let Some(order) = self.plan.orders.get_mut(id) {
                        order.state.confirmed = true;
                    }
                }
            }
        }
        any
    }

    fn tell(&mut self, kind: EventKind, id: OrderId, at: Moment) {
        if let Some(order) = self.plan.orders.get(id) {
            let target = order.range.map_or("", |range| self.plan.ranges.name(range));
            self.record.function(kind, (id, order), target, at);
        }
    }

    /// Does what is to be done up to where the path is. Whether anything was done.
    pub(super) fn act(&mut self) -> bool {
        let mut any = false;
        while self.progress.fault.is_none() && !self.progress.ended {
            let (place, index) = self.gates.cursor;
            if place > self.motion.reached {
                break;
            }
            if index < self.plan.track.actions(place).len() {
                if self.action(place, index) == Done::NotYet {
                    break;
                }
                self.gates.cursor.1 += 1;
                any = true;
            } else if place < self.motion.reached {
                self.gates.cursor = (place + 1, 0);
                any = true;
            } else {
                break;
            }
        }
        any
    }

    fn action(&mut self, place: u64, index: usize) -> Done {
        let Some(action) = self.plan.track.actions(place).get(index) else {
            return Done::Yes;
        };
        match action {
            Action::Command(id) => {
                let id = *id;
                self.command(id);
                Done::Yes
            }
            Action::Output(id) => {
                let id = *id;
                let blocked = self.range_of(id).and_then(|range| self.blocker(range));
                if blocked.is_some() {
                    return Done::NotYet;
                }
                self.output_at(id, place);
                Done::Yes
            }
            Action::Gate(ids) => {
                if ids.iter().all(|id| self.is_open(*id)) {
                    Done::Yes
                } else {
                    Done::NotYet
                }
            }
            Action::Stand(id) if self.motion.stands || !self.stands_for(*id) => Done::Yes,
            Action::Stand(_) => Done::NotYet,
            Action::BlockEnd => {
                let moves = !self.motion.still || place < self.motion.reached;
                if self
                    .single
                    .stands_at_end(self.plan.track.distance(place), false, moves)
                {
                    Done::NotYet
                } else {
                    Done::Yes
                }
            }
            Action::Dwell(seconds) => self.dwell(place, *seconds),
            Action::Independent(independent) => {
                let independent = independent.as_ref().clone();
                let at = self.now().position[independent.axis];
                self.motion.begin_independent(independent, at);
                Done::Yes
            }
            Action::AllEnded if self.motion.independent.is_empty() => Done::Yes,
            Action::AllEnded => Done::NotYet,
            Action::Fault(fault) => {
                self.progress.fault = Some(fault.as_ref().clone());
                Done::Yes
            }
            Action::End if !self.plan.leads.queue.is_empty() => Done::NotYet,
            Action::End => {
                self.progress.ended = true;
                Done::Yes
            }
        }
    }

    /// A dwell ends in the first cycle after its time, which begins when the path comes to rest.
    fn dwell(&mut self, place: u64, seconds: f64) -> Done {
        let cycle = self.cycle;
        let left = self.passed(place).map_or(0.0, |passed| passed.0);
        let end = *self
            .gates
            .dwell
            .get_or_insert_with(|| cycle + cycle_at((seconds - left).max(0.0), self.cycle_s));
        if cycle < end {
            return Done::NotYet;
        }
        self.gates.dwell = None;
        Done::Yes
    }

    pub(super) fn range_of(&self, id: OrderId) -> Option<RangeId> {
        self.plan.orders.get(id).and_then(|order| order.range)
    }

    /// The function for which nothing can be output to a range.
    pub(super) fn blocker(&self, range: RangeId) -> Option<OrderId> {
        self.plan
            .ranges
            .blocked(range, self.plc.fetched_before(self.cycle))
    }

    /// A spindle of the NC executes a function.
    fn command(&mut self, id: OrderId) {
        let Some(order) = self.plan.orders.get_mut(id) else {
            return;
        };
        order.state.commanded = true;
        if let Some(index) = order.spindle {
            let names = super::resolve::names(RangeId::Spindle(index), self.plan.settings);
            self.plc.command(id, &names, order.process_s, self.cycle);
        }
    }

    /// How long before this cycle, s, and how fast, mm/s, the path came to a place, if that was in the cycle before.
    pub(super) fn passed(&self, place: u64) -> Option<(f64, f64)> {
        let passed = self.motion.path.passed().iter();
        let mut at = passed.filter(|passed| passed.sequence + 1 == place);
        at.next().map(|passed| (passed.left_s, passed.speed_mm_s))
    }

    /// A function is output at a place of the path.
    fn output_at(&mut self, id: OrderId, place: u64) {
        let (left_s, speed_mm_s) = self.passed(place).unwrap_or((0.0, self.motion.speed()));
        let at = Moment {
            t: self.t(),
            position: self.plan.track.position(place),
            speed_mm_s,
        };
        let stamped = self.plan.orders.get(id).is_some_and(|order| {
            order.synch.kind == Synchronisation::MosTs && order.range == Some(RangeId::Channel)
        });
        // Below the cycle, however it is rounded.
        let offset_us = stamped.then(|| (left_s * 1e9).floor() / 1e3);
        self.output(id, at, offset_us);
        if stamped {
            self.record.output_beside(offset_us, None);
        }
    }

    /// A function is output, with the time since the path was at its place, µs, where the PLC gets that.
    pub(super) fn output(&mut self, id: OrderId, at: Moment, offset_us: Option<f64>) {
        let simulated = self.gates.simulated;
        if let Some(order) = self.plan.orders.get_mut(id)
            && simulated
            && !order.synch.forward
        {
            order.waits = false;
        }
        let has_room = self.plan.ranges.output(id, &mut self.plan.orders, self.cycle);
        let Some(order) = self.plan.orders.get(id) else {
            return;
        };
        let Some(range) = order.range else { return };
        let label = order.label();
        let names = self.plan.ranges.names(range);
        let output = Output {
            id,
            names,
            label: &label,
            range: range.in_window(),
            letter: order.letter.byte(),
            number: order.number,
            value: order.value.in_window(),
            process_s: order.process_s,
            offset_us,
            waits: order.waits,
        };
        self.plc.order(&output, self.cycle);
        let target = self.plan.ranges.name(range);
        self.record.function(EventKind::Output, (id, order), target, at);
        if !has_room {
            let message = format!("{label} is one late function too many that is not acknowledged");
            self.progress.fault = Some(super::fault::numbered(&order.place, 60146, message));
        }
    }

    /// Nothing is waited for because of this function.
    fn is_open(&self, id: OrderId) -> bool {
        self.plan
            .orders
            .get(id)
            .is_none_or(|order| self.order_is_open(order))
    }

    /// Whether the path comes to a standstill for a function in any case: not in simulated motion, as its type says there.
    fn stands_for(&self, id: OrderId) -> bool {
        !self.gates.simulated || self.plan.orders.get(id).is_some_and(|order| order.synch.forward)
    }

    fn order_is_open(&self, order: &Order) -> bool {
        order.is_done() || self.gates.simulated && !order.state.output && !order.synch.forward
    }

    /// Whether the path has to stop at a place, looking from one of its actions on.
    pub(super) fn is_closed(&self, place: u64, from: usize) -> bool {
        let actions = self.plan.track.actions(place).get(from..).unwrap_or_default();
        actions.iter().any(|action| match action {
            Action::Gate(ids) => !ids.iter().all(|id| self.is_open(*id)),
            Action::Stand(id) => self.stands_for(*id),
            Action::BlockEnd => self.single.stops_at(self.plan.track.distance(place), false),
            Action::Dwell(_) | Action::AllEnded | Action::End | Action::Fault(_) => true,
            Action::Output(_) | Action::Command(_) | Action::Independent(_) => false,
        })
    }

    /// The nearest place where the path has to stop, as far as it is known.
    pub(super) fn nearest_closed(&mut self) -> Option<u64> {
        let (cursor, index) = self.gates.cursor;
        let last = self.plan.track.last();
        let mut place = self.gates.open_to.max(cursor);
        while place < last && !self.is_closed(place, if place == cursor { index } else { 0 }) {
            place += 1;
        }
        self.gates.open_to = place;
        let closed =
            (place < last || self.is_closed(place, if place == cursor { index } else { 0 })).then_some(place);
        if !self.plan.ranges.any_blocked(self.plc.fetched_before(self.cycle)) {
            return closed;
        }
        // What is to be output next to a range whose last function is not fetched stops the path, too.
        let blocked = (cursor..place).find(|place| {
            let from = if *place == cursor { index } else { 0 };
            let actions = self.plan.track.actions(*place).get(from..).unwrap_or_default();
            actions.iter().any(|action| match action {
                Action::Output(id) => self.range_of(*id).and_then(|range| self.blocker(range)).is_some(),
                _ => false,
            })
        });
        blocked.or(closed)
    }

    /// The path went over a place where it should have stopped, but could not any more.
    pub(super) fn is_overrun(&self) -> bool {
        self.gates.cursor.0 < self.motion.reached
    }

    /// The functions for which the path cannot go on where it is.
    pub(super) fn missing(&self) -> Vec<OrderId> {
        if self.backward.is_on() {
            return self.missing_backward();
        }
        let (place, index) = self.gates.cursor;
        let mut missing = Vec::new();
        if place <= self.motion.reached {
            match self.plan.track.actions(place).get(index) {
                Some(Action::Gate(ids)) => {
                    missing.extend(ids.iter().copied().filter(|id| !self.is_open(*id)));
                }
                Some(Action::Output(id)) => {
                    missing.extend(self.range_of(*id).and_then(|range| self.blocker(range)));
                }
                _ => {}
            }
        }
        missing.extend(self.blocked_lead());
        missing
    }

    /// Whether something is to be done where the path is that is not done yet.
    pub(super) fn is_waiting(&self) -> bool {
        if self.backward.is_on() {
            return true;
        }
        let (place, index) = self.gates.cursor;
        let waits = |action: &Action| !matches!(action, Action::End | Action::AllEnded);
        place <= self.motion.reached && self.plan.track.actions(place).get(index).is_some_and(waits)
    }
}
