//! What is done ahead of its place: output by distance or by time, with the time that the path will take as planned.
//!
//! Decision: `MET_*` goes out in the first cycle in which the path as it is planned takes no longer than the lead: a
//! copy of the interpolator is run ahead, with the standstills and dwells that are known. M functions as `MET_MOS`
//! keep their lead, since their path does not stop for them; where an end velocity of 0 forbids a lead it is said,
//! whatever the type (also `kernel/src/gates/kept.rs`)

use bahn_motion::{Drive, Interpolator, State};
use bahn_path::Ahead;

use super::functions::{Functions, Moment, Way};
use super::held::SAME_MM;
use super::leads::Pending;
use super::places::Action;
use super::{Gates, cycle_at};

/// Time to go is planned up to this, s.
const LONGEST_S: f64 = 600.0;
/// Times nearer together than this are one, s.
const ROUNDING_S: f64 = 1e-9;

impl<T: Copy + Ord, O> Gates<T, O> {
    /// Outputs the functions whose places come near, as the path is driven. Whether there were any.
    pub fn output_ahead<F: Functions<Ticket = T, Own = O>>(&mut self, drive: &Drive, family: &mut F) -> bool {
        let mut any = false;
        if !self.leads.is_empty() {
            self.motion.feed(&self.places, self.closed);
        }
        while let Some((index, ahead)) = self.next_ahead(drive, family) {
            if family.blocker(ahead.id).is_some() {
                break;
            }
            let distance = self.distance();
            self.leads.take(index, distance);
            any = true;
            let mut at = self.now(family);
            if !matches!(ahead.lead, Ahead::Time(_)) {
                // What could not go out at its place, for that was not known or another came before, does so where the path is.
                let in_cycle =
                    |place: &f64| (self.motion.distance_before_mm - SAME_MM..=distance).contains(place);
                let places = [ahead.place(), self.leads.floor_mm];
                let place = places.into_iter().find(in_cycle).unwrap_or(distance);
                self.leads.output_at(ahead.id, place);
                at = Moment {
                    position: self.places.position_at(place, self.motion.reached + 1),
                    ..at
                };
            }
            let to_go = self.left_to_go(&ahead, drive, family);
            let planned_s = self.planned_s(&ahead, drive, family);
            family.output(ahead.id, at, Way::Ahead(to_go));
            self.watch(&ahead, at.t, planned_s, family);
        }
        any
    }

    /// The next function that is due.
    fn next_ahead<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        drive: &Drive,
        family: &F,
    ) -> Option<(usize, Pending<T>)> {
        let distance = self.distance();
        let passed = |point: f64, tickets: &[T]| {
            distance > point - SAME_MM && tickets.iter().all(|ticket| family.is_done(*ticket))
        };
        (0..self.leads.ready(passed)).find_map(|index| {
            let ahead = self.leads.get(index)?;
            self.is_due(&ahead, distance, drive, family)
                .then_some((index, ahead))
        })
    }

    /// The function for which the next one that is due cannot be output.
    pub(super) fn blocked_lead<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        drive: &Drive,
        family: &F,
    ) -> Option<T> {
        if self.leads.is_empty() || !family.any_blocked() {
            return None;
        }
        let (_, ahead) = self.next_ahead(drive, family)?;
        family.blocker(ahead.id)
    }

    fn is_due<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        ahead: &Pending<T>,
        distance: f64,
        drive: &Drive,
        family: &F,
    ) -> bool {
        let time_to = |lead_s: f64| {
            let farthest = self.fastest(ahead.point_mm, drive) * lead_s;
            if ahead.point_mm - distance > farthest {
                return None;
            }
            let time = self.time_to(ahead.point_mm, lead_s, drive, family);
            time.map(|time| time - ROUNDING_S)
        };
        distance + SAME_MM >= ahead.earliest_mm
            && ahead.lead.is_due(ahead.point_mm - distance - SAME_MM, time_to)
    }

    /// The greatest speed up to a place, mm/s, at most.
    fn fastest(&self, point: f64, drive: &Drive) -> f64 {
        let mut fastest = 0.0f64;
        let mut number = self.motion.reached;
        while let Some(leg) = self.places.leg(number).filter(|leg| leg.from_mm < point) {
            if leg.driving.rapid || drive.rapid {
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
    fn time_to<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        point: f64,
        most_s: f64,
        drive: &Drive,
        family: &F,
    ) -> Option<f64> {
        let mut preview = self.motion.preview.take()?;
        preview.as_mut().clone_from(&self.motion.path);
        let time = self.run_ahead(&mut preview, (point, most_s), drive, family);
        self.motion.preview = Some(preview);
        time
    }

    /// Runs a copy of the path ahead to a place, mm, up to a time, s.
    fn run_ahead<F: Functions<Ticket = T, Own = O>>(
        &self,
        path: &mut Interpolator<()>,
        (point, most_s): (f64, f64),
        drive: &Drive,
        family: &F,
    ) -> Option<f64> {
        let last = self.places.last();
        let mut target = self.motion.reached + u64::from(self.motion.path.rest_mm() <= 0.0);
        while target < last && self.places.distance(target) < point - SAME_MM {
            target += 1;
        }
        if self.places.distance(target) < point - SAME_MM {
            return None;
        }
        let mut stops = (self.open_to.max(self.motion.reached + 1)..=last)
            .filter(|place| self.is_closed(*place, 0, family));
        let mut drive = Drive {
            hold: false,
            stop_before: stops.next(),
            ..*drive
        };
        path.go_on();
        let most = (most_s / self.cycle_s).ceil() as u64 + 1;
        let mut cycle = self.dwells_now(family.cycle());
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
        let actions = self.places.actions(place).get(from..).unwrap_or_default();
        let dwell = actions.iter().filter_map(|action| match action {
            Action::Dwell(seconds) => Some(cycle_at((seconds - left_s).max(0.0), self.cycle_s)),
            _ => None,
        });
        dwell.sum()
    }

    /// Cycles that it dwells where it is.
    fn dwells_now(&self, now: u64) -> u64 {
        let place = self.motion.reached;
        let index = if self.cursor.0 == place { self.cursor.1 } else { 0 };
        match self.dwell {
            Some(end) => end.saturating_sub(now) + self.dwells(place, index + 1, 0.0),
            None => {
                let left_s = self.passed(place).map_or(0.0, |passed| passed.0);
                self.dwells(place, index, left_s)
            }
        }
    }

    /// How long the path takes to the place of a function that is output a time ahead of it now, s, up to that time.
    fn planned_s<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        ahead: &Pending<T>,
        drive: &Drive,
        family: &F,
    ) -> f64 {
        match ahead.lead {
            Ahead::Time(lead_s) if self.distance() + SAME_MM < ahead.point_mm => self
                .time_to(ahead.point_mm, lead_s, drive, family)
                .unwrap_or(lead_s),
            _ => 0.0,
        }
    }

    /// What is left to the place where a function is synchronised that is output now: the distance, mm, and the time, s.
    fn left_to_go<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        ahead: &Pending<T>,
        drive: &Drive,
        family: &F,
    ) -> Option<(f64, f64)> {
        if !self.leads.one_by_one || !family.is_waited_for(ahead.id) {
            return None;
        }
        let distance = if matches!(ahead.lead, Ahead::Time(_)) {
            self.distance()
        } else {
            ahead.place()
        };
        let time = self
            .time_to(ahead.point_mm, LONGEST_S, drive, family)
            .unwrap_or(0.0);
        Some((ahead.point_mm - distance, time))
    }
}
