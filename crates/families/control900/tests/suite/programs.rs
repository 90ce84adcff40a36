//! Programs from start to end [002:3606-3816].

use bahn_control900::{Mode, StandardAnswers};
use bahn_path::Axis;
use bahn_system900::{Flash, FlashError, Programs};

use crate::support::Rig;
use crate::support::list::{Line, Lines};

/// X to 100 and Y to 50, then both back to 10 and 20.
fn two_lines() -> [Line; 2] {
    [
        Line::to(&[(Axis::X, 100.0), (Axis::Y, 50.0)], 3000.0),
        Line::to(&[(Axis::X, 10.0), (Axis::Y, 20.0)], 3000.0),
    ]
}

#[test]
fn a_program_runs_from_start_to_end() {
    let mut rig = Rig::on("");
    assert_eq!(rig.read("P8685"), 0.0);
    rig.start(1, &two_lines());
    assert_eq!(
        (rig.read("P8684"), rig.read("P8704"), rig.read("P8703")),
        (1.0, 1.0, 2.0)
    );
    rig.until(|rig| rig.read("P12151") > 50.0);
    assert_eq!((rig.read("P8900"), rig.read("P8901")), (1000.0, 10.0));
    // Y goes half as far as X.
    assert!((rig.read("P12351") - rig.read("P12151") / 2.0).abs() < 0.002);
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (10.0, 20.0));
    assert!((rig.read("P12150") - 10.0).abs() < 0.04, "within the exact stop");
    assert_eq!(rig.read("P8685"), 0.0);
    assert_eq!(rig.control.messages(), []);
}

/// Lag [mm] = F [mm/min] / (60 * Kv): 6000 mm/min and Kv 16 give 6.25 mm [002:7085-7091].
#[test]
fn the_lag_is_that_of_the_manual() {
    let mut rig = Rig::on("");
    rig.start(1, &[Line::to(&[(Axis::X, 400.0)], 6000.0)]);
    rig.until(|rig| rig.exact("P12151") > 200.0);
    let lag = rig.exact("P12160");
    assert!((lag - 6000.0 / (60.0 * 16.0)).abs() < 0.01, "{lag}");
    // 9.5 V at the greatest speed.
    assert!((rig.read("P12169") - 9.5).abs() < 0.02, "{}", rig.read("P12169"));
}

/// Feed forward of 50 % halves the lag, of 100 % nothing is left [002:7369-7375].
#[test]
fn feed_forward_takes_lag_away() {
    for (percent, lag) in [("50", 3.125), ("100", 0.0)] {
        let mut rig = Rig::on(&format!("q2050: {percent}\n"));
        rig.start(1, &[Line::to(&[(Axis::X, 400.0)], 6000.0)]);
        rig.until(|rig| rig.exact("P12151") > 200.0);
        let found = rig.exact("P12160");
        assert!((found - lag).abs() < 0.01, "{percent} %: {found}");
    }
}

#[test]
fn two_channels_run_at_once() {
    let mut rig = Rig::on("");
    rig.start(1, &[Line::to(&[(Axis::X, 200.0)], 3000.0)]);
    rig.start(2, &[Line::to(&[(Axis::X, -100.0), (Axis::Y, 40.0)], 3000.0)]);
    assert_eq!((rig.read("P8685"), rig.read("2:P8685")), (2.0, 2.0));
    rig.until_end(1);
    rig.until_end(2);
    let at = ["P12151", "P12351", "2:P12151", "2:P12351"].map(|name| rig.read(name));
    assert_eq!(at, [200.0, 0.0, -100.0, 40.0]);
}

/// Without P8703 in AUTO, P8701 and P8709 nothing starts: P8684 stays 1, P8704 0.
#[test]
fn what_is_missing_refuses_the_start() {
    for missing in ["P8703", "P8701", "P8709"] {
        let mut rig = Rig::answered("", StandardAnswers::NONE);
        rig.load(1, &two_lines());
        for (name, value) in [("P8700", "1"), ("P8701", "1"), ("P8709", "1"), ("P8703", "2")] {
            let value = match (name == missing, name) {
                (true, "P8703") => "1",
                (true, _) => "0",
                (false, _) => value,
            };
            rig.plc(name, value);
        }
        rig.operator("P8682", "2");
        rig.plc("P8704", "1");
        rig.seconds(0.1);
        let state = (rig.read("P8684"), rig.read("P8704"), rig.read("P8685"));
        assert_eq!(state, (1.0, 0.0, 0.0), "{missing}");
    }
}

/// Stop brakes on the ramp of 250 ms: 100 mm/s need 12.5 mm; Start goes on to the end.
#[test]
fn stop_and_start() {
    let mut rig = Rig::on("");
    rig.start(1, &[Line::to(&[(Axis::X, 300.0)], 6000.0)]);
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.operator("P8682", "1");
    let before = rig.exact("P12151");
    rig.seconds(1.0);
    assert_eq!(rig.read("P8685"), 1.0);
    let way = rig.exact("P12151") - before;
    // The PLC answers within 10 ms and a cycle of 4 ms: 1.4 mm more.
    assert!((12.5..=12.5 + 1.4 + 0.1).contains(&way), "{way}");
    rig.operator("P8682", "2");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 300.0);
}

#[test]
fn single_blocks_wait_for_start() {
    let mut rig = Rig::on("");
    rig.load(1, &two_lines());
    // P8683 prints 3 for single blocks, P8703 4.
    rig.operator("P8683", "3");
    rig.seconds(0.05);
    assert_eq!((rig.read("P8703"), rig.control.mode(1)), (4.0, Mode::Single));
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8685") == 2.0);
    rig.until(|rig| rig.read("P8685") == 1.0);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (100.0, 50.0));
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P12151") == 10.0);
}

/// An abort keeps program and block; the axes come down.
#[test]
fn an_abort_keeps_its_place() {
    let mut rig = Rig::on("");
    rig.start(1, &two_lines());
    rig.until(|rig| rig.read("P8901") == 20.0);
    rig.plc("P8705", "1");
    rig.seconds(0.5);
    let kept = ["P8685", "P8802", "P8803", "P8906", "P8907"].map(|name| rig.read(name));
    assert_eq!(kept, [0.0, 1000.0, 20.0, 1000.0, 20.0]);
    let x = rig.read("P12151");
    rig.seconds(0.5);
    assert_eq!(rig.read("P12151"), x, "it stands");
    assert!(x > 10.0 && x < 100.0);
    rig.start(1, &two_lines());
    rig.until_end(1);
    assert_eq!((rig.read("P8906"), rig.read("P12151")), (0.0, 10.0));
}

/// P8801 is the block with which it starts.
#[test]
fn a_start_block_is_where_it_begins() {
    let mut rig = Rig::on("");
    rig.operator("P8801", "20");
    rig.start(1, &two_lines());
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (10.0, 20.0));
    assert_eq!(rig.read("P8901"), 20.0);
}

/// Network 1 with channels 1 and 2: the stop key of one stops both, and both change their mode [002:1276-1298].
#[test]
fn a_network_changes_mode_and_stops_together() {
    let mut rig = Rig::on("q903: $3\nq904: $3\nq905: $3\n");
    let line = [Line::to(&[(Axis::X, 300.0)], 3000.0)];
    rig.load(2, &line);
    rig.start(1, &line);
    assert_eq!(rig.read("2:P8703"), 2.0);
    rig.operator("2:P8682", "2");
    rig.until(|rig| rig.read("2:P8685") == 2.0);
    rig.operator("P8682", "1");
    rig.seconds(0.5);
    assert_eq!((rig.read("P8685"), rig.read("2:P8685")), (1.0, 1.0));
    rig.plc("2:P8705", "1");
    rig.seconds(0.1);
    assert_eq!((rig.read("P8685"), rig.read("2:P8685")), (0.0, 0.0));
}

/// Override 1 at half of its potentiometer: 127 * 120 / 255 = 59.8 %; F 3000 becomes 1793 mm/min.
#[test]
fn the_override_acts_on_the_path() {
    let mut rig = Rig::on("q1313: 120\n");
    rig.operator("P11311", "127");
    rig.start(1, &[Line::to(&[(Axis::X, 100.0)], 3000.0)]);
    rig.until(|rig| rig.exact("P12151") > 50.0);
    let feed = 3000.0 * 127.0 * 120.0 / 255.0 / 100.0;
    assert!((rig.read("P8938") - feed).abs() < 0.1, "{}", rig.read("P8938"));
    // Of the table it is the value of place 127 * 27 / 256 = 13: 55 %.
    rig.operator("P11314", "11370");
    rig.operator("P11311", "127");
    assert_eq!(rig.read("P11310"), 55.0);
}

/// P8817 = 4500 takes the place of F 3000 until the end of its block, with the override of 50 %; the next block has F 3000 again
/// [002:4294-4296].
#[test]
fn p8817_is_the_feed_of_its_block() {
    let mut rig = Rig::on("q1313: 100\n");
    rig.plc("P11311", "127.5");
    let line = |x: f64| Line::to(&[(Axis::X, x)], 3000.0);
    rig.start(1, &[line(100.0), line(200.0)]);
    rig.until(|rig| rig.exact("P12151") > 20.0);
    assert!((rig.read("P8938") - 1500.0).abs() < 0.1, "{}", rig.read("P8938"));
    rig.plc("P8817", "4500");
    rig.until(|rig| rig.exact("P12151") > 60.0);
    assert!((rig.read("P8938") - 2250.0).abs() < 0.1, "{}", rig.read("P8938"));
    rig.until(|rig| rig.exact("P12151") > 130.0);
    assert!((rig.read("P8938") - 1500.0).abs() < 0.1, "{}", rig.read("P8938"));
}

/// A clone goes on with the same bits.
#[test]
fn a_clone_goes_on_alike() {
    let mut rig = Rig::on("");
    rig.start(1, &two_lines());
    rig.until(|rig| rig.read("P12151") > 30.0);
    let mut other = rig.clone();
    for _ in 0..500 {
        rig.cycle();
        other.cycle();
        assert_eq!(rig.exact("P12150").to_bits(), other.exact("P12150").to_bits());
        assert_eq!(rig.exact("P12160").to_bits(), other.exact("P12160").to_bits());
    }
}

/// P8712 calls emergency program 3, which nobody has: what runs is broken off with a message, not gone on with.
#[test]
fn an_emergency_program_that_is_not_there_is_said() {
    let mut rig = Rig::on("");
    rig.start(1, &[Line::to(&[(Axis::X, 300.0)], 3000.0)]);
    rig.until(|rig| rig.read("P12151") > 50.0);
    rig.plc("P8712", "1");
    rig.seconds(1.0);
    assert_eq!(rig.read("P8685"), 0.0);
    let x = rig.read("P12151");
    // It comes down from 50 mm/s.
    assert!((50.0..60.0).contains(&x), "{x}");
    let said: Vec<String> = rig.control.pending_messages(1).map(ToString::to_string).collect();
    assert_eq!(said, ["emergency program 3 is not there, channel 1"]);
}

/// P8700 goes in the middle of a path, and the axis is pushed away: the program stops, nothing of the path is left out. START leads the
/// axis back to where the path was left.
#[test]
fn released_loops_stop_the_program() {
    let mut rig = Rig::answered(
        "",
        StandardAnswers {
            enable: false,
            ..StandardAnswers::ALL
        },
    );
    for name in ["P8700", "P8701", "P8709"] {
        rig.plc(name, "1");
    }
    rig.start(1, &two_lines());
    rig.until(|rig| rig.read("P12151") > 40.0);
    rig.plc("P8700", "0");
    rig.seconds(0.2);
    assert_eq!(rig.read("P8685"), 1.0);
    let [x, y] = ["P12151", "P12351"].map(|name| rig.read(name));
    // The nominal position is the actual one now, which lagged by 50 mm/s / 16/s in the path, less in X.
    assert!((36.0..42.0).contains(&x), "{x}");
    // 5 mm at 1000 increments a mm.
    rig.plant.ideal.turn(0, 5000);
    rig.seconds(0.1);
    assert!((rig.read("P12151") - x - 5.0).abs() < 0.01, "it follows");
    // Nothing starts without loops.
    rig.operator("P8682", "2");
    rig.seconds(0.1);
    assert_eq!(rig.read("P8685"), 1.0);
    rig.plc("P8700", "1");
    rig.seconds(0.1);
    assert_eq!(rig.read("P8685"), 1.0);
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8901") == 20.0);
    // The first line was passed to its end.
    let [now_x, now_y] = ["P12151", "P12351"].map(|name| rig.read(name));
    assert!(
        (now_x - 100.0).abs() < 0.1 && (now_y - 50.0).abs() < 0.1,
        "{now_x} {now_y}, from {x} {y}"
    );
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (10.0, 20.0));
}

/// A program that was broken off while its loops were released leaves nothing behind: the next one moves its axes.
#[test]
fn a_program_after_released_loops_moves_its_axes() {
    let mut rig = Rig::answered(
        "",
        StandardAnswers {
            enable: false,
            ..StandardAnswers::ALL
        },
    );
    for name in ["P8700", "P8701", "P8709"] {
        rig.plc(name, "1");
    }
    rig.start(1, &two_lines());
    rig.until(|rig| rig.read("P12151") > 40.0);
    rig.plc("P8700", "0");
    rig.seconds(0.2);
    rig.plc("P8705", "1");
    rig.seconds(0.1);
    rig.plc("P8700", "1");
    rig.seconds(0.1);
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8901") == 20.0);
    let [x, y] = ["P12151", "P12351"].map(|name| rig.read(name));
    assert!((x - 100.0).abs() < 0.1 && (y - 50.0).abs() < 0.1, "{x} {y}");
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P12351")), (10.0, 20.0));
}

/// Emergency program 1 interrupts the one that runs, whose place is kept, and is started with its block P8821; the mode AUTO
/// stays, P8710 is 0 again [002:3856-3873].
#[test]
fn an_emergency_program_interrupts() {
    let mut rig = Rig::on("");
    let away = [
        Line::to(&[(Axis::Y, 99.0)], 3000.0),
        Line::to(&[(Axis::Y, -15.0)], 3000.0),
    ];
    rig.control.set_emergency_program(1, 1, Some(Lines::boxed(&away)));
    rig.operator("P8820", "99");
    rig.operator("P8821", "20");
    rig.start(1, &[Line::to(&[(Axis::X, 300.0)], 3000.0)]);
    rig.until(|rig| rig.read("P12151") > 50.0);
    rig.plc("P8710", "1");
    rig.until(|rig| rig.read("P8900") == 99.0);
    assert_eq!(
        (rig.read("P8802"), rig.read("P8710"), rig.read("P8703")),
        (1000.0, 0.0, 2.0)
    );
    rig.until_end(1);
    assert_eq!(rig.read("P12351"), -15.0);
    let x = rig.read("P12151");
    assert!((50.0..60.0).contains(&x), "{x}");
    // The next start is that of P8800 again.
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8685") == 2.0);
    rig.until_end(1);
    assert_eq!((rig.read("P12151"), rig.read("P8900")), (300.0, 1000.0));
}

/// The event buffer of a run in which P11271 asks for the PLC, M functions and blocks, with a transfer to the PLC, an entry and a
/// message [002:6064-6198]: what came when, as the control puts it out.
#[test]
fn events_are_recorded() {
    let mut rig = Rig::on("P11271: $111\n");
    rig.operator("P11279", "12345");
    rig.start(
        1,
        &[
            Line::to(&[(Axis::X, 10.0)], 3000.0),
            Line::to(&[(Axis::X, 20.0)], 3000.0),
        ],
    );
    rig.until_end(1);
    rig.plc("P8503", "3498");
    let events: Vec<String> = rig
        .control
        .events()
        .records()
        .map(|record| record.event.to_string())
        .collect();
    let at = |event: &str| events.iter().position(|of| of == event);
    assert_eq!(at("======== system boot ============="), Some(0));
    let order = [
        "P11279: 12345",
        "PARA CNC --> PLC K1 P8683: 2",
        "PARA CNC <-- PLC K1 P8703: 2",
        "PARA CNC --> PLC K1 P8684: 1",
        "PARA CNC <-- PLC K1 P8704: 1",
        "PARA CNC --> PLC K1 P8685: 2",
        "PROG: K1 P1000 N10",
        "PROG: K1 P1000 N20",
        "PARA CNC --> PLC K1 P8685: 0",
        "PARA CNC <-- PLC K1 P8503: 3498",
        "K1 message: M3498",
    ];
    let places: Vec<Option<usize>> = order.iter().map(|event| at(event)).collect();
    assert!(
        places.iter().all(Option::is_some) && places.is_sorted(),
        "{places:?}: {events:#?}"
    );
}

/// q10 = 170 stores what is marked in HAND alone [002:403-463].
#[test]
fn functions_of_the_flash_are_executed_in_hand() {
    let mut rig = Rig::on("P51: 7 $20000401\n");
    let (mut flash, mut programs) = (Flash::default(), Programs::default());
    rig.operator("q10", "170");
    let function = rig.control.take_function();
    assert_eq!((function, rig.control.take_function()), (Some(170), None));
    assert_eq!(rig.control.execute(170, &mut flash, &mut programs), Ok(1));
    rig.operator("P51", "8");
    assert_eq!(rig.control.execute(200, &mut flash, &mut programs), Ok(1));
    assert_eq!(rig.read("P51"), 7.0);
    rig.operator("P8683", "2");
    rig.seconds(0.1);
    assert_eq!(
        rig.control.execute(170, &mut flash, &mut programs),
        Err(FlashError::NotInHand)
    );
    let said: Vec<String> = rig.control.pending_messages(1).map(ToString::to_string).collect();
    assert_eq!(said, ["q10: the machine is not in HAND, channel 1"]);
}
