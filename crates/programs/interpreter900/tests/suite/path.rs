//! Lines, circles, planes, feeds and stops.

use bahn_path::{Axis, Curve, OverrideLaw};

use crate::support::{ends, fault, fault_with, feeds, ran, ran_with};

/// G1 is in force at the start [002:5075-5077], an axis that is not named stays, G91 counts from where the path stands.
#[test]
fn lines_lead_where_their_words_say() {
    let ran = ran("N10 X10 F100\nN20 Y:5\nN30 G91 X-2.5 Z1\nN40 G90 X0\nN50 M30\nN60 X99\n");
    let expected = [
        [10.0, 0.0, 0.0],
        [10.0, 5.0, 0.0],
        [7.5, 5.0, 1.0],
        [0.0, 5.0, 1.0],
    ];
    assert_eq!(ends(&ran), expected);
    assert_eq!(feeds(&ran), [100.0; 4]);
}

/// A quarter about (0, 10) from the zero: clockwise it goes left, counter-clockwise right.
#[test]
fn circles_turn_about_their_centre() {
    for (text, sweep) in [("G3 X10 Y10 I0 J10", 90.0), ("G2 X-10 Y10 I0 J10", -90.0)] {
        let ran = ran(&format!("F100 {text}\n"));
        let Curve::Arc(arc) = ran.elements[0].curve else {
            panic!("{text} is no circle");
        };
        assert!((arc.sweep_deg - sweep).abs() < 1e-9, "{text}: {arc:?}");
        assert_eq!(arc.centre, [0.0, 10.0]);
    }
    let full = ran("F100 G2 I5\n");
    assert!((full.elements[0].length() - 10.0 * std::f64::consts::PI).abs() < 1e-9);
}

/// The chord from (0, 0) to (10, 0) with radius 10: 60 degrees the short way, 300 with a negative radius.
#[test]
fn a_radius_is_the_shorter_arc_unless_negative() {
    for (radius, sweep) in [("10", -60.0), ("-10", -300.0)] {
        let ran = ran(&format!("F100 G2 X10 R{radius}\n"));
        let Curve::Arc(arc) = ran.elements[0].curve else {
            panic!("no circle");
        };
        assert!(
            (arc.sweep_deg - sweep).abs() < 1e-6,
            "{radius}: {}",
            arc.sweep_deg
        );
    }
    assert_eq!(
        fault("F100 G2 X10 R4\n"),
        "R4 is too small: the ends are 10 mm apart"
    );
}

/// P8843 [002:4371-4376]: 0.003 where it is cleared. The end lies 0.01 beside the circle.
#[test]
fn ends_beside_the_circle_are_refused_as_1238() {
    let text = "F100 G3 X10.01 Y10 J10\n";
    assert!(fault(text).starts_with("M1238 "));
    assert_eq!(ran_with(text, "P8843: 0.02\n").elements.len(), 1);
}

/// 16.8: v = 16 * sqrt(2 * 10 * 0.01) mm/s, 60 times as much a minute. A radius within P8852 is refused.
#[test]
fn p8852_limits_the_feed_of_circles() {
    let ran = ran_with("F9000 G3 X10 Y10 J10\nG1 X20\n", "P8852: 0.01\n");
    let limit = 60.0 * 16.0 * 0.2_f64.sqrt();
    assert!((feeds(&ran)[0] - limit).abs() < 1e-9);
    assert_eq!(feeds(&ran)[1], 9000.0);
    assert!(fault_with("F100 G3 I5\n", "P8852: 6\n").starts_with("M1237 "));
}

/// [002:897-934]: G18 has Z and X with K and I, G117 what P8840 says, in the same block too [002:4350-4352].
#[test]
fn planes_say_the_axes_of_a_circle() {
    let of = |text: &str| match ran(text).elements[0].curve {
        Curve::Arc(arc) => (arc.plane.first, arc.plane.second, arc.centre),
        _ => panic!("{text} is no circle"),
    };
    assert_eq!(of("F100 G18 G3 K3 I4\n"), (Axis::Z, Axis::X, [3.0, 4.0]));
    assert_eq!(of("F100 G19 G3 J3\n"), (Axis::Y, Axis::Z, [3.0, 0.0]));
    assert_eq!(
        of("F100 G117 P8840:$00010302 G3 I2\n"),
        (Axis::Y, Axis::Z, [2.0, 0.0])
    );
    assert_eq!(fault("F100 G17 G3 K3 I4\n"), "K is no centre in the plane of G17");
}

/// P8818 is a percentage, P8815 takes the place of F, P8816 that of G0, G95 counts turns, G93 seconds.
#[test]
fn feeds_follow_their_parameters() {
    assert_eq!(feeds(&ran_with("F200 X1\n", "P8818: 50\n")), [100.0]);
    assert_eq!(
        feeds(&ran_with("F200 X1\nG0 X2\n", "P8815: 30\nP8816: 900\n")),
        [30.0, 900.0]
    );
    assert_eq!(feeds(&ran("S1000 F0.2 G95 X1\n")), [200.0]);
    assert_eq!(feeds(&ran("G93 F2 X10\n")), [300.0]);
    assert_eq!(feeds(&ran("G0 X10\n")), [0.0]);
    assert_eq!(fault("X10\n"), "no feed is programmed: F is 0");
}

/// P8858: 0 G0 ends with exact stop, 2 as G1 does. G8 stops one block, G28 all, but for those with G9.
#[test]
fn exact_stops_come_after_their_movement() {
    let stops = |text: &str, more: &str| {
        let ran = ran_with(text, more);
        let holds = ran.elements.iter().filter(|element| element.curve == Curve::Hold);
        holds.count()
    };
    assert_eq!(stops("G0 X1\nX2\n", ""), 2);
    assert_eq!(stops("G0 X1\nX2\n", "P8858: 2\n"), 0);
    assert_eq!(stops("F1 G8 X1\nX2\n", ""), 1);
    assert_eq!(stops("F1 G28 X1\nX2\nG9 X3\nG29 X4\n", ""), 2);
}

#[test]
fn a_dwell_takes_its_seconds_and_g63_the_override() {
    let ran = ran("G4 X2\nG4 F0.5\nG63 F100 X1\nG64 X2\n");
    assert_eq!((ran.elements[0].dwell_s, ran.elements[1].dwell_s), (2.0, 0.5));
    assert_eq!(ran.elements[2].override_law, OverrideLaw::Disabled);
    assert_eq!(ran.elements[3].override_law, OverrideLaw::Free);
}

/// q150, q151: X and C name radius and angle here. (10 cos 30, 10 sin 30), then 90 degrees.
#[test]
fn polar_words_are_radius_and_angle() {
    let ran = ran("G10 F100 X10 C30\nC90\nG11 X1\n");
    let expected = [[8.660254, 5.0, 0.0], [0.0, 10.0, 0.0], [1.0, 10.0, 0.0]];
    assert_eq!(ends(&ran), expected);
}

#[test]
fn what_is_not_executed_is_named() {
    for (text, said) in [
        ("G50 X1\n", "G50 is not executed here"),
        ("G66\n", "G66 is not executed here"),
        ("B5\n", "B is no axis of channel 1, q110 to q141"),
        ("M77\n", "M77 is defined nowhere: P11069"),
        ("G71\n", "the cycle Z71.900 does not lie beside the program"),
        ("I5\n", "I, J, K and R belong to a circle with G2 or G3"),
    ] {
        assert_eq!(fault(text), said);
    }
}

/// C goes round: P12001 = 2 the shortest way, 3 as G5, G6 and G7 say [002:6905-6916]. From 0 to 350 to 10 to 200 degrees, each
/// way counted on.
#[test]
fn axes_that_turn_go_their_way() {
    for (kind, word, ways) in [
        ("2", "G5", [-10.0, 10.0, -160.0]),
        ("3", "G7", [-10.0, 10.0, -160.0]),
        ("3", "G5", [350.0, 370.0, 560.0]),
        ("3", "G6", [-10.0, -350.0, -520.0]),
        ("1", "G6", [350.0, 10.0, 200.0]),
    ] {
        for turned in ["", "G45 "] {
            let text = format!("{word} {turned}G1 F100 C350\nC10\nC200\n");
            let found = ran_with(&text, &format!("P12601: {kind}\n"));
            let found: Vec<f64> = found
                .elements
                .iter()
                .map(|one| (one.end[Axis::C] * 1e6).round() / 1e6)
                .collect();
            assert_eq!(found, ways, "{kind} {text}");
        }
    }
    // A turn of 100 degrees, P12041; G91 goes as it says, and where it stands it need not go.
    let found = ran_with(
        "G1 F100 C90\nG91 C250\nG90 C-60\nC45\n",
        "P12601: 2\nP12641: 100\n",
    );
    let found: Vec<f64> = found.elements.iter().map(|one| one.end[Axis::C]).collect();
    assert_eq!(found, [-10.0, 240.0, 245.0]);
}
