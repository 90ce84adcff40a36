//! A cylinder surface laid flat: cycle 27 [000:6759-6763].

use crate::{Axis, Curve, PerAxis, Position};

/// A cylinder about a rotary axis whose surface the path sees unrolled under the tool. One main axis of the path is the distance
/// around it, mm; the axis itself stays over the centre, and the rotary axis turns instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The axis that turns.
    pub rotary: Axis,
    /// The main axis across it and across the tool: the distance around it on the path.
    pub around: Axis,
    /// Degrees of the rotary axis for a mm around the cylinder, with its sign.
    pub deg_per_mm: f64,
    /// Where the rotary axis stands at 0 of that axis, degrees.
    pub zero_deg: f64,
    /// Position of the main axis with the tool over the centre, mm.
    pub centre_mm: f64,
}

impl Cylinder {
    /// The axes for a position of the unrolled surface. What the path leads beside the centre stands in the place of the
    /// rotary axis, so that each position has its way back.
    pub(crate) fn roll(&self, flat: &Position) -> Position {
        let mut axes = *flat;
        axes[self.rotary] = self.zero_deg + flat[self.around] * self.deg_per_mm;
        axes[self.around] = self.centre_mm + flat[self.rotary];
        axes
    }

    /// The position of the unrolled surface for one of the axes.
    pub(crate) fn unroll(&self, axes: &Position) -> Position {
        let mut flat = *axes;
        flat[self.around] = (axes[self.rotary] - self.zero_deg) / self.deg_per_mm;
        flat[self.rotary] = axes[self.around] - self.centre_mm;
        flat
    }

    /// The derivative of the axes where that on the surface is `direction`.
    pub fn velocity(&self, direction: &PerAxis<f64>) -> PerAxis<f64> {
        let mut axes = *direction;
        axes[self.rotary] = direction[self.around] * self.deg_per_mm;
        axes[self.around] = direction[self.rotary];
        axes
    }

    /// The axis of the path that moves an axis of the machine.
    pub fn moved_by(&self, axis: Axis) -> Axis {
        match axis {
            _ if axis == self.rotary => self.around,
            _ if axis == self.around => self.rotary,
            _ => axis,
        }
    }

    /// Least and greatest positions of the axes on a curve of the surface.
    pub(crate) fn bounds(&self, curve: &Curve, start: &Position, end: &Position) -> [Position; 2] {
        let [a, b] = curve.bounds(start, end).map(|corner| self.roll(&corner));
        let each = |pick: fn(f64, f64) -> f64| PerAxis::from_fn(|axis| pick(a[axis], b[axis])).into();
        [each(f64::min), each(f64::max)]
    }
}
