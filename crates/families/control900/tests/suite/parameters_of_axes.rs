//! Parameters of axes, one after the other: what each does while the control runs [002:6893-8640].

use bahn_path::Axis;

use crate::support::list::Line;
use crate::support::{Rig, axis};

fn x(to: f64) -> [Line; 1] {
    [Line::to(&[(Axis::X, to)], 6000.0)]
}

/// Parameters of physical axis 1 with 500 INC per 2 mm, counted the other way round, with 8 V at the greatest speed that are
/// inverted and come out of output 9 [002:6987-7010] [002:7107-7121].
#[test]
fn an_axis_is_wired_as_its_parameters_say() {
    let mut rig = Rig::on("q2012: 500\nq2013: 2\nq2014: $01\nq2027: 8\nq2028: 1\nq2029: 9\n");
    rig.start(1, &x(300.0));
    rig.until(|rig| rig.exact("P12151") > 150.0);
    // Forwards, with the sense of the voltage turned round.
    assert!(
        (rig.plant_volts(8).abs() - 8.0).abs() < 0.02,
        "{}",
        rig.plant_volts(8)
    );
    assert!(rig.plant_volts(8) < 0.0 && rig.plant_volts(0) == 0.0);
    // Both speeds of the encoder.
    for name in ["P12168", "P12170"] {
        assert!(
            (rig.read(name) - 6000.0).abs() < 5.0,
            "{name}: {}",
            rig.read(name)
        );
    }
    rig.until_end(1);
    rig.seconds(0.5);
    // 300 mm of 250 INC.
    assert!(
        (rig.plant.ideal.count(0) + 75_000).abs() <= 10,
        "{}",
        rig.plant.ideal.count(0)
    );
    let [machine, actual] = ["P12150", "P12152"].map(|name| rig.read(name));
    assert!((machine - 300.0).abs() < 0.04 && actual == machine);
}

/// With P12015 byte 4 the axis is where P12152 says, and counts as referenced [002:7012-7022].
#[test]
fn an_absolute_axis_is_where_it_was() {
    let rig = Rig::on("q2152: 12.5 $03000010\n");
    assert_eq!(
        ["P12152", "P12151", "P12180", "P8579"].map(|name| rig.read(name)),
        [12.5, 12.5, 1.0, 1.0]
    );
    let rig = Rig::on("q2015: 0\nq2152: 12.5 $03000010\n");
    assert_eq!(["P12180", "P8579"].map(|name| rig.read(name)), [0.0, 0.0]);
}

/// Way from 100 mm/s to rest: v * t / 2 on the ramp of P12009 on a path, of P12008 by hand [002:6974-6978].
#[test]
fn ramps_are_those_of_their_dynamics() {
    let mut rig = Rig::on("q2008: 100\nq2009: 500\n");
    rig.start(1, &x(300.0));
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.plc("P8704", "0");
    let before = rig.exact("P12151");
    rig.seconds(1.0);
    let way = rig.exact("P12151") - before;
    assert!((25.0..=25.5).contains(&way), "{way}");
    let mut rig = Rig::on("q2008: 100\nq2009: 500\nq2030: 500\nq2031: -500\n");
    for (name, value) in [("P8755", "6000"), ("P8750", "1"), ("P8751", "1"), ("P8752", "1")] {
        rig.operator(name, value);
    }
    rig.seconds(0.5);
    assert!((rig.read("P12167") - 6000.0).abs() < 0.01);
    rig.operator("P8752", "0");
    let before = rig.exact("P12151");
    rig.seconds(0.5);
    let way = rig.exact("P12151") - before;
    assert!((5.0..=5.5).contains(&way), "{way}");
}

/// At 100 mm/s and Kv 16 the lag is 6.25 mm. With P12024 = 200 three times of it is too much, which the dead drive has after
/// 12.5 mm or 125 ms; P12025 allows 100 ms more [002:7085-7098].
#[test]
fn the_lag_has_its_limit_and_its_time() {
    let mut rig = Rig::on("q2024: 200\nq2025: 100\n");
    rig.start(1, &x(500.0));
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = true;
    let since_us = rig.control.now_us();
    rig.until(|rig| !rig.control.messages().is_empty());
    let message = &rig.control.messages()[0];
    let took_ms = (message.time_us - since_us) / 1000;
    assert!(
        message.number == 2001 && (224..=240).contains(&took_ms),
        "{took_ms} ms"
    );
}

/// P12016 = 2: the driving instruction goes off 2 mm before the axis is there, P12186 with it; backwards it says so in
/// byte 2 [002:7027-7042] [002:8520-8547].
#[test]
fn the_exact_stop_is_that_of_p12016() {
    let mut rig = Rig::on("q2016: 2\n");
    rig.start(1, &x(-40.0));
    rig.until(|rig| rig.exact("P12151") < -10.0);
    assert_eq!(
        (rig.read("P12187"), rig.read("P12186")),
        (f64::from(0x1_0100), 1.0)
    );
    rig.until(|rig| rig.read("P12187") == 0.0);
    let away = rig.exact("P12150") + 40.0;
    assert!((1.0..=2.0).contains(&away), "{away}");
    assert_eq!(rig.read("P12186"), 0.0);
}

/// P12018 = 500 ms [002:7044-7047].
#[test]
fn the_standstill_has_its_time() {
    let mut rig = Rig::on("q2025: -1\nq2018: 500\n");
    rig.start(1, &x(300.0));
    rig.until(|rig| rig.exact("P12151") > 290.0);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = true;
    rig.until(|rig| rig.read("P12151") == 300.0);
    let stands_us = rig.control.now_us();
    rig.until(|rig| !rig.control.messages().is_empty());
    let message = &rig.control.messages()[0];
    let took_ms = (message.time_us - stands_us) / 1000;
    assert!(
        message.number == 2022 && (490..=510).contains(&took_ms),
        "{took_ms} ms"
    );
}

/// Key minus to P12031: byte 2 of P12185. P8754 is the most that P8755 may ask for [002:4013].
#[test]
fn keys_stop_at_the_limits() {
    let mut rig = Rig::on("q2031: -10\n");
    for (name, value) in [
        ("P8754", "300"),
        ("P8755", "1200"),
        ("P8750", "1"),
        ("P8751", "1"),
        ("P8752", "2"),
    ] {
        rig.operator(name, value);
    }
    rig.seconds(0.5);
    assert!(
        (rig.read("P12167") + 300.0).abs() < 0.01,
        "{}",
        rig.read("P12167")
    );
    rig.seconds(3.0);
    assert_eq!((rig.read("P12151"), rig.read("P12185")), (-10.0, 256.0));
}

/// P12132: by P12033 and P12035 the axis goes so far, to P12034 it goes there, at most with the override of P12128
/// [002:8097-8137].
#[test]
fn basic_positions_are_approached() {
    let mut rig = Rig::on("q2033: -8\nq2034: 60\nq2035: -10\nq2128: 7\n");
    rig.plc("P12132", "$0100");
    rig.until(|rig| rig.read("P12182") == 1.0);
    assert_eq!(
        (rig.read("P12151"), rig.control.messages()[0].number),
        (-8.0, 2000)
    );
    rig.plc("P12132", "$010000");
    rig.seconds(0.4);
    // Override 7 is 50 %.
    assert_eq!((rig.read("P12167"), rig.read("P12182")), (3000.0, 0.0));
    rig.until(|rig| rig.read("P12182") == f64::from(0x1_0000));
    assert_eq!(rig.read("P12151"), 60.0);
    rig.plc("P12132", "$01000000");
    rig.until(|rig| rig.read("P12182") == f64::from(0x1_0000));
    assert_eq!(rig.read("P12151"), 50.0);
}

/// P12047 bit 1: axis 2 stops when axis 1 goes to its emergency position, axis 3 goes on [002:7312-7315].
#[test]
fn an_emergency_position_stops_the_named_axes() {
    let mut rig = Rig::on("q2032: -5\nq2047: 2\n");
    rig.plc("P12312", "200");
    rig.plc("2:P12112", "200");
    rig.seconds(0.5);
    rig.plc("P12132", "$1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P12367"), 0.0);
    assert!(rig.read("P12351") < 100.0 && rig.read("2:P12167") == 6000.0);
}

/// P12121 is the speed of P12111, and its override that of P12126, else of P8866; P12122, P12127 and P8867 are those of P12112
/// [002:7930-7932] [002:8002-8004]. Overrides 6 and 7 are 10 and 50 %.
#[test]
fn positions_have_their_own_speeds_and_overrides() {
    let mut rig = Rig::on("q2121: 1200\nq2122: 3000\nP8866: 7\nP8867: 6\n");
    for (name, speeds) in [
        ("P12111", (600.0, 120.0, "P12126", "6")),
        ("P12112", (300.0, 1500.0, "P12127", "7")),
    ] {
        let (of_channel, own, parameter, number) = speeds;
        rig.plc(name, "90");
        rig.seconds(0.5);
        assert_eq!(rig.read("P12167"), of_channel, "{name}");
        rig.plc(parameter, number);
        rig.plc(name, "90");
        rig.seconds(0.5);
        assert_eq!(rig.read("P12167"), own, "{name}");
        rig.plc(name, "--");
        rig.seconds(0.5);
    }
}

/// P12130 byte 4 sets the reference point where the axis is; P12044 byte 2 takes the zero pulse in negative direction alone
/// [002:8018-8042] [002:7241-7276].
#[test]
fn reference_drives_follow_their_logic() {
    let mut rig = Rig::on("q2015: 0\nq2040: 100\nq2044: $0100\n");
    rig.plant.ideal.marks[0] = Some(5000);
    rig.operator("P8755", "600");
    rig.plc("P12130", "$00010001");
    rig.seconds(1.5);
    assert!(rig.plant.ideal.count(0) > 6000 && rig.read("P12180") == 0.0);
    rig.plc("P12130", "$00010100");
    rig.until(|rig| rig.read("P12180") == 1.0);
    let mut rig = Rig::on("q2015: 0\nq2040: 100\n");
    rig.plc("P12130", "$01000000");
    rig.seconds(0.05);
    assert_eq!((rig.read("P12180"), rig.read("P12151")), (1.0, 100.0));
}

/// P8700 = 0, P12140 and P12141: the nominal position is where the axis is, which somebody turns by 500 INC, without a voltage
/// [002:3752-3756] [002:8272-8282].
#[test]
fn without_its_loop_an_axis_is_where_it_is() {
    for (name, value, back) in [
        ("P8700", "0", "1"),
        ("P12140", "$01", "0"),
        ("P12140", "$0100", "0"),
        ("P12141", "$01", "0"),
    ] {
        let mut rig = Rig::answered("", bahn_control900::StandardAnswers::NONE);
        for name in ["P8700", "P8701"] {
            rig.plc(name, "1");
        }
        rig.seconds(0.1);
        rig.plc(name, value);
        rig.seconds(0.1);
        rig.plant.ideal.turn(0, 500);
        rig.seconds(0.1);
        assert_eq!(
            (rig.read("P12151"), rig.plant_volts(0)),
            (0.5, 0.0),
            "{name}: {value}"
        );
        rig.plc(name, back);
        rig.seconds(0.1);
        rig.plant.ideal.turn(0, 500);
        rig.seconds(0.5);
        assert_eq!(rig.read("P12151"), 0.5, "{name} is back: the loop holds it");
    }
}

/// Of slope 2 the default is 20 % of P12004; where both act the lower one counts [002:8237-8246].
#[test]
fn slopes_have_their_speeds() {
    let mut rig = Rig::on("q2005: 300\nq2006: 900\n");
    rig.plc("P12112", "200");
    for (bytes, speed) in [("$0100", 900.0), ("$0101", 300.0), ("$0", 6000.0)] {
        rig.plc("P12136", bytes);
        rig.seconds(0.5);
        assert_eq!(rig.read("P12167"), speed, "{bytes}");
    }
}

/// Area 2 of axis 1: channel 1, reference P60, control P61. 7 is within 10 above it, byte 2 of P12189; so is area 1 with the
/// own position as -2152 [002:7684-7790].
#[test]
fn areas_compare_parameters() {
    let mut rig = Rig::on(
        "q2105: 1\nq2106: 60\nq2107: 61\nq2108: 10\nq2109: -10\nq2100: 1\nq2101: -2152\nq2102: 61\nq2104: 20\n",
    );
    // Within area 1 from 0 to 20, byte 3 of P12188; below, within, above area 2, bytes 1 to 3 of P12189. Where both are equal they
    // are within both ranges.
    for (reference, control, first, second) in [
        ("5", "12", 0x1_0000, 0x100),
        ("5", "5", 0x1_0000, 0x1_0101),
        ("5", "-1", 0, 0x1_0000),
        ("5", "30", 0, 0),
    ] {
        rig.plc("P60", reference);
        rig.plc("P61", control);
        rig.seconds(0.05);
        let bytes = ["P12188", "P12189"].map(|name| rig.read(name) as i32);
        assert_eq!(bytes, [first, second], "{control}");
    }
}

/// P12052: forwards the axis is led so much farther [002:7352-7361].
#[test]
fn a_backlash_moves_the_axis_farther() {
    let mut rig = Rig::on("q2052: 0.042\n");
    let counts = [40.0, 0.0, 20.0].map(|to| {
        rig.start(1, &x(to));
        rig.until_end(1);
        rig.seconds(0.5);
        rig.plant.ideal.count(0)
    });
    assert_eq!(counts, [40_042, 0, 20_042]);
}

/// P12001 = 2 shows the position within P12041 [002:6905-6916].
#[test]
fn a_round_axis_is_shown_within_its_turn() {
    let mut rig = Rig::on("q2001: 2\nq2041: 90\n");
    rig.start(1, &x(100.0));
    rig.until_end(1);
    rig.seconds(0.5);
    assert_eq!(rig.read("P12151"), 10.0);
}

/// P12134 turns axis 5 as a spindle: with P12124 = 36000 degrees/min to either side, at the override 2 by default, else at that of
/// P12129; P12184 says when it is reached, P12174 how fast it is [002:8199-8228].
#[test]
fn the_plc_turns_axes() {
    let mut rig = Rig::on(&(axis(5) + "q2801: 2\nq2804: 360000\nq2924: 36000\nq1318: 100\nq1313: 100\n"));
    let turns = |rig: &mut Rig, speed: f64| {
        rig.seconds(1.5);
        assert!(
            (rig.read("q2974") - speed).abs() < 100.0,
            "{} {speed}",
            rig.read("q2974")
        );
        assert_eq!(rig.read("q2984"), f64::from(speed != 0.0));
    };
    rig.plc("q2934", "$1");
    turns(&mut rig, 36_000.0);
    // Override 2 at half of its potentiometer.
    rig.plc("P11316", "127.5");
    turns(&mut rig, 18_000.0);
    rig.plc("q2929", "1");
    turns(&mut rig, 36_000.0);
    rig.plc("q2934", "$100");
    turns(&mut rig, -36_000.0);
    rig.plc("q2924", "0");
    turns(&mut rig, -360_000.0);
    rig.plc("q2934", "0");
    turns(&mut rig, 0.0);
    assert!(!rig.control.moves());
}

/// P12120 = 1500 limits X on paths, not what the PLC positions.
#[test]
fn paths_have_their_own_greatest_speed() {
    let mut rig = Rig::on("q2120: 1500\n");
    rig.start(1, &[Line::to(&[(Axis::X, 50.0)], 3000.0)]);
    rig.until(|rig| rig.exact("P12151") > 25.0);
    assert!((rig.read("P8938") - 1500.0).abs() < 0.1, "{}", rig.read("P8938"));
    rig.until_end(1);
    rig.plc("P12112", "150");
    rig.until(|rig| rig.exact("P12151") > 100.0);
    assert!((rig.read("P12167") - 6000.0).abs() < 0.1);
}
