//! Whether a lead was kept: what went out later before its place than it should is reported.
//!
//! A time ahead of a place where the path waits is planned with an end velocity of 0 there; when the acknowledgement comes in
//! time the path does not stop, and is there sooner [004:87]. M functions that nobody waits for keep their lead (inferred).

use super::Channel;
use super::leads::{Ahead, Held, Promise, SAME};
use super::order::Lead;
use crate::report::Warning;

/// Times nearer together than this are one, s.
const ROUNDING_S: f64 = 1e-6;
/// ms in a second.
const PER_S: f64 = 1e3;

impl Channel<'_> {
    /// A function was output ahead at a time, s; so long the path was to take to its place then, s.
    pub(super) fn watch(&mut self, ahead: &Ahead, output_s: f64, planned_s: f64) {
        let promise = Promise {
            ahead: *ahead,
            output_s,
            planned_s,
        };
        match ahead.lead {
            Lead::Time(_) if self.distance() + SAME < ahead.point => {
                self.plan.leads.watched.promises.push_back(promise)
            }
            Lead::Time(lead_s) => self.tell_lead(promise, (0.0, lead_s * PER_S), "ms"),
            Lead::Distance(lead) => {
                let placed = self.plan.leads.placed(ahead.id).unwrap_or(ahead.point);
                let distance = ahead.point - placed;
                if distance + 2.0 * SAME < lead {
                    self.tell_lead(promise, (distance, lead), "mm");
                }
            }
            Lead::None => {}
        }
    }

    /// The path has come so far in a cycle that ends at a time, s.
    pub(super) fn passed_leads(&mut self, now_s: f64) {
        let distance = self.distance();
        while let Some(promise) = self.plan.leads.watched.promises.front().copied()
            && promise.ahead.point <= distance + SAME
        {
            self.plan.leads.watched.promises.pop_front();
            let Lead::Time(lead_s) = promise.ahead.lead else {
                continue;
            };
            let mut passed = self.motion.path.passed().iter();
            let at =
                passed.find(|end| self.plan.track.distance(end.sequence + 1) >= promise.ahead.point - SAME);
            let was_s = now_s - at.map_or(0.0, |end| end.left_s) - promise.output_s;
            if was_s + self.cycle_s + ROUNDING_S < lead_s {
                self.tell_lead(promise, (was_s * PER_S, lead_s * PER_S), "ms");
            }
        }
    }

    /// A lead is less than it should be.
    fn tell_lead(&mut self, promise: Promise, (is, asked): (f64, f64), unit: &str) {
        let Some(order) = self.plan.orders.get(promise.ahead.id) else {
            return;
        };
        let (label, place) = (order.label(), order.place.clone());
        let reported = &mut self.plan.leads.watched.reported;
        if !reported.insert((label.clone(), place.program.clone(), place.line)) {
            return;
        }
        let why = self.why(&promise);
        let digits = if unit == "ms" { 1.0 } else { 1e3 };
        let (is, asked) = ((is * digits).round() / digits, (asked * digits).round() / digits);
        let (is, side) = (is.abs(), if is < 0.0 { "after" } else { "before" });
        self.record.warnings.push(Warning {
            message: format!("{label} is output {is} {unit} {side} its place, not {asked} {unit}: {why}"),
            program: place.program.to_string(),
            block: place.block.to_string(),
        });
    }

    /// Why it is less.
    fn why(&self, promise: &Promise) -> String {
        let ahead = &promise.ahead;
        let short = match ahead.lead {
            Lead::Time(lead_s) => promise.planned_s + self.cycle_s + ROUNDING_S < lead_s,
            _ => true,
        };
        let waits = self.plan.orders.get(ahead.id).is_some_and(|order| order.waits);
        if !short && waits {
            return "it is planned with an end velocity of 0 there, and the path has not stopped".to_owned();
        }
        if !short {
            return "the path has come there sooner than it was planned".to_owned();
        }
        let placed = self.plan.leads.placed(ahead.id).unwrap_or(ahead.point);
        match ahead.held {
            _ if placed > ahead.earliest + self.motion.path.speed_mm_s() * self.cycle_s + SAME => {
                "another function came first, or was not fetched".to_owned()
            }
            Held::Barrier => "the path begins there, or comes to rest there for a flush".to_owned(),
            Held::LookAhead => {
                let blocks = self.plan.in_force.settings.pre_output.blocks;
                format!("the look-ahead of {blocks} blocks begins there (P-CHAN-00274)")
            }
        }
    }
}
