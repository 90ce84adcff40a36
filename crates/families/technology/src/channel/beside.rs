//! Axes that move on their own, beside the path.

use bahn_din::Independent;
use bahn_motion::{Aim, Limits, PointToPoint};
use bahn_path::Position;

/// The axes that move on their own, and where they have ended.
pub(super) struct Beside<'a> {
    limits: &'a Limits,
    moving: Vec<(Independent, PointToPoint)>,
    ended_at: Position,
}

impl<'a> Beside<'a> {
    /// No axis moves beside the path yet.
    pub(super) fn new(limits: &'a Limits) -> Beside<'a> {
        Beside {
            limits,
            moving: Vec::new(),
            ended_at: Position::UNKNOWN,
        }
    }

    /// The path begins anew: where they are it takes over.
    pub(super) fn clear(&mut self) {
        self.moving.clear();
        self.ended_at = Position::UNKNOWN;
    }

    /// No axis moves beside the path any more.
    pub(super) fn all_ended(&self) -> bool {
        self.moving.is_empty()
    }

    /// The path takes over where they have ended. Whether any has.
    pub(super) fn take_over(&mut self) -> bool {
        let any = !self.ended_at.known().is_empty();
        self.ended_at = Position::UNKNOWN;
        any
    }

    /// Where all axes are when the path is somewhere.
    pub(super) fn with_path(&self, mut position: Position) -> Position {
        for axis in self.ended_at.known().iter() {
            position[axis] = self.ended_at[axis];
        }
        for (independent, axis) in &self.moving {
            position[independent.axis] = axis.position();
        }
        position
    }

    /// An axis begins to move on its own, from where it is.
    pub(super) fn begin(&mut self, independent: Independent, at: f64) {
        let at = if at.is_nan() { 0.0 } else { at };
        self.moving.retain(|(other, _)| other.axis != independent.axis);
        self.moving.push((independent, PointToPoint::new(at)));
    }

    /// They move for a cycle, s. Whether there are any.
    pub(super) fn cycle(&mut self, cycle_s: f64) -> bool {
        let any = !self.moving.is_empty();
        let Beside {
            limits,
            moving,
            ended_at,
        } = self;
        moving.retain_mut(|(order, axis)| {
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
                ended_at[order.axis] = order.end;
            }
            !is_at
        });
        any
    }
}
