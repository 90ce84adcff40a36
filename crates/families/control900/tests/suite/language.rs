//! Programs in the language of the control.

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::Position;
use bahn_text::MemoryFiles;

use crate::support::{Rig, axis};

/// Lines, a circle, a real-time parameter, M functions with stop, a branch that is not taken, a dwell: the program writes and
/// reads parameters of the control while it runs.
#[test]
fn a_program_runs_with_the_parameters_of_its_control() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\nP11051: $10050601\nP50: 0 $00010004\n"));
    let text = b"N10 G1 X50 Y10 F3000\nN20 X60 M6\nN30 G2 X80 I10 J0 F1000\nN40 G1 P50:12.5 P51:7 X:P51\n\
        N50 M7.70 Y30\nN60 Y40\nN70 G0 X0 Y0 M5\nN80 G4 X0.5\nN90 M30\n";
    let beside = Arc::new(MemoryFiles::default());
    let program = Reader900::new("P1000.900", text, 1, Position::ZERO, beside);
    rig.operator("P8800", "1000");
    rig.control.set_program(1, Some(Box::new(program)));
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8901") == 30.0);
    // P50 is a real-time parameter: it is written where its block is executed; P51 was in the look-ahead.
    assert_eq!((rig.read("P50"), rig.read("P51")), (0.0, 7.0));
    rig.until(|rig| rig.read("P8901") == 50.0);
    assert_eq!((rig.read("P50"), rig.read("P12151")), (12.5, 7.0));
    rig.until_end(1);
    assert_eq!(
        (rig.read("P12151"), rig.read("P12351"), rig.read("P8906")),
        (0.0, 0.0, 0.0)
    );
    let sent: Vec<_> = rig
        .control
        .transfers()
        .map(|one| (one.m, one.block, one.branch, one.taken))
        .collect();
    assert_eq!(
        sent,
        [(6, 20, false, false), (7, 50, true, false), (5, 70, false, false)]
    );
    assert_eq!(rig.control.messages(), []);
}

/// M26: P8715 ends the way to X 100 within the ramp, P8695 gets the number of the block, and the program goes on after it from
/// where X stands: G1 and F of the block stay in force [002:3717-3727].
#[test]
fn p8715_ends_the_way_of_m26() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\n"));
    rig.start_text("N10 G1 X40 F6000\nN20 X100 F3000 M26\nN30 G91 Y10\nN40 G90 X0\nN50 M30\n");
    // Before its block the signal does nothing.
    rig.until(|rig| rig.exact("P12151") > 20.0);
    rig.plc("P8715", "1");
    rig.until(|rig| rig.exact("P12151") > 60.0);
    rig.plc("P8715", "0");
    let from = rig.exact("P12151");
    rig.plc("P8715", "1");
    assert_eq!(rig.read("P8695"), 20.0);
    rig.until(|rig| rig.read("P8901") == 30.0);
    // 50 mm/s brake on a ramp of 250 ms to 100 mm/s: 3.125 mm, begun within a cycle of 4 ms.
    let way = rig.exact("P12151") - from;
    assert!((3.1..3.5).contains(&way), "{way}");
    rig.until(|rig| rig.read("P8938") > 2990.0);
    rig.until(|rig| rig.read("P8901") == 40.0);
    assert_eq!(rig.read("P12351"), 10.0);
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (0.0, 10.0));
    assert_eq!(rig.control.messages(), []);

    // Without the signal, and with one after its end, the way is gone to its end.
    rig.plc("P8715", "0");
    rig.start_text("N10 G1 X50 F3000 M26\nN20 X60\nN30 M30\n");
    rig.until(|rig| rig.read("P8901") == 20.0);
    assert_eq!(rig.exact("P12151").floor(), 50.0);
    rig.plc("P8715", "1");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 60.0);
    assert_eq!(rig.read("P8695"), 20.0, "the earlier one");
}
