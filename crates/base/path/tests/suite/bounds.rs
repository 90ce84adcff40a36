//! The box around an element.

use bahn_path::{Arc, Axis, CornerArc, Curve, Plane, Position};
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

proptest! {
    /// Every point of an arc between skew lines lies in its box, the box is reached, and its parts are the arc itself.
    #[test]
    fn box_holds_a_corner_arc(
        corner in prop::array::uniform3(-50.0f64..50.0),
        a in prop::array::uniform3(-1.0f64..1.0),
        b in prop::array::uniform3(-1.0f64..1.0),
        leg in 0.1f64..100.0,
        cut in 0.01f64..0.99,
    ) {
        let unit = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
        let (a, b) = (unit(a), unit(b));
        let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
        prop_assume!(dot.abs() < 0.999);
        let place = |towards: [f64; 3]| at(corner[0] + leg * towards[0], corner[1] + leg * towards[1], corner[2] + leg * towards[2]);
        let (start, end) = (place(a), place(b));
        let curve = Curve::Corner(CornerArc { corner });
        let [min, max] = curve.bounds(&start, &end);
        let mut seen = [start, start];
        for step in 0..=1000 {
            let p = curve.position(&start, &end, f64::from(step) / 1000.0);
            for axis in [Axis::X, Axis::Y, Axis::Z] {
                prop_assert!(p[axis] >= min[axis] - 1e-9 && p[axis] <= max[axis] + 1e-9);
                seen[0][axis] = seen[0][axis].min(p[axis]);
                seen[1][axis] = seen[1][axis].max(p[axis]);
            }
        }
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            prop_assert!(seen[0][axis] - min[axis] < 1e-3 * leg && max[axis] - seen[1][axis] < 1e-3 * leg);
        }
        let mut length = 0.0;
        for (from, to) in [(0.0, cut), (cut, 1.0)] {
            let (part, first, last) = curve.part(&start, &end, from, to);
            length += part.length(&first, &last);
            for step in 0..=10 {
                let t = f64::from(step) / 10.0;
                let (own, whole) = (part.position(&first, &last, t), curve.position(&start, &end, from + (to - from) * t));
                for axis in [Axis::X, Axis::Y, Axis::Z] {
                    prop_assert!((own[axis] - whole[axis]).abs() < 1e-8, "{axis} {} {}", own[axis], whole[axis]);
                }
            }
        }
        prop_assert!((length - curve.length(&start, &end)).abs() < 1e-8);
    }
}

/// An arc in space takes no more room than one in a main plane.
#[test]
fn a_corner_arc_is_no_larger_than_an_arc() {
    assert!(size_of::<CornerArc>() <= size_of::<Arc>());
    assert!(size_of::<Curve>() <= size_of::<Arc>() + 8);
}
