//! An axis that modules of a PLC lead for itself, beside all programs.
//!
//! Decision: An axis of the PLC that does not follow stops on its ramp, and its order is over; a reference run by
//! module 9123 cancels the error, its message stays until CE

use bahn_motion::Aim;
use bahn_path::Direction;

use crate::axis::{AxisUnit, Mover};
use crate::now::Now;

/// What such an axis is to do. Feeds are in mm/min or degrees/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisOrder {
    /// To a place.
    Go {
        /// The place, machine coordinate, or the distance to it, mm or degrees.
        target: f64,
        /// It is a distance.
        incremental: bool,
        /// The feed, mm/min or degrees/min, before the override.
        feed: f64,
    },
    /// Brakes to a standstill.
    Stop,
    /// On until its reference mark is found, with no limit switches and no override.
    FindMark {
        /// The feed, mm/min or degrees/min; no override acts on it.
        feed: f64,
        /// Where it seeks.
        direction: Direction,
    },
}

/// An axis with what the PLC orders of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OrderedAxis {
    pub order: Option<AxisOrder>,
    /// Where it goes, once it began.
    pub target: Option<f64>,
    pub override_percent: f64,
}

impl Default for OrderedAxis {
    fn default() -> OrderedAxis {
        OrderedAxis {
            order: None,
            target: None,
            override_percent: 100.0,
        }
    }
}

impl OrderedAxis {
    /// Moves its axis for a cycle.
    pub fn moves(&mut self, unit: &mut AxisUnit, now: &Now) {
        let rapid = unit.parameters.motion.rapid_mm_min;
        let able = unit.can_be_driven() && now.ready;
        let passes_marks = matches!(self.order, Some(AxisOrder::FindMark { .. }));
        let cancels = unit.servo.fault().is_some_and(|fault| !fault.opens_loop());
        if able && passes_marks && cancels && self.target.is_none() {
            // A reference run cancels the positioning error [000:15979].
            unit.servo.acknowledge();
            unit.transfer();
        }
        // An axis that does not follow stops, as the machine does [000:5198].
        let mut stop = !able || unit.servo.fault().is_some();
        match self.order {
            Some(AxisOrder::Go {
                target,
                incremental,
                feed,
            }) if !stop => {
                let wanted = *self.target.get_or_insert(if incremental {
                    unit.nominal + target
                } else {
                    let modulo = unit.parameters.travel.modulo.map(|modulo| modulo.deg);
                    shortest(unit.nominal, target, modulo)
                });
                let feed = feed.max(0.0) * self.override_percent / 100.0;
                unit.drive(now.time_s, Aim::Position(wanted), feed);
                if unit.ptp.is_at(wanted) && unit.servo.in_position() {
                    self.order = None;
                }
            }
            Some(AxisOrder::FindMark { feed, direction }) if !stop => {
                if self.target.replace(0.0).is_none() {
                    unit.servo.forget_marks();
                    unit.referenced = false;
                }
                let mark = unit.servo.take_mark();
                if let Some((count, scale)) = mark.and_then(|mark| Some((mark.count, mark.scale_mm?))) {
                    unit.set_datum(count, scale - unit.parameters.travel.machine_datum_mm);
                    unit.referenced = true;
                    self.order = Some(AxisOrder::Stop);
                }
                let feed = feed.max(0.0);
                unit.drive(now.time_s, Aim::Feed(direction.sign() * feed), feed);
            }
            _ => stop = true,
        }
        if stop {
            unit.drive(now.time_s, Aim::Feed(0.0), rapid);
            if unit.stands() {
                self.order = None;
            }
        }
        if self.order.is_none() {
            self.target = None;
        }
        unit.mover = if self.order.is_some() {
            Mover::Plc
        } else {
            Mover::None
        };
    }
}

/// The target of an axis with modulo value, on the shorter way [000:4107] (which way is inferred).
fn shortest(from: f64, target: f64, modulo: Option<f64>) -> f64 {
    match modulo.filter(|modulo| *modulo > 0.0) {
        Some(modulo) => {
            let turns = ((from - target) / modulo).round();
            target + turns * modulo
        }
        None => target,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chain_turns_the_shorter_way() {
        assert_eq!(shortest(350.0, 10.0, Some(360.0)), 370.0);
        assert_eq!(shortest(10.0, 350.0, Some(360.0)), -10.0);
        assert_eq!(shortest(730.0, 108.0, Some(360.0)), 828.0);
        assert_eq!(shortest(350.0, 10.0, None), 10.0);
    }
}
