//! Working planes.

use crate::{Axis, Position};

/// A point in a working plane: first and second axis of the plane, mm.
pub type Point2 = [f64; 2];

/// A plane of two linear axes; the normal is the tool axis that stands on it.
///
/// The order of the axes makes first, second, normal a right-handed system, so that positive angles
/// are counter-clockwise seen against the normal: XY (Z), YZ (X), ZX (Y) [003:708-713] [003:2733-2738].
/// Parallel axes may stand for their main axis [003:5397-5432].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Plane {
    /// Axis from which angles count.
    pub first: Axis,
    /// Axis at +90 degrees.
    pub second: Axis,
    /// Axis that is perpendicular to the plane.
    pub normal: Axis,
}

impl Plane {
    /// The main plane of tool axis Z.
    pub const XY: Plane = Plane {
        first: Axis::X,
        second: Axis::Y,
        normal: Axis::Z,
    };
    /// The main plane of tool axis X.
    pub const YZ: Plane = Plane {
        first: Axis::Y,
        second: Axis::Z,
        normal: Axis::X,
    };
    /// The main plane of tool axis Y.
    pub const ZX: Plane = Plane {
        first: Axis::Z,
        second: Axis::X,
        normal: Axis::Y,
    };

    /// The main plane of a tool axis; `None` for a rotary axis. A parallel tool axis (W) keeps its
    /// own letter as the normal [003:5397-5432].
    pub fn of_tool_axis(tool_axis: Axis) -> Option<Plane> {
        let main = match tool_axis.main()? {
            Axis::X => Plane::YZ,
            Axis::Y => Plane::ZX,
            _ => Plane::XY,
        };
        Some(Plane {
            normal: tool_axis,
            ..main
        })
    }

    /// The plane that two axes span, in either order; `None` when they are parallel or rotary. The
    /// normal is the main axis perpendicular to both.
    pub fn of_axes(a: Axis, b: Axis) -> Option<Plane> {
        let (first, second, normal) = match (a.main()?, b.main()?) {
            (Axis::X, Axis::Y) => (a, b, Axis::Z),
            (Axis::Y, Axis::X) => (b, a, Axis::Z),
            (Axis::Y, Axis::Z) => (a, b, Axis::X),
            (Axis::Z, Axis::Y) => (b, a, Axis::X),
            (Axis::Z, Axis::X) => (a, b, Axis::Y),
            (Axis::X, Axis::Z) => (b, a, Axis::Y),
            _ => return None,
        };
        Some(Plane {
            first,
            second,
            normal,
        })
    }

    /// Whether the axis is one of the two axes of the plane.
    pub fn contains(&self, axis: Axis) -> bool {
        axis == self.first || axis == self.second
    }

    /// The point of the plane at a position; NaN where an axis has no position.
    #[inline]
    pub fn point(&self, position: &Position) -> Point2 {
        [position[self.first], position[self.second]]
    }

    /// Puts a point of the plane into a position.
    #[inline]
    pub fn set(&self, position: &mut Position, point: Point2) {
        position[self.first] = point[0];
        position[self.second] = point[1];
    }
}
