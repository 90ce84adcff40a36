//! A cycle of the path.
//!
//! Decision: The path stops at a gate by the planner's stop before an element; what is closed when it must brake
//! stops it, what opens meanwhile lets it go on

use std::sync::Arc;

use bahn_motion::{Drive, State};

use super::Gates;
use super::functions::{Functions, Moment};
use super::held::SAME_MM;
use super::motion::ROUNDING_MM;

/// Nearer to a place the path is there, in time.
const ROUNDING_S: f64 = 1e-9;

impl<T: Copy + Ord, O> Gates<T, O> {
    /// Spends a cycle on the path, forward or backward: it turns where it stands. Whether anything moved.
    pub fn cycle<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        mut drive: Drive,
        backward: bool,
        family: &mut F,
    ) -> bool {
        if backward == self.back.is_some() {
            return self.spend(drive, family);
        }
        if !self.motion.still {
            drive.hold = true;
            return self.spend(drive, family);
        }
        if !self.motion.stands {
            let at = self.now(family);
            self.stop(at, family);
        }
        if backward {
            self.turn_back();
        } else {
            self.turn_forward(family);
        }
        self.spend(drive, family);
        true
    }

    fn spend<F: Functions<Ticket = T, Own = O>>(&mut self, drive: Drive, family: &mut F) -> bool {
        if self.back.is_some() {
            self.cycle_back(drive, family)
        } else {
            self.cycle_path(drive, family)
        }
    }

    /// Spends a cycle forward. Whether the path moved.
    fn cycle_path<F: Functions<Ticket = T, Own = O>>(&mut self, drive: Drive, family: &mut F) -> bool {
        self.motion.feed(&self.places, self.closed);
        let closed = self.nearest_closed(family);
        let blocked = self.blocked_lead(&drive, family).is_some();
        let mut drive = Drive {
            stop_before: closed,
            hold: drive.hold || self.is_overrun() || blocked,
            ..drive
        };
        // The first element of a path has none before it at whose end it could stop.
        if closed.is_some_and(|place| place <= self.motion.reached) {
            drive.hold = true;
        } else {
            self.motion.path.go_on();
        }
        let leg = self.places.leg(self.motion.reached);
        let block = leg.map(|leg| leg.block.clone());
        self.drive_once(&drive, block, family)
    }

    /// Drives a cycle. Whether anything moved.
    pub(super) fn drive_once<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        drive: &Drive,
        block: Option<Arc<str>>,
        family: &mut F,
    ) -> bool {
        let (before, distance) = (self.now(family), self.distance());
        self.motion.distance_before_mm = distance;
        let cycle = self.motion.path.cycle(drive);
        let (rest, speed) = (self.motion.path.rest_mm(), self.motion.speed());
        // A distance to go within rounding counts as reached in this cycle, not in the next one.
        let arrives = rest > 0.0 && rest <= speed * ROUNDING_S + if speed > 0.0 { 0.0 } else { ROUNDING_MM };
        let here = self.motion.path.element().map(|element| element.sequence);
        let passed = self.motion.path.passed().last().map(|last| last.sequence);
        if let Some(passed) = here.filter(|_| arrives).or(passed) {
            self.pass(passed);
        }
        let t = family.cycle() as f64 * self.cycle_s;
        self.passed_leads(t + self.cycle_s, family);
        let moved = (self.distance() - distance).abs() > 2.0 * ROUNDING_MM;
        self.motion.still = speed <= 0.0;
        if self.motion.stands && moved {
            family.tell(true, block.as_deref().unwrap_or_default(), before);
            self.motion.stands = false;
        }
        let beside = family.move_beside();
        self.motion.held = cycle.state == State::Held;
        family.went(self.distance(), speed);
        moved || beside || !self.motion.still || !self.motion.path.passed().is_empty()
    }

    /// The block in which the path is, or at whose end.
    pub fn block_now(&self) -> Arc<str> {
        let at_place = self.distance() <= self.places.distance(self.motion.reached) + SAME_MM;
        match self.places.leg(self.motion.reached).filter(|_| !at_place) {
            Some(leg) => leg.block.clone(),
            None => self.places.block_before(self.motion.reached),
        }
    }

    /// Tells that the path stands.
    pub fn stop<F: Functions<Ticket = T, Own = O>>(&mut self, at: Moment, family: &mut F) {
        family.tell(false, &self.block_now(), at);
        self.motion.stands = true;
    }
}
