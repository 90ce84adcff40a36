//! Zero points, G92, G44, rotation, mirrors.

use crate::support::{ends, fault, ran_with};

/// One area, 7 points, 3 axes: the sum of G54 is P20003 to P20005.
const SHIFTS: &str = "P20000: 1\nP20003: 100\nP20004: 50\nP8000: 0.25\n";

#[test]
fn zero_points_move_the_program() {
    let ran = ran_with("F100 X10\nG54 X10 Y1\nG153 X10\nG53 Y0\n", SHIFTS);
    let expected = [
        [11.0, 0.0, 0.0],
        [110.0, 51.0, 0.0],
        [10.0, 51.0, 0.0],
        [10.0, 0.0, 0.0],
    ];
    assert_eq!(ends(&ran), expected);
    let at_start = ran_with("F100 X10\n", &format!("{SHIFTS}P8830: 54\n"));
    assert_eq!(ends(&at_start), [[110.0, 0.0, 0.0]]);
    assert_eq!(fault("G154\n"), "G154: the channel has no such zero point, q174");
}

/// G92 is added to the zero point, alone it takes itself back; G44 adds P8000.
#[test]
fn g92_and_g44_are_added() {
    let ran = ran_with("G54 G92 X5\nF100 X1\nG44 X2\nG43 G92\nX3\n", SHIFTS);
    assert_eq!(
        ends(&ran),
        [[106.0, 0.0, 0.0], [107.25, 0.0, 0.0], [103.0, 0.0, 0.0]]
    );
}

/// X = U cos E - V sin E + U0, Y = U sin E + V cos E + V0 [002:1531-1537]; activated in the block [002:1524-1532].
#[test]
fn g45_turns_about_its_origin() {
    let ran = ran_with("G45 P160:10 P161:20 P163:90 F100 X5 Y1\nG46 X5 Y1\n", "");
    assert_eq!(ends(&ran), [[9.0, 25.0, 0.0], [5.0, 1.0, 0.0]]);
}

/// G61 mirrors the first axis of the plane, a circle turns the other way round; P8892 mirrors at the machine.
#[test]
fn mirrors_turn_circles_over() {
    let ran = ran_with("G61 F100 X10 Y1\nG3 X20 Y11 J10\nG60 G1 X1\n", "");
    assert_eq!(
        ends(&ran),
        [[-10.0, 1.0, 0.0], [-20.0, 11.0, 0.0], [1.0, 11.0, 0.0]]
    );
    let bahn_path::Curve::Arc(arc) = ran.elements[1].curve else {
        panic!("no circle");
    };
    assert!((arc.sweep_deg + 90.0).abs() < 1e-9);
    let machine = ran_with("G54 F100 X10 Y1\n", &format!("{SHIFTS}P8892: 1\n"));
    assert_eq!(ends(&machine), [[-110.0, 51.0, 0.0]]);
}
