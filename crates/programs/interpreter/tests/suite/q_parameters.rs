//! Programs with Q parameters: the manual's examples and the rules of single functions.

use crate::support::*;
use bahn_interpreter::WarningKind;
use bahn_path::{Axis, Curve, FeedRate};

/// P18: rectangular pocket by Q parameters, with RND at the corners, at the start and at the end
/// [003:4499-4552].
#[test]
fn p18_pocket() {
    let run = run_manual("P18");
    // Contour X 5..95, Y 15..85 with corners of R10; the tool of R5 runs inside, counter-clockwise.
    let centre_path = [
        [90.0, 75.0],
        [85.0, 80.0],
        [15.0, 80.0],
        [10.0, 75.0],
        [10.0, 25.0],
        [15.0, 20.0],
        [85.0, 20.0],
        [90.0, 25.0],
        [90.0, 50.0],
    ];
    close_points(&ends(&run.of_blocks(22..=30)), &centre_path, 1e-9);
    for (block, centre) in [
        (23, [85.0, 75.0]),
        (25, [15.0, 75.0]),
        (27, [15.0, 25.0]),
        (29, [85.0, 25.0]),
    ] {
        let arc = run.of_block(block);
        close_points(&[arc_of(arc[0]).0], &[centre], 1e-9);
        close(arc_radius(arc[0]), 10.0 - 5.0, 1e-9);
        close(arc_of(arc[0]).1, 90.0, 1e-9);
        // F in RND holds for the rounding only [003:3034].
        assert_eq!(arc[0].feed, FeedRate::Programmed(100.0));
        assert_eq!(run.of_block(block + 1)[0].feed, FeedRate::Programmed(200.0));
    }
    assert!(run.of_blocks(20..=31).iter().all(|e| e.end[Axis::Z] == -15.0));
}

/// P18: RND with R2.5 after the first and the last contour point leads the tool on arcs of R2.5 to and from
/// the point beside it, although the tool has R5.
#[test]
fn p18_smooth_approach_and_departure() {
    let run = run_manual("P18");
    for block in [21, 31] {
        let arc = run.of_block(block);
        assert_eq!(arc.len(), 1);
        close(arc_radius(arc[0]), 10.0 / 4.0, 1e-9);
        // The tool lies to the left of the upward contour at X = 95: the arc's centre does too.
        close_points(&[arc_of(arc[0]).0], &[[90.0 - 2.5, 50.0]], 1e-9);
        assert_eq!(arc[0].feed, FeedRate::Programmed(100.0));
    }
    close_points(&ends(&run.of_block(21)), &[[90.0, 50.0]], 1e-9);
    // From the centre of the pocket and back in straight lines that touch the arcs.
    let line = run.of_block(20)[0];
    close(
        (line.end[Axis::X] - 87.5).hypot(line.end[Axis::Y] - 50.0),
        2.5,
        1e-9,
    );
    close_points(&[xyz(&line.start)], &[[50.0, 50.0, -15.0]], 1e-9);
    close_points(&ends(&run.of_block(32)), &[[50.0, 50.0]], 1e-9);
}

/// P19: two bolt circles by one subprogram with a loop [003:4570-4596].
#[test]
fn p19_bolt_circles() {
    let run = run_manual("P19");
    let circle = |x: f64, y: f64, radius: f64, step: f64, count: u32| {
        (0..count).map(move |k| {
            let angle = (90.0 + step * f64::from(k)).to_radians();
            [x + radius * angle.cos(), y + radius * angle.sin(), -15.0]
        })
    };
    let expected: Vec<[f64; 3]> = circle(30.0, 70.0, 25.0, 30.0, 12)
        .chain(circle(90.0, 25.0, 35.0, 30.0, 5))
        .collect();
    let bottoms: Vec<[f64; 3]> = run
        .moves()
        .map(|e| xyz(&e.end))
        .filter(|at| at[2] == -15.0)
        .collect();
    close_points(&bottoms, &expected, 1e-9);
    // Infeeds of 5 mm: three to a hole.
    let plunges = run.moves().filter(|e| !is_rapid(e)).count();
    assert_eq!(plunges, 17 * 3);
    // SETUP and PECKG have another sign than DEPTH: said once for the definition, not for each of the 17 calls.
    let signs = run
        .warnings
        .iter()
        .filter(|w| w.kind == WarningKind::CycleSign { cycle: 1 });
    assert_eq!(signs.map(|w| w.count).sum::<u64>(), 1);
}

/// P20: an ellipse of 40 chords [003:4622-4661].
#[test]
fn p20_ellipse() {
    let run = run_manual("P20");
    let chords = run.of_block(38);
    assert_eq!(chords.len(), 40);
    for (k, chord) in chords.iter().enumerate() {
        let angle = (9.0 * (k + 1) as f64).to_radians();
        close_points(
            &[xyz(&chord.end)],
            &[[50.0 + 50.0 * angle.cos(), 50.0 + 20.0 * angle.sin(), -10.0]],
            1e-12,
        );
        assert_eq!(chord.feed, FeedRate::Programmed(350.0));
    }
    let perimeter: f64 = (0..40)
        .map(|k| {
            let (a, b) = (
                (9.0 * f64::from(k)).to_radians(),
                (9.0 * f64::from(k + 1)).to_radians(),
            );
            (50.0 * (b.cos() - a.cos())).hypot(20.0 * (b.sin() - a.sin()))
        })
        .sum();
    close(length(&chords), perimeter, 1e-9);
    close(perimeter, 229.895, 5e-4);
    close_points(&[xyz(&chords[0].start)], &[[100.0, 50.0, -10.0]], 1e-12);
}

/// P22: the corner of a flat end mill moves on a sphere of R45 about (50,50,-45); arcs of the Z/X plane are
/// rotated about Z between the passes [003:4699-4803].
#[test]
fn p22_hemisphere() {
    let run = run_manual("P22");
    let points = run.of_block(37);
    // 0° to 360° in steps of 5°, both inclusive, with 18 points each and the top.
    assert_eq!(points.len(), 73 * 18);
    assert_eq!(run.of_block(40).len(), 73);
    for (pass, arc) in points.chunks(18).enumerate() {
        let rotation = (5.0 * pass as f64).to_radians();
        let top = run.of_block(40)[pass];
        for (step, at) in arc.iter().copied().chain([top]).enumerate() {
            let solid = (90.0 - 5.0 * step as f64).to_radians();
            let reach = 45.0 * solid.sin() + 5.0;
            let expected = [
                50.0 + reach * rotation.cos(),
                50.0 + reach * rotation.sin(),
                -45.0 + 45.0 * solid.cos(),
            ];
            close_points(&[xyz(&at.end)], &[expected], 1e-10);
        }
    }
    close_points(&[xyz(&points[0].end)], &[[100.0, 50.0, -45.0]], 1e-10);
    close_points(&[xyz(&run.of_block(40)[0].end)], &[[55.0, 50.0, 0.0]], 1e-10);
    // All transformations are cancelled at the end.
    close_points(&[[run.position[Axis::Z]]], &[[100.0]], 1e-10);
}

/// What a single calculation gives.
fn calculated(block: &str) -> f64 {
    run(&format!("FN 0: Q2 = +10\nFN 0: Q5 = +30\n{block}")).q[1]
}

/// Functions FN 0 to 8 and 13 [003:4149-4276].
#[test]
fn functions_calculate() {
    let cases = [
        ("FN 0: Q1 = +60", 60.0),
        ("FN 1: Q1 = -Q2 + -5", -15.0),
        ("FN 2: Q1 = +10 - +5", 5.0),
        ("FN 3: Q1 = +3 * +3", 9.0),
        ("FN 4: Q1 = +8 DIV +Q2", 0.8),
        ("FN 5: Q1 = SQRT 4", 2.0),
        ("FN 6: Q1 = SIN -Q5", -0.5),
        ("FN 7: Q1 = COS -Q5", (3.0f64).sqrt() / 2.0),
        ("FN 8: Q1 = +5 LEN +12", 13.0),
        ("FN 13: Q1 = +10 ANG -Q2", 135.0),
        ("FN 13: Q1 = -1 ANG +0", 270.0),
    ];
    for (block, expected) in cases {
        close(calculated(block), expected, 1e-12);
    }
}

/// Conditions FN 9 to 12 [003:4301-4315].
#[test]
fn functions_jump() {
    for (condition, a, b, jumps) in [
        ("FN 9: IF +Q1 EQU +Q2", 3.0, 3.0, true),
        ("FN 9: IF +Q1 EQU +Q2", 3.0, 4.0, false),
        ("FN 10: IF +Q1 NE +Q2", 3.0, 4.0, true),
        ("FN 10: IF +Q1 NE +Q2", 3.0, 3.0, false),
        ("FN 11: IF +Q1 GT +Q2", 3.0, 2.0, true),
        ("FN 11: IF +Q1 GT +Q2", 3.0, 3.0, false),
        ("FN 12: IF +Q1 LT +Q2", 2.0, 3.0, true),
        ("FN 12: IF +Q1 LT +Q2", 3.0, 3.0, false),
    ] {
        let text = format!("{condition} GOTO LBL 7\nFN 0: Q3 = +1\nLBL 7");
        let run = Job::new(program(&text))
            .with(|s| s.q_values = vec![(1, a), (2, b)])
            .run();
        run.assert_completed();
        assert_eq!(run.q[3] == 0.0, jumps, "{condition} with {a} and {b}");
    }
}

/// Preassigned parameters [003:7587-7662].
#[test]
fn preassigned_parameters() {
    let fresh = run("L X+0 FMAX");
    // Q109 -1: no tool axis; Q110 -1: spindle not defined.
    assert_eq!((fresh.q[109], fresh.q[110], fresh.q[113]), (-1.0, -1.0, 0.0));
    let text = |axis: char, m: u32| {
        format!(
            "TOOL DEF 1 L+12.5 R+4\nTOOL CALL 1 {axis} S1000\nL X+0 Y+0 Z+0 FMAX M3\nL X+1 FMAX M{m}\nL Z+1 FMAX M8"
        )
    };
    let x = run(&text('X', 3));
    assert_eq!((x.q[108], x.q[109], x.q[114]), (4.0, 0.0, 12.5));
    assert_eq!(run(&text('Y', 3)).q[109], 1.0);
    let z = run(&text('Z', 5));
    // Q110 2: M05 after M03; Q111 1: M08.
    assert_eq!((z.q[109], z.q[110], z.q[111]), (2.0, 2.0, 1.0));
    assert_eq!(run(&text('Z', 4)).q[110], 1.0);
    // Q123: radius compensation.
    for (word, number) in [
        ("L X+10 R0 F9", 0.0),
        ("L X+10 RL F9", 1.0),
        ("L X+10 RR F9", 2.0),
        ("X+10 R+ F9", 3.0),
        ("X+10 R- F9", 4.0),
    ] {
        let run = run(&format!(
            "TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S1\nL X+0 Y+0 R0 FMAX\n{word}"
        ));
        assert_eq!(run.q[123], number, "{word}");
    }
}

/// A Q parameter can stand for coordinates, radii, angles, feeds, speeds and tool numbers [003:4032-4066].
#[test]
fn q_parameters_stand_for_numbers() {
    let plain = run(
        "TOOL DEF 3 L+0 R+2\nTOOL CALL 3 Z S800\nL X+10 Y-5 FMAX\nCC X+0 Y+0\nLP PR+20 PA+45 F150\nCP IPA-90 DR-",
    );
    let q = Job::new(program(
        "TOOL DEF Q1 L+Q9 R+Q2\nTOOL CALL Q1 Z SQ3\nL X+Q4 Y-Q5 FMAX\nCC X+Q9 Y-Q9\nLP PR+Q6 PA+Q7 FQ8\nCP IPA-Q10 DR-",
    ))
    .with(|s| {
        s.q_values = vec![(1, 3.0), (2, 2.0), (3, 800.0), (4, 10.0), (5, 5.0), (6, 20.0), (7, 45.0), (8, 150.0), (10, 90.0)];
    })
    .run();
    q.assert_completed();
    assert_eq!(shapes(&plain), shapes(&q));
    assert_eq!(plain.tool_calls(), q.tool_calls());
    assert!(plain.moves().any(|e| matches!(e.curve, Curve::Arc(_))));
}
