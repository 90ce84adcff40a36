//! M112: arcs at the corners of uncompensated lines, and M124: points that are left out for them [000:5128-5158].
#![allow(clippy::expect_used, reason = "what fails here fails the test")]

mod support;

use bahn_path::{Axis, Curve, Plane};
use support::*;

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

/// Lines that lie in no common main plane keep their corner.
#[test]
fn m112_leaves_skew_corners_sharp() {
    let run = run("L X+0 Y+0 Z+0 R0 F1000 M112 T0.1\nL X+10 Z+3\nL Y+10 Z+6");
    assert!(run.moves().all(|e| e.curve == Curve::Line));
    assert_eq!(run.moves().count(), 3);
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
