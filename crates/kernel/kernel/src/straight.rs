//! A straight way beside the program: the axes are led along it, and stop on it where they are told to.

use bahn_motion::{Aim, PointToPoint};
use bahn_path::{Axis, PerAxis, Position};

use crate::axes::OwnAxes;
use crate::axis::{AxisUnit, Mover};
use crate::kinematics::Chain;
use crate::now::Now;

/// A straight way, and how far the axes are on it.
#[derive(Clone, Copy, Debug)]
pub struct Straight {
    from: Position,
    to: Position,
    length: f64,
    /// Of the path, m/s².
    acceleration_m_s2: f64,
    /// Distance along the line, mm.
    way: PointToPoint,
}

impl Straight {
    /// From a place to another one, path coordinates, mm; no faster than the axes that move.
    pub fn new([from, to]: [Position; 2], axes: &OwnAxes) -> Straight {
        let way = |axis: Axis| to[axis] - from[axis];
        let squares = Axis::ALL.into_iter().map(|axis| way(axis).powi(2));
        let moving = axes.iter().filter(|unit| way(unit.axis).abs() > 0.0);
        Straight {
            from,
            to,
            length: squares.filter(|square| square.is_finite()).sum::<f64>().sqrt(),
            acceleration_m_s2: moving
                .map(|unit| unit.parameters.motion.acceleration_m_s2)
                .fold(f64::INFINITY, f64::min),
            way: PointToPoint::new(0.0),
        }
    }

    /// Its start and its end, path coordinates.
    pub fn ends(&self) -> [Position; 2] {
        [self.from, self.to]
    }

    /// Length from start to end, mm.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The axes are on it so far from its start, mm.
    pub fn is_at(&self, way: f64) -> bool {
        self.way.is_at(way)
    }

    /// The axes are at its end.
    pub fn is_over(&self) -> bool {
        self.length == 0.0 || self.is_at(self.length)
    }

    /// Nothing moves on it.
    pub fn stands(&self) -> bool {
        self.way.speed_mm_s() == 0.0
    }

    /// An axis of it cannot move: the way stands at once, as a path does [000:5352].
    pub fn is_held(&mut self, axes: &OwnAxes) -> bool {
        let held = axes
            .iter()
            .any(|unit| self.moves(unit.axis) && !unit.may_be_led());
        if held {
            self.halt();
        }
        held
    }

    /// It stands at once.
    pub fn halt(&mut self) {
        self.way = PointToPoint::new(self.way.position());
    }

    /// Not of an axis whose place no path knows: one of the PLC, or a slave.
    fn moves(&self, axis: Axis) -> bool {
        (self.to[axis] - self.from[axis]).abs() > 0.0
    }

    /// The position so far along it, path coordinates.
    pub fn along(&self, way: f64) -> Position {
        let part = if self.length > 0.0 { way / self.length } else { 0.0 };
        PerAxis::from_fn(|axis| self.from[axis] + part * (self.to[axis] - self.from[axis])).into()
    }

    /// How far along it a position is, mm, as the axes of the machine know it.
    pub fn part_of<'a>(&self, position: &Position, axes: impl Iterator<Item = &'a AxisUnit>) -> f64 {
        let along = axes.map(|unit| {
            let axis = unit.axis;
            let way = self.to[axis] - self.from[axis];
            let at = position[axis] - self.from[axis];
            if way == 0.0 || way.is_nan() {
                0.0
            } else {
                at * way / self.length
            }
        });
        along.sum()
    }

    /// Leads the axes for a cycle, with a feed in mm/min. Where they are then, path coordinates.
    pub fn lead(
        &mut self,
        aim: Aim,
        feed_mm_min: f64,
        axes: &mut OwnAxes,
        chain: &Chain,
        now: &Now,
    ) -> Position {
        let ramps_down = axes.iter().any(|unit| self.moves(unit.axis) && unit.ramps_down());
        let aim = if ramps_down { Aim::Feed(0.0) } else { aim };
        let at = self
            .way
            .cycle(now.time_s, aim, feed_mm_min, self.acceleration_m_s2);
        let position = self.along(at);
        let nominal = chain.to_axes(&position);
        for unit in axes.iter_mut() {
            let value = nominal[unit.axis];
            if value.is_finite() && matches!(unit.mover, Mover::None | Mover::Path) && unit.is_free() {
                unit.follow_probe(value, now.time_s);
            }
        }
        position
    }
}
