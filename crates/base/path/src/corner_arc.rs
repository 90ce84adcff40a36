//! Circular arcs at the corners of lines that lie anywhere in space.

use crate::{Axis, Position};

/// The main axes, in which such an arc lies.
const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// A circular arc of less than half a turn in any plane of X, Y and Z. It touches two lines that meet in a corner: the one from its
/// start to there and the one from there to its end, which are of the same length. Start, corner and end say all about it.
///
/// Other axes move linearly with the angle, as beside every arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CornerArc {
    /// Where the tangents at start and end meet: X, Y, Z, mm.
    pub corner: [f64; 3],
}

/// The circle of an arc: what [`CornerArc`] is between its start and its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Start of the arc, mm.
    start: [f64; 3],
    /// Unit vector of the direction at the start.
    ahead: [f64; 3],
    /// Unit vector from the start to the centre.
    inward: [f64; 3],
    /// Radius, mm; infinite where the path is straight.
    pub radius_mm: f64,
    /// Sweep, rad; 0 where the path is straight.
    pub sweep_rad: f64,
    /// Length of the arc, mm.
    pub length_mm: f64,
}

impl CornerArc {
    /// The arc on its circle. What is straight within rounding is a straight line.
    pub fn circle(&self, start: &Position, end: &Position) -> Circle {
        let [from, to] = [start, end].map(|place| MAIN.map(|axis| place[axis]));
        let (before, after) = (between(from, self.corner), between(self.corner, to));
        let legs = [length(before), length(after)];
        let straight = |offset: [f64; 3]| {
            let length = length(offset);
            Circle {
                start: from,
                ahead: if length > 0.0 {
                    offset.map(|d| d / length)
                } else {
                    [0.0; 3]
                },
                inward: [0.0; 3],
                radius_mm: f64::INFINITY,
                sweep_rad: 0.0,
                length_mm: length,
            }
        };
        if legs[0] <= 0.0 || legs[1] <= 0.0 {
            return straight(between(from, to));
        }
        let (u, v) = (before.map(|d| d / legs[0]), after.map(|d| d / legs[1]));
        let along = dot(u, v);
        let across = [0, 1, 2].map(|i| v[i] - along * u[i]);
        let sine = length(across);
        // Below it the directions are the same within the rounding of positions.
        const STRAIGHT: f64 = 1e-12;
        if sine < STRAIGHT {
            return straight(between(from, to));
        }
        let sweep_rad = sine.atan2(along);
        let radius_mm = 0.5 * (legs[0] + legs[1]) / (0.5 * sweep_rad).tan();
        Circle {
            start: from,
            ahead: u,
            inward: across.map(|d| d / sine),
            radius_mm,
            sweep_rad,
            length_mm: radius_mm * sweep_rad,
        }
    }

    /// The part of the arc between two fractions of it.
    pub fn part(&self, start: &Position, end: &Position, from: f64, to: f64) -> CornerArc {
        let circle = self.circle(start, end);
        let (place, direction) = (circle.place(from), circle.direction(from));
        let leg = if circle.sweep_rad > 0.0 {
            circle.radius_mm * (0.5 * circle.sweep_rad * (to - from)).tan()
        } else {
            0.5 * circle.length_mm * (to - from)
        };
        CornerArc {
            corner: [0, 1, 2].map(|i| place[i] + leg * direction[i]),
        }
    }
}

impl Circle {
    /// X, Y and Z at a fraction of the arc, mm.
    pub fn place(&self, t: f64) -> [f64; 3] {
        if self.sweep_rad == 0.0 {
            return [0, 1, 2].map(|i| self.start[i] + self.ahead[i] * self.length_mm * t);
        }
        let angle = self.sweep_rad * t;
        // 1 - cos without what cancels in it: flat arcs have large radii.
        let half = (0.5 * angle).sin();
        let (along, inward) = (self.radius_mm * angle.sin(), self.radius_mm * 2.0 * half * half);
        [0, 1, 2].map(|i| self.start[i] + along * self.ahead[i] + inward * self.inward[i])
    }

    /// Unit vector of the direction at a fraction of the arc.
    pub fn direction(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = (self.sweep_rad * t).sin_cos();
        [0, 1, 2].map(|i| cos * self.ahead[i] + sin * self.inward[i])
    }

    /// The centre of the circle, mm; `None` where the path is straight.
    pub fn centre(&self) -> Option<[f64; 3]> {
        (self.sweep_rad > 0.0).then(|| [0, 1, 2].map(|i| self.start[i] + self.radius_mm * self.inward[i]))
    }

    /// The fraction of the arc that is nearest to a place, mm.
    pub fn nearest(&self, place: [f64; 3]) -> f64 {
        let offset = between(self.start, place);
        let (along, inward) = (dot(offset, self.ahead), dot(offset, self.inward));
        if self.sweep_rad == 0.0 {
            let t = along / self.length_mm;
            return if t.is_finite() { t.clamp(0.0, 1.0) } else { 1.0 };
        }
        let angle = along.atan2(self.radius_mm - inward);
        let after = angle.rem_euclid(std::f64::consts::TAU);
        // Outside of the arc the end that is nearer by the angle.
        if after <= self.sweep_rad {
            after / self.sweep_rad
        } else if after - self.sweep_rad < std::f64::consts::TAU - after {
            1.0
        } else {
            0.0
        }
    }

    /// The greatest share that the direction has anywhere on the arc along a unit vector.
    pub fn greatest_share(&self, along: [f64; 3]) -> f64 {
        let (ahead, inward) = (dot(self.ahead, along), dot(self.inward, along));
        let (sin, cos) = self.sweep_rad.sin_cos();
        // What the share changes by at the start and at the end: in between it is greatest if the sign changes.
        if inward * (cos * inward - sin * ahead) < 0.0 {
            ahead.hypot(inward)
        } else {
            ahead.abs().max((cos * ahead + sin * inward).abs())
        }
    }

    /// The fraction of the arc at which an axis turns back, if it does: 0 X, 1 Y, 2 Z.
    pub(crate) fn turning_point(&self, axis: usize) -> Option<f64> {
        let (ahead, inward) = (self.ahead.get(axis)?, self.inward.get(axis)?);
        let angle = (-ahead * inward.signum()).atan2(inward.abs());
        let angle = if angle < 0.0 {
            angle + std::f64::consts::PI
        } else {
            angle
        };
        (angle > 0.0 && angle < self.sweep_rad).then(|| angle / self.sweep_rad)
    }
}

fn between(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| b[i] - a[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
