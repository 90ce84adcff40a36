//! What watches the axes [002:7044-7127] [002:6893-6903].

use bahn_control900::Kind;
use bahn_path::Axis;

use crate::support::Rig;
use crate::support::list::{Line, Lines};

fn far() -> [Line; 1] {
    [Line::to(&[(Axis::X, 300.0)], 6000.0)]
}

/// Until a message comes: number, channel, logical axis, kind.
fn message(rig: &mut Rig) -> (u32, u8, Option<u8>, Kind) {
    rig.until(|rig| !rig.control.messages().is_empty());
    let message = &rig.control.messages()[0];
    (message.number, message.channel, message.axis, message.kind)
}

/// A drive that does not move: at 100 mm/s the lag passes 1.5 times 6.25 mm after 31 ms, and 50 ms later comes M2001.
#[test]
fn a_lag_that_lasts_is_m2001() {
    let mut rig = Rig::on("");
    rig.start(1, &far());
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = true;
    let since_us = rig.control.now_us();
    assert_eq!(message(&mut rig), (2001, 1, Some(1), Kind::High));
    let took_ms = (rig.control.messages()[0].time_us - since_us) / 1000;
    assert!((81..=95).contains(&took_ms), "{took_ms} ms");
    assert_eq!(
        (rig.read("P12197"), rig.read("P12198"), rig.read("P12199")),
        (2001.0, 1.0, 1.0)
    );
    rig.seconds(0.5);
    assert_eq!(
        (rig.read("P8685"), rig.read("P8802")),
        (0.0, 1000.0),
        "the program is broken off"
    );
}

/// While its message stands, START does nothing; acknowledged with HAND, the program starts again.
#[test]
fn nothing_starts_under_a_message() {
    let mut rig = Rig::on("");
    rig.start(1, &far());
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = true;
    message(&mut rig);
    rig.seconds(0.5);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = false;
    rig.seconds(2.0);
    rig.operator("P8682", "2");
    rig.seconds(0.5);
    assert_eq!((rig.read("P8685"), rig.read("P8704")), (0.0, 0.0));
    rig.operator("P8683", "1");
    rig.seconds(0.1);
    rig.operator("P8683", "2");
    rig.seconds(0.1);
    rig.operator("P8682", "2");
    rig.until(|rig| rig.read("P8685") == 2.0);
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 300.0);
}

/// An emergency program moves no axis whose drive has failed, though its message is pending already.
#[test]
fn an_emergency_program_moves_no_failed_axis() {
    let mut rig = Rig::on("");
    rig.control
        .set_emergency_program(1, 1, Some(Lines::boxed(&far())));
    rig.start(1, &far());
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = true;
    message(&mut rig);
    rig.seconds(0.5);
    let stands = rig.exact("P12151");
    rig.plc("P8710", "1");
    rig.seconds(1.0);
    assert_eq!((rig.read("P8685"), rig.control.messages().len()), (0.0, 1));
    let moved = rig.exact("P12151") - stands;
    assert!(moved.abs() < 0.01, "{moved}");
}

/// P12025 = -1 switches it off; what stays is that the axis does not come to a standstill within 3 s.
#[test]
fn an_axis_that_does_not_arrive_is_m2022() {
    let mut rig = Rig::on("q2025: -1\n");
    rig.start(1, &far());
    rig.until(|rig| rig.exact("P12151") > 290.0);
    rig.plant.ideal.drives[0].as_mut().unwrap().is_dead = true;
    rig.until(|rig| rig.read("P12151") == 300.0);
    let stands_us = rig.control.now_us();
    assert_eq!(message(&mut rig), (2022, 1, Some(1), Kind::High));
    let took_ms = (rig.control.messages()[0].time_us - stands_us) / 1000;
    assert!((2990..=3010).contains(&took_ms), "{took_ms} ms");
}

/// Of 9.5 V at the greatest speed 5 V are admissible: M2002, and 0 V. Without P12142 nothing watches.
#[test]
fn a_voltage_that_is_not_admissible_is_m2002() {
    let mut rig = Rig::on("q2026: 5\nq2142: 1\n");
    rig.start(1, &far());
    assert_eq!(message(&mut rig), (2002, 1, Some(1), Kind::High));
    rig.cycle();
    assert_eq!(rig.plant_volts(0), 0.0);
    let mut rig = Rig::on("q2026: 5\n");
    rig.start(1, &far());
    rig.until_end(1);
    assert_eq!(rig.control.messages(), []);
}

#[test]
fn an_axis_that_must_not_move_is_m2020() {
    let mut rig = Rig::on("q2000: 2\n");
    rig.start(1, &far());
    assert_eq!(message(&mut rig), (2020, 1, Some(1), Kind::High));
}

/// The change to HAND acknowledges, with q157 = 1 only P8508 does.
#[test]
fn messages_are_acknowledged() {
    for (more, by_hand) in [("", true), ("q157: 1\n", false)] {
        let mut rig = Rig::on(&format!("q2000: 2\n{more}"));
        rig.start(1, &far());
        message(&mut rig);
        rig.operator("P8683", "1");
        rig.seconds(0.1);
        assert_eq!(rig.control.pending_messages(1).count(), usize::from(!by_hand));
        rig.operator("P8508", "1");
        assert_eq!(rig.control.pending_messages(1).count(), 0);
    }
}

/// Messages of the PLC: system breaks all off, high its channel, low stops it, display does nothing.
#[test]
fn messages_do_what_their_kind_says() {
    for (name, kind, states) in [
        ("P8500", Kind::System, (0.0, 0.0)),
        ("P8501", Kind::High, (0.0, 2.0)),
        ("P8502", Kind::Low, (1.0, 2.0)),
        ("P8503", Kind::Display, (2.0, 2.0)),
    ] {
        let mut rig = Rig::on("");
        rig.start(1, &far());
        rig.start(2, &far());
        rig.plc(name, "3498");
        rig.seconds(0.1);
        assert_eq!((rig.read("P8685"), rig.read("2:P8685")), states, "{name}");
        assert_eq!(message(&mut rig), (3498, 1, None, kind));
    }
}

/// The axis comes down on its ramp, and its loop opens; when the voltage is back, the acknowledgement closes it.
#[test]
fn an_emergency_stop_opens_the_loops() {
    let mut rig = Rig::on("");
    rig.start(1, &far());
    rig.until(|rig| rig.exact("P12151") > 100.0);
    rig.plant.pressed = true;
    let (_, _, _, kind) = message(&mut rig);
    assert_eq!(kind, Kind::System);
    rig.seconds(1.0);
    assert_eq!((rig.plant_volts(0), rig.read("P8685")), (0.0, 0.0));
    rig.plant.pressed = false;
    rig.seconds(0.1);
    rig.operator("P8683", "1");
    rig.seconds(0.1);
    rig.start(1, &far());
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 300.0);
}

/// A block beyond the software limit is refused before it moves: its number is in P8911.
#[test]
fn a_program_does_not_leave_the_software_limits() {
    let mut rig = Rig::on("q2030: 50\nq2031: -10\n");
    let to = |x| Line::to(&[(Axis::X, x)], 3000.0);
    rig.start(1, &[to(40.0), to(50.1)]);
    let (_, channel, axis, kind) = message(&mut rig);
    assert_eq!((channel, axis, kind), (1, Some(1), Kind::High));
    rig.seconds(0.5);
    assert_eq!(
        ["P8910", "P8911", "P12151", "P8685"].map(|name| rig.read(name)),
        [1000.0, 20.0, 40.0, 0.0]
    );
}

/// The example of the manual: axis 1 watches axis 2, by P12102 = 2350; within 10 mm above it byte 2 is set
/// [002:7773-7790]. Beside each other X, which comes from below, is a little short of Y.
#[test]
fn areas_are_watched() {
    let mut rig = Rig::on("q2102: 2350\nq2103: 10\nq2104: -5\n");
    for (x, y, bytes) in [
        (0.0, 20.0, 0),
        (12.0, 20.0, 0x100),
        (20.0, 20.0, 0x101),
        (24.0, 20.0, 0x1_0000),
    ] {
        rig.start(1, &[Line::to(&[(Axis::X, x), (Axis::Y, y)], 3000.0)]);
        rig.until_end(1);
        rig.seconds(0.2);
        assert_eq!(rig.read("P12188"), f64::from(bytes), "{x} {y}");
    }
}

/// P8891: a move of a locked axis holds the execution until it is free.
#[test]
fn a_locked_axis_holds_its_block() {
    let mut rig = Rig::on("");
    rig.plc("P8891", "$2");
    rig.start(
        1,
        &[
            Line::to(&[(Axis::X, 10.0)], 3000.0),
            Line::to(&[(Axis::Y, 10.0)], 3000.0),
        ],
    );
    rig.seconds(2.0);
    assert_eq!(
        (rig.read("P12151"), rig.read("P12351"), rig.read("P8685")),
        (10.0, 0.0, 2.0)
    );
    rig.plc("P8891", "0");
    rig.until_end(1);
    assert_eq!(rig.read("P12351"), 10.0);
}

/// P8702 stops on the ramp, P8701 = 0 at once; both go on when they are gone.
#[test]
fn enables_stop_the_axes() {
    let mut rig = Rig::answered(
        "",
        bahn_control900::StandardAnswers {
            enable: false,
            ..Default::default()
        },
    );
    for name in ["P8700", "P8701", "P8709"] {
        rig.plc(name, "1");
    }
    rig.seconds(0.05);
    rig.start(1, &far());
    rig.until(|rig| rig.exact("P12151") > 50.0);
    rig.plc("P8702", "1");
    let before = rig.exact("P12151");
    rig.seconds(1.0);
    let way = rig.exact("P12151") - before;
    assert!((12.5..=13.0).contains(&way), "{way}");
    rig.plc("P8702", "0");
    rig.until(|rig| rig.exact("P12151") > 150.0);
    rig.plc("P8701", "0");
    let before = rig.exact("P12151");
    rig.seconds(0.5);
    assert!(rig.exact("P12151") - before < 0.9);
    assert_eq!(rig.plant_volts(0), 0.0);
    rig.plc("P8701", "1");
    rig.until_end(1);
    assert_eq!(rig.read("P12151"), 300.0);
    assert_eq!(rig.control.messages(), []);
}
