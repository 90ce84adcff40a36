//! M112: arcs at the corners of uncompensated lines, and M124: points that are left out for them [000:5128-5158].

use crate::support::*;
use bahn_path::{Axis, Curve, Plane};

/// M112 T0.05 puts an arc of 0.1207 mm at a corner of 90 degrees, tangent to both lines; M113 ends it;
/// lines that lie in another main plane have arcs, too [000:5128-5158].
#[test]
fn m112_rounds_corners_of_uncompensated_lines() {
    let run = run(
        "L X+0 Y+0 Z+0 R0 F1000\nL X+10 R0 F6000 M112 T0.05 A10\nL Y+10\nL X+0\nL Z+5\nL X+10 M113\nL Y+0",
    );
    let arcs: Vec<_> = run
        .moves()
        .filter_map(|e| match &e.curve {
            Curve::Arc(arc) => Some((e, arc)),
            _ => None,
        })
        .collect();
    assert_eq!(arcs.len(), 3);
    // From X into Z, in the plane ZX.
    let (third, upright) = arcs[2];
    assert_eq!(upright.plane, Plane::ZX);
    let tolerance = 0.05;
    let sine = 45f64.to_radians().sin();
    let radius = tolerance * sine / (1.0 - sine);
    let (first, arc) = arcs[0];
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(
        close(xyz(&first.start), [10.0 - radius, 0.0, 0.0]),
        "{:?}",
        first.start
    );
    assert!(close(xyz(&first.end), [10.0, radius, 0.0]), "{:?}", first.end);
    assert!((arc.sweep_deg - 90.0).abs() < 1e-9);
    assert!(close(xyz(&third.start), [radius, 10.0, 0.0]), "{:?}", third.start);
    assert!(close(xyz(&third.end), [0.0, 10.0, radius]), "{:?}", third.end);
    // The path has no gap.
    let moves: Vec<_> = run.moves().collect();
    for pair in moves.windows(2) {
        assert!(close(xyz(&pair[0].end), xyz(&pair[1].start)));
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| x / length(a))
}

/// Checks the path of a corner from `a` over `b` to `c` and hands out the radius and the nearest point to the corner: on the
/// bisector, an arc about its centre there, tangent to both lines.
fn skew_corner(
    run: &Run,
    [a, b, c]: [[f64; 3]; 3],
) -> Result<Option<(f64, f64)>, proptest::test_runner::TestCaseError> {
    use proptest::prelude::*;
    let moves: Vec<_> = run.moves().filter(|e| e.start.known().len() >= 3).collect();
    let Some(index) = moves.iter().position(|e| matches!(e.curve, Curve::Corner(_))) else {
        return Ok(None);
    };
    let (before, arc, after) = (moves[index - 1], moves[index], moves[index + 1]);
    let near = |p: [f64; 3], q: [f64; 3]| length(minus(p, q)) < 1e-9;
    prop_assert!(near(xyz(&before.start), a) && near(xyz(&before.end), xyz(&arc.start)));
    prop_assert!(near(xyz(&arc.end), xyz(&after.start)) && near(xyz(&after.end), c));
    let (u, v) = (unit(minus(b, a)), unit(minus(c, b)));
    // Of the two rays from the corner, half the angle between them.
    let half = 0.5 * (std::f64::consts::PI - dot(u, v).acos());
    let leg = length(minus(b, xyz(&arc.start)));
    let radius = leg * half.tan();
    let bisector = unit(minus(v, u));
    let centre = [0, 1, 2].map(|i| b[i] + bisector[i] * radius / half.sin());
    let mut nearest = f64::INFINITY;
    for step in 0..=64 {
        let t = f64::from(step) / 64.0;
        let p = xyz(&arc.curve.position(&arc.start, &arc.end, t));
        prop_assert!((length(minus(p, centre)) - radius).abs() < 1e-6, "{p:?}");
        let tangent = arc.curve.tangent(&arc.start, &arc.end, t);
        let tangent = [Axis::X, Axis::Y, Axis::Z].map(|axis| tangent[axis]);
        // Perpendicular to the radius, in the plane of the lines, of length 1.
        prop_assert!((dot(tangent, minus(p, centre)) / radius).abs() < 1e-6);
        prop_assert!((length(tangent) - 1.0).abs() < 1e-9);
        nearest = nearest.min(length(minus(p, b)));
    }
    let tangents = [0.0, 1.0].map(|t| arc.curve.tangent(&arc.start, &arc.end, t));
    for (tangent, line) in tangents.iter().zip([u, v]) {
        let tangent = [Axis::X, Axis::Y, Axis::Z].map(|axis| tangent[axis]);
        prop_assert!(length(minus(tangent, line)) < 1e-7, "{tangent:?} {line:?}");
    }
    prop_assert!((arc.length() - radius * (std::f64::consts::PI - 2.0 * half)).abs() < 1e-6);
    Ok(Some((radius, nearest)))
}

/// A line in ZX and one in YZ lie in no common main plane: their arc passes the corner at T; without T it takes half of the
/// shorter line; and beyond the limit angle it is as large as the feed needs [000:5140-5152].
#[test]
fn m112_rounds_skew_corners() {
    let corner = |functions: &str, feed: u32| {
        let run = run(&format!(
            "L X+0 Y+0 Z+0 R0 F1000\nL X+12 Z+5 F{feed} M112 {functions}\nL Y+8 Z+11"
        ));
        run.assert_completed();
        let points = [[0.0, 0.0, 0.0], [12.0, 0.0, 5.0], [12.0, 8.0, 11.0]];
        skew_corner(&run, points).expect("tangent").expect("an arc")
    };
    let (_, nearest) = corner("T0.1 A10", 60_000);
    assert!((nearest - 0.1).abs() < 1e-9, "{nearest}");
    // cos of the change: (12, 0, 5) · (0, 8, 6) / (13 · 10) = 3/13, tan² of half the included angle: (1 + 3/13) / (1 - 3/13).
    let (radius, _) = corner("A179", 1000);
    assert!((radius - 5.0 * 1.6f64.sqrt()).abs() < 1e-9, "{radius}");
    // The radius of the feed goes with its square.
    let (slow, fast) = (corner("A10", 100).0, corner("A10", 200).0);
    assert!((fast / slow - 4.0).abs() < 1e-6, "{slow} {fast}");
}

/// Beside another axis than X, Y and Z a corner stays sharp.
#[test]
fn m112_leaves_corners_of_other_axes_sharp() {
    let run = run("L X+0 Y+0 Z+0 C+0 R0 F1000 M112 T0.1\nL X+10 Z+3 C+5\nL Y+10 Z+6");
    run.assert_completed();
    assert!(run.moves().all(|e| e.curve == Curve::Line));
    assert_eq!(run.moves().count(), 3);
}

proptest::proptest! {
    /// Whatever the lines: the arc is tangent, keeps to T and to half of the shorter line.
    #[test]
    fn skew_corners_are_tangent_and_keep_the_tolerance(
        b in proptest::array::uniform3(-50i32..50), c in proptest::array::uniform3(-50i32..50), t in 1u32..500,
    ) {
        let t = f64::from(t) / 1000.0;
        let run = run(&format!(
            "L X+0 Y+0 Z+0 R0 F1000\nL X{:+} Y{:+} Z{:+} F60000 M112 T{t} A10\nL X{:+} Y{:+} Z{:+}",
            b[0], b[1], b[2], c[0], c[1], c[2],
        ));
        let (b, c) = (b.map(f64::from), c.map(f64::from));
        let skew = (0..3).all(|i| b[i] != 0.0 || c[i] != b[i]);
        let cross = [1, 2, 0].map(|i: usize| {
            let (j, v) = ((i + 1) % 3, minus(c, b));
            b[i] * v[j] - b[j] * v[i]
        });
        let found = skew_corner(&run, [[0.0; 3], b, c])?;
        // Neither straight on nor back.
        let bent = length(cross) > 0.05 * length(b) * length(minus(c, b));
        proptest::prop_assert!(found.is_some() || !skew || !bent);
        if let Some((radius, nearest)) = found {
            proptest::prop_assert!(nearest <= t + 1e-6, "{nearest} mm of {t}");
            let cosine = dot(unit(b), unit(minus(c, b)));
            let leg = radius * ((1.0 - cosine) / (1.0 + cosine)).sqrt();
            let half = 0.5 * length(b).min(length(minus(c, b)));
            proptest::prop_assert!(leg <= half * (1.0 + 1e-6), "{leg} mm of {half}");
        }
    }
}

/// M124 T0.5 (public): of points nearer than 0.5 mm to the one before the next one takes the place, for the corners of M112.
/// Without M112 it does nothing, and M113 ends it. A last point is reached, be it near; so is one with a function.
#[test]
fn m124_leaves_out_points() {
    let ends = |blocks: &str| {
        let run = run(&format!("L X+0 Y+0 R0 FMAX\nL X+10 F1000 {blocks}"));
        run.assert_completed();
        let lines = run.moves().filter(|e| e.curve == Curve::Line);
        lines
            .map(|e| [e.start[Axis::X], e.start[Axis::Y], e.end[Axis::X], e.end[Axis::Y]])
            .skip(1)
            .collect::<Vec<_>>()
    };
    // A tolerance of next to nothing leaves the ends where they are, within a micrometre.
    let close = |a: &[[f64; 4]], b: &[[f64; 4]]| {
        assert_eq!(a.len(), b.len(), "{a:?} {b:?}");
        assert!(
            a.iter()
                .flatten()
                .zip(b.iter().flatten())
                .all(|(a, b)| (a - b).abs() < 0.01),
            "{a:?} {b:?}"
        );
    };
    let near = "L X+10.2 Y+0.2\nL Y+0.4\nL Y+10";
    close(
        &ends(&format!("M112 T0.001 M124 T0.5\n{near}")),
        &[
            [0.0, 0.0, 10.0, 0.0],
            // (10.2, 0.2) is 0.28 from (10, 0) and left out; (10.2, 0.4) is 0.45 from it, too.
            [10.0, 0.0, 10.2, 10.0],
        ],
    );
    close(
        &ends(&format!("M112 T0.001 M124 T0.3\n{near}")),
        &[
            [0.0, 0.0, 10.0, 0.0],
            [10.0, 0.0, 10.2, 0.4],
            [10.2, 0.4, 10.2, 10.0],
        ],
    );
    let all = [
        [0.0, 0.0, 10.0, 0.0],
        [10.0, 0.0, 10.2, 0.2],
        [10.2, 0.2, 10.2, 0.4],
        [10.2, 0.4, 10.2, 10.0],
    ];
    close(&ends(&format!("M124 T0.5\n{near}")), &all);
    close(&ends(&format!("M112 T0.001 M124 T0.5\nL M113\n{near}")), &all);
    close(&ends(&format!("M112 T0.001 M124 T0.5\nL M124\n{near}")), &all);
    // What is no straight line goes on from the point itself.
    close(
        &ends("M112 T0.001 M124 T0.5\nL X+10.2"),
        &[[0.0, 0.0, 10.0, 0.0], [10.0, 0.0, 10.2, 0.0]],
    );
    close(
        &ends("M112 T0.001 M124 T0.5\nL X+10.2 M8\nL Y+10"),
        &[
            [0.0, 0.0, 10.0, 0.0],
            [10.0, 0.0, 10.2, 0.0],
            [10.2, 0.0, 10.2, 10.0],
        ],
    );
    let circle = run(
        "L X+0 Y+0 R0 FMAX\nL X+10 F1000 M112 T0.001 M124 T0.5\nL X+10.2\nCC X+10.2 Y+5\nC X+10.2 Y+10 DR+",
    );
    circle.assert_completed();
    let arc = circle.moves().last().expect("the circle");
    assert!((arc.start[Axis::X] - 10.2).abs() < 1e-9 && arc.start[Axis::Y].abs() < 1e-9);
}
