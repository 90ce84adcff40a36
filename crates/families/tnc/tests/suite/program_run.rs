//! Program run on the mill: paths, functions, stops.

use crate::support::*;
use bahn_tnc::RunState;

/// Three axes move along the path of a program and end where it says; the datum is that of the machine.
#[test]
fn a_program_runs_to_its_end() {
    let mut rig = Build::mill()
        .program("1.H", "TOOL CALL 1 Z S1000\nL X+200 Y+100 Z+200 R0 FMAX M3\nL X+250 F2000\nCC X+250 Y+150\nC X+250 Y+200 DR+\nL Z+250 FMAX M5")
        .rig();
    rig.power_on();
    rig.run("1.H", 60.0);
    assert_eq!(rig.messages(), [""; 0]);
    rig.seconds(0.5);
    // Z of the spindle nose: 250 and the tool of 70 mm.
    for (letter, expected) in [('X', 250.0), ('Y', 200.0), ('Z', 320.0)] {
        let actual = rig.machine_position(letter);
        assert!((actual - expected).abs() < 0.006, "{letter} {actual}");
        let table = rig.machine.axis(letter).unwrap().position;
        assert!((table - expected).abs() < 0.02, "{letter} table {table}");
    }
    assert_eq!(rig.control.snapshot().run, RunState::Idle);
    assert!(rig.bit("M2061"), "END PGM was executed");
}
