//! Corners of G12 [002:1518-1523] and feeds by what comes next.

use bahn_path::{Curve, FeedRate};

use super::support::{ends, fault, reader, run};

const CORNER: &str = "N10 G1 X50 G12 F1000\nN20 Y40\nN30 M30\n";

/// P70 takes 10 mm off both lines, P71 rounds with 10 mm: in a corner of 90 degrees from the same places.
#[test]
fn g12_puts_a_chamfer_or_a_radius_into_the_corner() {
    let wanted = [[40.0, 0.0, 0.0], [50.0, 10.0, 0.0], [50.0, 40.0, 0.0]];
    assert_eq!(ends("P70: 10\n", CORNER), wanted);
    assert_eq!(ends("P71: 10\n", CORNER), wanted);
    let ran = run(&mut reader("P71: 10\n", CORNER));
    assert!(matches!(ran.elements[1].curve, Curve::Arc(arc) if arc.sweep_deg == 90.0));
    let ran = run(&mut reader("P70: 10\n", CORNER));
    assert_eq!(ran.elements[1].curve, Curve::Line);
}

/// The chamfer of the contour is corrected as all of it: 5 mm to the right of the lines, round its two outer corners.
#[test]
fn corners_are_corrected_too() {
    let program = "N10 G42 G1 X10 F1000\nN20 X50 G12\nN30 Y40\nN40 M30\n";
    let data = "P8160: 5\nP71: 10\n";
    let wanted = [
        [10.0, -5.0, 0.0],
        [40.0, -5.0, 0.0],
        [55.0, 10.0, 0.0],
        [55.0, 40.0, 0.0],
    ];
    assert_eq!(ends(data, program), wanted);
}

#[test]
fn a_corner_that_does_not_go_in_is_said() {
    assert_eq!(fault("", CORNER), "G12 needs the chamfer P70 or the radius P71");
    assert_eq!(
        fault("P70: 1\nP71: 1\n", CORNER),
        "G12 takes the chamfer P70 or the radius P71, not both"
    );
    assert_eq!(
        fault("P70: 45\n", CORNER),
        "G12: the chamfer P70 is longer than a line"
    );
    assert_eq!(fault("P71: 45\n", CORNER), "G12: the radius P71 is too large");
    assert_eq!(
        fault("P70: 1\n", "N10 G1 X50 G12 F1000\nN20 M30\n"),
        "G12: no movement in its plane follows"
    );
    assert_eq!(
        fault("P70: 1\n", "N10 G12\nN20 M30\n"),
        "G12 stands in a block that moves in the plane"
    );
}

/// (0, 0), (20, 60), (100, 100), (180, 60) lie on the circle of 100 mm about (100, 0): with P8857 = 0.1 the feed is limited as on
/// it by P8852, 60 * 16 * sqrt(2 * 100 * 0.1) mm/min [002:4637-4649].
#[test]
fn p8857_limits_feeds_by_the_circles_through_the_points() {
    let program = "N10 G1 X20 Y60 F9000\nN20 X100 Y100\nN30 X180 Y60\nN40 M30\n";
    let feeds = |data: &str| -> Vec<f64> {
        let ran = run(&mut reader(data, program));
        assert_eq!(ran.fault, None);
        let feed = |feed| match feed {
            FeedRate::Programmed(feed) => feed,
            FeedRate::Rapid => 0.0,
        };
        ran.elements.iter().map(|one| feed(one.feed)).collect()
    };
    assert_eq!(feeds(""), [9000.0; 3]);
    let wanted = 60.0 * 16.0 * 20f64.sqrt();
    assert!(
        feeds("P8857: 0.1\n")
            .iter()
            .all(|feed| (feed - wanted).abs() < 1e-6),
        "{:?}",
        feeds("P8857: 0.1\n")
    );
}

/// Angles of 180, 150, 135 and 120 degrees are changes of direction of 0, 30, 45 and 60: the feed before the corner is multiplied by 1,
/// 0.866, 0.707, 0.5 with P8851 = 1, by 1, 0.649, 0.353, 0.125 with 3 [002:4500-4530]. Below 90 degrees it is 0.
#[test]
fn p8851_slows_down_before_corners() {
    let before = |p8851: &str, turn: f64| {
        let (sin, cos) = turn.to_radians().sin_cos();
        let end = format!("X{:.6} Y{:.6}", 50.0 + 50.0 * cos, 50.0 * sin);
        let program = format!("N10 G1 X50 F1000\nN20 {end}\nN30 M30\n");
        let ran = run(&mut reader(p8851, &program));
        assert_eq!(ran.fault, None);
        ran.elements[0].end_feed.unwrap_or(1000.0) / 1000.0
    };
    for (turn, one, three) in [
        (0.0, 1.0, 1.0),
        (30.0, 0.866, 0.649),
        (45.0, 0.707, 0.353),
        (60.0, 0.5, 0.125),
        (91.0, 0.0, 0.0),
    ] {
        for (p8851, wanted) in [("1", one), ("3", three), ("-1", one), ("0", 1.0)] {
            let found = before(&format!("P8851: {p8851}\n"), turn);
            assert!((found - wanted).abs() < 1e-3, "{turn} {p8851}: {found}");
        }
    }
}
