//! Programs of a System 900 are read in the coordinates of the axes: zero points, rotations and tools are in them.

use bahn_kernel::{Kinematics, Offsets};
use bahn_path::{Curve, Position};

/// The path is where the axes are, whatever tool is called.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OfAxes;

impl Kinematics for OfAxes {
    fn to_axes(&self, path: &Position, _: &Offsets) -> Position {
        *path
    }

    fn to_path(&self, axes: &Position, _: &Offsets) -> Position {
        *axes
    }

    fn bounds(&self, curve: &Curve, start: &Position, end: &Position, _: &Offsets) -> [Position; 2] {
        curve.bounds(start, end)
    }
}
