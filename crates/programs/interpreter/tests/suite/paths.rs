//! Path programs of the TNC 360 manual: straight lines, arcs, roundings, polar coordinates, helix. The tool
//! radius is compensated; expected tool-centre paths follow from the contour by hand.

use std::f64::consts::{PI, SQRT_2};

use crate::support::*;
use bahn_parameters::{ControlModel, MessageId};
use bahn_path::{Axis, Curve, FeedRate, Function};

/// Hand calculations below are exact; programs give coordinates to 0.001 mm.
const EXACT: f64 = 1e-9;
const ROUNDED: f64 = 2e-3;

/// P01: rectangle 90 x 90 with RL, the tool runs outside and rolls round three corners [003:2636-2653].
#[test]
fn p01_rectangle() {
    let run = run_manual("P01");
    let contour = run.of_blocks(9..=12);
    close_points(&ends(&run.of_block(8)), &[[0.0, 5.0]], EXACT);
    let corners = [
        [0.0, 95.0],
        [5.0, 100.0],
        [95.0, 100.0],
        [100.0, 95.0],
        [100.0, 5.0],
        [95.0, 0.0],
        [5.0, 0.0],
    ];
    close_points(&ends(&contour), &corners, EXACT);
    for (arc, centre) in
        contour
            .iter()
            .filter(|e| e.curve != Curve::Line)
            .zip([[5.0, 95.0], [95.0, 95.0], [95.0, 5.0]])
    {
        close_points(&[arc_of(arc).0], &[centre], EXACT);
        close(arc_of(arc).1, -90.0, EXACT);
        close(arc_radius(arc), 5.0, EXACT);
    }
    close(length(&contour), 4.0 * 90.0 + 3.0 * 5.0 * PI / 2.0, EXACT);
    assert!(
        contour
            .iter()
            .all(|e| e.feed == FeedRate::Programmed(100.0) && e.end[Axis::Z] == -10.0)
    );
    // Back to the start, then up: M2 ends the program.
    close_points(&[xyz(&run.position)], &[[-10.0, -10.0, 100.0]], EXACT);
    assert!(run.functions().contains(&(14, &Function::M(2))));
}

/// P01: an island of 90 x 90 is left: the tool, one diameter wide, clears all of the blank outside it. At the
/// corners its edge runs on a circle of R10 about the contour's corner, which contains the blank's corner.
#[test]
fn p01_leaves_the_square() {
    let part = run_manual("P01").workpiece(0.25).finished();
    close(part.removed_mm3(), (100.0 * 100.0 - 90.0 * 90.0) * 10.0, 1e-3);
    assert_eq!(part.height_at([5.2, 5.2]), Some(0.0));
    assert_eq!(part.height_at([4.8, 50.0]), Some(-10.0));
}

/// P02: chamfer of 10 mm at the corner (95,5), RR with R10 [003:2695].
#[test]
fn p02_chamfer() {
    let run = run_manual("P02");
    close_points(&ends(&run.of_block(8)), &[[0.0, -5.0]], EXACT);
    // The parallel of the chamfer line (85,5)-(95,15) at 10 mm to the right.
    let shift = 10.0 / SQRT_2;
    let expected = [
        [85.0, -5.0],
        [85.0 + shift, 5.0 - shift],
        [95.0 + shift, 15.0 - shift],
        [105.0, 15.0],
        [105.0, 100.0],
    ];
    let contour = run.of_blocks(9..=11);
    close_points(&ends(&contour), &expected, EXACT);
    close(
        length(&contour),
        85.0 + 10.0 * SQRT_2 + 85.0 + 2.0 * 10.0 * PI / 4.0,
        EXACT,
    );
    // The chamfer takes the feed of block 8 [003:2679].
    assert!(
        run.of_block(10)
            .iter()
            .all(|e| e.feed == FeedRate::Programmed(200.0))
    );
    assert!(!run.of_block(10).is_empty());
}

/// P03: full circle with smooth approach and departure on arcs of R10 [003:2834].
#[test]
fn p03_full_circle() {
    full_circle_outside(&run_manual("P03"));
}

/// P08: the same circle with polar coordinates, from other points before and after [003:3210].
#[test]
fn p08_full_circle_polar() {
    full_circle_outside(&run_manual("P08"));
}

fn full_circle_outside(run: &Run) {
    let circle = run.of_block(11);
    assert_eq!(circle.len(), 1);
    let (centre, sweep) = arc_of(circle[0]);
    close_points(&[centre], &[[50.0, 50.0]], EXACT);
    close(sweep, -360.0, EXACT);
    close(arc_radius(circle[0]), 50.0 + 15.0, EXACT);
    close(length(&circle), 2.0 * PI * 65.0, EXACT);
    assert_eq!(circle[0].end[Axis::Z], -5.0);
    // Approach: the tool lies below the contour point, so the arc's centre is 10 mm below (50,-15).
    for block in [10, 12] {
        let arc = run.of_block(block);
        assert_eq!(arc.len(), 1);
        close_points(&[arc_of(arc[0]).0], &[[50.0, -25.0]], EXACT);
        close(arc_radius(arc[0]), 10.0, EXACT);
        assert!(arc_of(arc[0]).1 > 0.0);
    }
    close_points(&ends(&run.of_block(10)), &[[50.0, -15.0]], EXACT);
    // The lines before and after touch the arcs tangentially.
    let line = run.of_block(9);
    let arc = run.of_block(10);
    tangential(line[0], arc[0]);
    let departure = run.of_block(12);
    let away = run.of_block(13);
    tangential(departure[0], away[0]);
}

#[track_caller]
fn tangential(a: &bahn_path::PathElement, b: &bahn_path::PathElement) {
    let from = a.curve.tangent(&a.start, &a.end, 1.0);
    let to = b.curve.tangent(&b.start, &b.end, 0.0);
    for axis in [Axis::X, Axis::Y] {
        close(from[axis], to[axis], 1e-9);
        close(a.end[axis], b.start[axis], 1e-9);
    }
}

/// P04: semicircle by its radius, machined from inside [003:2923-2937].
#[test]
fn p04_arc_with_radius() {
    let run = run_manual("P04");
    close_points(&ends(&run.of_block(8)), &[[25.0, 0.0]], EXACT);
    let arc = run.of_block(9);
    assert_eq!(arc.len(), 1);
    close_points(&[arc_of(arc[0]).0], &[[50.0, 0.0]], EXACT);
    close(arc_of(arc[0]).1, -180.0, EXACT);
    close_points(&ends(&arc), &[[75.0, 0.0]], EXACT);
    close(length(&arc), PI * 25.0, EXACT);
    assert_eq!(arc[0].end[Axis::Z], -18.0);
}

/// P05: an arc tangential to the line before it, then a corner that is inside for the tool [003:2986-3002].
#[test]
fn p05_tangential_arc() {
    let run = run_manual("P05");
    // Circle through (10,40) with tangent (-1,1) and through (50,50): r = |c|² / (2 t×c) with
    // c = (40,10), t = (-1,1)/√2: r = 1700 / (2 · -50/√2) = -24.0416; centre (10,40) - r·(-1,-1)/√2.
    let radius = 1700.0 * SQRT_2 / 100.0;
    let centre = [10.0 + radius / SQRT_2, 40.0 + radius / SQRT_2];
    close_points(&[centre], &[[27.0, 57.0]], EXACT);
    let side = 20.0 / SQRT_2;
    let path_radius = radius + 20.0;
    // Inside corner: the parallel of Y = 50 is Y = 70.
    let corner = [27.0 + (path_radius * path_radius - 13.0 * 13.0).sqrt(), 70.0];
    let expected = [
        [50.0 - side, -side],
        [10.0 - side, 40.0 - side],
        corner,
        [100.0, 70.0],
    ];
    let contour = run.of_blocks(8..=11);
    close_points(&ends(&contour), &expected, EXACT);
    let arc = run.of_block(10);
    close_points(&[arc_of(arc[0]).0], &[centre], EXACT);
    // From -135° clockwise to the corner.
    let sweep = 225.0 - (13.0f64).atan2(corner[0] - 27.0).to_degrees();
    close(arc_of(arc[0]).1, -sweep, EXACT);
    let expected = 40.0 * SQRT_2 + path_radius * sweep.to_radians() + 100.0 - corner[0];
    close(length(&run.of_blocks(9..=11)), expected, EXACT);
    close(expected, 247.244, 5e-4);
}

/// P06: a corner rounded with R20, outside for the tool [003:3050-3065].
#[test]
fn p06_rounding() {
    let run = run_manual("P06");
    let contour = run.of_blocks(9..=11);
    close_points(&ends(&run.of_block(8)), &[[0.0, -5.0]], EXACT);
    close_points(
        &ends(&contour),
        &[[75.0, -5.0], [105.0, 25.0], [105.0, 100.0]],
        EXACT,
    );
    let rounding = run.of_block(10);
    close_points(&[arc_of(rounding[0]).0], &[[75.0, 25.0]], EXACT);
    close(arc_radius(rounding[0]), 20.0 + 10.0, EXACT);
    close(length(&contour), 75.0 + 30.0 * PI / 2.0 + 75.0, EXACT);
}

/// P07: hexagon in polar coordinates, absolute and incremental angles; PR is kept [003:3142-3167].
#[test]
fn p07_hexagon() {
    let run = run_manual("P07");
    let corner = |k: f64| {
        let angle = (180.0 - 60.0 * k).to_radians();
        [50.0 + 45.0 * angle.cos(), 50.0 + 45.0 * angle.sin()]
    };
    // Outside of side k, from corner k to corner k+1, 5 mm along its normal.
    let offset = |k: f64, at: [f64; 2]| {
        let normal = (150.0 - 60.0 * k).to_radians();
        [at[0] + 5.0 * normal.cos(), at[1] + 5.0 * normal.sin()]
    };
    close_points(&ends(&run.of_block(9)), &[offset(0.0, corner(0.0))], EXACT);
    let mut expected = Vec::new();
    for k in 0..6 {
        let k = f64::from(k);
        expected.push(offset(k, corner(k + 1.0)));
        if k < 5.0 {
            expected.push(offset(k + 1.0, corner(k + 1.0)));
        }
    }
    let contour = run.of_blocks(10..=15);
    close_points(&ends(&contour), &expected, EXACT);
    close(length(&contour), 6.0 * 45.0 + 5.0 * 5.0 * PI / 3.0, EXACT);
    // The values of the manual's drawing.
    close_points(&[offset(0.0, corner(0.0))], &[[0.670, 52.5]], 5e-4);
}

/// P09: internal right-hand thread, nine turns of 1.5 mm [003:3382-3408].
#[test]
fn p09_thread() {
    let run = run_manual("P09");
    let helix = run.of_block(10);
    assert_eq!(helix.len(), 1);
    let (centre, sweep) = arc_of(helix[0]);
    close_points(&[centre], &[[50.0, 50.0]], EXACT);
    close(sweep, 9.0 * 360.0, EXACT);
    // Inside: radius of the thread minus tool radius.
    close(arc_radius(helix[0]), 32.0 - 5.0, EXACT);
    close_points(&[xyz(&helix[0].start)], &[[23.0, 50.0, -12.75]], 1e-9);
    close_points(&[xyz(&helix[0].end)], &[[23.0, 50.0, 0.75]], 1e-9);
    close(length(&helix), (9.0 * 2.0 * PI * 27.0).hypot(13.5), 1e-9);
    assert_eq!(helix[0].feed, FeedRate::Programmed(200.0));
    // From -180° the thread starts at Z = 0 half a turn before its end: angle 0 at 8.5 turns.
    let at_zero = helix[0].curve.position(&helix[0].start, &helix[0].end, 8.5 / 9.0);
    close_points(&[xyz(&at_zero)], &[[77.0, 50.0, 0.0]], 1e-9);
}

/// P13: a hill milled in passes along an arc in the Z/X plane [003:3831-3866].
#[test]
fn p13_hill_in_zx() {
    let run = run_manual("P13");
    for (block, centre_x, sign) in [(10, 40.0, 1.0), (21, 60.0, -1.0)] {
        let passes = run.of_block(block);
        assert_eq!(passes.len(), 41);
        for (k, pass) in passes.iter().enumerate() {
            // The programmed points are rounded to 0.001 mm, and so is the centre.
            let (centre, sweep) = arc_of(pass);
            close_points(&[centre], &[[-30.0, centre_x]], ROUNDED);
            close(arc_radius(pass), 30.0, ROUNDED);
            // From the point of contact to the top: cos = (-20.2 + 30) / 30.
            close(sweep, sign * (9.8f64 / 30.0).acos().to_degrees(), 1e-2);
            close(pass.end[Axis::Y], -1.0 + 2.5 * k as f64, EXACT);
            close(pass.end[Axis::Z], 0.0, EXACT);
        }
    }
    close(run.of_block(13).last().unwrap().end[Axis::Y], 101.5, EXACT);
    assert_eq!(run.blocks_executed, 5 + 41 * 9 + 2 + 41 * 9 + 1);
}

/// P13: what is left is a hill of radius 30 about (50,-30): the tool's radius is in the path.
#[test]
fn p13_leaves_the_hill() {
    let part = run_manual("P13").workpiece(0.5).finished();
    for x in [25.0f64, 30.0, 40.0, 45.0, 55.0, 70.0, 75.0] {
        let expected = -30.0 + (900.0 - (x - 50.0) * (x - 50.0)).sqrt();
        // A column is removed by what passes over its centre; the flank rises by its slope over a column.
        let slope = ((x - 50.0) / (expected + 30.0)).abs();
        close(part.height_at([x, 50.0]).unwrap(), expected, 0.05 + 0.5 * slope);
    }
}

/// P15 and P16: the same circle with numbers and with Q parameters [003:4099-4138].
#[test]
fn p15_and_p16_are_the_same_path() {
    let (plain, q) = (run_manual("P15"), run_manual("P16"));
    assert_eq!(shapes(&plain), shapes(&q));
    // DR+ with RR: outside, counter-clockwise.
    let circle = plain.of_block(10);
    close_points(&ends(&plain.of_block(9)), &[[50.0, -15.0]], EXACT);
    close(arc_of(circle[0]).1, 360.0, EXACT);
    close(length(&circle), 2.0 * PI * 65.0, EXACT);
    close_points(&ends(&plain.of_block(7)), &[[30.0, -20.0]], EXACT);
    close_points(&ends(&plain.of_block(11)), &[[70.0, -20.0]], EXACT);
    assert_eq!(plain.tool_calls()[0].tool, 6);
    assert_eq!(q.tool_calls()[0].tool, 1);
}

/// P38: digitized points are ordinary straight lines [003:6842-6848].
#[test]
fn p38_digitized_data() {
    let job = Job::new(manual("P38")).with(|s| s.start[Axis::Z] = 50.0);
    // The loader program leaves a feed in force; without it there is none.
    assert_eq!(
        job.run().message(),
        Some((bahn_parameters::MessageId::FeedRateIsMissing, 3))
    );
    let with_feed = manual("P38").replace("X+2.005 Y-12.561", "X+2.005 Y-12.561 F500");
    let run = Job::new(with_feed).run();
    run.assert_completed();
    let lines: Vec<_> = run.moves().collect();
    assert_eq!(lines.len(), 9);
    // The contour line ends 0.001 mm from where it began.
    let gap = lines[2].end[Axis::Y] - lines[4].end[Axis::Y];
    close(gap.abs(), 0.001, EXACT);
    close_points(&[xyz(&lines[5].end)], &[[0.0, -10.423, 0.5]], EXACT);
}

/// P39: the program that loads tool, feed and spindle before digitized data moves nothing [003:6869-6876].
#[test]
fn p39_loader() {
    let run = run_manual("P39");
    assert_eq!(run.moves().count(), 0);
    let call = run.tool_calls()[0];
    assert_eq!((call.tool, call.axis, call.speed_rpm), (1, Axis::Z, 1000.0));
    assert_eq!((call.shape.length, call.shape.radius), (30.0, 4.0));
    let functions = run.functions();
    assert!(functions.contains(&(3, &Function::M(3))) && functions.contains(&(4, &Function::M(50))));
    // Q110: spindle clockwise [003:7616-7619].
    assert_eq!(run.q[110], 0.0);
}

/// Incremental polar words count from the last position [003:786]: the same rectangle in the Y/Z plane.
#[test]
fn incremental_polar_points() {
    let run = run("L Y+10 Z+0 R0 FMAX\nCC Y+0 Z+0\nLP IPR+10 PA+90 F100\nLP IPA+90\nLP IPR-5 IPA+90");
    let points: Vec<_> = run.moves().map(|e| [e.end[Axis::Y], e.end[Axis::Z]]).collect();
    close_points(
        &points,
        &[[10.0, 0.0], [0.0, 20.0], [-20.0, 0.0], [0.0, -15.0]],
        EXACT,
    );
}

/// CTP ends at polar coordinates and starts tangentially; the pole is not its centre [003:3216-3231].
#[test]
fn tangential_arc_to_a_polar_point() {
    let run = run("L X-10 Y+0 R0 FMAX\nCC X+0 Y+10\nL X+0 F100\nCTP PR+10 PA+0");
    // From (0,0) along +X to (10,10): a quarter of a circle about (0,10).
    let arc = run.of_block(4);
    close_points(&ends(&arc), &[[10.0, 10.0]], EXACT);
    close_points(&[arc_of(arc[0]).0], &[[0.0, 10.0]], EXACT);
    close(arc_of(arc[0]).1, 90.0, EXACT);
}

/// CR takes the smaller arc for R > 0 and the larger for R < 0, in the sense of DR [003:2861-2879].
#[test]
fn the_four_arcs_of_a_radius() {
    let arc = |words: &str| {
        let run = run(&format!("L X+0 Y+0 R0 FMAX\nCR X+10 Y+0 {words} F100"));
        arc_of(run.of_block(2)[0])
    };
    // Centres lie at (5, ±12) for R13: the smaller arc spans 2·asin(5/13).
    let small = 2.0 * (5.0f64 / 13.0).asin().to_degrees();
    for (words, y, sweep) in [
        ("R+13 DR+", 12.0, small),
        ("R+13 DR-", -12.0, -small),
        ("R-13 DR+", -12.0, 360.0 - small),
        ("R-13 DR-", 12.0, small - 360.0),
    ] {
        let (centre, actual) = arc(words);
        close_points(&[centre], &[[5.0, y]], EXACT);
        close(actual, sweep, EXACT);
    }
}

/// A helix by an absolute angle and height: DR decides the way round [003:3210] [003:3243-3324].
#[test]
fn helix_to_an_absolute_height() {
    let run = run("L X+10 Y+0 Z+0 R0 FMAX\nCC X+0 Y+0\nCP PA+90 Z-6 DR+ F100\nCP PA+0 Z+0 DR+");
    let helix = run.of_block(3);
    close_points(&[xyz(&helix[0].end)], &[[0.0, 10.0, -6.0]], EXACT);
    close(helix[0].length(), (5.0 * PI).hypot(6.0), EXACT);
    close(arc_of(run.of_block(4)[0]).1, 270.0, EXACT);
}

/// A parallel axis stands for its main axis: a circle in U/Y [003:5397-5432].
#[test]
fn parallel_axes() {
    let run = run("L U+10 Y+0 R0 FMAX\nCC U+0 Y+0\nC U-10 Y+0 DR+ F100");
    let arc = run.of_block(3);
    close(arc[0].end[Axis::U], -10.0, EXACT);
    close(arc[0].length(), 10.0 * PI, EXACT);
    assert_eq!(run.position.get(Axis::X), None);
}

/// Compensated contours may move the tool axis at the same time: a ramp along the contour.
#[test]
fn a_ramp_along_the_contour() {
    let run = run(
        "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1\nL X-20 Y-20 Z+0 R0 FMAX\nL X+0 Y+0 RL F100\nL Y+50 Z-4\nL X+50 Z-8\nL Y+80 R0",
    );
    let path: Vec<_> = run.of_blocks(5..=6).iter().map(|e| xyz(&e.end)).collect();
    // The transition arc stays at the height of the corner.
    close_points(
        &path,
        &[[-5.0, 50.0, -4.0], [0.0, 55.0, -4.0], [50.0, 55.0, -8.0]],
        EXACT,
    );
}

/// TNC 415/425: an arc with one more axis, which moves linearly with the angle: a quarter circle while C turns by 90
/// degrees, a Cartesian helix, a full circle beside which only C is named [000:140].
#[test]
fn arcs_in_three_axes() {
    let start = "CC X+0 Y+0\nL X+10 Y+0 Z+0 C+0 R0 F100";
    let third = |axis: Axis, block: &str| {
        let run = run(&format!("{start}\n{block}"));
        let e = run.moves().last().unwrap().clone();
        let Curve::Arc(arc) = e.curve else {
            panic!("{block}: {e:?}")
        };
        let at = |t| e.curve.position(&e.start, &e.end, t);
        let (middle, end) = (at(0.5), at(1.0));
        close_points(&[arc.centre], &[[0.0, 0.0]], 1e-9);
        let way = [middle[axis], end[axis]];
        (arc.sweep_deg, [middle[Axis::X], middle[Axis::Y]], way)
    };
    let diagonal = 10.0 * 45f64.to_radians().cos();
    for (axis, block, end) in [
        (Axis::C, "C X+0 Y+10 C+90 DR+", 90.0),
        (Axis::C, "C X+0 Y+10 IC-30 DR+ R0", -30.0),
        (Axis::C, "CR X+0 Y+10 C+90 R+10 DR+", 90.0),
        (Axis::C, "CP PA+90 C+45 DR+", 45.0),
        (Axis::Z, "C X+0 Y+10 Z-5 DR+", -5.0),
        (Axis::Z, "CR X+0 Y+10 Z-5 R+10 DR+", -5.0),
    ] {
        let (sweep, middle, way) = third(axis, block);
        assert!((sweep - 90.0).abs() < 1e-9, "{block}");
        close_points(&[middle, way], &[[diagonal; 2], [0.5 * end, end]], 1e-9);
    }
    let (sweep, middle, way) = third(Axis::C, "C C+360 DR-");
    close_points(
        &[[sweep, 0.0], middle, way],
        &[[-360.0, 0.0], [-10.0, 0.0], [180.0, 360.0]],
        1e-9,
    );
    // Tangential to X: a half circle about (0,5), C going on.
    let run = run("L X-10 Y+0 C+0 R0 F100\nL X+0\nCT X+0 Y+10 C+90");
    let e = run.moves().last().unwrap();
    let middle = e.curve.position(&e.start, &e.end, 0.5);
    close_points(
        &[[middle[Axis::X], middle[Axis::Y]], [middle[Axis::C], 0.0]],
        &[[5.0, 5.0], [45.0, 0.0]],
        1e-9,
    );
}

/// With RL the arc has another radius and C the same way: the tool of R2 runs inside the circle of 10 mm.
#[test]
fn arcs_in_three_axes_are_compensated() {
    let run = run(
        "TOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S100\nCC X+0 Y+0\nL X+0 Y-10 C+0 R0 FMAX\nL X+10 Y+0 RL F100\n\
         C X+0 Y+10 C+90 DR+\nC X-10 Y+0 C+180 DR+\nL X-20 R0",
    );
    let arcs: Vec<_> = run
        .moves()
        .filter(|e| matches!(e.curve, Curve::Arc(_)))
        .map(|e| {
            (
                [e.end[Axis::X], e.end[Axis::Y]],
                [e.start[Axis::C], e.end[Axis::C]],
            )
        })
        .collect();
    assert_eq!(arcs.len(), 2);
    close_points(&[arcs[0].0, arcs[1].0], &[[0.0, 8.0], [-8.0, 0.0]], 1e-9);
    assert_eq!([arcs[0].1, arcs[1].1], [[0.0, 90.0], [90.0, 180.0]]);
}

/// What is no arc in three axes: more axes, one parallel to the plane, and any third one on other controls.
#[test]
fn planes_that_are_wrongly_defined() {
    let start = "CC X+0 Y+0\nL X+10 Y+0 Z+0 R0 F100\nL A+0 C+0 U+0";
    for block in [
        "C X+0 Y+10 Z+5 C+90 DR+",
        "C X+0 Y+10 A+5 C+90 DR+",
        "C X+0 Y+10 U+5 DR+",
        "CR X+0 Y+10 U+5 R+10 DR+",
        "CR Z+5 C+90 R+10 DR+",
        "CP PA+90 Z-5 C+45 DR+",
    ] {
        let run = Job::new(program(&format!("{start}\n{block}"))).run();
        assert_eq!(
            run.message(),
            Some((MessageId::PlaneWronglyDefined, 4)),
            "{block}"
        );
    }
    for block in [
        "C X+0 Y+10 C+90 DR+",
        "C X+0 Y+10 Z+5 DR+",
        "CR X+0 Y+10 C+9 R+10 DR+",
        "CP PA+90 C+45 DR+",
    ] {
        let job = Job::new(program(&format!("{start}\n{block}")));
        let run = job.with(|settings| settings.model = ControlModel::Tnc407).run();
        assert_eq!(
            run.message(),
            Some((MessageId::PlaneWronglyDefined, 4)),
            "{block}"
        );
    }
}
