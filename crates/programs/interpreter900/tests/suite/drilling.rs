//! Drilling and patterns (16.18).

use bahn_path::{Axis, OverrideLaw};

use crate::support::{ends, fault_with, feeds, ran_with};

const HOLE: &str = "P30: 0.5\nP32: 50\nP33: -10\nP34: 2\nP35: 20\n";

#[test]
fn g81_drills_where_the_block_ends() {
    let ran = ran_with("G0 X5 G81\nX6\n", HOLE);
    let z: Vec<f64> = ends(&ran).iter().map(|end| end[2]).collect();
    assert_eq!(z, [0.0, 2.0, -10.0, 2.0, 20.0, 20.0], "it does not stay in force");
    assert_eq!(feeds(&ran)[..5], [0.0, 0.0, 50.0, 0.0, 0.0]);
    let modal = ran_with("G0 X5 G81\nX6\nG80 X7\n", &format!("{HOLE}P8806: $00010000\n"));
    assert_eq!(ends(&modal).len(), 5 + 5 + 1);
    assert!(fault_with("G81 P33:--\n", HOLE).starts_with("G81 needs P33"));
    let dwells = ran.elements.iter().filter(|one| one.end[Axis::Z] == -10.0);
    assert_eq!(dwells.map(|one| one.dwell_s).collect::<Vec<_>>(), [0.5], "P30");
}

/// Three strokes of (-10 - 2) / 3 = -4, back to 1 above the last depth.
#[test]
fn g83_comes_out_after_each_stroke() {
    let ran = ran_with("G83\n", &format!("{HOLE}P36: 3\nP38: 1\n"));
    let z: Vec<f64> = ends(&ran).iter().map(|end| end[2]).collect();
    assert_eq!(z, [2.0, -2.0, 2.0, -1.0, -6.0, 2.0, -5.0, -10.0, 2.0, 20.0]);
}

#[test]
fn g85_comes_back_at_the_feed_and_g84_by_the_pitch() {
    assert_eq!(feeds(&ran_with("G85\n", HOLE))[1..3], [50.0, 50.0]);
    let tapped = ran_with("S100 G84 P32:1.5\n", HOLE);
    assert_eq!(feeds(&tapped)[1..3], [150.0, 150.0]);
    // Without a compensating chuck, P31 = 3, the path follows the spindle.
    let rigid = ran_with("S100 G84 P32:1.5 P31:3\n", HOLE);
    let threads = rigid.elements.iter().filter_map(|one| match one.override_law {
        OverrideLaw::Spindle(thread) => Some((thread.pitch_mm, thread.retracts)),
        _ => None,
    });
    assert_eq!(threads.collect::<Vec<_>>(), [(1.5, false), (1.5, true)]);
}

/// Places in the plane, in their order.
fn places(text: &str) -> Vec<[f64; 2]> {
    let ran = ran_with(text, HOLE);
    let mut places: Vec<[f64; 2]> = Vec::new();
    for [x, y, z] in ends(&ran) {
        if z == -10.0 {
            places.push([x, y]);
        }
    }
    places
}

#[test]
fn patterns_say_where_holes_are() {
    let vector = "G81 G86 P100:10 P101:5 P103:90 P105:2 P106:3\n";
    assert_eq!(places(vector), [[10.0, 5.0], [10.0, 7.0], [10.0, 9.0]]);
    let two = "P100:0 P101:0 P103:0 P104:20 P106:3 P113:90 P115:5 P116:3\n";
    let round = places(&format!("G81 G87 {two}"));
    assert_eq!(
        round,
        [
            [0.0, 0.0],
            [10.0, 0.0],
            [20.0, 0.0],
            [20.0, 5.0],
            [20.0, 10.0],
            [10.0, 10.0],
            [0.0, 10.0],
            [0.0, 5.0]
        ]
    );
    let by_length = two.replace("P115:5", "P114:10");
    assert_eq!(places(&format!("G81 G87 {by_length}")), round);
    assert_eq!(places(&format!("G81 G88 {two}")).len(), 9);
    let circle = places("G81 G89 P120:1 P121:2 P122:20 P123:0 P125:90 P126:4\n");
    assert_eq!(circle, [[11.0, 2.0], [1.0, 12.0], [-9.0, 2.0], [1.0, -8.0]]);
    let by_sweep = places("G81 G89 P120:1 P121:2 P122:20 P123:0 P124:270 P126:4\n");
    assert_eq!(by_sweep, circle);
    assert!(fault_with("G86 P106:2\n", HOLE).starts_with("G86 without drilling"));
}
