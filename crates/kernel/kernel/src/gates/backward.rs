//! Backward motion along what was executed, and forward again over it.
//!
//! In backward motion functions are output as MOS, those that wait on the way back as MVS_SVS; forward again they have their own
//! types [004:54] (public: backward motion). What is output ahead is output at the place it belongs to in backward motion, and
//! forward again ahead of it; where the path turns after that, at once, as what does not come early enough (inferred).
//!
//! Decision: The way back reaches over 10,000 elements, within the program; what is output ahead goes out at its own
//! place on the way back, and ahead again forward, at once where the path turns after the place of output

use std::collections::VecDeque;

use bahn_motion::Drive;

use super::Gates;
use super::back::{Again, Back, FeedBack};
use super::functions::{Functions, Moment, Way};
use super::places::Action;

impl<T: Copy + Ord, O> Gates<T, O> {
    /// The element on which the path is, and how much of it is executed, mm.
    fn whereabouts(&self) -> (u64, f64) {
        let number = self.motion.reached;
        let leg = self.places.leg(number);
        let along = leg.map_or(0.0, |leg| self.distance() - leg.from_mm);
        match number.checked_sub(1).and_then(|before| self.places.leg(before)) {
            Some(before) if along <= 0.0 => (number - 1, before.length_mm),
            _ => (number, along),
        }
    }

    pub(super) fn turn_back(&mut self) {
        let (from, along) = self.whereabouts();
        let position = self.motion.path.position();
        self.single.all_block_ends();
        self.leads.promises.clear();
        self.motion.turn(position);
        self.again.clear();
        self.back = Some(Back {
            from,
            along_mm: along,
            fed: 1,
            reached: from + 1,
            seen: from + 1,
            at_limit: false,
        });
    }

    /// The distance along the path, mm, while it is run back.
    pub(super) fn backward_distance(&self) -> Option<f64> {
        let (back, path) = (self.back.as_ref()?, &self.motion.path);
        let number = path.element().and_then(|element| back.element(element.sequence));
        let leg = number.and_then(|number| self.places.leg(number));
        Some(match leg {
            Some(leg) => leg.from_mm + path.rest_mm(),
            None => self.places.leg(back.from).map_or_else(
                || self.places.distance(self.places.first()),
                |leg| leg.from_mm + back.along_mm,
            ),
        })
    }

    pub(super) fn cycle_back<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        mut drive: Drive,
        family: &mut F,
    ) -> bool {
        let Some(back) = self.back.as_mut() else {
            return false;
        };
        let mut feed = FeedBack {
            track: &self.places,
            back,
        };
        self.motion.path.prepare(&mut feed, usize::MAX);
        let (from, seen, reached) = (back.from, back.seen, back.reached);
        let waits = self.again.is_waited_for() || back.at_limit;
        // The next place with a function that is waited for in backward motion.
        let first = self.places.first();
        let known = (from + 2).saturating_sub(back.fed).max(first);
        let stop = (known..seen)
            .rev()
            .find(|place| self.waits_backward(*place, family));
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
        let block = self.places.leg(number).map(|leg| leg.block.clone());
        self.drive_once(&drive, block, family)
    }

    /// Whether the path stops at a place in backward motion.
    fn waits_backward<F: Functions<Ticket = T, Own = O>>(&self, place: u64, family: &F) -> bool {
        let distance = self.places.distance(place);
        let waits = |ticket| family.waits_backward(ticket);
        self.ends_block(place) && self.single.stops_at(distance, true)
            || self.outputs(place).any(waits)
            || self.leads.of_place(distance).any(waits)
    }

    /// The functions that have their output place there.
    fn outputs(&self, place: u64) -> impl Iterator<Item = T> {
        let actions = self.places.actions(place).iter();
        actions.filter_map(|action| match action {
            Action::Output(ticket) => Some(*ticket),
            _ => None,
        })
    }

    /// Whether a programmed block ends at a place.
    fn ends_block(&self, place: u64) -> bool {
        let actions = self.places.actions(place);
        actions.iter().any(|action| matches!(action, Action::BlockEnd))
    }

    /// Puts the functions of a place that are output in backward motion into a queue that is empty, the last one in program
    /// order first.
    fn queue_place<F: Functions<Ticket = T, Own = O>>(
        &self,
        place: u64,
        queue: &mut VecDeque<T>,
        family: &mut F,
    ) {
        queue.extend(self.outputs(place));
        for ticket in self.leads.of_place(self.places.distance(place)) {
            let after = queue.iter().position(|other| *other > ticket);
            queue.insert(after.unwrap_or(queue.len()), ticket);
        }
        queue.make_contiguous().reverse();
        queue.retain_mut(|ticket| match family.again(*ticket, true) {
            Some(again) => {
                *ticket = again;
                true
            }
            None => false,
        });
    }

    /// The path has come to the end of an element.
    pub(super) fn pass(&mut self, sequence: u64) {
        match self.back.as_mut() {
            Some(back) => {
                if let Some(place) = back.element(sequence) {
                    back.reached = place;
                }
            }
            None => self.motion.reached = self.motion.reached.max(sequence + 1),
        }
    }

    /// Outputs functions in backward motion. Whether anything was done.
    pub fn act_backward<F: Functions<Ticket = T, Own = O>>(&mut self, family: &mut F) -> bool {
        let Some(mut back) = self.back.take() else {
            return false;
        };
        let mut again = std::mem::replace(&mut self.again, Again::new());
        let mut any = false;
        loop {
            while let Some(ticket) = again.queue.front().copied() {
                if family.blocker(ticket).is_some() {
                    break;
                }
                again.queue.pop_front();
                any = true;
                let at = Moment {
                    position: self.places.position(back.seen),
                    ..self.now(family)
                };
                family.output(ticket, at, Way::Back);
                again.gate.push(ticket);
            }
            again.gate.retain(|ticket| !family.is_done(*ticket));
            if back.at_limit && !again.is_waited_for() {
                let moves = !self.motion.still || back.reached < back.seen;
                let distance = self.places.distance(back.seen);
                back.at_limit = self.single.stands_at_end(distance, true, moves);
                any |= !back.at_limit;
            }
            if again.is_waited_for() || back.at_limit || back.seen <= back.reached {
                break;
            }
            back.seen -= 1;
            any = true;
            self.queue_place(back.seen, &mut again.queue, family);
            back.at_limit = self.ends_block(back.seen);
        }
        (self.back, self.again) = (Some(back), again);
        any
    }

    /// Goes forward again from where the path stands: what it comes over is output anew.
    pub(super) fn turn_forward<F: Functions<Ticket = T, Own = O>>(&mut self, family: &mut F) {
        let distance = self.distance();
        let Some(back) = self.back.take() else {
            return;
        };
        let number = back.reached.saturating_sub(1).max(self.places.first());
        let (mut number, mut along) = match self.places.leg(number) {
            Some(leg) => (number, (distance - leg.from_mm).max(0.0)),
            // There is nothing to go back: it is still at the place where it turned.
            None => (number, 0.0),
        };
        if self.places.leg(number).is_some_and(|leg| along >= leg.length_mm) {
            (number, along) = (number + 1, 0.0);
        }
        let position = self.motion.path.position();
        self.single.all_block_ends();
        let first = if along > 0.0 { number + 1 } else { number };
        let turned = self
            .places
            .leg(back.from)
            .map_or(distance, |leg| leg.from_mm + back.along_mm);
        self.renew(first, (turned, distance), family);
        let done = if along > 0.0 {
            self.places.actions(number).len()
        } else {
            0
        };
        let part = (along > 0.0).then_some(along);
        self.motion.begin_on(position, number, part);
        (self.cursor, self.open_to, self.dwell) = ((number, done), number, None);
    }

    /// The functions from a place up to where actions are done next, and those ahead that the path comes over, which turned at
    /// a distance and goes on from another, mm, are new ones.
    fn renew<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        first: u64,
        (turned, from): (f64, f64),
        family: &mut F,
    ) {
        let Gates {
            again: Again { renewed, .. },
            leads,
            places,
            ..
        } = self;
        renewed.clear();
        leads.repeat(turned, from, |ticket| renewed.push((ticket, ticket)));
        for action in (first..=self.cursor.0).flat_map(|place| places.actions(place)) {
            if let Action::Output(ticket) | Action::Command(ticket) = action {
                renewed.push((*ticket, *ticket));
            }
        }
        renewed.sort_unstable();
        renewed.dedup();
        for (old, new) in renewed.iter_mut() {
            *new = family.again(*old, false).unwrap_or(*old);
        }
        let new = |ticket: &mut T| {
            if let Ok(at) = renewed.binary_search_by_key(ticket, |(old, _)| *old) {
                *ticket = renewed[at].1;
            }
        };
        for place in first..=places.last() {
            for action in places.actions_mut(place) {
                match action {
                    Action::Output(ticket) | Action::Command(ticket) | Action::Stand(ticket) => new(ticket),
                    Action::Gate(tickets) => tickets.iter_mut().for_each(new),
                    Action::Dwell(_) | Action::BlockEnd | Action::Own(_) => {}
                }
            }
        }
        family.renamed(&new);
        leads.rename(new);
    }
}
