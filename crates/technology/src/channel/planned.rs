//! What is done ahead of its place: output by way or by time, with the time that the path will take as planned.

use bahn_motion::{Drive, State};

use super::Channel;
use super::leads::{Ahead, SAME};
use super::order::{Lead, OrderId};
use super::record::Moment;
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
        while let Some((index, ahead)) = self.next_ahead(drive) {
            let blocked = self.range_of(ahead.id).and_then(|range| self.blocker(range));
            if blocked.is_some() {
                break;
            }
            self.leads
                .take(index, self.in_force.settings.pre_output.value_to_go);
            any = true;
            let way = self.way();
            let mut at = self.now();
            if !matches!(ahead.lead, Lead::Time(_)) {
                // What could not go out at its place, for that was not known or another came before, does so where the path is.
                let in_cycle = |place: &f64| (self.way_before - SAME..=way).contains(place);
                let places = [ahead.place(), self.leads.floor];
                let place = places.into_iter().find(in_cycle).unwrap_or(way);
                self.leads.floor = place;
                at = Moment {
                    position: self.track.position_at(place, self.reached + 1),
                    ..at
                };
            }
            let to_go = self.to_go(&ahead, drive);
            self.output(ahead.id, at, None);
            self.record.output_beside(None, to_go);
        }
        any
    }

    /// The next function that is due.
    fn next_ahead(&self, drive: &Drive) -> Option<(usize, Ahead)> {
        let way = self.way();
        let passed =
            |point: f64, ids: &[OrderId]| way > point - SAME && ids.iter().all(|id| self.orders.is_done(*id));
        let one_by_one = self.in_force.settings.pre_output.value_to_go;
        let mut candidates = self.leads.next(one_by_one, passed);
        let due = candidates.find(|(_, ahead)| self.is_due(ahead, way, drive));
        due.map(|(index, ahead)| (index, *ahead))
    }

    /// The function for which the next one that is due cannot be output.
    pub(super) fn blocked_lead(&self) -> Option<OrderId> {
        if self.leads.queue.is_empty() || !self.ranges.any_blocked(self.plc.fetched_before(self.cycle)) {
            return None;
        }
        let (_, ahead) = self.next_ahead(&self.drive_now())?;
        self.range_of(ahead.id).and_then(|range| self.blocker(range))
    }

    fn is_due(&self, ahead: &Ahead, way: f64, drive: &Drive) -> bool {
        if way + SAME < ahead.place() {
            return false;
        }
        let Lead::Time(lead_s) = ahead.lead else {
            return true;
        };
        if way + SAME >= ahead.point {
            return true;
        }
        let fastest = self.fastest(ahead.point, drive);
        ahead.point - way <= fastest * lead_s
            && self
                .time_to(ahead.point, lead_s, drive)
                .is_some_and(|time| time <= lead_s + ROUNDING_S)
    }

    /// The greatest speed up to a place, mm/s, at most.
    fn fastest(&self, point: f64, drive: &Drive) -> f64 {
        let mut fastest = 0.0f64;
        let mut number = self.reached;
        while let Some(leg) = self.track.leg(number).filter(|leg| leg.from < point) {
            if leg.driving.rapid {
                return f64::INFINITY;
            }
            fastest = fastest.max(leg.driving.feed_mm_min);
            number += 1;
        }
        let percent = drive.feed_override_percent.max(100.0);
        fastest.max(self.path.speed_mm_s() * 60.0) / 60.0 * percent / 100.0
    }

    /// How long the path takes to a place of it, s, where it comes to a stop: planned as the path is planned, with stops where
    /// it has to wait. `None` when that is longer than asked for.
    fn time_to(&self, point: f64, most_s: f64, drive: &Drive) -> Option<f64> {
        let last = self.track.last();
        let mut target = self.reached + u64::from(self.path.rest_mm() <= 0.0);
        while target < last && self.track.way(target) < point - SAME {
            target += 1;
        }
        if self.track.way(target) < point - SAME {
            return None;
        }
        let closed = |place: &u64| *place == target || self.is_closed(*place, 0);
        let mut stops = (self.reached + 1..=target).filter(closed);
        let mut path = self.path.clone();
        let mut drive = Drive {
            hold: false,
            stop_before: stops.next(),
            ..*drive
        };
        path.go_on();
        let most = (most_s / self.cycle_s).ceil() as u64 + 1;
        for cycle in 1..=most {
            let state = path.cycle(&drive).state;
            let arrived = path.passed().iter().find(|end| end.sequence + 1 == target);
            if let Some(end) = arrived {
                return Some(cycle as f64 * self.cycle_s - end.left_s);
            }
            match state {
                State::BlockEnd => {
                    drive.stop_before = stops.next();
                    path.go_on();
                }
                State::Moving => {}
                _ => return None,
            }
        }
        None
    }

    /// What is left to the place where a function is synchronised that is output now.
    fn to_go(&self, ahead: &Ahead, drive: &Drive) -> Option<ToGo> {
        let order = self.orders.get(ahead.id)?;
        if !self.in_force.settings.pre_output.value_to_go || !order.waits {
            return None;
        }
        let way = if matches!(ahead.lead, Lead::Time(_)) {
            self.way()
        } else {
            ahead.place()
        };
        let time = self.time_to(ahead.point, LONGEST_S, drive).unwrap_or(0.0);
        Some(ToGo {
            path: ((ahead.point - way) * PER_MM).round() as i64,
            time: (time * PER_S).round() as i64,
        })
    }
}
