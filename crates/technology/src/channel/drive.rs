//! A cycle of the path.

use std::sync::Arc;

use bahn_motion::{Aim, Drive, PointToPoint, Prepared, State};
use bahn_path::{Barrier, BlockRef, ElementSource, LiveData, PathElement, Step};

use super::Channel;
use super::leads::SAME;
use super::prepare::within;
use super::record::Moment;
use super::track::Track;
use crate::plc::cycle_at;

/// Elements that the interpolator looks ahead.
pub(super) const LOOK_AHEAD: usize = 512;

/// Nearer to a place the path is there, in time and way.
const ROUNDING_S: f64 = 1e-9;
const ROUNDING_MM: f64 = 1e-9;
/// Slower than this it stands, mm/s: it brakes over less than the way above.
const STANDS_MM_S: f64 = 1e-3;

/// Gives the interpolator the elements of the track.
struct Feed<'a> {
    track: &'a Track,
    fed: &'a mut u64,
    /// So much of the next element is executed already, mm.
    part: &'a mut Option<f64>,
    /// Elements with another path acceleration wait until the limits are others.
    acceleration: f64,
    /// Nothing comes behind those that are known before the path has come to their end.
    closed: bool,
}

impl ElementSource for Feed<'_> {
    type Error = ();

    fn next(&mut self) -> Step<()> {
        match self.track.leg(*self.fed) {
            Some(leg) if self.part.is_some() => {
                let along = self.part.take().unwrap_or(0.0);
                let element = leg.rest(along, false).element(*self.fed);
                *self.fed += 1;
                Step::Element(element)
            }
            Some(leg) if leg.driving.limit.acceleration_mm_s2 == self.acceleration => {
                let element: PathElement = leg.element(*self.fed);
                *self.fed += 1;
                Step::Element(element)
            }
            Some(_) => Step::Starved,
            None if self.closed => Step::Barrier(Barrier::Acknowledge {
                block: BlockRef::default(),
            }),
            None => Step::Starved,
        }
    }

    fn resume(&mut self, _: LiveData) {}
}

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

    /// Gives the interpolator what is known of the path.
    pub(super) fn feed(&mut self) {
        let closed = self.decoding.holds || self.decoding.ended;
        loop {
            let mut feed = Feed {
                track: &self.track,
                fed: &mut self.fed,
                part: &mut self.part,
                acceleration: self.acceleration,
                closed,
            };
            if self.path.stop().is_some() && feed.track.leg(*feed.fed).is_some() {
                self.path.resume(&mut feed, LiveData::default());
            }
            let prepared = self.path.prepare(&mut feed, usize::MAX);
            let next = self.track.leg(self.fed).map(|leg| leg.driving.limit);
            match next {
                Some(limit) if prepared == Prepared::Starved => {
                    self.acceleration = limit.acceleration_mm_s2;
                    self.path.set_limits(&within(self.limits, self.acceleration));
                }
                _ => return,
            }
        }
    }

    /// Spends a cycle. Whether the path moved.
    pub(super) fn cycle_path(&mut self, mut drive: Drive) -> bool {
        self.feed();
        let closed = self.nearest_closed();
        drive.stop_before = closed;
        drive.hold |= self.is_overrun() || self.blocked_lead().is_some();
        // The first element of a path has none before it at whose end it could stop.
        if closed.is_some_and(|place| place <= self.reached) {
            drive.hold = true;
        } else {
            self.path.go_on();
        }
        let block = self.track.leg(self.reached).map(|leg| leg.block.clone());
        self.drive_once(&drive, block)
    }

    /// Path speed, mm/s.
    pub(super) fn speed(&self) -> f64 {
        let speed = self.path.speed_mm_s();
        if speed < STANDS_MM_S && self.path.rest_mm() < ROUNDING_MM {
            0.0
        } else {
            speed
        }
    }

    /// Drives a cycle. Whether anything moved.
    pub(super) fn drive_once(&mut self, drive: &Drive, block: Option<Arc<str>>) -> bool {
        let (before, way) = (self.now(), self.way());
        self.way_before = way;
        let cycle = self.path.cycle(drive);
        let (rest, speed) = (self.path.rest_mm(), self.speed());
        // What lacks rounding alone to be there is there in this cycle, not in the next one.
        let arrives = rest > 0.0 && rest <= speed * ROUNDING_S + if speed > 0.0 { 0.0 } else { ROUNDING_MM };
        let here = self.path.element().map(|element| element.sequence);
        let passed = self.path.passed().last().map(|last| last.sequence);
        if let Some(passed) = here.filter(|_| arrives).or(passed) {
            self.pass(passed);
        }
        self.passed_leads(self.t() + self.cycle_s);
        let moved = (self.way() - way).abs() > 2.0 * ROUNDING_MM;
        self.still = speed <= 0.0;
        if self.stands && moved {
            self.record
                .path(true, block.as_deref().unwrap_or_default(), before);
            self.stands = false;
        }
        let ended = self.cycle_independent();
        self.held = cycle.state == State::Held;
        self.record.sample(self.t() + self.cycle_s, self.way(), speed);
        moved || ended || !self.still || !self.path.passed().is_empty()
    }

    /// Says where the path stands, and for what.
    pub(super) fn stand(&mut self) {
        let at = self.now();
        if !self.still {
            self.record.stands_for_nothing(at.t);
            return;
        }
        let missing = self.missing();
        let orders = missing.iter().filter_map(|id| Some((*id, self.orders.get(*id)?)));
        self.record.stands_for(orders, at);
        if !self.stands && (self.is_waiting() || self.held || !missing.is_empty()) {
            self.stop(at);
        }
    }

    /// The block in which the path is, or at whose end.
    pub(super) fn block_now(&self) -> Arc<str> {
        let at_place = self.way() <= self.track.way(self.reached) + SAME;
        match self.track.leg(self.reached).filter(|_| !at_place) {
            Some(leg) => leg.block.clone(),
            None => self.track.block_before(self.reached),
        }
    }

    /// The path stands.
    pub(super) fn stop(&mut self, at: Moment) {
        let block = self.block_now();
        self.record.path(false, &block, at);
        self.stands = true;
    }

    /// An axis begins to move on its own.
    pub(super) fn begin_independent(&mut self, independent: bahn_din::Independent) {
        let at = self.now().position[independent.axis];
        let at = if at.is_nan() { 0.0 } else { at };
        self.independent
            .retain(|(other, _)| other.axis != independent.axis);
        self.independent.push((independent, PointToPoint::new(at)));
    }

    /// Axes that move on their own do so. Whether there are any.
    fn cycle_independent(&mut self) -> bool {
        let any = !self.independent.is_empty();
        let (limits, cycle_s) = (self.limits, self.cycle_s);
        let mut ended = Vec::new();
        self.independent.retain_mut(|(order, axis)| {
            let greatest = limits.max_feed_mm_min[order.axis];
            let feed = if order.rapid {
                greatest
            } else {
                order.feed_mm_min.min(greatest)
            };
            let acceleration = limits.acceleration_m_s2[order.axis];
            axis.cycle(cycle_s, Aim::Position(order.end), feed, acceleration);
            let is_at = axis.is_at(order.end);
            if is_at {
                ended.push((order.axis, order.end));
            }
            !is_at
        });
        for (axis, end) in ended {
            self.ended_at[axis] = end;
        }
        any
    }
}
