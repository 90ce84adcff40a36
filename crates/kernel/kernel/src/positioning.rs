//! Movements of single axes that no path and no operator leads: to a place, on order of a PLC, round and round.

use bahn_motion::Aim;
use bahn_parameters::PerPlcAxis;

use crate::axes::OwnAxes;
use crate::axis::Mover;
use crate::now::Now;
use crate::ordered_axis::{AxisOrder, OrderedAxis};

/// Where an axis is positioned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Machine coordinate, mm or degrees.
    pub position: f64,
    /// Feed, mm/min or degrees/min.
    pub feed_mm_min: f64,
}

/// What single axes are to do, by axis index.
#[derive(Clone, Copy, Debug, Default)]
pub struct Positioning {
    goals: PerPlcAxis<Option<Goal>>,
    /// What the axes of the PLC execute.
    ordered: PerPlcAxis<OrderedAxis>,
    /// Free rotation: 1 or -1.
    turning: PerPlcAxis<Option<f64>>,
}

impl Positioning {
    /// Ends what the axes of the PLC do and the free rotation: EMERGENCY STOP.
    pub fn stop(&mut self) {
        for axis in &mut self.ordered {
            if axis.order.is_some() {
                axis.order = Some(AxisOrder::Stop);
            }
        }
        self.turning = PerPlcAxis::splat(None);
    }

    /// An axis is positioned.
    pub fn is_on(&self) -> bool {
        self.goals.iter().any(Option::is_some)
    }

    /// An axis is to go to a place, or no more.
    pub fn position(&mut self, index: usize, goal: Option<Goal>) {
        if let Some(slot) = self.goals.get_mut(index) {
            *slot = goal;
        }
    }

    /// Moves what is positioned; the axes that are there, or whose positioning is `broken_off`. Not those that a program
    /// run `restores`.
    pub fn moves(
        &mut self,
        axes: &mut OwnAxes,
        now: &Now,
        broken_off: bool,
        restores: bool,
    ) -> PerPlcAxis<bool> {
        let mut over = PerPlcAxis::splat(false);
        for unit in axes.iter_mut() {
            let Some(goal) = self.goals.get(unit.index).copied().flatten() else {
                if unit.mover == Mover::Positioning && !restores {
                    unit.come_to_rest(now.time_s);
                }
                continue;
            };
            unit.ask_to_unclamp();
            if !unit.can_be_driven() {
                continue;
            }
            unit.mover = Mover::Positioning;
            let (aim, feed) = if now.stop {
                (Aim::Feed(0.0), unit.parameters.motion.rapid_mm_min)
            } else {
                let feed = (goal.feed_mm_min * now.feed_percent / 100.0).min(now.rapid_limit_mm_min);
                (Aim::Position(goal.position), feed)
            };
            unit.drive(now.time_s, aim, feed);
            let there = unit.ptp.is_at(goal.position) && unit.servo.in_position();
            if let Some(over) = over.get_mut(unit.index) {
                *over = there || broken_off;
            }
        }
        over
    }

    /// Orders what an axis of the PLC does.
    pub fn order(&mut self, index: usize, order: AxisOrder) {
        if let Some(axis) = self.ordered.get_mut(index) {
            axis.order = Some(order);
            axis.target = None;
        }
    }

    /// The override of an axis of the PLC, %.
    pub fn set_override(&mut self, index: usize, percent: f64) {
        if let Some(axis) = self.ordered.get_mut(index) {
            axis.override_percent = percent;
        }
    }

    /// An axis of the PLC has something to do.
    pub fn is_ordered(&self, index: usize) -> bool {
        self.ordered.get(index).is_some_and(|axis| axis.order.is_some())
    }

    /// Moves the axes of the PLC. Always with servo lag, no override but their own, no software limits in the reference
    /// run [000:4094-4116] [000:15938-16000].
    pub fn move_ordered(&mut self, axes: &mut OwnAxes, now: &Now) {
        for unit in axes.iter_mut().filter(|unit| unit.is_plc_axis()) {
            if let Some(axis) = self.ordered.get_mut(unit.index) {
                axis.moves(unit, now);
            }
        }
    }

    /// An axis turns freely, with a sign, or no more.
    pub fn turn(&mut self, index: usize, sign: Option<f64>) {
        if let Some(turning) = self.turning.get_mut(index) {
            *turning = sign;
        }
    }

    /// Turns the axes of the free rotation, with feeds by axis index, mm/min.
    pub fn move_turning(&mut self, axes: &mut OwnAxes, feed_mm_min: impl Fn(usize) -> f64, now: &Now) {
        for unit in axes.iter_mut().filter(|unit| unit.can_be_driven()) {
            let turning = self.turning.get(unit.index).copied().flatten();
            match turning.filter(|_| now.ready) {
                Some(sign) if matches!(unit.mover, Mover::None | Mover::Rotation) => {
                    unit.mover = Mover::Rotation;
                    let feed = feed_mm_min(unit.index).min(now.rapid_limit_mm_min);
                    unit.drive(now.time_s, Aim::Feed(sign * feed), feed);
                }
                None if unit.mover == Mover::Rotation => unit.come_to_rest(now.time_s),
                _ => {}
            }
        }
    }
}
