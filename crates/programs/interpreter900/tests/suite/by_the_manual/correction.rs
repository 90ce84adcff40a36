//! Radius correction G41, G42 with the corners of P8845 and the messages of P8844 [002:4378-4403].

use bahn_path::{Arc, Curve, FeedRate};

use super::support::{Ran, ends, fault, reader, run};

/// The radius that the path is computed with, P8160, is 5 mm.
const TOOL: &str = "P8160: 5\n";

fn path(more: &str, program: &str) -> Ran {
    let ran = run(&mut reader(&format!("{TOOL}{more}"), program));
    assert_eq!(ran.fault, None);
    ran
}

/// Where movements end in the plane.
fn points(ran: &Ran) -> Vec<[f64; 2]> {
    ran.ends().into_iter().map(|[x, y, _]| [x, y]).collect()
}

/// To the left of X50 the tool runs 5 mm above it, and before Y40 5 mm beside it: both meet at (45, 5). G40 leads back.
#[test]
fn the_tool_runs_beside_the_contour() {
    let program = "N10 G41 G1 X10 F1000\nN20 X50\nN30 Y40\nN40 G40 X0\nN50 X1\nN60 M30\n";
    let wanted = [[10.0, 5.0], [45.0, 5.0], [45.0, 40.0], [0.0, 40.0], [1.0, 40.0]];
    assert_eq!(points(&path("", program)), wanted);
}

/// To the right the corner lies outside. With P8845 cleared a circle about it is always inserted, with 0 from 120 degrees on:
/// 90 degrees are an intersection, (55, -5).
#[test]
fn outer_corners_follow_p8845() {
    let program = "N10 G42 G1 X10 F1000\nN20 X50\nN30 Y40\nN40 M30\n";
    let inserted = [[10.0, -5.0], [50.0, -5.0], [55.0, 0.0], [55.0, 40.0]];
    let met = [[10.0, -5.0], [55.0, -5.0], [55.0, 40.0]];
    let with = |p8845: &str| points(&path(p8845, program));
    assert_eq!(with(""), inserted);
    assert_eq!(with("P8845: 0\n"), met);
    assert_eq!(with("P8845: 90\n"), met);
    assert_eq!(with("P8845: 89\n"), inserted);
    let circle = &path("", program).elements[2];
    let Curve::Arc(Arc {
        centre, sweep_deg, ..
    }) = circle.curve
    else {
        panic!("no circle is inserted")
    };
    assert_eq!((centre, sweep_deg), ([50.0, 0.0], 90.0));
    assert!(circle.tangential_end);
}

/// "Direction deviation 120 degrees and degree number of 110: circle is inserted. 130: intersection is calculated" [002:4397-4400].
/// The intersection lies 5 * tan(60 degrees) = 8.660254 beyond the corner.
#[test]
fn the_example_of_the_manual_turns_by_120_degrees() {
    let program = "N10 G41 G1 X10 F1000\nN20 X50\nN30 X40 Y-17.320508\nN40 M30\n";
    let with = |p8845: &str| points(&path(p8845, program))[1];
    assert_eq!(with("P8845: 110\n"), [50.0, 5.0]);
    let [x, y] = with("P8845: 130\n");
    assert!((x - 58.660254).abs() < 1e-5 && y == 5.0, "{x} {y}");
}

/// Round the outside of a circle the tool runs on a circle that is greater by its radius.
#[test]
fn circles_are_corrected() {
    let program = "N10 G41 G1 X10 F1000\nN20 X20\nN30 G2 X40 Y-20 J-20\nN40 G1 Y-50\nN50 G40 X60\nN60 M30\n";
    let ran = path("", program);
    let wanted = [
        [10.0, 5.0],
        [20.0, 5.0],
        [45.0, -20.0],
        [45.0, -50.0],
        [60.0, -50.0],
    ];
    assert_eq!(points(&ran), wanted);
    assert!((ran.elements[2].length() - 25.0 * std::f64::consts::FRAC_PI_2).abs() < 1e-9);
}

/// P8850 = 1: the programmed feed is that of the edge: 1000 * 25/20 on the circle of the centre. With P8850 = 100 and
/// P8848 = 50 it is 1000 * (1 + 0.5 * (100 - 20)/(100 - 5)) on a convex arc [002:4437-4470].
#[test]
fn feeds_of_arcs_follow_p8848_to_p8850() {
    let program = "N10 G41 G1 X10 F1000\nN20 X20\nN30 G2 X40 Y-20 J-20\nN40 M30\n";
    let feed = |more: &str| match path(more, program).elements[2].feed {
        FeedRate::Programmed(feed) => feed,
        FeedRate::Rapid => panic!("rapid"),
    };
    assert_eq!(feed(""), 1000.0);
    assert!((feed("P8850: 1\n") - 1250.0).abs() < 1e-9);
    let wanted = 1000.0 * (1.0 + 0.5 * 80.0 / 95.0);
    assert!((feed("P8850: 100\nP8848: 50\n") - wanted).abs() < 1e-9);
    // The arc is convex: P8849 says nothing of it, nor P8848 of one as great as P8850.
    assert_eq!(feed("P8850: 100\nP8849: 50\n"), 1000.0);
    assert_eq!(feed("P8850: 20\nP8848: 50\n"), 1000.0);
    // Inside of the same arc P8849 counts.
    let inside = program.replace("G41", "G42");
    let ran = path("P8850: 100\nP8849: -50\n", &inside);
    let wanted = 1000.0 * (1.0 - 0.5 * 80.0 / 95.0);
    assert!(matches!(ran.elements[2].feed, FeedRate::Programmed(feed) if (feed - wanted).abs() < 1e-9));
}

/// An inside arc of 3 mm is too small: M1154. Suppressed by P8844 the lines beside it meet at (23 - 5, 5).
#[test]
fn a_small_inside_arc_is_m1154() {
    let program = "N10 G41 G1 X10 F1000\nN20 X20\nN30 G3 X23 Y3 J3\nN40 G1 Y40\nN50 M30\n";
    assert_eq!(
        fault(TOOL, program),
        "M1154 the tool is larger than the inside arc"
    );
    let wanted = [[10.0, 5.0], [18.0, 5.0], [18.0, 40.0]];
    assert_eq!(points(&path("P8844: 1\n", program)), wanted);
}

/// A chamfer of 2.83 mm lies between two inside corners of 45 degrees, each of which takes 5 * tan(22.5 degrees) = 2.07 mm from
/// it: it vanishes, M1155 at its block. Suppressed its neighbours meet at (22 - 5, 5).
#[test]
fn an_element_that_vanishes_is_m1155() {
    let program = "N10 G41 G1 X10 F1000\nN20 X20\nN30 X22 Y2\nN40 Y40\nN50 M30\n";
    assert_eq!(
        fault(TOOL, program),
        "M1155 the element vanishes under the radius correction"
    );
    let wanted = [[10.0, 5.0], [17.0, 5.0], [17.0, 40.0]];
    assert_eq!(points(&path("P8844: 2\n", program)), wanted);
}

/// Y- is turned round: the tool to the left of the program is to the right of the machine's path.
#[test]
fn a_mirror_changes_the_side() {
    let program = "N10 G62 G41 G1 X10 F1000\nN20 X50\nN30 Y40\nN40 M30\n";
    let wanted = [[10.0, -5.0], [45.0, -5.0], [45.0, -40.0]];
    assert_eq!(points(&path("", program)), wanted);
}

/// Z between two elements of the contour moves beside it, M1 ends what is held.
#[test]
fn what_stands_between_stays_beside_the_contour() {
    let program = "N10 G41 G1 X10 F1000\nN20 X50\nN30 Z-2\nN40 Y40\nN50 M30\n";
    let wanted = [
        [10.0, 5.0, 0.0],
        [45.0, 5.0, 0.0],
        [45.0, 5.0, -2.0],
        [45.0, 40.0, -2.0],
    ];
    assert_eq!(ends(TOOL, program), wanted);
    let program = "N10 G41 G1 X10 F1000\nN20 X50\nN30 M1\nN40 X60\nN50 M30\n";
    let ran = path("", program);
    assert_eq!(points(&ran), [[10.0, 5.0], [50.0, 5.0], [60.0, 5.0]]);
    assert_eq!(ran.barriers.len(), 1);
}

#[test]
fn what_correction_cannot_do_is_said() {
    let said = |program: &str| fault(TOOL, &format!("{program}\nN90 M30\n"));
    assert_eq!(
        said("N10 G41 G3 X10 Y10 J10 F1000"),
        "G41 and G42 begin on a straight line"
    );
    assert_eq!(
        said("N10 G41 G1 X10 F1000\nN20 X20\nN30 G42 X30"),
        "the side of the tool changes: G40 stands between G41 and G42"
    );
    assert_eq!(
        said("N10 G41 G1 X10 F1000\nN20 X20\nN30 P8160:4 X30"),
        "the radius of the tool changes within G41 or G42"
    );
    let hole = "N5 P32:50 P33:-10 P34:2\nN10 G41 G1 X10 F1000\nN20 G81 X20";
    assert_eq!(said(hole), "G81 within G41 or G42 is not executed here");
}
