//! Writes down what happens.

use std::collections::BTreeSet;
use std::sync::Arc;

use bahn_kernel::gates::Moment;

use super::order::{Order, OrderId};
use crate::report::{Coordinates, Event, EventKind, Sample, ToGo, Value, Wait, Warning, rounded};

/// Velocities that are kept at most; where there are more, every other one goes.
const SAMPLES: usize = 20_000;
/// Events that are kept at most: far more than any program has that somebody reads.
pub(super) const EVENTS: usize = 5_000_000;
/// Times are multiples of a cycle: what binary fractions add is less than this part of a second.
const PER_S: f64 = 1e9;
/// From mm/s to mm/min.
const PER_MIN: f64 = 60.0;

#[derive(Debug, Default)]
pub(super) struct Record {
    pub(super) events: Vec<Event>,
    pub(super) waits: Vec<Wait>,
    /// Functions for which the path stands now, each with its wait.
    open: Vec<(OrderId, usize)>,
    pub(super) warnings: Vec<Warning>,
    pub(super) samples: Vec<Sample>,
    /// Every so many cycles one is kept.
    every: u64,
    skipped: u64,
    /// Leads that were not kept: a block that comes again is reported once.
    short_leads: BTreeSet<(String, Arc<str>, u32)>,
}

impl Record {
    fn event(&mut self, kind: EventKind, at: Moment) -> &mut Event {
        let end = self.events.len();
        self.events.push(Event {
            t: time(at.t),
            kind,
            function: None,
            value: Value::None,
            offset_us: None,
            v: rounded(at.speed_mm_s * PER_MIN, 1e6),
            target: None,
            block: None,
            position: Coordinates(at.position),
            to_go: None,
            order: None,
        });
        &mut self.events[end]
    }

    /// A function is output, fetched or acknowledged.
    pub(super) fn function(
        &mut self,
        kind: EventKind,
        (id, order): (OrderId, &Order),
        target: &str,
        at: Moment,
    ) {
        let event = self.event(kind, at);
        event.order = Some(id);
        event.function = Some(order.label());
        event.value = order.value.clone();
        event.target = Some(target.to_owned());
        event.block = Some(order.place.block.to_string());
    }

    /// What is said of the output before, beside: the offset of a time stamp, µs, and what is to go.
    pub(super) fn output_beside(&mut self, offset_us: Option<f64>, to_go: Option<ToGo>) {
        if let Some(event) = self.events.last_mut() {
            event.offset_us = offset_us;
            event.to_go = to_go;
        }
    }

    /// The lead of a function in a line of a program was not kept. Whether that is new.
    pub(super) fn is_first(&mut self, function: String, program: Arc<str>, line: u32) -> bool {
        self.short_leads.insert((function, program, line))
    }

    /// The path begins anew: what is reported once may be so again.
    pub(super) fn begin_path(&mut self) {
        self.short_leads.clear();
    }

    /// The path stands, or moves.
    pub(super) fn path(&mut self, moves: bool, block: &str, at: Moment) {
        let kind = if moves { EventKind::Go } else { EventKind::Stop };
        self.event(kind, at).block = Some(block.to_owned());
    }

    /// A list of active functions has changed.
    pub(super) fn active(&mut self, target: &str, letter: &str, numbers: Vec<u16>, at: Moment) {
        let event = self.event(EventKind::Active, at);
        event.function = Some(letter.to_owned());
        event.value = Value::Numbers(numbers);
        event.target = Some(target.to_owned());
    }

    /// The path stands for these functions now, and for no others.
    pub(super) fn stands_for<'a>(
        &mut self,
        missing: impl Iterator<Item = (OrderId, &'a Order)> + Clone,
        at: Moment,
    ) {
        let Record { open, waits, .. } = self;
        open.retain(|(id, index)| {
            let still = missing.clone().any(|(one, _)| one == *id);
            if !still && let Some(wait) = waits.get_mut(*index) {
                wait.to_s = Some(time(at.t));
            }
            still
        });
        for (id, order) in missing {
            if open.iter().all(|(one, _)| *one != id) {
                open.push((id, waits.len()));
                waits.push(Wait {
                    function: order.label(),
                    block: order.place.block.to_string(),
                    from_s: time(at.t),
                    to_s: None,
                    position: Coordinates(at.position),
                    order: id,
                });
            }
        }
    }

    /// The path stands for nothing any more.
    pub(super) fn stands_for_nothing(&mut self, t: f64) {
        for (_, index) in self.open.drain(..) {
            if let Some(wait) = self.waits.get_mut(index) {
                wait.to_s = Some(time(t));
            }
        }
    }

    pub(super) fn sample(&mut self, t: f64, distance_mm: f64, speed_mm_s: f64) {
        self.skipped += 1;
        if self.skipped < self.every {
            return;
        }
        self.skipped = 0;
        if self.samples.len() >= SAMPLES {
            let mut index = 0;
            self.samples.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every = self.every.max(1) * 2;
        }
        self.samples.push(Sample {
            t: time(t),
            distance_mm,
            v: speed_mm_s * PER_MIN,
        });
    }

    /// A stop after which nothing goes any more is the end of the path, and none.
    pub(super) fn drop_last_stop(&mut self) {
        let last = self
            .events
            .iter()
            .rposition(|event| matches!(event.kind, EventKind::Stop | EventKind::Go));
        if let Some(last) = last
            && self
                .events
                .get(last)
                .is_some_and(|event| event.kind == EventKind::Stop)
        {
            self.events.remove(last);
        }
    }
}

pub(super) fn time(t: f64) -> f64 {
    rounded(t, PER_S)
}
