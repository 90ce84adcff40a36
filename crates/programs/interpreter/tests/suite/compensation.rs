//! Radius compensation: corners, M functions that change them, paraxial blocks.

use std::f64::consts::PI;

use crate::support::*;
use bahn_parameters::MessageId;
use bahn_path::{Axis, Curve, FeedRate};

const TOOL: &str = "TOOL DEF 1 L+0 R+10\nTOOL CALL 1 Z S1000\nL X-20 Y-20 R0 FMAX";

fn contour(blocks: &str) -> Vec<[f64; 2]> {
    let run = run(&format!("{TOOL}\n{blocks}"));
    ends(&run.moves().skip(1).collect::<Vec<_>>())
}

/// An outside corner gets a transition arc, with M97 the intersection of both parallels [003:3467-3493].
#[test]
fn m97_goes_to_the_intersection() {
    let text = |m: &str| format!("L X+0 Y+0 RL F100\nL Y+50{m}\nL X+50\nL Y+80 R0");
    close_points(
        &contour(&text("")),
        &[
            [-10.0, 0.0],
            [-10.0, 50.0],
            [0.0, 60.0],
            [50.0, 60.0],
            [50.0, 80.0],
        ],
        1e-9,
    );
    close_points(
        &contour(&text(" M97")),
        &[[-10.0, 0.0], [-10.0, 60.0], [50.0, 60.0], [50.0, 80.0]],
        1e-9,
    );
}

/// Steps that are smaller than the tool: TOOL RADIUS TOO LARGE, M97 helps [003:3469-3493].
#[test]
fn small_steps() {
    // A step of 5 mm down at X = 30, tool R10 above.
    let text = |m: &str| format!("{TOOL}\nL X+0 Y+50 RL F100\nL X+30{m}\nL Y+45\nL X+80{m}\nL Y+0 R0");
    let plain = Job::new(program(&text(""))).run();
    assert_eq!(
        plain.message().map(|(id, _)| id),
        Some(bahn_parameters::MessageId::ToolRadiusTooLarge)
    );
    let run = Job::new(program(&text(" M97"))).run();
    run.assert_completed();
    // The parallels meet at (40,60) and (40,55).
    let path = ends(&run.moves().skip(1).collect::<Vec<_>>());
    close_points(
        &path[..4],
        &[[0.0, 60.0], [40.0, 60.0], [40.0, 55.0], [80.0, 55.0]],
        1e-9,
    );
}

/// An open inside corner: with M98 both elements are machined to their ends [003:3497-3512].
#[test]
fn m98_machines_both_elements_completely() {
    let text = |m: &str| format!("L X+0 Y+0 RR F100\nL Y+50{m}\nL X+50\nL Y+80 R0");
    close_points(
        &contour(&text("")),
        &[[10.0, 0.0], [10.0, 40.0], [50.0, 40.0], [50.0, 80.0]],
        1e-9,
    );
    let open = contour(&text(" M98"));
    close_points(&open[..2], &[[10.0, 0.0], [10.0, 50.0]], 1e-9);
    assert!(
        open.contains(&[0.0, 40.0]),
        "the second element begins beside its start: {open:?}"
    );
}

/// M90 asks for constant speed at the corner, block by block [003:3439-3457].
#[test]
fn m90_keeps_the_speed() {
    let run = run("L X+0 Y+0 R0 F100\nL X+10 M90\nL Y+10\nL X+0");
    let speeds: Vec<bool> = run.moves().map(|e| e.constant_speed).collect();
    assert_eq!(speeds, [false, true, false, false]);
}

/// R+ lengthens and R- shortens a paraxial path by the tool radius; R0 neither [003:2046-2057].
#[test]
fn paraxial_compensation() {
    for (word, x) in [("R+", 40.0 + 10.0), ("R-", 40.0 - 10.0), ("R0", 40.0)] {
        assert_eq!(contour(&format!("X+40 {word} F100")), [[x, -20.0]], "{word}");
    }
    // In negative direction the path is lengthened to the negative side.
    assert_eq!(contour("X-60 R+ F100"), [[-70.0, -20.0]]);
    // "Only for single-axis movements in the working plane": not for the tool axis and rotary ones [003:2046].
    for block in ["Z-5 R+ F100", "Z+5 R- F100", "W+5 R+ F100", "C+5 R+ F100"] {
        let run = Job::new(program(&format!("{TOOL}\n{block}"))).run();
        assert_eq!(
            run.message(),
            Some((MessageId::WrongAxisProgrammed, 4)),
            "{block}"
        );
    }
    // One that stays in force after a block of the plane waits for the next one there.
    run(&format!("{TOOL}\nX+40 R+ F100\nZ-5\nX+50")).assert_completed();
}

/// The side changes with an R0 block between; RL and RR without one is an error [003:2042].
#[test]
fn from_left_to_right() {
    let path = contour("L X+0 Y+0 RL F100\nL Y+50\nL X+20 Y+80 R0\nL X+50 Y+50 RR\nL Y+0\nL Y-30 R0");
    close_points(
        &path,
        &[
            [-10.0, 0.0],
            [-10.0, 50.0],
            [20.0, 80.0],
            [40.0, 50.0],
            [40.0, 0.0],
            [50.0, -30.0],
        ],
        1e-9,
    );
}

/// Movements of the tool axis between contour elements do not disturb the corner.
#[test]
fn infeed_in_a_contour() {
    let run = run(&format!(
        "{TOOL}\nL X+0 Y+0 RL F100\nL Y+50\nL Z-5\nL X+50\nL Y+80 R0"
    ));
    let path: Vec<_> = run
        .moves()
        .skip(1)
        .map(|e| [e.end[Axis::X], e.end[Axis::Y], e.end[Axis::Z]])
        .collect();
    close_points(&path[2..4], &[[-10.0, 50.0, -5.0], [0.0, 60.0, -5.0]], 1e-9);
}

/// An inside corner between line and arc, and an arc inside of the tool's radius [003:2074-2078].
#[test]
fn inside_of_arcs() {
    // Semicircle R20 from (0,0) over (20,20) to (40,0), machined inside with R10: radius 10 is left.
    let path = run(&format!(
        "{TOOL}\nL X+0 Y+0 RR F100\nCC X+20 Y+0\nC X+40 Y+0 DR-\nL Y-40 R0"
    ));
    let arc = path.moves().find(|e| matches!(e.curve, Curve::Arc(_))).unwrap();
    close(arc_radius(arc), 10.0, 1e-9);
    close(arc.length(), 10.0 * PI, 1e-9);
    let small = Job::new(program(&format!(
        "{TOOL}\nL X+0 Y+0 RR F100\nCR X+18 Y+0 R+9 DR-\nL Y-40 R0"
    )))
    .run();
    assert_eq!(
        small.message(),
        Some((bahn_parameters::MessageId::ToolRadiusTooLarge, 5))
    );
}

/// M109 keeps the feed of the cutting edge on arcs, M110 lowers it only [000:5120-5126].
#[test]
fn feed_at_the_cutting_edge() {
    // Arc of R20 outside with tool R10 (centre R30) and inside (centre R10).
    let feeds = |m: &str| {
        let run = run(&format!(
            "{TOOL}\nL X+0 Y+0 RL F100 {m}\nCC X+20 Y+0\nC X+40 Y+0 DR-\nL Y-60 R0\nL X+0 Y+0 RR\nC X+40 Y+0 DR-\nL Y-60 R0"
        ));
        let arcs = run.moves().filter(|e| matches!(e.curve, Curve::Arc(_)));
        arcs.map(|e| e.feed).collect::<Vec<_>>()
    };
    let feed = FeedRate::Programmed;
    assert_eq!(feeds(""), [feed(100.0), feed(100.0)]);
    assert_eq!(feeds("M109"), [feed(150.0), feed(50.0)]);
    assert_eq!(feeds("M110"), [feed(100.0), feed(50.0)]);
}

/// Two roundings in a row, each inside for the tool and large enough for it.
#[test]
fn roundings_inside() {
    let run = run(&format!(
        "{TOOL}\nL X+0 Y+0 RR F100\nL Y+60\nRND R15\nL X+60\nRND R15\nL Y+0\nL Y-30 R0"
    ));
    let arcs: Vec<_> = run.moves().filter(|e| matches!(e.curve, Curve::Arc(_))).collect();
    assert_eq!(arcs.len(), 2);
    for (arc, centre) in arcs.iter().zip([[15.0, 45.0], [45.0, 45.0]]) {
        close_points(&[arc_of(arc).0], &[centre], 1e-9);
        close(arc_radius(arc), 5.0, 1e-9);
    }
}

/// A chamfer may use up a whole side, and an inside arc may have exactly the tool's radius.
#[test]
fn limits_that_just_fit() {
    let chamfer = run("L X+0 Y+0 R0 F100\nL X+10\nL 10\nL Y+10\nL X+30");
    let points = ends(&chamfer.moves().skip(1).collect::<Vec<_>>());
    assert_eq!(points.last(), Some(&[30.0, 10.0]));
    assert!(points.contains(&[10.0, 10.0]));
    let arc = run(&format!(
        "{TOOL}\nL X+0 Y+0 RR F100\nL Y+20\nCR X+20 Y+20 R+10 DR-\nL Y-40\nL Y-60 R0"
    ));
    // The tool stands still in the arc's centre.
    close_points(&ends(&arc.of_block(6)), &[[10.0, 20.0]], 1e-9);
    close(length(&arc.of_block(6)), 0.0, 1e-9);
}

/// Parallel axes stand for their main axes in the plane of compensation [003:5397-5432]: tool R10 left of
/// U20 .. U60, then of Y0 .. Y50. First point (20, 10) beside the start, inside corner (50, 10), last point
/// (50, 50); X does not move.
#[test]
fn parallel_axes_are_compensated() {
    let run = run(
        "TOOL DEF 1 L+0 R+10\nTOOL CALL 1 Z S1000\nL X+3 Y-20 U+0 R0 FMAX\n\
                   L U+20 Y+0 RL F100\nL U+60\nL Y+50\nL U+0 R0",
    );
    run.assert_completed();
    let points: Vec<[f64; 3]> = run
        .moves()
        .skip(1)
        .map(|e| [e.end[Axis::X], e.end[Axis::U], e.end[Axis::Y]])
        .collect();
    let expected = [
        [3.0, 20.0, 10.0],
        [3.0, 50.0, 10.0],
        [3.0, 50.0, 50.0],
        [3.0, 0.0, 50.0],
    ];
    close_points(&points, &expected, 1e-9);
}

/// An axis and its parallel axis cannot share a compensated contour.
#[test]
fn main_and_parallel_axis_do_not_mix() {
    let run = Job::new(program(&format!(
        "{TOOL}\nL X+0 Y+0 RL F100\nL X+50\nL U+20\nL Y+50 R0"
    )))
    .run();
    assert_eq!(run.message(), Some((MessageId::PlaneWronglyDefined, 6)));
}
