//! Parameters of axes, channels and devices, one after the other: what each does while the control runs.

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::{Axis, Position};
use bahn_text::MemoryFiles;

use crate::support::list::{Line, Lines};
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

/// P8762 points into the table of P8763 ff., from 0 on; P8761 takes the next one and shows it in P8760 [002:4053-4076].
#[test]
fn steps_are_those_of_the_table() {
    let mut rig = Rig::on("");
    for (name, value) in [
        ("P8750", "2"),
        ("P8751", "1"),
        ("P8764", "5"),
        ("P8765", "2.5"),
        ("P8762", "1"),
    ] {
        rig.operator(name, value);
    }
    rig.operator("P8752", "1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P12151"), 5.0);
    rig.operator("P8761", "1");
    assert_eq!(
        ["P8760", "P8761", "P8762"].map(|name| rig.read(name)),
        [2.5, 0.0, 2.0]
    );
    rig.operator("P8752", "1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P12151"), 7.5);
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
    for (reference, control, second) in [
        ("5", "12", 0x100),
        ("5", "5", 0x1_0101),
        ("5", "-1", 0x1_0000),
        ("5", "30", 0),
    ] {
        rig.plc("P60", reference);
        rig.plc("P61", control);
        rig.seconds(0.05);
        let first = rig.read("P12188");
        let is_within = matches!(control, "12" | "5");
        assert_eq!(first, f64::from(u32::from(is_within) << 16), "{control}");
        let bytes = rig.read("P12189") as i32;
        // Where both are equal they are within both ranges.
        let expected = if control == "5" {
            bytes & 1 | 0x1_0100
        } else {
            second
        };
        assert_eq!(
            (bytes, bytes & 1),
            (expected, i32::from(control == "5")),
            "{control}"
        );
    }
}

/// P7000, P7064 and P7096 hold by logical axes what the axes show [002:1543-1563].
#[test]
fn positions_stand_by_logical_axes() {
    let mut rig = Rig::on("");
    rig.operator("P12153", "3");
    rig.operator("P12353", "4");
    rig.start(1, &[Line::to(&[(Axis::X, 40.0), (Axis::Y, 20.0)], 3000.0)]);
    rig.until(|rig| rig.exact("P12151") > 10.0);
    assert_eq!(["P7064", "P7065"].map(|name| rig.read(name)), [40.0, 20.0]);
    for (table, own) in [
        ("P7096", "P12156"),
        ("P7097", "P12356"),
        ("P7000", "P12153"),
        ("P7001", "P12353"),
    ] {
        assert_eq!(rig.read(table), rig.read(own), "{table}");
    }
    assert!((20.0..30.0).contains(&rig.read("P7096")));
    assert_eq!(rig.read("P7001"), 4.0);
}

/// P8865 names the override of the path: 7 is 50 %. P8936 is F, P8940 its G function [002:4690-4693] [002:4894-4913].
#[test]
fn the_path_has_its_override_and_shows_its_feed() {
    let mut rig = Rig::on("P8865: 7\n");
    rig.start(
        1,
        &[
            Line::to(&[(Axis::X, 60.0)], 3000.0),
            Line {
                to: vec![(Axis::X, 0.0)],
                ..Line::default()
            },
        ],
    );
    rig.until(|rig| rig.exact("P12151") > 20.0);
    assert_eq!(
        ["P8936", "P8938", "P8940"].map(|name| rig.read(name)),
        [3000.0, 1500.0, 1.0]
    );
    rig.until(|rig| rig.read("P8901") == 20.0);
    assert_eq!(rig.read("P8940"), 0.0);
}

/// The other overrides are as the first one: potentiometer, least, greatest, own table of three values [002:6375-6402].
#[test]
fn overrides_are_all_alike() {
    for first in [11_310, 11_315, 11_320, 11_325] {
        let mut rig = Rig::on("P11370: 3\nP11371: 0\nP11372: 50\nP11373: 80\n");
        let of = |offset: u32| format!("P{}", first + offset);
        rig.plc(&of(2), "20");
        rig.plc(&of(3), "75");
        let percent = |rig: &mut Rig, raw: &str| {
            rig.operator(&of(1), raw);
            rig.read(&of(0))
        };
        assert_eq!([percent(&mut rig, "0"), percent(&mut rig, "255")], [20.0, 75.0]);
        rig.plc(&of(4), "11370");
        // floor(127 * 3 / 256) = 1, floor(255 * 3 / 256) = 2 with 80 %, of which 75 are allowed.
        assert_eq!([percent(&mut rig, "127"), percent(&mut rig, "255")], [50.0, 75.0]);
    }
}

/// Handwheels 1 to 8 at encoders 9 to 16: 300 INC with 100 INC/mm to the other side move X by -3 mm, three times as much with
/// P11404 = 3 [002:6448-6473].
#[test]
fn handwheels_are_all_alike() {
    for wheel in 0..8 {
        let first = 1400 + 10 * wheel;
        let set = format!(
            "q{first}: {}\nq{}: 1\nq{}: 1\nq{}: -100\n",
            9 + wheel,
            first + 1,
            first + 2,
            first + 3
        );
        let mut rig = Rig::on(&set);
        rig.plant.ideal.turn(8 + wheel as usize, 300);
        rig.seconds(1.0);
        assert_eq!(rig.read("P12151"), -3.0, "{wheel}");
        rig.plc(&format!("q{}", first + 4), "3");
        rig.plant.ideal.turn(8 + wheel as usize, 300);
        rig.seconds(1.0);
        assert_eq!(rig.read("P12151"), -12.0, "{wheel}");
        rig.plc(&format!("q{}", first + 2), "0");
        rig.seconds(0.1);
        rig.plant.ideal.turn(8 + wheel as usize, 300);
        rig.seconds(0.5);
        assert_eq!(rig.read("P12151"), -12.0, "{wheel} is not active");
    }
}

/// Couplings 2 to 8: the slave, physical axis 3, comes to 5 + 20 / 10 * master, and both stop when it is 1 mm off for 100 ms
/// [002:6520-6573].
#[test]
fn couplings_are_all_alike() {
    for coupling in 0..8 {
        let of = |offset: u32| format!("q{}", 1480 + 20 * coupling + offset);
        let set = [
            (0, 1),
            (1, 3),
            (4, 1),
            (5, 100),
            (10, 1),
            (11, 7),
            (12, 20),
            (13, 10),
        ];
        let set: String = set
            .iter()
            .map(|(offset, value)| format!("{}: {value}\n", of(*offset)))
            .collect();
        let mut rig = Rig::on(&format!("{set}q2425: -1\n"));
        rig.plc(&of(15), "2");
        rig.until(|rig| rig.read(&of(16)) == 2.0);
        rig.start(1, &[Line::to(&[(Axis::X, 10.0)], 1500.0)]);
        rig.until_end(1);
        rig.seconds(0.5);
        // 7 + 2 * (10 - 1).
        assert!(
            (rig.read("2:P12151") - 25.0).abs() < 0.001,
            "{coupling}: {}",
            rig.read("2:P12151")
        );
        rig.start(1, &[Line::to(&[(Axis::X, 100.0)], 1500.0)]);
        rig.until(|rig| rig.read("P12151") > 20.0);
        rig.plant.ideal.drives[2].as_mut().unwrap().is_dead = true;
        rig.until(|rig| !rig.control.messages().is_empty());
        assert_eq!(&*rig.control.messages()[0].text, "coupling error", "{coupling}");
        rig.plc(&of(15), "0");
        rig.seconds(0.1);
        assert_eq!(rig.read(&of(16)), 0.0);
    }
}

/// Spindles 1 to 8 on physical axis 5: at most 400 rpm, reached within 50 % of it, that is before it is at 400; 2 goes to the
/// reset position of 90 degrees [002:6575-6627].
#[test]
fn spindles_are_all_alike() {
    for spindle in 0..8 {
        let of = |offset: u32| format!("q{}", 1640 + 20 * spindle + offset);
        let set = [(0, 5), (5, 400), (8, 500), (12, 90), (13, 50)];
        let set: String = set
            .iter()
            .map(|(offset, value)| format!("{}: {value}\n", of(*offset)))
            .collect();
        let mut rig = Rig::on(&(axis(5) + "q2801: 2\nq2804: 360000\n" + &set));
        rig.plc(&of(10), "1");
        rig.until(|rig| rig.read(&of(11)) == 1.0);
        let reached = rig.read(&of(9));
        assert!((200.0..300.0).contains(&reached), "{spindle}: {reached}");
        rig.seconds(1.0);
        assert!(
            (rig.read(&of(9)) - 400.0).abs() < 0.5,
            "{spindle}: {}",
            rig.read(&of(9))
        );
        rig.plc(&of(10), "2");
        rig.until(|rig| rig.read(&of(11)) == 2.0);
        assert!(
            (rig.read("q2950") - 90.0).abs() < 0.1,
            "{spindle}: {}",
            rig.read("q2950")
        );
        rig.plc(&of(10), "0");
        rig.seconds(0.1);
        assert_eq!(rig.read(&of(11)), 0.0);
    }
}

/// P8711 to P8713 call the programs of P8822, P8824, P8826 with the blocks behind them [002:3875-3882] [002:4306-4314].
#[test]
fn every_emergency_program_has_its_call() {
    for which in 0..4u32 {
        let mut rig = Rig::on("");
        let away = [
            Line::to(&[(Axis::Y, 99.0)], 3000.0),
            Line::to(&[(Axis::Y, -15.0)], 3000.0),
        ];
        rig.control
            .set_emergency_program(1, which as u8 + 1, Some(Lines::boxed(&away)));
        rig.operator(&format!("P{}", 8820 + 2 * which), "99");
        rig.operator(&format!("P{}", 8821 + 2 * which), "20");
        rig.start(1, &x(300.0));
        rig.until(|rig| rig.read("P12151") > 50.0);
        let call = format!("P{}", 8710 + which);
        rig.plc(&call, "1");
        rig.until(|rig| rig.read("P8900") == 99.0);
        assert_eq!(rig.read(&call), 0.0);
        rig.until_end(1);
        assert_eq!(
            (rig.read("P8801").is_nan(), rig.read("P12351")),
            (true, -15.0),
            "{call}"
        );
    }
}

/// P8504 names the axis of a message [002:3372].
#[test]
fn a_message_has_its_axis() {
    let mut rig = Rig::on("");
    rig.plc("P8504", "2");
    rig.plc("P8503", "3498");
    let message = &rig.control.messages()[0];
    assert_eq!((message.number, message.axis), (3498, Some(2)));
}

/// P8046 copies the spindle tool, or that of the PLC, to that which the path is computed with; P8045:1 copies the latter to both
/// others; customer data and all [002:1741-1777].
#[test]
fn tools_are_copied_as_ordered() {
    let mut data = String::new();
    for at in 0..50 {
        data += &format!("P{}: {}\nP{}: {}\n", 8050 + at, 100 + at, 8100 + at, 200 + at);
    }
    let mut rig = Rig::on(&data);
    let block = |rig: &Rig, first: u32| {
        (0..50)
            .map(|at| rig.read(&format!("P{}", first + at)))
            .collect::<Vec<_>>()
    };
    let counted = |first: u32| (0..50).map(|at| f64::from(first + at)).collect::<Vec<_>>();
    rig.plc("P8046", "1");
    assert_eq!(block(&rig, 8150), counted(200));
    rig.plc("P8046", "2");
    assert_eq!(block(&rig, 8150), counted(100));
    rig.plc("P8046", "1");
    rig.plc("P8045", "1");
    assert_eq!(
        [8100, 8150].map(|first| block(&rig, first)),
        [counted(100), counted(100)]
    );
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

/// Runs a program of channel 1 with X, Y and Z, physical axis 5, and 2000 parameters from P20000 on.
fn ran(more: &str, text: &str) -> Rig {
    let space = "q103: 300\nq3: 40000\nq104: 30000\nq105: 2000\nq112: $0305005A\nP11051: $10050601\n";
    let mut rig = Rig::on(&(axis(5) + space + more));
    let beside = Arc::new(MemoryFiles::default());
    let program = Reader900::new("P1000.900", text.as_bytes(), 1, Position::ZERO, beside);
    rig.operator("P8800", "1000");
    rig.control.set_program(1, Some(Box::new(program)));
    rig.operator("P8683", "2");
    rig.seconds(0.05);
    rig.operator("P8682", "2");
    rig.until_end(1);
    assert_eq!(rig.control.messages(), []);
    rig
}

/// P8555 = 2: G54 of the second area, which begins behind 2 groups of 7 points with 3 axes: P20042 + 3 [002:978-1022].
#[test]
fn p8555_chooses_the_work_area() {
    let areas = "q170: 20000\nq171: 2\nq172: 1\nq173: 3\nq174: 0\nP20003: 50\nP20045: 100\n";
    for (chosen, x) in [("P8555: 1\n", 51.0), ("P8555: 2\n", 101.0)] {
        let rig = ran(&format!("{areas}{chosen}"), "N10 G54 G1 X1 F6000\nN20 M30\n");
        assert_eq!(rig.read("P12151"), x, "{chosen}");
    }
}

/// T2 M6: the record of the tool goes to P8050 and P8150 whole, to P8200 and, by the standard answer, to P8100 without the data of
/// the customer; the path has length and radius with their corrections [002:1806-1997].
#[test]
fn a_tool_goes_through_its_records() {
    let record = [
        2.0, 7.0, 3.0, 1.0, 4.0, 11.0, 12.0, 13.0, 0.0, 14.0, 5.0, 100.0, 0.5, 0.25, 3.0, 9.0, 8.0,
    ];
    let data: String = (20_120..)
        .zip(record)
        .map(|(number, value)| format!("P{number}: {value}\n"))
        .collect();
    let layout = "q175: 20100\nq176: 2\nq178: 20\n";
    let rig = ran(
        &format!("{layout}{data}"),
        "N10 T2 M6\nN20 G1 Z1 F6000\nN30 G41 X10\nN40 X50\nN50 M30\n",
    );
    assert_eq!(["P8048", "P8049"].map(|name| rig.read(name)), [2.0, 6.0]);
    let block = |first: u32, count: u32| {
        (first..first + count)
            .map(|at| rig.read(&format!("P{at}")))
            .collect::<Vec<_>>()
    };
    for first in [8050, 8150] {
        assert_eq!(block(first, 17), record, "P{first}");
    }
    for first in [8200, 8100] {
        assert_eq!(block(first, 15), record[..15], "P{first}");
    }
    assert_eq!(["P12551", "P12351"].map(|name| rig.read(name)), [101.25, 5.5]);
}

/// q150 and q151 are the letters of radius and angle: U10 V90 is Y 10 [002:883-884].
#[test]
fn polar_words_have_their_letters() {
    let rig = ran("q150: 85\nq151: 86\n", "N10 G10 G1 U10 V90 F6000\nN20 M30\n");
    assert_eq!(["P12151", "P12351"].map(|name| rig.read(name)), [0.0, 10.0]);
}

/// P8841 and P8842 are the planes of G118 and G119, q152 that of G17: here with Z alone as normal, in which a tool has its
/// length [002:891-908] [002:4354-4366].
#[test]
fn planes_are_those_of_their_parameters() {
    let tool = "q175: 20100\nq176: 2\nq178: 20\nP20120: 2\nP20131: 30\n";
    for (plane, word) in [
        ("P8841", "G118"),
        ("P8842", "G119"),
        ("q152", "G17"),
        ("q153", "G18"),
        ("q154", "G19"),
    ] {
        // Logical axes 3 and 1 in the plane, 2 is its normal.
        let program = format!("N10 {word}\nN20 T2 M16\nN30 G1 Y1 F6000\nN40 M30\n");
        let rig = ran(&format!("{tool}{plane}: $00020103\n"), &program);
        assert_eq!(rig.read("P12351"), 31.0, "{plane}");
    }
}

/// P8859 byte 1 bit 1: G45 turns the shift of G92, or does not. 90 degrees lead (11, 0) to (0, 11), and (1, 0) to (0, 1), to
/// which 10 are added [002:4665-4671].
#[test]
fn p8859_says_whether_g92_is_turned() {
    let text = "N10 G92 X10\nN20 G45 P160:0 P161:0 P163:90\nN30 G1 X1 Y0 F6000\nN40 M30\n";
    for (more, place) in [("", [0.0, 11.0]), ("P8859: $2\n", [10.0, 1.0])] {
        let rig = ran(more, text);
        assert_eq!(["P12151", "P12351"].map(|name| rig.read(name)), place, "{more}");
    }
}

/// P8860 byte 1 is the spindle whose turns G95 counts: 0.2 mm of 1000 rpm, or of 500 rpm [002:4672-4678].
#[test]
fn p8860_names_the_spindle_of_g95() {
    for (more, feed) in [("", 200.0), ("P8860: $2\n", 100.0)] {
        let rig = ran(more, "N10 S1000 S2:500\nN20 F0.2 G95 G1 X1\nN30 M30\n");
        assert_eq!(rig.read("P8936"), feed, "{more}");
    }
}
