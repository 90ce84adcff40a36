//! Where the blank lies: from positions of nine axes to coordinates in the blank.

use bahn_path::{Axis, Blank, Position};

/// A point in the blank, mm from its least corner: first axis of the working plane, second axis,
/// tool axis.
pub(crate) type Local = [f64; 3];

/// Orientation and place of the blank.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup {
    /// Main axes: first and second of the working plane, tool axis.
    pub axes: [Axis; 3],
    /// Least corner in the order of `axes`, mm.
    pub min: Local,
    /// Side lengths in the order of `axes`, mm.
    pub size: Local,
    /// Coordinates of the first axis count to the left, with the other sign: a part that is drawn turned.
    pub leftwards: bool,
}

impl Setup {
    /// `None` when a side has no positive finite length or the plane is not one of linear axes.
    pub fn new(blank: &Blank) -> Option<Setup> {
        let plane = blank.plane;
        let axes = [plane.first.main()?, plane.second.main()?, plane.normal.main()?];
        let mut setup = Setup {
            axes,
            min: [0.0; 3],
            size: [0.0; 3],
            leftwards: false,
        };
        for (k, axis) in axes.into_iter().enumerate() {
            // The main axes X, Y, Z are the first three of all axes, as the corners of a blank are.
            let (min, max) = (*blank.min.get(axis.index())?, *blank.max.get(axis.index())?);
            let size = max - min;
            if !(size.is_finite() && size > 0.0) {
                return None;
            }
            setup.min[k] = min;
            setup.size[k] = size;
        }
        let all_different = axes[0] != axes[1] && axes[1] != axes[2] && axes[2] != axes[0];
        all_different.then_some(setup)
    }

    /// The point of the blank where the tool tip is; `None` while an axis has no position.
    pub fn local(&self, position: &Position) -> Option<Local> {
        let mut local = [0.0; 3];
        for (k, value) in local.iter_mut().enumerate() {
            *value = coordinate(position, self.axes[k])? - self.min[k];
            if !value.is_finite() {
                return None;
            }
        }
        Some(local)
    }
}

/// The coordinate along a main axis: a parallel axis carries the tool in the same direction, so both
/// add up where both have a position (inferred) [003:5397-5432].
fn coordinate(position: &Position, main: Axis) -> Option<f64> {
    let parallel = match main {
        Axis::X => Axis::U,
        Axis::Y => Axis::V,
        _ => Axis::W,
    };
    match (position.get(main), position.get(parallel)) {
        (Some(a), Some(b)) => Some(a + b),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_path::Plane;

    #[test]
    fn tool_axis_x_has_working_plane_yz() {
        let plane = Plane::of_tool_axis(Axis::X).unwrap();
        let blank = Blank {
            plane,
            min: [-30.0, 10.0, 20.0],
            max: [0.0, 50.0, 90.0],
        };
        let setup = Setup::new(&blank).unwrap();
        assert_eq!(setup.axes, [Axis::Y, Axis::Z, Axis::X]);
        assert_eq!(setup.size, [40.0, 70.0, 30.0]);
        let mut p = Position::UNKNOWN;
        p[Axis::X] = -5.0;
        p[Axis::Y] = 11.0;
        assert_eq!(setup.local(&p), None);
        p[Axis::Z] = 22.0;
        assert_eq!(setup.local(&p), Some([1.0, 2.0, 25.0]));
        // V acts like Y.
        p[Axis::V] = 3.0;
        assert_eq!(setup.local(&p), Some([4.0, 2.0, 25.0]));
    }

    #[test]
    fn a_blank_without_thickness_is_none() {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [10.0, 10.0, 0.0],
        };
        assert!(Setup::new(&blank).is_none());
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [10.0, f64::NAN, 10.0],
        };
        assert!(Setup::new(&blank).is_none());
    }
}
