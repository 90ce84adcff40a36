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

/// M26: P8715, or the measuring key P8716, ends the way to X 100 within the ramp, P8695 gets the number of the block, and the program goes on after it from
/// where X stands: G1 and F of the block stay in force [002:3717-3727].
#[test]
fn p8715_ends_the_way_of_m26() {
    for signal in ["P8715", "P8716"] {
        ends_the_way(signal);
    }
}

fn ends_the_way(signal: &str) {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\n"));
    rig.start_text("N10 G1 X40 F6000\nN20 X100 F3000 M26\nN30 G91 Y10\nN40 G90 X0\nN50 M30\n");
    // Before its block the signal does nothing.
    rig.until(|rig| rig.exact("P12151") > 20.0);
    rig.plc(signal, "1");
    rig.until(|rig| rig.exact("P12151") > 60.0);
    rig.plc(signal, "0");
    let from = rig.exact("P12151");
    rig.plc(signal, "1");
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
    rig.plc(signal, "0");
    rig.start_text("N10 G1 X50 F3000 M26\nN20 X60\nN30 M30\n");
    rig.until(|rig| rig.read("P8901") == 20.0);
    assert_eq!(rig.exact("P12151").floor(), 50.0);
    rig.plc(signal, "1");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 60.0);
    assert_eq!(rig.read("P8695"), 20.0, "the earlier one");
}

/// What is in force is shown with the block that is executed, not with the one that is read: the circle of N30, its plane, its
/// exact stop; the words of N20 are gone then [002:4845-5024].
#[test]
fn g_functions_are_shown_as_they_are_executed() {
    let mut rig = Rig::on(
        &(axis(5)
            + "q112: $0305005A\nq104: 30000\nq105: 1000\nq3: 40000\nq170: 20000\nq171: 1\nq172: 2\nq173: 3\nq174: 0\n"),
    );
    rig.start_text(
        "N10 G1 X10 F3000\nN20 G2 X30 I10 J0 G28 G44 G63 G93 F2\nN30 G45 G55 G61 G62 G5 G10 G94 F3000\nN35 G92 Y2\n\
         N40 G1 G18 G91 G47 Z40\nN50 G4 F1.5\nN60 M24.50.2\nN70 G41 G17\nN80 G1 X-5\nN90 X-5\nN95 G40 X-1\nN99 M30\n",
    );
    let mode = [
        "P8950", "P8951", "P8952", "P8953", "P8958", "P8964", "P8965", "P8966", "P8967", "P8969", "P8970",
        "P8971", "P8972", "P8978", "P8979", "P8980", "P8943", "P8945", "P8947", "P8948",
    ];
    let shown = |rig: &Rig| mode.map(|name| rig.read(name) as i64);
    rig.until(|rig| rig.read("P8901") == 10.0);
    assert_eq!(
        shown(&rig),
        [
            17, 1, 2, 3, 29, 40, 43, 46, 147, 53, 60, 60, 60, 90, 0, 94, 7, 11, 14, 15
        ]
    );
    assert!(rig.read("P8918").is_nan() && rig.read("P8941").is_nan());
    rig.until(|rig| rig.read("P8901") == 20.0);
    assert_eq!([rig.read("P8918"), rig.read("P8919")], [10.0, 0.0]);
    assert!(rig.read("P8920").is_nan() && rig.read("P8921").is_nan());
    assert_eq!(
        shown(&rig),
        [
            17, 1, 2, 3, 28, 40, 44, 46, 147, 53, 60, 60, 63, 90, 0, 93, 7, 11, 14, 15
        ]
    );
    rig.until(|rig| rig.read("P8901") == 40.0);
    assert!(rig.read("P8918").is_nan());
    assert_eq!(
        shown(&rig),
        [
            18, 3, 1, 2, 28, 40, 44, 45, 47, 55, 61, 62, 63, 91, 92, 94, 5, 10, 14, 15
        ]
    );
    assert_eq!([rig.read("P9100"), rig.read("P9101")], [0.0, 2.0]);
    rig.until(|rig| rig.read("P8901") == 50.0);
    assert_eq!(rig.read("P8941"), 1.5);
    rig.until(|rig| rig.read("P8934") == 2.0);
    assert_eq!(rig.read("P8935"), 1.0);
    rig.until(|rig| rig.read("P8964") == 41.0);
    assert_eq!(rig.read("P8901"), 80.0);
    rig.until_end(1);
    assert_eq!(rig.control.messages(), []);
}

/// In a cycle: its number and block, its level, and from where it was called.
#[test]
fn the_cycle_that_is_executed_is_shown() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\nP11069: $00004000\n"));
    let beside: MemoryFiles = [("Z77.900", "N5 X2\nN6 G2 X6 R2\n")].into_iter().collect();
    let text = b"N10 G1 X1 F300 M77\nN20 G1 X9\nN30 M30\n";
    let program = Reader900::new("P1000.900", text, 1, Position::ZERO, Arc::new(beside));
    rig.load_text("");
    rig.control.set_program(1, Some(Box::new(program)));
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    let names = ["P8904", "P8905", "P8912", "P8913", "P8914"];
    rig.until(|rig| rig.read("P8904") == 77.0);
    assert_eq!(names.map(|name| rig.read(name)), [77.0, 5.0, 1.0, 1000.0, 10.0]);
    rig.until(|rig| rig.read("P8905") == 6.0);
    assert_eq!(rig.read("P8921"), 2.0);
    rig.until(|rig| rig.read("P8901") == 20.0);
    assert_eq!(rig.read("P8912"), 0.0);
    assert!(
        ["P8904", "P8905", "P8913", "P8914"]
            .iter()
            .all(|name| rig.read(name).is_nan())
    );
    rig.until_end(1);
}

/// P8801 is the N number of the block with which a program starts, P8821 that of emergency program 1 [002:4156-4158]
/// [002:4303-4314]: the one says nothing of the other.
#[test]
fn start_blocks_are_numbers_of_blocks() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\nP8801: 300\nP8821: 20\n"));
    let program = |name: &str, text: &[u8]| {
        let beside = Arc::new(MemoryFiles::default());
        Box::new(Reader900::new(name, text, 1, Position::ZERO, beside))
    };
    let text = b"N100 G1 X50 F3000\nN200 Y10\nN300 G1 X60 F3000\nN400 M30\n";
    rig.operator("P8800", "1000");
    rig.control.set_program(1, Some(program("P1000.900", text)));
    let away = b"N10 G0 Y50\nN20 G1 Y5 F3000\nN300 Y70\n";
    rig.control
        .set_emergency_program(1, 1, Some(program("P9001.900", away)));
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8685") == 2.0);
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (60.0, 0.0));
    let passed = |rig: &mut Rig| {
        let mut passed = Vec::new();
        while rig.read("P8685") == 2.0 {
            let block = rig.read("P8901");
            if passed.last() != Some(&block) {
                passed.push(block);
            }
            rig.cycle();
        }
        passed
    };
    rig.plc("P8710", "1");
    rig.until(|rig| rig.read("P8685") == 2.0);
    assert_eq!(passed(&mut rig), [20.0, 300.0]);
    assert_eq!(rig.read("P12351"), 70.0);
}

/// A program with a loop that is broken off in its second round, at N40: P8804 passes over the first round without a movement,
/// M4 (bit 5) goes out and M5 does not, X and Y go straight to where N40 begins with P8816, and the program goes on there
/// [002:4165-4216].
#[test]
fn a_restart_comes_back_to_the_contour() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\nP11051: $00000321\nP8816: 1200\n"));
    let text = "N10 G1 X10 F3000 M4\nN20 G91 M5\nN30 X20\nN40 Y15\nN50 M24.30.1\nN60 G90 X0 Y0\nN70 M30\n";
    rig.start_text(text);
    rig.until(|rig| rig.read("P12351") > 20.0);
    rig.operator("P8683", "1");
    rig.seconds(0.5);
    let kept = ["P8802", "P8803", "P8685"].map(|name| rig.read(name));
    assert_eq!(kept, [1000.0, 40.0, 0.0]);
    let place = rig.read("P8807");
    // Axes are moved away by hand.
    rig.plc("P12111", "-30");
    rig.plc("P12311", "-20");
    rig.until(|rig| rig.read("P12191") == 1.0 && rig.read("P12391") == 1.0);
    let [x, y] = ["P12151", "P12351"].map(|name| rig.read(name));
    let sent = rig.control.transfers().count();
    rig.operator("P8804", "1");
    rig.load_text(text);
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8686") == 1.0);
    rig.until(|rig| rig.read("P8686") == 2.0);
    rig.until(|rig| rig.read("P8938") > 1190.0);
    assert!(rig.read("P8938") < 1201.0, "{}", rig.read("P8938"));
    // On the line to X 50, Y 15.
    let [now_x, now_y] = ["P12151", "P12351"].map(|name| rig.read(name));
    let along = (now_x - x) / (50.0 - x);
    assert!(((now_y - y) / (15.0 - y) - along).abs() < 0.01, "{now_x} {now_y}");
    rig.until(|rig| rig.read("P8686") == 0.0);
    assert_eq!((rig.read("P8804"), rig.read("P8901")), (0.0, 40.0));
    assert!((rig.read("P12151") - 50.0).abs() < 0.001 && (rig.read("P12351") - 15.0).abs() < 0.5);
    let went: Vec<u16> = rig.control.transfers().skip(sent).map(|one| one.m).collect();
    assert_eq!(went, [4]);
    rig.until(|rig| rig.read("P12351") > 29.9);
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (0.0, 0.0));
    assert!(place > 4.0, "the second round");
    // A program that has ended keeps nothing: P8804 is taken back, and it begins at its begin.
    assert_eq!(["P8802", "P8803", "P8807"].map(|name| rig.read(name)), [0.0; 3]);
    rig.operator("P8804", "1");
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8901") == 10.0);
    assert_eq!((rig.read("P8804"), rig.read("P8686")), (0.0, 0.0));
    assert_eq!(rig.control.messages(), []);
}

/// In a cycle a restart begins with its first block; broken off again on its way, it keeps its place.
#[test]
fn a_restart_begins_a_cycle_anew() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\nP11069: $00004000\n"));
    let start = |rig: &mut Rig| {
        let beside: MemoryFiles = [("Z77.900", "N5 X20\nN6 Y30\n")].into_iter().collect();
        let text = b"N10 G1 X10 F3000 M77\nN20 G1 X0\nN30 M30\n";
        let program = Reader900::new("P1000.900", text, 1, Position::ZERO, Arc::new(beside));
        rig.load_text("");
        rig.control.set_program(1, Some(Box::new(program)));
        rig.operator("P8683", "2");
        rig.seconds(0.05);
        rig.operator("P8682", "2");
        rig.until(|rig| rig.read("P8685") == 2.0);
    };
    start(&mut rig);
    rig.until(|rig| rig.read("P12351") > 10.0);
    rig.plc("P8705", "1");
    rig.seconds(0.5);
    let place = rig.read("P8807");
    rig.operator("P8804", "1");
    start(&mut rig);
    rig.until(|rig| rig.read("P8686") == 2.0);
    rig.plc("P8705", "1");
    rig.seconds(0.5);
    let kept = ["P8686", "P8804", "P8807", "P8803"].map(|name| rig.read(name));
    assert_eq!(kept, [0.0, 1.0, place, 6.0]);
    start(&mut rig);
    rig.until(|rig| rig.read("P8686") == 2.0);
    rig.until(|rig| rig.read("P8686") == 0.0);
    assert_eq!(rig.read("P8905"), 5.0);
    assert!(
        rig.read("P12351").abs() < 0.01 && rig.read("P12151") < 11.0,
        "{} {}",
        rig.read("P12151"),
        rig.read("P12351")
    );
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (0.0, 30.0));
}

/// The corner of G12 is shown in its block; P8892 ends with the change to HAND [002:4762-4782].
#[test]
fn corners_are_shown_and_mirrors_end_by_hand() {
    let mut rig = Rig::on(&(axis(5) + "q112: $0305005A\nP8892: $1\n"));
    rig.start_text("N10 P71:1 G1 G12 X-10 F600\nN20 Y10\nN30 M30\n");
    rig.until(|rig| rig.read("P8901") == 10.0);
    assert_eq!(rig.read("P8946"), 12.0);
    rig.until(|rig| rig.read("P8901") == 20.0 && rig.exact("P12351") > 2.0);
    assert!(rig.read("P8946").is_nan());
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P8892")), (10.0, 1.0));
    rig.operator("P8683", "1");
    rig.seconds(0.05);
    assert_eq!(rig.read("P8892"), 0.0);
}
