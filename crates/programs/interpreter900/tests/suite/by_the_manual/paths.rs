//! G0 to G4, planes, circles, feeds, exact stop.

use bahn_path::{Axis, Curve, FeedRate};

use super::support::{ends, fault, reader, run};

/// Axis words with and without a colon, absolute and incremental [002:7826-7828].
#[test]
fn lines_lead_to_what_is_programmed() {
    let program = "N10 G1 X200 Y:100 F1000\nN20 G91 X-50 Z5\nN30 G90 X0\nN40 M30\n";
    let wanted = [[200.0, 100.0, 0.0], [150.0, 100.0, 5.0], [0.0, 100.0, 5.0]];
    assert_eq!(ends("", program), wanted);
}

#[test]
fn rapid_traverse_ends_with_an_exact_stop() {
    let data = |rule: &str| format!("P8858: {rule}\n");
    let program = "N10 G0 X10\nN20 X20\nN30 M30\n";
    let holds = |data: &str| {
        let ran = run(&mut reader(data, program));
        assert_eq!(ran.fault, None);
        assert!(
            ran.elements
                .iter()
                .filter(|one| one.curve != Curve::Hold)
                .all(|one| one.feed == FeedRate::Rapid)
        );
        ran.elements.iter().filter(|one| one.curve == Curve::Hold).count()
    };
    // P8858 cleared: each G0 stops; 2: none does [002:4651-4660].
    assert_eq!((holds(""), holds(&data("2"))), (2, 0));
}

/// G8 stops in its block alone, G28 until G29 [002:7820].
#[test]
fn exact_stops_are_programmed() {
    let program = "N10 G1 X1 F100 G8\nN20 X2\nN30 G28 X3\nN40 X4\nN50 G29 X5\nN60 G9 X6\nN70 M30\n";
    let ran = run(&mut reader("", program));
    let shape: String = ran
        .elements
        .iter()
        .map(|one| if one.curve == Curve::Hold { 's' } else { 'm' })
        .collect();
    assert_eq!(shape, "msmmsmsmm");
}

/// A quarter about (0, 0) from (10, 0) to (0, 10): I -10, J 0 from the start; its length is 10 * pi / 2.
#[test]
fn circles_have_their_centre_from_the_start() {
    let program = "N10 G1 X10 F600\nN20 G3 X0 Y10 I-10 J0\nN30 M30\n";
    let ran = run(&mut reader("", program));
    let arc = ran.elements.last().unwrap();
    assert!((arc.length() - 10.0 * std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    let Curve::Arc(arc) = arc.curve else {
        panic!("no arc")
    };
    assert!((arc.sweep_deg - 90.0).abs() < 1e-9, "{}", arc.sweep_deg);
}

/// In G18 the plane is Z, X and the centre K, I [002:897-934].
#[test]
fn planes_have_their_own_centre_words() {
    let program = "N10 G18 G1 Z10 F600\nN20 G3 Z0 X10 K-10 I0\nN30 M30\n";
    let ran = run(&mut reader("", program));
    assert_eq!(ran.fault, None);
    let Curve::Arc(arc) = ran.elements.last().unwrap().curve else {
        panic!("no arc")
    };
    assert_eq!((arc.plane.first, arc.plane.second), (Axis::Z, Axis::X));
    assert!((arc.sweep_deg - 90.0).abs() < 1e-9);
}

/// P8840:$00010302 and G117 in one block: the plane is logical axis 2, 3, normal 1, that of G19 [002:4350-4352].
#[test]
fn a_plane_is_written_in_the_block_that_takes_it() {
    let program = "N10 G1 Y10 F600\nN20 G117 P8840:$00010302\nN30 G3 Y0 Z10 I-10 J0\nN40 M30\n";
    let ran = run(&mut reader("", program));
    assert_eq!(ran.fault, None);
    let Curve::Arc(arc) = ran.elements.last().unwrap().curve else {
        panic!("no arc")
    };
    assert_eq!((arc.plane.first, arc.plane.second), (Axis::Y, Axis::Z));
}

/// The end 10.1 from a centre whose start is 10 away: M1238, but with P8843 = 0.2 [002:4371-4376].
#[test]
fn the_radius_of_a_circle_may_differ_by_p8843() {
    let program = "N10 G1 X10 F600\nN20 G3 X0 Y10.1 I-10 J0\nN30 M30\n";
    assert_eq!(
        fault("", program),
        "M1238 the end of the circle does not lie on it: its radii differ by more than P8843"
    );
    assert_eq!(ends("P8843: 0.2\n", program).len(), 2);
}

/// v = Kv * sqrt(2 * R * deviation): 16 * sqrt(2 * 110 * 0.1) = 75.047 mm/s = 4502.8 mm/min with R = 110.
#[test]
fn p8852_limits_the_feed_of_circles() {
    let program = "N10 G1 X110 F9000\nN20 G3 X0 Y110 I-110 J0\nN30 M30\n";
    let kv = "P12020: 16\nP12220: 16\n";
    let ran = run(&mut reader(&format!("P8852: 0.1\n{kv}"), program));
    let wanted = 60.0 * 16.0 * (2.0 * 110.0 * 0.1f64).sqrt();
    let FeedRate::Programmed(feed) = ran.elements.last().unwrap().feed else {
        panic!("rapid")
    };
    assert!((feed - wanted).abs() < 1e-6, "{feed} {wanted}");
    let small = "N10 G1 X0.05 F9000\nN20 G3 X0 Y0.05 I-0.05 J0\nN30 M30\n";
    let said = fault(&format!("P8852: 0.1\n{kv}"), small);
    assert!(said.starts_with("M1237 the radius"), "{said}");
}

/// P8815 replaces, P8818 scales the programmed feed; P8816 is rapid traverse [002:4282-4300]. G95 counts for a turn.
#[test]
fn feeds_follow_their_parameters() {
    let feeds = |data: &str, program: &str| -> Vec<FeedRate> {
        let ran = run(&mut reader(data, program));
        assert_eq!(ran.fault, None);
        let moving = ran.elements.iter().filter(|one| one.curve != Curve::Hold);
        moving.map(|one| one.feed).collect()
    };
    let program = "N10 G0 X1\nN20 G1 X2 F500\nN30 M30\n";
    use FeedRate::{Programmed, Rapid};
    assert_eq!(feeds("", program), [Rapid, Programmed(500.0)]);
    assert_eq!(
        feeds("P8815: 80\nP8816: 4000\n", program),
        [Programmed(4000.0), Programmed(80.0)]
    );
    assert_eq!(feeds("P8818: 50\n", program), [Rapid, Programmed(250.0)]);
    assert_eq!(
        feeds("", "N10 G1 G95 F0.2 S1000 X1\nN20 M30\n"),
        [Programmed(200.0)]
    );
    assert_eq!(fault("", "N10 G1 X1\nN20 M30\n"), "no feed is programmed: F is 0");
}

/// G4 in seconds by X or F [002:4906-4920].
#[test]
fn a_dwell_takes_its_seconds() {
    let ran = run(&mut reader("", "N10 G4 X2\nN20 G4 F0.5\nN30 M30\n"));
    let dwells: Vec<f64> = ran.elements.iter().map(|one| one.dwell_s).collect();
    assert_eq!(dwells, [2.0, 0.5]);
}

#[test]
fn what_the_manual_does_not_explain_is_refused_by_its_name() {
    let said = fault("", "N10 G65 X1\nN20 M30\n");
    assert!(said.ends_with("G65 is not executed here"), "{said}");
    let said = fault("", "N10 G50 X1 F100\nN20 M30\n");
    assert!(said.ends_with("G50 is not executed here"), "{said}");
}
