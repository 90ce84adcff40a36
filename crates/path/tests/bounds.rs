//! The box around an element.

use bahn_path::{Arc, Axis, Curve, Plane, Position};
use proptest::prelude::*;

fn at(x: f64, y: f64, z: f64) -> Position {
    let mut position = Position::ZERO;
    (position[Axis::X], position[Axis::Y], position[Axis::Z]) = (x, y, z);
    position
}

/// A half circle from (10, 0) counter-clockwise to (-10, 0) about the origin reaches Y+10 and no negative Y.
#[test]
fn half_circle() {
    let arc = Curve::Arc(Arc {
        plane: Plane::XY,
        centre: [0.0, 0.0],
        sweep_deg: 180.0,
    });
    let [min, max] = arc.bounds(&at(10.0, 0.0, 0.0), &at(-10.0, 0.0, -2.0));
    assert_eq!((max[Axis::Y], min[Axis::Y], min[Axis::Z]), (10.0, 0.0, -2.0));
    assert_eq!((max[Axis::X], min[Axis::X]), (10.0, -10.0));
}

proptest! {
    /// Every point of an arc lies in the box, and the box is reached on each side.
    #[test]
    fn box_holds_the_arc(
        centre in [-50.0f64..50.0, -50.0..50.0],
        radius in 0.1f64..100.0,
        from in -360.0f64..360.0,
        sweep in -800.0f64..800.0,
    ) {
        let point = |angle: f64| {
            let angle = angle.to_radians();
            at(centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin(), 0.0)
        };
        let (start, end) = (point(from), point(from + sweep));
        let curve = Curve::Arc(Arc { plane: Plane::XY, centre, sweep_deg: sweep });
        let [min, max] = curve.bounds(&start, &end);
        let mut seen = [start, start];
        for step in 0..=4000 {
            let p = curve.position(&start, &end, f64::from(step) / 4000.0);
            for axis in [Axis::X, Axis::Y] {
                prop_assert!(p[axis] >= min[axis] - 1e-9 && p[axis] <= max[axis] + 1e-9);
                seen[0][axis] = seen[0][axis].min(p[axis]);
                seen[1][axis] = seen[1][axis].max(p[axis]);
            }
        }
        for axis in [Axis::X, Axis::Y] {
            prop_assert!(seen[0][axis] - min[axis] < 1e-3 * radius);
            prop_assert!(max[axis] - seen[1][axis] < 1e-3 * radius);
        }
    }
}
