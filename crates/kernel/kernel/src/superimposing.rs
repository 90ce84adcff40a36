//! M118: handwheel movements on top of the path of a program [000:742].
//!
//! Decision: M118 leads the axes of the machine beside the path, whatever plane it stands in, on a ramp of MP1060 of
//! their own, so that path and handwheel together reach twice of it and no more, also at NC stop and not in a thread;
//! no faster than the path leaves it of MP1010 in the same cycle, and where the path gains more than that ramp
//! brakes, at a corner, the wheel gives way at once, since the axis then just keeps MP1010; a fault of an axis stops
//! it as the machine [000:5198]; a block on whose way the range reaches beyond the traverse range is refused,
//! measuring is, too; M118 without words goes back, end of program and INTERNAL STOP leave the axes where they are;
//! what is turned while loops are open, the PLC positions the axis, or until axes are back on their path, adds
//! nothing (also `kernel/src/feeder.rs`)

use bahn_motion::{Aim, PointToPoint};
use bahn_parameters::PerPlcAxis;
use bahn_path::{Axis, PerAxis, Position};

use crate::axis::{AxisUnit, Mover};

/// How far the axes may be led beside the path, how far they are to be, and where they are on the way there. In
/// coordinates of the axes, whatever the path stands in (inferred).
#[derive(Clone, Copy, Debug)]
pub struct Superimposed {
    /// To either side of the path, mm or degrees; 0 where there is nothing.
    range: Position,
    /// Where the wheels lead.
    target: Position,
    /// What is added to the path now, each on its own ramp of MP1060.
    ramps: PerAxis<PointToPoint>,
    /// By how much that changed in this cycle.
    ways: Position,
    /// Anything of it is not 0.
    on: bool,
}

/// What leads the axes beside the path in a contour cycle.
#[derive(Clone, Copy, Debug)]
pub struct Wheels<'a> {
    /// By how much each was turned in this cycle, by axis index, mm or degrees.
    pub turned_mm: &'a PerPlcAxis<f64>,
    /// Path and wheel together are no faster, mm/min.
    pub rapid_limit_mm_min: f64,
    /// The contour cycle, s.
    pub time_s: f64,
    /// A loop has a fault: the machine stops.
    pub fault: bool,
}

impl Default for Superimposed {
    fn default() -> Superimposed {
        Superimposed {
            range: Position::ZERO,
            target: Position::ZERO,
            ramps: PerAxis::splat(PointToPoint::new(0.0)),
            ways: Position::ZERO,
            on: false,
        }
    }
}

impl Superimposed {
    /// Something is added to the path, or may be.
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// What is added to an axis, mm or degrees.
    pub fn of(&self, axis: Axis) -> f64 {
        self.ramps[axis].position()
    }

    /// How far it may be led to either side of the path, mm or degrees.
    pub fn range(&self, axis: Axis) -> f64 {
        self.range[axis]
    }

    /// By how much that changed in this cycle.
    pub fn way(&self, axis: Axis) -> f64 {
        self.ways[axis]
    }

    /// M118: other ranges; an axis without one goes back to the path.
    pub fn set_range(&mut self, range: Position) {
        self.range = range;
        self.on = true;
    }

    /// Nothing is added any more: the axes stand where they are, and the path begins there.
    pub fn forget(&mut self) {
        if self.on {
            *self = Superimposed::default();
        }
    }

    /// The axes stand beside the path: what leads them on begins anew, and what was turned before moves nothing later.
    pub fn stand(&mut self) {
        if !self.on {
            return;
        }
        self.ways = Position::ZERO;
        for axis in Axis::ALL {
            let position = self.of(axis);
            self.ramps[axis] = PointToPoint::new(position);
            self.target[axis] = position;
        }
    }

    /// Axis positions with what is added (`sign` 1), or without it (-1).
    pub fn added(&self, axes: Position, sign: f64) -> Position {
        if !self.on {
            return axes;
        }
        PerAxis::from_fn(|axis| axes[axis] + sign * self.of(axis)).into()
    }

    /// Follows the wheels for a cycle, beside a path that leads the axes to `path` in it; `None` when it stands. Not while the
    /// path `holds` it. An axis without loop or feed enable stands at once, one that was taken over beside its path goes back
    /// to that first, one that the PLC positions goes where it is to: what is turned meanwhile moves nothing later. A fault stops
    /// all on their ramps, as the machine does [000:5198]. None is led out of its traverse range.
    pub fn follow<'a>(
        &mut self,
        path: Option<&Position>,
        axes: impl Iterator<Item = &'a AxisUnit>,
        wheels: &Wheels,
        holds: bool,
    ) {
        if !self.on {
            return;
        }
        let mut on = self.range != Position::ZERO;
        self.ways = Position::ZERO;
        for unit in axes.filter(|unit| unit.is_free()) {
            let axis = unit.axis;
            let before = self.ramps[axis].position();
            let on_path = matches!(unit.mover, Mover::None | Mover::Path) && unit.left_at.is_none();
            if on_path && unit.enabled && unit.servo.closed() {
                let was = unit.nominal - before;
                let path = path.map(|path| path[axis]).filter(|path| !path.is_nan());
                let path_mm_s = (path.unwrap_or(was) - was) / wheels.time_s;
                if wheels.fault {
                    self.lead(unit, Aim::Feed(0.0), path_mm_s, wheels);
                    self.target[axis] = self.of(axis);
                } else {
                    let turned = wheels.turned_mm.get(unit.index).filter(|_| !holds);
                    self.turn(unit, turned.copied().unwrap_or(0.0), path.unwrap_or(was));
                    self.lead(unit, Aim::Position(self.target[axis]), path_mm_s, wheels);
                }
            } else {
                self.ramps[axis] = PointToPoint::new(before);
                self.target[axis] = before;
            }
            self.ways[axis] = self.of(axis) - before;
            on |= !self.ramps[axis].is_at(0.0) || self.ways[axis] != 0.0;
        }
        self.on = on;
    }

    /// Where the wheel leads an axis whose path is at `path`.
    fn turn(&mut self, unit: &AxisUnit, turned: f64, path: f64) {
        let most = self.range[unit.axis];
        let mut target = (self.target[unit.axis] + turned).clamp(-most, most);
        if let Some([least, greatest]) = unit.limited() {
            target = target
                .min((greatest - path).max(0.0))
                .max((least - path).min(0.0));
        }
        self.target[unit.axis] = target;
    }

    /// Leads an axis on its ramp, as fast as the path leaves it of the rapid traverse. What the path takes of that faster than the
    /// ramp brakes, at a corner that it passes, the wheel gives way by at once (inferred): the axis then keeps the rapid
    /// traverse, and its own velocity changes by no more than that of the path does and the ramp allows.
    fn lead(&mut self, unit: &AxisUnit, aim: Aim, path_mm_s: f64, wheels: &Wheels) {
        let motion = &unit.parameters.motion;
        let limit = motion.rapid_mm_min.min(wheels.rapid_limit_mm_min);
        let feed = (limit - path_mm_s.abs() * 60.0).max(0.0);
        let ramp = &mut self.ramps[unit.axis];
        let before = ramp.position();
        let way = ramp.cycle(wheels.time_s, aim, feed, motion.acceleration_m_s2) - before;
        let rapid = motion.rapid_mm_min / 60.0;
        let (least, most) = ((-rapid - path_mm_s).min(0.0), (rapid - path_mm_s).max(0.0));
        let left = way.clamp(least * wheels.time_s, most * wheels.time_s);
        if left != way {
            *ramp = PointToPoint::moving(before + left, ramp.speed_mm_s().clamp(least, most));
        }
    }
}
