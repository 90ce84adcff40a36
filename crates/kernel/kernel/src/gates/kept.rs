//! Whether a lead was kept: what went out later before its place than it should is reported.
//!
//! A time ahead of a place where the path waits is planned with an end velocity of 0 there; when the acknowledgement comes in
//! time the path does not stop, and is there sooner [004:87]. M functions that nobody waits for keep their lead (inferred).

use bahn_path::Ahead;

use super::Gates;
use super::functions::{Functions, Short, Why};
use super::held::{Held, SAME_MM};
use super::leads::{Pending, Promise};

/// Times nearer together than this are one, s.
const ROUNDING_S: f64 = 1e-6;

impl<T: Copy + Ord, O> Gates<T, O> {
    /// A function was output ahead at a time, s; so long the path was to take to its place then, s.
    pub(super) fn watch<F: Functions<Ticket = T, Own = O>>(
        &mut self,
        ahead: &Pending<T>,
        output_s: f64,
        planned_s: f64,
        family: &mut F,
    ) {
        let promise = Promise {
            ahead: *ahead,
            output_s,
            planned_s,
        };
        match ahead.lead {
            Ahead::Time(_) if self.distance() + SAME_MM < ahead.point_mm => {
                self.leads.promises.push_back(promise);
            }
            Ahead::Time(lead_s) => self.tell_lead(promise, 0.0, lead_s, family),
            Ahead::Distance(lead) => {
                let placed = self.leads.placed(ahead.id).unwrap_or(ahead.point_mm);
                let distance = ahead.point_mm - placed;
                if distance + 2.0 * SAME_MM < lead {
                    self.tell_lead(promise, distance, lead, family);
                }
            }
        }
    }

    /// The path has come so far in a cycle that ends at a time, s.
    pub(super) fn passed_leads<F: Functions<Ticket = T, Own = O>>(&mut self, now_s: f64, family: &mut F) {
        let distance = self.distance();
        while let Some(promise) = self.leads.promises.front().copied()
            && promise.ahead.point_mm <= distance + SAME_MM
        {
            self.leads.promises.pop_front();
            let Ahead::Time(lead_s) = promise.ahead.lead else {
                continue;
            };
            let mut passed = self.motion.path.passed().iter();
            let at =
                passed.find(|end| self.places.distance(end.sequence + 1) >= promise.ahead.point_mm - SAME_MM);
            let was_s = now_s - at.map_or(0.0, |end| end.left_s) - promise.output_s;
            if was_s + self.cycle_s + ROUNDING_S < lead_s {
                self.tell_lead(promise, was_s, lead_s, family);
            }
        }
    }

    /// A lead is less than it should be.
    fn tell_lead<F: Functions<Ticket = T, Own = O>>(
        &self,
        promise: Promise<T>,
        is: f64,
        asked: f64,
        family: &mut F,
    ) {
        let short = Short {
            is,
            asked,
            is_time: matches!(promise.ahead.lead, Ahead::Time(_)),
            why: self.why(&promise, family),
        };
        family.tell_short_lead(promise.ahead.id, short);
    }

    /// Why it is less.
    fn why<F: Functions<Ticket = T, Own = O>>(&self, promise: &Promise<T>, family: &F) -> Why {
        let ahead = &promise.ahead;
        let short = match ahead.lead {
            Ahead::Time(lead_s) => promise.planned_s + self.cycle_s + ROUNDING_S < lead_s,
            Ahead::Distance(_) => true,
        };
        if !short && family.is_waited_for(ahead.id) {
            return Why::NoStop;
        }
        if !short {
            return Why::Sooner;
        }
        let placed = self.leads.placed(ahead.id).unwrap_or(ahead.point_mm);
        match ahead.held {
            _ if placed > ahead.earliest_mm + self.motion.path.speed_mm_s() * self.cycle_s + SAME_MM => {
                Why::Another
            }
            Held::LookAhead => Why::LookAhead,
            Held::Barrier | Held::No => Why::Barrier,
        }
    }
}
