//! A cycle of the path.

use std::sync::Arc;

use bahn_motion::{Drive, State};

use super::Channel;
use super::leads::SAME;
use super::motion::ROUNDING_MM;
use super::record::Moment;
use crate::plc::cycle_at;

/// Nearer to a place the path is there, in time.
const ROUNDING_S: f64 = 1e-9;

impl Channel<'_> {
    /// How the path is to be driven now, but for where it stops.
    pub(super) fn drive_now(&self) -> Drive {
        let t = self.t() + 0.5 * self.cycle_s;
        let script = self.plc.script();
        let percent = script.and_then(|script| {
            let said = script.overrides.iter().take_while(|(from, _)| *from <= t);
            said.last().map(|(_, percent)| *percent)
        });
        let held = script.is_some_and(|script| script.holds.iter().any(|hold| hold.contains(&t)));
        let percent = percent.unwrap_or(100.0);
        Drive {
            feed_override_percent: percent,
            rapid_override_percent: percent,
            hold: held,
            ..Drive::default()
        }
    }

    /// The next cycle in which the script changes how the path is driven.
    pub(super) fn next_change(&self) -> Option<u64> {
        let script = self.plc.script()?;
        let ranges = script
            .holds
            .iter()
            .chain(&script.backward)
            .chain(&script.simulated)
            .chain(&script.singles);
        let times = ranges.flat_map(|range| [range.start, range.end]);
        let overrides = script.overrides.iter().map(|(from, _)| *from);
        let times = times.chain(overrides).chain(script.resets.iter().copied());
        let times = times.chain(script.starts.iter().copied());
        let cycles = times.map(|time| cycle_at(time, self.cycle_s));
        cycles.filter(|cycle| *cycle > self.cycle).min()
    }

    /// Spends a cycle. Whether the path moved.
    pub(super) fn cycle_path(&mut self, mut drive: Drive) -> bool {
        self.motion.feed(&self.plan);
        let closed = self.nearest_closed();
        drive.stop_before = closed;
        drive.hold |= self.is_overrun() || self.blocked_lead().is_some();
        // The first element of a path has none before it at whose end it could stop.
        if closed.is_some_and(|place| place <= self.motion.reached) {
            drive.hold = true;
        } else {
            self.motion.path.go_on();
        }
        let block = self
            .plan
            .track
            .leg(self.motion.reached)
            .map(|leg| leg.block.clone());
        self.drive_once(&drive, block)
    }

    /// Drives a cycle. Whether anything moved.
    pub(super) fn drive_once(&mut self, drive: &Drive, block: Option<Arc<str>>) -> bool {
        let (before, distance) = (self.now(), self.distance());
        self.motion.distance_before = distance;
        let cycle = self.motion.path.cycle(drive);
        let (rest, speed) = (self.motion.path.rest_mm(), self.motion.speed());
        // A distance to go within rounding counts as reached in this cycle, not in the next one.
        let arrives = rest > 0.0 && rest <= speed * ROUNDING_S + if speed > 0.0 { 0.0 } else { ROUNDING_MM };
        let here = self.motion.path.element().map(|element| element.sequence);
        let passed = self.motion.path.passed().last().map(|last| last.sequence);
        if let Some(passed) = here.filter(|_| arrives).or(passed) {
            self.pass(passed);
        }
        self.passed_leads(self.t() + self.cycle_s);
        let moved = (self.distance() - distance).abs() > 2.0 * ROUNDING_MM;
        self.motion.still = speed <= 0.0;
        if self.motion.stands && moved {
            self.record
                .path(true, block.as_deref().unwrap_or_default(), before);
            self.motion.stands = false;
        }
        let ended = self.motion.cycle_independent(self.cycle_s);
        self.motion.held = cycle.state == State::Held;
        self.record
            .sample(self.t() + self.cycle_s, self.distance(), speed);
        moved || ended || !self.motion.still || !self.motion.path.passed().is_empty()
    }

    /// Says where the path stands, and for what.
    pub(super) fn stand(&mut self) {
        let at = self.now();
        if !self.motion.still {
            self.record.stands_for_nothing(at.t);
            return;
        }
        let missing = self.missing();
        let orders = missing
            .iter()
            .filter_map(|id| Some((*id, self.plan.orders.get(*id)?)));
        self.record.stands_for(orders, at);
        if !self.motion.stands && (self.is_waiting() || self.motion.held || !missing.is_empty()) {
            self.stop(at);
        }
    }

    /// The block in which the path is, or at whose end.
    pub(super) fn block_now(&self) -> Arc<str> {
        let at_place = self.distance() <= self.plan.track.distance(self.motion.reached) + SAME;
        match self.plan.track.leg(self.motion.reached).filter(|_| !at_place) {
            Some(leg) => leg.block.clone(),
            None => self.plan.track.block_before(self.motion.reached),
        }
    }

    /// Notes that the path stands.
    pub(super) fn stop(&mut self, at: Moment) {
        let block = self.block_now();
        self.record.path(false, &block, at);
        self.motion.stands = true;
    }
}
