//! What is done ahead of its place: output by distance or by time, with the time that the path will take as planned.

use bahn_motion::{Drive, State};

use super::Channel;
use super::leads::{Ahead, SAME};
use super::order::{Lead, OrderId};
use super::record::Moment;
use super::track::Action;
use crate::plc::cycle_at;
use crate::report::ToGo;

/// Time to go is planned up to this, s.
const LONGEST_S: f64 = 600.0;
/// Times nearer together than this are one, s.
const ROUNDING_S: f64 = 1e-9;
/// 0.1 µm and µs are these parts of a mm and a second.
const PER_MM: f64 = 1e4;
const PER_S: f64 = 1e6;

impl Channel<'_> {
    /// Outputs the functions whose places come near. Whether there were any.
    pub(super) fn output_ahead(&mut self, drive: &Drive) -> bool {
        let mut any = false;
        if !self.plan.leads.queue.is_empty() {
            self.motion.feed(&self.plan);
        }
        while let Some((index, ahead)) = self.next_ahead(drive) {
            let blocked = self.range_of(ahead.id).and_then(|range| self.blocker(range));
            if blocked.is_some() {
                break;
            }
            let distance = self.distance();
            self.plan.leads.take(
                index,
                self.plan.in_force.settings.pre_output.value_to_go,
                distance,
            );
            any = true;
            let mut at = self.now();
            if !matches!(ahead.lead, Lead::Time(_)) {
                // What could not go out at its place, for that was not known or another came before, does so where the path is.
                let in_cycle = |place: &f64| (self.motion.distance_before - SAME..=distance).contains(place);
                let places = [ahead.place(), self.plan.leads.floor];
                let place = places.into_iter().find(in_cycle).unwrap_or(distance);
                self.plan.leads.output_at(ahead.id, place);
                at = Moment {
                    position: self.plan.track.position_at(place, self.motion.reached + 1),
                    ..at
                };
            }
            let to_go = self.to_go(&ahead, drive);
            let planned_s = self.planned_s(&ahead, drive);
            self.output(ahead.id, at, None);
            self.record.output_beside(None, to_go);
            self.watch(&ahead, at.t, planned_s);
        }
        any
    }

    /// The next function that is due.
    fn next_ahead(&self, drive: &Drive) -> Option<(usize, Ahead)> {
        let distance = self.distance();
        let passed = |point: f64, ids: &[OrderId]| {
            distance > point - SAME && ids.iter().all(|id| self.plan.orders.is_done(*id))
        };
        let one_by_one = self.plan.in_force.settings.pre_output.value_to_go;
        let mut candidates = self.plan.leads.next(one_by_one, passed);
        let due = candidates.find(|(_, ahead)| self.is_due(ahead, distance, drive));
        due.map(|(index, ahead)| (index, *ahead))
    }

    /// The function for which the next one that is due cannot be output.
    pub(super) fn blocked_lead(&self) -> Option<OrderId> {
        if self.plan.leads.queue.is_empty()
            || !self.plan.ranges.any_blocked(self.plc.fetched_before(self.cycle))
        {
            return None;
        }
        let (_, ahead) = self.next_ahead(&self.drive_now())?;
        self.range_of(ahead.id).and_then(|range| self.blocker(range))
    }

    fn is_due(&self, ahead: &Ahead, distance: f64, drive: &Drive) -> bool {
        if distance + SAME < ahead.place() {
            return false;
        }
        let Lead::Time(lead_s) = ahead.lead else {
            return true;
        };
        if distance + SAME >= ahead.point {
            return true;
        }
        let fastest = self.fastest(ahead.point, drive);
        ahead.point - distance <= fastest * lead_s
            && self
                .time_to(ahead.point, lead_s, drive)
                .is_some_and(|time| time <= lead_s + ROUNDING_S)
    }

    /// The greatest speed up to a place, mm/s, at most.
    fn fastest(&self, point: f64, drive: &Drive) -> f64 {
        let mut fastest = 0.0f64;
        let mut number = self.motion.reached;
        while let Some(leg) = self.plan.track.leg(number).filter(|leg| leg.from < point) {
            if leg.driving.rapid {
                return f64::INFINITY;
            }
            fastest = fastest.max(leg.driving.feed_mm_min);
            number += 1;
        }
        let percent = drive.feed_override_percent.max(100.0);
        fastest.max(self.motion.path.speed_mm_s() * 60.0) / 60.0 * percent / 100.0
    }

    /// How long the path takes to a place of it, s: as it is planned, with the standstills that are known now. So it stops at
    /// the place of a function that it waits for, whose gate is closed [004:87], and passes that of any other.
    /// `None` when that is longer than asked for.
    fn time_to(&self, point: f64, most_s: f64, drive: &Drive) -> Option<f64> {
        let last = self.plan.track.last();
        let mut target = self.motion.reached + u64::from(self.motion.path.rest_mm() <= 0.0);
        while target < last && self.plan.track.distance(target) < point - SAME {
            target += 1;
        }
        if self.plan.track.distance(target) < point - SAME {
            return None;
        }
        let mut stops = (self.gates.open_to.max(self.motion.reached + 1)..=last)
            .filter(|place| self.is_closed(*place, 0));
        let mut path = self.motion.path.clone();
        let mut drive = Drive {
            hold: false,
            stop_before: stops.next(),
            ..*drive
        };
        path.go_on();
        let most = (most_s / self.cycle_s).ceil() as u64 + 1;
        let mut cycle = self.dwells_now();
        while cycle < most {
            cycle += 1;
            let state = path.cycle(&drive).state;
            let arrived = path.passed().iter().find(|end| end.sequence + 1 == target);
            if let Some(end) = arrived {
                return Some(cycle as f64 * self.cycle_s - end.left_s);
            }
            match state {
                State::BlockEnd => {
                    let left_s = path.passed().last().map_or(0.0, |end| end.left_s);
                    cycle += drive.stop_before.map_or(0, |place| self.dwells(place, 0, left_s));
                    drive.stop_before = stops.next();
                    path.go_on();
                }
                State::Moving => {}
                _ => return None,
            }
        }
        None
    }

    /// Cycles that the path dwells at a place to which it came so long before the end of a cycle, s, from one of its actions on.
    fn dwells(&self, place: u64, from: usize, left_s: f64) -> u64 {
        let actions = self.plan.track.actions(place).get(from..).unwrap_or_default();
        let dwell = actions.iter().filter_map(|action| match action {
            Action::Dwell(seconds) => Some(cycle_at((seconds - left_s).max(0.0), self.cycle_s)),
            _ => None,
        });
        dwell.sum()
    }

    /// Cycles that it dwells where it is.
    fn dwells_now(&self) -> u64 {
        let place = self.motion.reached;
        let index = if self.gates.cursor.0 == place {
            self.gates.cursor.1
        } else {
            0
        };
        match self.gates.dwell {
            Some(end) => end.saturating_sub(self.cycle) + self.dwells(place, index + 1, 0.0),
            None => {
                let left_s = self.passed(place).map_or(0.0, |passed| passed.0);
                self.dwells(place, index, left_s)
            }
        }
    }

    /// How long the path takes to the place of a function that is output a time ahead of it now, s, up to that time.
    fn planned_s(&self, ahead: &Ahead, drive: &Drive) -> f64 {
        match ahead.lead {
            Lead::Time(lead_s) if self.distance() + SAME < ahead.point => {
                self.time_to(ahead.point, lead_s, drive).unwrap_or(lead_s)
            }
            _ => 0.0,
        }
    }

    /// What is left to the place where a function is synchronised that is output now.
    fn to_go(&self, ahead: &Ahead, drive: &Drive) -> Option<ToGo> {
        let order = self.plan.orders.get(ahead.id)?;
        if !self.plan.in_force.settings.pre_output.value_to_go || !order.waits {
            return None;
        }
        let distance = if matches!(ahead.lead, Lead::Time(_)) {
            self.distance()
        } else {
            ahead.place()
        };
        let time = self.time_to(ahead.point, LONGEST_S, drive).unwrap_or(0.0);
        Some(ToGo {
            path: ((ahead.point - distance) * PER_MM).round() as i64,
            time: (time * PER_S).round() as i64,
        })
    }
}
