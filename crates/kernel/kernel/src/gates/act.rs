//! What is done where the path is, and where it has to stop.
//!
//! Decision: What the PLC has not fetched in its cycle blocks the next output to its range; an output that can no
//! more be stopped before waits after its place, and the path stops as soon as it can

use super::functions::{Functions, Moment, Way};
use super::places::Action;
use super::{Gates, cycle_at};

impl<T: Copy + Ord, O> Gates<T, O> {
    /// Does what is to be done up to where the path is. Whether anything was done.
    pub fn act<F: Functions<Ticket = T, Own = O>>(&mut self, family: &mut F) -> bool {
        let mut any = false;
        while family.goes_on() {
            let (place, index) = self.cursor;
            if place > self.motion.reached {
                break;
            }
            if index < self.places.actions(place).len() {
                if !self.action(place, index, family) {
                    break;
                }
                self.cursor.1 += 1;
                any = true;
            } else if place < self.motion.reached {
                self.cursor = (place + 1, 0);
                any = true;
            } else {
                break;
            }
        }
        any
    }

    /// Does an action. Whether it is done: otherwise the path stands here for it.
    fn action<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        place: u64,
        index: usize,
        family: &mut F,
    ) -> bool {
        let Some(action) = self.places.actions(place).get(index) else {
            return true;
        };
        match action {
            Action::Command(ticket) => {
                family.command(*ticket);
                true
            }
            Action::Output(ticket) => {
                let is_free = family.blocker(*ticket).is_none();
                if is_free {
                    self.output_at(*ticket, place, family);
                }
                is_free
            }
            Action::Gate(tickets) => tickets.iter().all(|ticket| family.is_open(*ticket)),
            Action::Stand(ticket) => self.motion.stands || !family.stands_for(*ticket),
            Action::BlockEnd => {
                let moves = !self.motion.still || place < self.motion.reached;
                let distance = self.places.distance(place);
                !self.single.stands_at_end(distance, false, moves)
            }
            Action::Dwell(seconds) => {
                let seconds = *seconds;
                self.dwell(place, seconds, family.cycle())
            }
            Action::Own(own) => {
                let at = self.now(family).position;
                family.act(own, at, self.leads.is_empty())
            }
        }
    }

    /// A dwell ends in the first cycle after its time, which begins when the path comes to rest.
    fn dwell(&mut self, place: u64, seconds: f64, cycle: u64) -> bool {
        let left = self.passed(place).map_or(0.0, |passed| passed.0);
        let cycles = || cycle + cycle_at((seconds - left).max(0.0), self.cycle_s);
        let end = self.dwell.unwrap_or_else(cycles);
        let is_over = cycle >= end;
        self.dwell = (!is_over).then_some(end);
        is_over
    }

    /// How long before this cycle, s, and how fast, mm/s, the path came to a place, if that was in the cycle before.
    pub(super) fn passed(&self, place: u64) -> Option<(f64, f64)> {
        let passed = self.motion.path.passed().iter();
        let mut at = passed.filter(|passed| passed.sequence + 1 == place);
        at.next().map(|passed| (passed.left_s, passed.speed_mm_s))
    }

    /// A function is output at a place of the path.
    fn output_at<F: Functions<Ticket = T, Own = O>>(&self, ticket: T, place: u64, family: &mut F) {
        let (left_s, speed_mm_s) = self.passed(place).unwrap_or((0.0, self.motion.speed()));
        let at = Moment {
            t: family.cycle() as f64 * self.cycle_s,
            position: self.places.position(place),
            speed_mm_s,
        };
        family.output(ticket, at, Way::Place(left_s));
    }

    /// Whether the path has to stop at a place, looking from one of its actions on.
    pub(super) fn is_closed<F: Functions<Ticket = T, Own = O>>(
        &self,
        place: u64,
        from: usize,
        family: &F,
    ) -> bool {
        let actions = self.places.actions(place).get(from..).unwrap_or_default();
        actions.iter().any(|action| match action {
            Action::Gate(tickets) => !tickets.iter().all(|ticket| family.is_open(*ticket)),
            Action::Stand(ticket) => family.stands_for(*ticket),
            Action::BlockEnd => self.single.stops_at(self.places.distance(place), false),
            Action::Dwell(_) => true,
            Action::Own(own) => family.stops_for(own),
            Action::Output(_) | Action::Command(_) => false,
        })
    }

    /// The action of a place from which on is to be looked.
    fn from(&self, place: u64) -> usize {
        if place == self.cursor.0 { self.cursor.1 } else { 0 }
    }

    /// The nearest place where the path has to stop, as far as it is known.
    pub(super) fn nearest_closed<F: Functions<Ticket = T, Own = O>>(&mut self, family: &F) -> Option<u64> {
        let cursor = self.cursor.0;
        let last = self.places.last();
        let mut place = self.open_to.max(cursor);
        while place < last && !self.is_closed(place, self.from(place), family) {
            place += 1;
        }
        self.open_to = place;
        let closed = (place < last || self.is_closed(place, self.from(place), family)).then_some(place);
        if !family.any_blocked() {
            return closed;
        }
        // What cannot go out next, since what went before it was not taken, stops the path, too.
        let blocked = (cursor..place).find(|place| {
            let actions = self.places.actions(*place).get(self.from(*place)..);
            actions.unwrap_or_default().iter().any(|action| match action {
                Action::Output(ticket) => family.blocker(*ticket).is_some(),
                _ => false,
            })
        });
        blocked.or(closed)
    }

    /// The path went over a place where it should have stopped, but could not any more.
    pub(super) fn is_overrun(&self) -> bool {
        self.cursor.0 < self.motion.reached
    }

    /// The functions for which the path cannot go on where it is; driven so.
    pub fn missing<'a, F: Functions<Ticket = T, Own = O>>(
        &'a mut self,
        drive: &bahn_motion::Drive,
        family: &'a F,
    ) -> impl Iterator<Item = T> + 'a {
        let backward = self.is_backward();
        let lead = match backward {
            true => None,
            false => self.blocked_lead(drive, family),
        };
        let (place, index) = self.cursor;
        let actions = match place <= self.motion.reached {
            true => self.places.actions(place),
            false => &[],
        };
        let (gate, blocker): (&[T], Option<T>) = match actions.get(index) {
            _ if backward => (&self.again.gate, self.again.blocker(family)),
            Some(Action::Gate(tickets)) => (tickets, None),
            Some(Action::Output(ticket)) => (&[], family.blocker(*ticket)),
            _ => (&[], None),
        };
        let shut = gate.iter().copied();
        shut.filter(move |ticket| backward || !family.is_open(*ticket))
            .chain(blocker)
            .chain(lead)
    }

    /// Whether something is to be done where the path is that is not done yet.
    pub fn is_waiting<F: Functions<Ticket = T, Own = O>>(&self, family: &F) -> bool {
        if self.back.is_some() {
            return true;
        }
        let (place, index) = self.cursor;
        let waits = |action: &Action<T, O>| match action {
            Action::Own(own) => family.waits_for(own),
            _ => true,
        };
        place <= self.motion.reached && self.places.actions(place).get(index).is_some_and(waits)
    }
}
