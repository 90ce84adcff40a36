//! Coordinate transformations of the program as one frame.
//!
//! Decision: `point = shift + rotation · mirror · scaling · programmed`
//!
//! Decision: The basic rotation turns the frame of a program from outside, about the datum; the axes and the display
//! stay as they are

use crate::{Axis, PerAxis, Plane, Position};

/// Datum shift, mirror image, rotation and scaling combined in the recommended order
/// (inferred) [003:6240] [003:6315]:
///
/// `point_machine = B(basic rotation) · (shift + R(rotation) · M(mirror) · S(scale) · (c + F(factors of single axes) · (p - c)))`
///
/// Rotation turns in the working plane about the active datum; mirroring and scaling act on each axis. The basic
/// rotation turns all of it about the datum of the workpiece [003:1282-1304].
///
/// ```
/// use bahn_path::{Axis, Frame, Plane, Position};
/// let mut frame = Frame::identity(Plane::XY);
/// frame.shift[Axis::X] = 40.0;
/// frame.rotation_deg = 90.0;
/// let mut p = Position::UNKNOWN;
/// p[Axis::X] = 10.0;
/// p[Axis::Y] = 0.0;
/// let q = frame.to_outer(&p);
/// assert!((q[Axis::X] - 40.0).abs() < 1e-12 && (q[Axis::Y] - 10.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Plane in which the rotation turns.
    pub plane: Plane,
    /// Datum shift of each axis, mm or degrees.
    pub shift: Position,
    /// Rotation in the plane, degrees, counter-clockwise positive.
    pub rotation_deg: f64,
    /// Basic rotation of the workpiece in the plane, degrees, counter-clockwise positive.
    pub basic_rotation_deg: f64,
    /// Factor of each axis: the scaling factor, negative where the axis is mirrored.
    pub factor: Position,
    /// Factors of single axes, which act on what is programmed before everything else.
    pub axis_scaling: Option<AxisScaling>,
}

/// Scaling of single axes (cycle 26): `centre + factor · (p - centre)` in programmed coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisScaling {
    /// Factor of each axis, positive.
    pub factor: Position,
    /// What stays where it is, mm.
    pub centre: Position,
}

impl AxisScaling {
    /// Factors that change nothing.
    pub fn none() -> AxisScaling {
        AxisScaling {
            factor: PerAxis::splat(1.0).into(),
            centre: Position::ZERO,
        }
    }
}

impl Frame {
    /// The frame that changes nothing.
    pub fn identity(plane: Plane) -> Frame {
        Frame {
            plane,
            shift: Position::ZERO,
            rotation_deg: 0.0,
            basic_rotation_deg: 0.0,
            factor: PerAxis::splat(1.0).into(),
            axis_scaling: None,
        }
    }

    /// Whether the frame changes nothing.
    pub fn is_identity(&self) -> bool {
        *self == Frame::identity(self.plane)
    }

    /// From programmed coordinates to those of the workpiece datum. An axis without a position keeps
    /// none; with a rotation both axes of the plane must have one, else neither has one afterwards.
    pub fn to_outer(&self, programmed: &Position) -> Position {
        let mut result = *programmed;
        if let Some(own) = &self.axis_scaling {
            for axis in Axis::ALL {
                result[axis] = own.centre[axis] + own.factor[axis] * (result[axis] - own.centre[axis]);
            }
        }
        for axis in Axis::ALL {
            result[axis] *= self.factor[axis];
        }
        self.rotate(&mut result, self.rotation_deg);
        for axis in Axis::ALL {
            result[axis] += self.shift[axis];
        }
        self.rotate(&mut result, self.basic_rotation_deg);
        result
    }

    /// From coordinates of the workpiece datum back to programmed ones.
    pub fn to_programmed(&self, outer: &Position) -> Position {
        let mut result = *outer;
        self.rotate(&mut result, -self.basic_rotation_deg);
        for axis in Axis::ALL {
            result[axis] -= self.shift[axis];
        }
        self.rotate(&mut result, -self.rotation_deg);
        for axis in Axis::ALL {
            result[axis] /= self.factor[axis];
        }
        if let Some(own) = &self.axis_scaling {
            for axis in Axis::ALL {
                result[axis] = own.centre[axis] + (result[axis] - own.centre[axis]) / own.factor[axis];
            }
        }
        result
    }

    /// By how much directions are turned in the plane, degrees.
    pub fn turn_deg(&self) -> f64 {
        self.rotation_deg + self.basic_rotation_deg
    }

    /// Both axes of the plane depend on each other.
    pub fn turns(&self) -> bool {
        self.rotation_deg != 0.0 || self.basic_rotation_deg != 0.0
    }

    /// How many times as long as programmed a length along an axis is; positive.
    pub fn scale(&self, axis: Axis) -> f64 {
        let own = self.axis_scaling.map_or(1.0, |own| own.factor[axis]);
        (self.factor[axis] * own).abs()
    }

    /// Whether the frame turns the sense of rotation around in a plane (an odd number of its axes is
    /// mirrored), so that DR and the side of the tool change [003:6276-6284].
    pub fn reverses(&self, plane: Plane) -> bool {
        (self.factor[plane.first] < 0.0) != (self.factor[plane.second] < 0.0)
    }

    fn rotate(&self, position: &mut Position, angle_deg: f64) {
        if angle_deg == 0.0 {
            return;
        }
        let (sin, cos) = sin_cos_deg(angle_deg);
        let [a, b] = self.plane.point(position);
        self.plane.set(position, [a * cos - b * sin, a * sin + b * cos]);
    }
}

/// Sine and cosine of degrees, exact at multiples of 90 degrees so that a quarter turn stays on the grid.
pub(crate) fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    match angle_deg.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => angle_deg.to_radians().sin_cos(),
    }
}
