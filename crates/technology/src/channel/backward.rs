//! Backward motion along what was executed, and forward again over it.
//!
//! In backward motion functions are output as MOS, those with BWD_SYNCH as MVS_SVS; forward again they have their own types
//! [004:54] (public: backward motion). What is output ahead is output at the place it belongs to in backward motion, and forward
//! again ahead of it; where the path turns after that, at once, as what does not come early enough (inferred).

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use bahn_motion::{Drive, Interpolator};
use bahn_path::Synchronisation;

use super::Channel;
use super::back::{Back, FeedBack};
use super::order::{OrderId, State};
use super::record::Moment;
use super::track::Action;
use crate::synch::Synch;

impl Channel<'_> {
    /// Spends a cycle on the path. Whether it moved.
    pub(super) fn spend(&mut self, mut drive: Drive) -> bool {
        drive.hold |= self.resets();
        let t = self.t() + 0.5 * self.cycle_s;
        let script = self.plc.script();
        let wanted = script.is_some_and(|script| script.backward.iter().any(|range| range.contains(&t)));
        if wanted == self.backward.is_on() {
            return self.spend_on(drive);
        }
        // The path turns where it stands.
        if !self.motion.still {
            drive.hold = true;
            return self.spend_on(drive);
        }
        if !self.motion.stands {
            let at = self.now();
            self.stop(at);
        }
        if wanted {
            self.turn_back();
        } else {
            self.turn_forward();
        }
        self.spend_on(drive);
        true
    }

    fn spend_on(&mut self, drive: Drive) -> bool {
        if self.backward.is_on() {
            self.cycle_back(drive)
        } else {
            self.cycle_path(drive)
        }
    }

    /// The element on which the path is, and how much of it is executed, mm.
    fn whereabouts(&self) -> (u64, f64) {
        let number = self.motion.reached;
        let leg = self.plan.track.leg(number);
        let along = leg.map_or(0.0, |leg| self.distance() - leg.from);
        match number
            .checked_sub(1)
            .and_then(|before| self.plan.track.leg(before))
        {
            Some(before) if along <= 0.0 => (number - 1, before.length),
            _ => (number, along),
        }
    }

    fn turn_back(&mut self) {
        let (from, along) = self.whereabouts();
        let position = self.motion.path.position();
        self.single.all_block_ends();
        self.plan.leads.watched.clear();
        self.motion.turn(position);
        self.backward.back = Some(Back {
            from,
            along,
            fed: 1,
            reached: from + 1,
            seen: from + 1,
            queue: VecDeque::new(),
            gate: Vec::new(),
            at_limit: false,
        });
    }

    /// The distance along the path, mm, while it is run back.
    pub(super) fn backward_distance(&self, path: &Interpolator<()>) -> Option<f64> {
        let back = self.backward.back.as_ref()?;
        let number = path.element().and_then(|element| back.element(element.sequence));
        let leg = number.and_then(|number| self.plan.track.leg(number));
        Some(match leg {
            Some(leg) => leg.from + path.rest_mm(),
            None => self.plan.track.leg(back.from).map_or_else(
                || self.plan.track.distance(self.plan.track.first()),
                |leg| leg.from + back.along,
            ),
        })
    }

    fn cycle_back(&mut self, mut drive: Drive) -> bool {
        let Some(back) = self.backward.back.as_mut() else {
            return false;
        };
        let mut feed = FeedBack {
            track: &self.plan.track,
            back,
        };
        self.motion.path.prepare(&mut feed, usize::MAX);
        let (from, seen, reached) = (back.from, back.seen, back.reached);
        let waits = back.waits();
        // The next place with a function that is waited for in backward motion.
        let first = self.plan.track.first();
        let known = (from + 2).saturating_sub(back.fed).max(first);
        let stop = (known..seen).rev().find(|place| self.waits_backward(*place));
        drive.stop_before = stop.map(|place| from + 2 - place);
        drive.hold |= waits;
        if stop != Some(reached) && !waits {
            self.motion.path.go_on();
        }
        let number = if reached > from {
            from
        } else {
            reached.saturating_sub(1)
        };
        let block = self.plan.track.leg(number).map(|leg| leg.block.clone());
        self.drive_once(&drive, block)
    }

    /// Whether the path stops at a place in backward motion.
    fn waits_backward(&self, place: u64) -> bool {
        let actions = self.plan.track.actions(place);
        actions.iter().any(|action| matches!(action, Action::BlockEnd))
            && self.single.stops_at(self.plan.track.distance(place), true)
            || self.of_place(place).into_iter().any(|id| {
                let order = self.plan.orders.get(id);
                order.is_some_and(|order| order.synch.backward)
            })
    }

    /// The functions of a place that are output in backward motion, in program order.
    fn of_place(&self, place: u64) -> Vec<OrderId> {
        let outputs = self
            .plan
            .track
            .actions(place)
            .iter()
            .filter_map(|action| match action {
                Action::Output(id) => Some(*id),
                _ => None,
            });
        let mut ids: Vec<OrderId> = outputs.collect();
        for id in self.plan.leads.of_place(self.plan.track.distance(place)) {
            let at = ids.iter().position(|other| *other > id).unwrap_or(ids.len());
            ids.insert(at, id);
        }
        ids
    }

    /// The path has come to the end of an element.
    pub(super) fn pass(&mut self, sequence: u64) {
        match self.backward.back.as_mut() {
            Some(back) => {
                if let Some(place) = back.element(sequence) {
                    back.reached = place;
                }
            }
            None => self.motion.reached = self.motion.reached.max(sequence + 1),
        }
    }

    /// Outputs functions in backward motion. Whether anything was done.
    pub(super) fn act_backward(&mut self) -> bool {
        let Some(mut back) = self.backward.back.take() else {
            return false;
        };
        let mut any = false;
        loop {
            while let Some(id) = back.queue.front().copied() {
                if self.range_of(id).and_then(|range| self.blocker(range)).is_some() {
                    break;
                }
                back.queue.pop_front();
                any = true;
                let at = Moment {
                    position: self.plan.track.position(back.seen),
                    ..self.now()
                };
                self.output(id, at, None);
                back.gate.push(id);
            }
            back.gate.retain(|id| !self.plan.orders.is_done(*id));
            if back.at_limit && back.queue.is_empty() && back.gate.is_empty() {
                let moves = !self.motion.still || back.reached < back.seen;
                back.at_limit = self
                    .single
                    .stands_at_end(self.plan.track.distance(back.seen), true, moves);
                any |= !back.at_limit;
            }
            if back.waits() || back.seen <= back.reached {
                break;
            }
            back.seen -= 1;
            any = true;
            back.queue = self.repeated(back.seen);
            let limit = |action: &Action| matches!(action, Action::BlockEnd);
            back.at_limit = self.plan.track.actions(back.seen).iter().any(limit);
        }
        self.backward.back = Some(back);
        any
    }

    /// The functions of a place as they are output in backward motion, the last one first.
    fn repeated(&mut self, place: u64) -> VecDeque<OrderId> {
        let mut queue = VecDeque::new();
        for id in self.of_place(place).into_iter().rev() {
            let Some(mut order) = self.plan.orders.get(id).cloned() else {
                continue;
            };
            order.waits = order.synch.backward;
            let kind = if order.waits {
                Synchronisation::MvsSvs
            } else {
                Synchronisation::Mos
            };
            // In backward motion a simulated one is waited for all the same (public).
            order.synch = Synch {
                kind,
                forward: order.waits,
                ..order.synch
            };
            (order.spindle, order.state) = (None, State::default());
            queue.push_back(self.plan.orders.push(order));
        }
        queue
    }

    /// The functions for which the path cannot go on back.
    pub(super) fn missing_backward(&self) -> Vec<OrderId> {
        let Some(back) = &self.backward.back else {
            return Vec::new();
        };
        let front = back.queue.front();
        let blocked = front.and_then(|id| self.range_of(*id).and_then(|range| self.blocker(range)));
        back.gate.iter().copied().chain(blocked).collect()
    }

    /// Goes forward again from where the path stands: what it comes over is output anew.
    fn turn_forward(&mut self) {
        let distance = self.distance();
        let Some(back) = self.backward.back.take() else {
            return;
        };
        let number = back.reached.saturating_sub(1).max(self.plan.track.first());
        let (mut number, mut along) = match self.plan.track.leg(number) {
            Some(leg) => (number, (distance - leg.from).max(0.0)),
            // There is nothing to go back: it is still at the place where it turned.
            None => (number, 0.0),
        };
        if self.plan.track.leg(number).is_some_and(|leg| along >= leg.length) {
            (number, along) = (number + 1, 0.0);
        }
        let position = self.motion.path.position();
        self.single.all_block_ends();
        let first = if along > 0.0 { number + 1 } else { number };
        let turned = self
            .plan
            .track
            .leg(back.from)
            .map_or(distance, |leg| leg.from + back.along);
        let ahead = self.plan.leads.repeat(turned, distance);
        self.renew(first, self.gates.cursor.0, &ahead);
        let done = if along > 0.0 {
            self.plan.track.actions(number).len()
        } else {
            0
        };
        let part = (along > 0.0).then_some(along);
        self.motion.begin_on(position, number, part);
        (self.gates.cursor, self.gates.open_to, self.gates.dwell) = ((number, done), number, None);
    }

    /// The functions of these places, and these that are output ahead, are new ones.
    fn renew(&mut self, first: u64, last: u64, ahead: &[OrderId]) {
        let mut old: BTreeSet<OrderId> = ahead.iter().copied().collect();
        for place in first..=last {
            for action in self.plan.track.actions(place) {
                if let Action::Output(id) | Action::Command(id) = action {
                    old.insert(*id);
                }
            }
        }
        let mut renewed: BTreeMap<OrderId, OrderId> = BTreeMap::new();
        for id in old {
            if let Some(mut order) = self.plan.orders.get(id).cloned() {
                order.state = State::default();
                renewed.insert(id, self.plan.orders.push(order));
            }
        }
        let new = |id: &mut OrderId| *id = renewed.get(id).copied().unwrap_or(*id);
        for place in first..=self.plan.track.last() {
            for action in self.plan.track.actions_mut(place) {
                match action {
                    Action::Output(id) | Action::Command(id) | Action::Stand(id) => new(id),
                    Action::Gate(ids) => ids.iter_mut().for_each(new),
                    _ => {}
                }
            }
        }
        self.plan.decoding.late.iter_mut().flatten().for_each(new);
        self.plan.leads.rename(new);
    }
}
