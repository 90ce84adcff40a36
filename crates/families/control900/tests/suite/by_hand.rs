//! Axes beside all paths [002:3983-4140] [002:7795-8042] [002:6575-6627].

use bahn_control900::Kind;
use bahn_path::{At, Axis, Function, Synchronisation};

use crate::support::list::Line;
use crate::support::{Rig, axis};

/// Key plus of X with 1200 mm/min; it goes on until the key is released, at most to the software limit.
#[test]
fn a_direction_key_moves_an_axis() {
    let mut rig = Rig::on("q2030: 30\n");
    for (name, value) in [("P8750", "1"), ("P8751", "1"), ("P8755", "1200"), ("P8752", "1")] {
        rig.operator(name, value);
    }
    rig.seconds(1.0);
    assert!(
        (rig.read("P12167") - 1200.0).abs() < 0.01,
        "{}",
        rig.read("P12167")
    );
    rig.operator("P8752", "0");
    rig.seconds(0.5);
    let stopped = rig.read("P12151");
    // 20 mm/s for a second, of which 50 ms are ramp: 19.5 mm, and 0.5 mm to the stop.
    assert!((19.5..=20.6).contains(&stopped), "{stopped}");
    rig.operator("P8752", "1");
    rig.seconds(2.0);
    assert_eq!((rig.read("P12151"), rig.read("P12185")), (30.0, 1.0));
}

/// On a side without software limit the key moves the axis until it is released.
#[test]
fn a_direction_key_needs_no_limit() {
    let mut rig = Rig::on("q2030: 30\n");
    for (name, value) in [("P8750", "1"), ("P8751", "1"), ("P8755", "1200"), ("P8752", "2")] {
        rig.operator(name, value);
    }
    rig.seconds(3.0);
    rig.operator("P8752", "0");
    rig.seconds(0.5);
    // 20 mm/s for three seconds, less half of a ramp of 50 ms, and as much again to the stop.
    let stopped = rig.read("P12151");
    assert!((-60.6..=-59.5).contains(&stopped), "{stopped}");
}

/// A step of the table, 10 mm, and of the next one, 1 mm.
#[test]
fn a_step_moves_an_axis() {
    let mut rig = Rig::on("");
    for (name, value) in [("P8750", "2"), ("P8751", "2"), ("P8755", "1200"), ("P8752", "2")] {
        rig.operator(name, value);
    }
    rig.seconds(2.0);
    assert_eq!(rig.read("P12351"), -10.0);
    rig.operator("P8761", "1");
    rig.operator("P8752", "1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P12351"), -9.0);
}

/// The PLC positions: absolute to 30, then by -10. P12192 and P12191 say when.
#[test]
fn the_plc_positions_an_axis() {
    let mut rig = Rig::on("q2122: 3000\n");
    rig.plc("P12112", "30");
    rig.seconds(0.3);
    assert_eq!((rig.read("P12192"), rig.read("P12167")), (0.0, 3000.0));
    rig.until(|rig| rig.read("P12192") == 1.0);
    assert_eq!(rig.read("P12151"), 30.0);
    rig.plc("P12111", "-10");
    rig.until(|rig| rig.read("P12191") == 1.0);
    assert_eq!(rig.read("P12151"), 20.0);
    // Clearing aborts.
    rig.plc("P12112", "500");
    rig.seconds(0.5);
    rig.plc("P12112", "--");
    rig.seconds(1.0);
    assert!(rig.read("P12151") < 100.0 && rig.read("P12167") == 0.0);
}

/// The zero pulse lies 5 mm on; there P12040 is loaded. Only then P8709 lets a program start.
#[test]
fn a_reference_drive_takes_the_zero_pulse() {
    let mut rig = Rig::on("q2015: 0\nq2040: 100\n");
    rig.plant.ideal.marks[0] = Some(5000);
    assert_eq!((rig.read("P12180"), rig.read("P8709")), (0.0, 0.0));
    rig.operator("P8755", "600");
    rig.plc("P12130", "$00010001");
    rig.until(|rig| rig.read("P12180") == 1.0);
    rig.seconds(0.5);
    // The pulse is at 100 now; the axis stands where it came to a stop behind it.
    let (machine, count) = (rig.exact("P12150"), rig.plant.ideal.count(0));
    assert!(
        (machine - (100.0 + (count as f64 - 5000.0) / 1000.0)).abs() < 1e-6,
        "{machine} {count}"
    );
    assert_eq!((rig.read("P12167"), rig.read("P8709")), (0.0, 1.0));
}

/// A handwheel at encoder 9, 1000 INC/mm, ten times: 500 INC move X by 5 mm.
#[test]
fn a_handwheel_moves_an_axis() {
    let mut rig = Rig::on("q1400: 9\nq1401: 1\nq1402: 1\nq1403: 1000\nq1404: 10\n");
    rig.plant.ideal.turn(8, 500);
    rig.seconds(1.0);
    assert_eq!(rig.read("P12151"), 5.0);
    rig.operator("P11402", "0");
    rig.seconds(0.1);
    rig.plant.ideal.turn(8, 500);
    rig.seconds(0.5);
    assert_eq!(rig.read("P12151"), 5.0, "it is not active");
}

/// Spindle 1 is physical axis 5, 1000 rpm at most: it turns with 500 rpm, P11651 says when.
#[test]
fn a_spindle_turns() {
    let mut rig = Rig::on(&(axis(5) + "q2801: 2\nq2804: 360000\nq1640: 5\nq1648: 500\n"));
    rig.plc("P11650", "-1");
    rig.until(|rig| rig.read("P11651") == 1.0);
    rig.seconds(0.5);
    assert!((rig.read("P11649") + 500.0).abs() < 0.5, "{}", rig.read("P11649"));
    rig.plc("P11650", "0");
    rig.seconds(1.0);
    assert!(rig.read("P11649").abs() < 0.5);
}

/// q142 gives the word S of the channel to spindle 1; P11645 limits it to 800 rpm.
#[test]
fn a_programmed_speed_goes_to_its_spindle() {
    let mut rig = Rig::on(&(axis(5) + "q142: 1\nq2801: 2\nq2804: 360000\nq1640: 5\nq1645: 800\n"));
    let line = Line::to(&[(Axis::X, 10.0)], 3000.0);
    rig.start(
        1,
        &[line.says(Function::SpindleSpeed(900.0), At::Start, Synchronisation::MvsSvs)],
    );
    rig.until_end(1);
    assert_eq!(rig.read("P11648"), 900.0);
    rig.plc("P11650", "1");
    rig.until(|rig| rig.read("P11651") == 1.0);
    rig.seconds(0.5);
    assert!((rig.read("P11649") - 800.0).abs() < 0.5, "{}", rig.read("P11649"));
}

/// Key switch 2 sets lock 1: a parameter with its status bit is refused to the operator, not to the PLC
/// [002:5273-5417].
#[test]
fn a_key_switch_locks_parameters() {
    let mut rig = Rig::on("P50: 1 $00010001\nP11011: $1\n");
    rig.operator("P50", "2");
    rig.plc("P11001", "1");
    assert_eq!(rig.read("P11020"), 1.0);
    let refused = rig
        .control
        .write_operator("P50".parse().unwrap(), "3".parse().unwrap());
    assert_eq!(
        refused.unwrap_err().to_string(),
        "P50 is locked by parameter lock 1"
    );
    assert_eq!(rig.read("P50"), 2.0);
    rig.plc("P50", "4");
    assert_eq!(rig.read("P50"), 4.0);
}

/// P12132: emergency position absolute, P12032, at the greatest speed; M2000 is shown, the program of the channel is broken off.
#[test]
fn an_axis_goes_to_its_emergency_position() {
    let mut rig = Rig::on("q2032: -20\nq2036: 12\nq2123: 600\n");
    rig.start(2, &[Line::to(&[(Axis::X, 300.0)], 3000.0)]);
    rig.start(1, &[Line::to(&[(Axis::X, 300.0)], 3000.0)]);
    rig.until(|rig| rig.read("P12151") > 20.0);
    rig.plc("P12132", "$1");
    rig.until(|rig| rig.read("P12182") == 1.0);
    assert_eq!(
        (rig.read("P12151"), rig.read("P8685"), rig.read("2:P8685")),
        (-20.0, 0.0, 2.0)
    );
    let message = &rig.control.messages()[0];
    assert_eq!(
        (message.number, message.channel, message.kind),
        (2000, 1, Kind::Display)
    );
    // P12133: the fixed position with P12123.
    rig.plc("P12133", "$1");
    rig.seconds(0.5);
    assert_eq!(rig.read("P12167"), 600.0);
    rig.until(|rig| rig.read("P12183") == 1.0);
    assert_eq!(rig.read("P12151"), 12.0);
}

/// P12136: while slope 1 acts the axis is no faster than 10 % of P12004; P12137 locks a direction.
#[test]
fn slopes_and_locks_act_on_axes() {
    let mut rig = Rig::on("");
    rig.plc("P12136", "$1");
    rig.start(
        1,
        &[
            Line::to(&[(Axis::X, 100.0)], 3000.0),
            Line::to(&[(Axis::X, 0.0)], 3000.0),
        ],
    );
    rig.seconds(2.0);
    assert_eq!(rig.read("P12167"), 600.0);
    rig.plc("P12136", "0");
    rig.plc("P12137", "$0100");
    rig.seconds(5.0);
    assert_eq!(
        (rig.read("P12151"), rig.read("P8685")),
        (100.0, 2.0),
        "minus is locked"
    );
    rig.plc("P12137", "0");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 0.0);
}

/// P8702 holds what the PLC positions, too: it stops on its ramp and goes on afterwards. P12171 to P12173 show how fast the axis goes
/// to its relative, absolute and fixed position [002:8442-8444].
#[test]
fn positions_of_the_plc_are_held_and_show_their_speeds() {
    for (name, to, shown, reached) in [
        ("P12111", "100", "P12171", "P12191"),
        ("P12112", "100", "P12172", "P12192"),
        ("P12133", "1", "P12173", "P12183"),
    ] {
        let mut rig = Rig::on("q2036: 100\nq2121: 3000\nq2122: 3000\nq2123: 3000\n");
        rig.plc(name, to);
        rig.until(|rig| rig.exact("P12151") > 30.0);
        for other in ["P12171", "P12172", "P12173"] {
            let speed = if other == shown { 3000.0 } else { 0.0 };
            assert!((rig.read(other) - speed).abs() < 30.0, "{name} {other}");
        }
        rig.plc("P8702", "1");
        let before = rig.exact("P12151");
        rig.seconds(1.0);
        // 50 mm/s brake on 3.125 mm.
        let way = rig.exact("P12151") - before;
        assert!((3.1..3.4).contains(&way), "{name} {way}");
        assert_eq!(rig.read(reached), 0.0);
        rig.plc("P8702", "0");
        rig.until(|rig| rig.read(reached) == 1.0);
        assert_eq!(rig.read("P12151"), 100.0);
        rig.cycle();
        assert_eq!(rig.read(shown), 0.0);
    }
}

/// P8756 is P8755, at most P8754 [002:4013-4015].
#[test]
fn the_feed_by_hand_is_shown() {
    let mut rig = Rig::on("P8755: 500\n");
    assert_eq!(rig.read("P8756"), 500.0);
    rig.plc("P8754", "400");
    rig.cycle();
    assert_eq!(rig.read("P8756"), 400.0);
}
