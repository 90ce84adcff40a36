//! Movements that the PLC commands: PLC positioning of NC axes, PLC axes, free rotation.

use bahn_exchange::signal;
use bahn_motion::Aim;
use bahn_plc::PlcAxisCommand;

use crate::axes::Mover;
use crate::control::Control;
use crate::markers::{AXES, PLC_POSITIONING, POSITIONING_FEED, TRANSFER};

/// Position words count in 1/10 000 mm [000:4026].
pub(crate) const PER_MM: f64 = 10_000.0;

/// What the PLC commanded.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Positioning {
    /// Targets of PLC positioning, machine coordinates, with their feed.
    pub targets: [Option<(f64, f64)>; AXES],
    /// What each PLC axis executes.
    pub plc_axes: [PlcAxis; AXES],
    /// Free rotation: feed with sign, by axis.
    pub rotation: [Option<f64>; AXES],
}

/// A PLC axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlcAxis {
    pub command: Option<PlcAxisCommand>,
    /// Target of the positioning, once it began.
    pub target: Option<f64>,
    pub override_percent: f64,
}

impl Default for PlcAxis {
    fn default() -> PlcAxis {
        PlcAxis {
            command: None,
            target: None,
            override_percent: 100.0,
        }
    }
}

impl Positioning {
    /// Ends what PLC axes do and the free rotation: EMERGENCY STOP.
    pub fn stop(&mut self) {
        for axis in &mut self.plc_axes {
            if axis.command.is_some() {
                axis.command = Some(PlcAxisCommand::Stop);
            }
        }
        self.rotation = [None; AXES];
    }
}

impl Control {
    /// PLC positioning: M2704 ff. with target and feed, relative to the machine datum, without software
    /// limits. It starts only on referenced axes, without a program or during a strobe of it, in Manual
    /// without direction keys; the PLC aborts it by resetting the strobe [000:4005-4053].
    pub(crate) fn take_positioning_strobes(&mut self) {
        let nc = self.exchange.nc();
        let free = !self.run.is_running() || self.handshakes.strobe_is_set();
        let keys = self.panel.axis_keys.iter().any(Option::is_some);
        let free = free && !keys && !self.stop_given();
        let most = usize::from(self.model.limits().plc_positioning_axes_max);
        let mut running = self.positioning.targets.iter().flatten().count();
        for index in 0..AXES {
            let (Some(strobe), Some(target), Some(feed)) = (
                PLC_POSITIONING.get(index),
                TRANSFER.get(index),
                POSITIONING_FEED.get(index),
            ) else {
                continue;
            };
            let Some(slot) = self.positioning.targets.get_mut(index) else {
                continue;
            };
            if !nc.bit(*strobe) {
                *slot = None;
                continue;
            }
            let unit = self
                .places
                .get(index)
                .copied()
                .flatten()
                .and_then(|place| self.axes.get(place));
            let ready =
                unit.is_some_and(|unit| unit.referenced && unit.is_free() && unit.parameters.controlled);
            if slot.is_none() && ready && free && running < most {
                running += 1;
                let target = f64::from(nc.number(*target)) / PER_MM;
                // Feeds above 32 767 mm/min count on in the word.
                let feed = f64::from(nc.number(*feed) as u16);
                *slot = Some((target, feed));
            }
        }
    }

    /// Moves what the PLC positions; the NC resets the strobe at the end, or when it is broken off.
    pub(crate) fn move_for_plc(&mut self) {
        let time = self.cycle_s();
        let percent = self.feed_override.percent();
        let limit = self.rapid_limit_mm_min();
        // NC stop ends it in Manual and Handwheel; in the automatic modes only with internal stop.
        let broken_off = self.stop_given() && !self.run.is_active();
        let waits = self.stop_given();
        let mut reached = [false; AXES];
        for unit in &mut self.axes {
            let Some((target, feed)) = self.positioning.targets.get(unit.index).copied().flatten() else {
                if unit.mover == Mover::Positioning && self.run.restoring().is_none() {
                    unit.drive(time, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
                    if unit.stands() {
                        unit.mover = Mover::None;
                    }
                }
                continue;
            };
            unit.ask_to_unclamp();
            if !(unit.servo.closed() && unit.enabled) {
                continue;
            }
            unit.mover = Mover::Positioning;
            let (aim, feed) = if waits {
                (Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min)
            } else {
                (Aim::Position(target), (feed * percent / 100.0).min(limit))
            };
            unit.drive(time, aim, feed);
            let there = unit.ptp.is_at(target) && unit.servo.in_position();
            if (there || broken_off)
                && let Some(reached) = reached.get_mut(unit.index)
            {
                *reached = true;
            }
        }
        for (index, reached) in reached.into_iter().enumerate() {
            if reached {
                self.end_positioning(index);
            }
        }
    }

    /// The PLC positions an axis.
    pub(crate) fn is_positioning(&self) -> bool {
        self.positioning.targets.iter().any(Option::is_some)
    }

    /// Resets the strobe of a PLC positioning.
    pub(crate) fn end_positioning(&mut self, index: usize) {
        if let Some(target) = self.positioning.targets.get_mut(index)
            && target.take().is_some()
            && let Some(strobe) = PLC_POSITIONING.get(index)
        {
            self.exchange.nc_set(*strobe, false);
        }
    }

    /// PLC axes: modules 9120 to 9124. Always with servo lag, no override but that of 9124, no software
    /// limits in the reference run [000:4094-4116] [000:15938-16000].
    pub(crate) fn move_plc_axes(&mut self) {
        let time = self.cycle_s();
        for unit in self.axes.iter_mut().filter(|unit| unit.is_plc_axis()) {
            let (Some(axis), Some(status)) = (
                self.positioning.plc_axes.get_mut(unit.index),
                self.link.plc_axes.get_mut(unit.index),
            ) else {
                continue;
            };
            let rapid = unit.parameters.motion.rapid_mm_min;
            let able = unit.servo.closed() && unit.enabled;
            let mut stop = !able || self.emergency.circuit() != crate::emergency::Circuit::Ready;
            match axis.command {
                Some(PlcAxisCommand::Start {
                    target,
                    incremental,
                    feed,
                }) if !stop => {
                    let wanted = *axis.target.get_or_insert(if incremental {
                        unit.nominal + target
                    } else {
                        shortest(unit.nominal, target, unit.parameters.travel.modulo_deg)
                    });
                    let feed = feed.max(0.0) * axis.override_percent / 100.0;
                    unit.drive(time, Aim::Position(wanted), feed);
                    if unit.ptp.is_at(wanted) && unit.servo.in_position() {
                        axis.command = None;
                    }
                }
                Some(PlcAxisCommand::TraverseReferenceMarks { feed, negative }) if !stop => {
                    if axis.target.replace(0.0).is_none() {
                        unit.servo.forget_marks();
                        unit.referenced = false;
                    }
                    let mark = unit.servo.take_mark();
                    if let Some((count, scale)) = mark.and_then(|mark| Some((mark.count, mark.scale_mm?))) {
                        unit.set_datum(count, scale - unit.parameters.travel.machine_datum_mm);
                        unit.referenced = true;
                        axis.command = Some(PlcAxisCommand::Stop);
                    }
                    let feed = feed.max(0.0);
                    let sign = if negative { -1.0 } else { 1.0 };
                    unit.drive(time, Aim::Feed(sign * feed), feed);
                }
                _ => stop = true,
            }
            if stop {
                unit.drive(time, Aim::Feed(0.0), rapid);
                if unit.stands() {
                    axis.command = None;
                }
            }
            if axis.command.is_none() {
                axis.target = None;
            }
            unit.mover = if axis.command.is_some() {
                Mover::Plc
            } else {
                Mover::None
            };
            status.positioning = axis.command.is_some();
            status.negative = unit.speed < 0.0;
            status.referenced = unit.referenced;
            status.error = unit.servo.fault().is_some();
        }
    }

    /// M2720: free rotation of the axes in B518 in the directions of B519 [000:6494-6517].
    pub(crate) fn take_free_rotation(&mut self) {
        let nc = self.exchange.nc();
        if !nc.bit(signal::FREE_ROTATION) {
            return;
        }
        let axes = nc.number(signal::FREE_ROTATION_AXIS);
        let negative = nc.number(signal::FREE_ROTATION_DIRECTION);
        for index in 3..AXES {
            let turns = axes >> index & 1 != 0;
            let sign = if negative >> index & 1 != 0 { -1.0 } else { 1.0 };
            if let Some(rotation) = self.positioning.rotation.get_mut(index) {
                *rotation = turns.then_some(sign);
            }
        }
        self.exchange.nc_set(signal::FREE_ROTATION, false);
    }

    /// Turns the axes of the free rotation, at W566 or W568 with the override W754, 0 to 300 %.
    pub(crate) fn move_rotation(&mut self) {
        let time = self.cycle_s();
        let nc = self.exchange.nc();
        let percent = f64::from(nc.number(signal::FREE_ROTATION_FEED_OVERRIDE).clamp(0, 300));
        let stop = self.emergency.circuit() != crate::emergency::Circuit::Ready;
        let limit = self.rapid_limit_mm_min();
        for unit in &mut self.axes {
            let Some(rotation) = self.positioning.rotation.get(unit.index).copied() else {
                continue;
            };
            if !(unit.servo.closed() && unit.enabled) {
                continue;
            }
            match rotation.filter(|_| !stop) {
                Some(sign) if matches!(unit.mover, Mover::None | Mover::Rotation) => {
                    let word = POSITIONING_FEED.get(unit.index);
                    let feed = word.map_or(0.0, |word| f64::from(nc.number(*word) as u16));
                    unit.mover = Mover::Rotation;
                    let feed = (feed * percent / 100.0).min(limit);
                    unit.drive(time, Aim::Feed(sign * feed), feed);
                }
                None if unit.mover == Mover::Rotation => {
                    unit.drive(time, Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min);
                    if unit.stands() {
                        unit.mover = Mover::None;
                    }
                }
                _ => {}
            }
        }
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
