//! The chains of MP7510 to MP7592 against rotations that are computed here on their own.

use bahn_path::{Axis, Curve, Link, PerAxis, Placement, Position, Swivels};
use proptest::prelude::*;
use std::sync::Arc;

type V = [f64; 3];

fn head(axis: Axis, dimension: f64) -> Link {
    Link {
        axis,
        table: false,
        absolute: false,
        dimension,
    }
}

fn table(axis: Axis, dimension: f64, absolute: bool) -> Link {
    Link {
        axis,
        table: true,
        absolute,
        dimension,
    }
}

/// Example 1: double swivel head, right-angled [000:4303-4340].
fn right_angled() -> Swivels {
    Swivels::new([
        head(Axis::Z, 200.4),
        head(Axis::Y, -1.9),
        head(Axis::A, 0.0),
        head(Axis::X, 201.5),
        head(Axis::Z, 3.1),
        head(Axis::B, 0.0),
    ])
}

/// Example 2: double swivel head, 45 degrees [000:4342-4380].
fn inclined() -> Swivels {
    Swivels::new([
        head(Axis::Z, 150.5),
        head(Axis::A, -45.0),
        head(Axis::Z, 251.5),
        head(Axis::C, 0.0),
        head(Axis::A, 45.0),
        head(Axis::B, 0.0),
    ])
}

/// Example 3: universal table [000:4382-4437].
fn universal_table() -> Swivels {
    Swivels::new([
        table(Axis::X, 420.0, true),
        table(Axis::Y, 151.2, true),
        table(Axis::Z, -395.4, true),
        table(Axis::C, 0.0, false),
        table(Axis::Y, -2.7, false),
        table(Axis::Z, -331.3, false),
        table(Axis::A, 0.0, false),
        table(Axis::Z, 125.9, false),
        table(Axis::B, 0.0, false),
    ])
}

/// Rodrigues' formula: a vector turned about any axis.
fn turned(v: V, axis: V, deg: f64) -> V {
    let n = (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]).sqrt();
    let k = axis.map(|x| x / n);
    let (s, c) = deg.to_radians().sin_cos();
    let cross = [
        k[1] * v[2] - k[2] * v[1],
        k[2] * v[0] - k[0] * v[2],
        k[0] * v[1] - k[1] * v[0],
    ];
    let dot = k[0] * v[0] + k[1] * v[1] + k[2] * v[2];
    [0, 1, 2].map(|i| v[i] * c + cross[i] * s + k[i] * dot * (1.0 - c))
}

fn plus(a: V, b: V) -> V {
    [0, 1, 2].map(|i| a[i] + b[i])
}

fn minus(a: V, b: V) -> V {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn at(axis: Axis, value: f64) -> Position {
    let mut position = Position::ZERO;
    position[axis] = value;
    position
}

fn angles(values: &[(Axis, f64)]) -> Position {
    values.iter().fold(Position::ZERO, |mut position, (axis, value)| {
        position[*axis] = *value;
        position
    })
}

fn assert_near(a: V, b: V) {
    for i in 0..3 {
        assert!((a[i] - b[i]).abs() < 1e-9, "{a:?} is not {b:?}");
    }
}

#[test]
fn free_axes_of_the_examples() {
    let of = |swivels: Swivels| swivels.free_axes().collect::<Vec<_>>();
    assert_eq!(of(right_angled()), [Axis::A, Axis::B]);
    assert_eq!(of(inclined()), [Axis::C, Axis::B]);
    assert_eq!(of(universal_table()), [Axis::C, Axis::A, Axis::B]);
}

/// The body is turned in space, axis after axis, each where it stands in the machine at 0: first the inner one about its
/// place, then the outer one about its. The tool datum starts at the origin.
#[test]
fn right_angled_head() {
    let centre_a = [0.0, -1.9, 200.4];
    let centre_b = plus(centre_a, [201.5, 0.0, 3.1]);
    for (a, b) in [(0.0, 0.0), (30.0, 0.0), (0.0, -50.0), (-20.0, 75.0), (90.0, 90.0)] {
        let body = |v: V| {
            let v = plus(centre_a, turned(minus(v, centre_a), [1.0, 0.0, 0.0], a));
            plus(centre_b, turned(minus(v, centre_b), [0.0, 1.0, 0.0], b))
        };
        // The axes move the other way from where the tool datum has gone.
        let angles = angles(&[(Axis::A, a), (Axis::B, b)]);
        assert_near(right_angled().head_offset(&angles), body([0.0; 3]).map(|x| -x));
        let tool = right_angled().head_rotation(&angles).map(|row| row[2]);
        assert_near(tool, minus(body([0.0, 0.0, 1.0]), body([0.0; 3])));
    }
}

/// The axis C leans by 45 degrees: the coordinate system is turned about A by -45 degrees before it.
#[test]
fn inclined_head() {
    let axis_c = turned([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], -45.0);
    let centre_c = plus([0.0, 0.0, 150.5], axis_c.map(|x| 251.5 * x));
    for (c, b) in [(0.0, 0.0), (180.0, 0.0), (37.0, -50.0), (-120.0, 75.0)] {
        let body = |v: V| {
            let v = plus(centre_c, turned(minus(v, centre_c), axis_c, c));
            plus(centre_c, turned(minus(v, centre_c), [0.0, 1.0, 0.0], b))
        };
        let angles = angles(&[(Axis::C, c), (Axis::B, b)]);
        assert_near(inclined().head_offset(&angles), body([0.0; 3]).map(|x| -x));
        let tool = inclined().head_rotation(&angles).map(|row| row[2]);
        assert_near(tool, minus(body([0.0, 0.0, 1.0]), body([0.0; 3])));
    }
    // C180 lays the tool down: it leads along the axis that leaned by 45 degrees on the other side.
    let down = inclined().head_rotation(&at(Axis::C, 180.0)).map(|row| row[2]);
    assert_near(down, [0.0, 1.0, 0.0]);
}

/// The table turns against the sense of its axes, which name the movement of the tool.
#[test]
fn table_with_three_axes() {
    let c = [420.0, 151.2, -395.4];
    let a = plus(c, [0.0, -2.7, -331.3]);
    let b = plus(a, [0.0, 0.0, 125.9]);
    for [ac, aa, ab] in [[0.0; 3], [90.0, 0.0, 0.0], [0.0, 20.0, 0.0], [15.0, -30.0, 45.0]] {
        let point = [500.0, 100.0, -300.0];
        let mut v = plus(c, turned(minus(point, c), [0.0, 0.0, 1.0], -ac));
        v = plus(a, turned(minus(v, a), [1.0, 0.0, 0.0], -aa));
        v = plus(b, turned(minus(v, b), [0.0, 1.0, 0.0], -ab));
        let angles = angles(&[(Axis::C, ac), (Axis::A, aa), (Axis::B, ab)]);
        assert_near(universal_table().on_table(point, &angles), v);
    }
}

/// With all axes at 0 nothing differs from a machine without swivel axes.
#[test]
fn upright_heads_change_nothing() {
    for swivels in [right_angled(), inclined()] {
        assert_near(swivels.head_offset(&Position::ZERO), [0.0; 3]);
        let placement = Placement::tilted(&swivels, &Position::ZERO, [&Position::ZERO; 2], (Axis::Z, 50.0));
        let nose = placement.to_nose(&at(Axis::X, 7.0));
        assert_near([nose[Axis::X], nose[Axis::Y], nose[Axis::Z]], [7.0, 0.0, 50.0]);
    }
}

prop_compose! {
    fn place()(values in prop::collection::vec(-400.0..400.0f64, Axis::ALL.len())) -> Position {
        PerAxis::from_fn(|axis| values[axis.index()]).into()
    }
}

fn placements(angles: &Position, datum: &Position, shift: &Position, length: f64) -> Vec<Placement> {
    let mut placements = Vec::new();
    for swivels in [right_angled(), inclined(), universal_table()] {
        placements.push(Placement::tilted(
            &swivels,
            angles,
            [datum, shift],
            (Axis::Z, length),
        ));
        placements.push(Placement::compensated(
            Arc::new(swivels),
            datum,
            (Axis::Z, length),
        ));
    }
    placements
}

proptest! {
    /// There and back again, and what something is called in another placement is called there and back, too.
    #[test]
    fn inverse_of_forward(angles in place(), datum in place(), shift in place(), path in place(), l in 0.0..300.0f64) {
        let placements = placements(&angles, &datum, &shift, l);
        for (placement, other) in placements.iter().zip(placements.iter().skip(1)) {
            let back = placement.from_nose(&placement.to_nose(&path));
            let renamed = Placement::change(Some(placement), Some(other), &path);
            let again = Placement::change(Some(other), Some(placement), &renamed);
            let upright = Placement::change(Some(placement), None, &path);
            let from_upright = Placement::change(None, Some(placement), &upright);
            for axis in Axis::ALL {
                prop_assert!((back[axis] - path[axis]).abs() < 1e-8);
                prop_assert!((again[axis] - path[axis]).abs() < 1e-8);
                prop_assert!((from_upright[axis] - path[axis]).abs() < 1e-8);
            }
        }
    }

    /// A tilted plane and the compensation of the same angles hold the tool at the same place with the same tip.
    #[test]
    fn the_tip_is_where_the_plane_says(a in -90.0..90.0f64, b in -90.0..90.0f64, l in 0.0..300.0f64) {
        let angles = angles(&[(Axis::A, a), (Axis::B, b)]);
        let swivels = right_angled();
        let tilted = Placement::tilted(&swivels, &angles, [&Position::ZERO; 2], (Axis::Z, l));
        let compensated = Placement::compensated(Arc::new(swivels), &Position::ZERO, (Axis::Z, l));
        // At the datum all coordinates are 0, whichever way they lie.
        let (tilted, compensated) = (tilted.to_nose(&angles), compensated.to_nose(&angles));
        for axis in Axis::ALL {
            prop_assert!((tilted[axis] - compensated[axis]).abs() < 1e-9);
        }
    }

    /// What the velocities say is what the positions do, and the bounds hold all positions of the movement.
    #[test]
    fn velocities_and_bounds(start in place(), end in place(), datum in place(), t in 0.01..0.99f64) {
        for placement in placements(&end, &datum, &Position::ZERO, 120.0) {
            let delta = PerAxis::from_fn(|axis| end[axis] - start[axis]);
            let at = |t: f64| placement.to_nose(&Curve::Line.position(&start, &end, t));
            let velocity = placement.velocity(&Curve::Line.position(&start, &end, t), &delta);
            let (before, after) = (at(t - 1e-6), at(t + 1e-6));
            for axis in Axis::ALL {
                let slope = (after[axis] - before[axis]) / 2e-6;
                prop_assert!((velocity[axis] - slope).abs() < 0.1 + 1e-4 * slope.abs());
            }
            let [least, greatest] = placement.bounds(&Curve::Line, &start, &end);
            let here = at(t);
            for axis in Axis::ALL {
                prop_assert!(here[axis] >= least[axis] - 1e-9 && here[axis] <= greatest[axis] + 1e-9);
            }
        }
    }
}
