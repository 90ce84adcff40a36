//! The mill with digital drives: a TNC 425 whose speed loops run in servo steps of 0.6 ms.

use crate::support::bench::*;
use crate::support::*;
use bahn_parameters::ControlModel;
use bahn_tnc::Mode;

fn dig425() -> Build {
    Build::of("dig425", ControlModel::Tnc425)
}

/// The axis X of the plant has its wires exchanged.
fn reversed() -> Build {
    dig425().plant(
        "current_drive = { pitch = 10, inertia = 0.0004, torque_constant = 0.7, current = 12, time_constant_ms = 0.1, lines = 4000, off_delay_ms = 280 }\nencoder = { input = \"X1\"",
        "current_drive = { pitch = 10, inertia = 0.0004, torque_constant = 0.7, current = 12, time_constant_ms = 0.1, lines = 4000, off_delay_ms = 280, reversed = true }\nencoder = { input = \"X1\"",
    )
}

/// A circle of 40 mm at 3 m/min: with kv 8 and both pre-controls the axes stay within 5 µm of the contour.
#[test]
fn digital_drives_follow_a_circle() {
    let mut rig = dig425()
        .program(
            "1.H",
            "TOOL CALL 1 Z S800\nCC X+0 Y+0\nL X+40 Y+0 R0 FMAX\nC X+40 Y+0 DR+ F3000",
        )
        .rig();
    rig.power_on();
    for axis in ["X", "Y", "Z"] {
        rig.command(&format!("datum {axis} 0"));
    }
    let centre = [rig.table('X'), rig.table('Y')];
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    let mut worst = 0.0_f64;
    let mut on_circle = 0;
    for _ in 0..4000 {
        rig.cycle();
        if rig
            .control
            .element()
            .is_some_and(|element| element.block.block == 4)
        {
            let radius = (rig.table('X') - centre[0]).hypot(rig.table('Y') - centre[1]);
            worst = worst.max((radius - 40.0).abs());
            on_circle += 1;
        }
    }
    // 251 mm at 3 m/min: 5 s.
    assert!(
        on_circle > 1600 && worst < 0.005,
        "{on_circle} cycles, {worst} mm"
    );
    assert_eq!(rig.messages(), [""; 0]);
}

/// Exchanged wires feed back positively: the message is as the manual has it, and only power-off helps; MP1950 sets it
/// right [000:18387-18391] [000:18579-18584].
#[test]
fn gross_positioning_error_3f() {
    let mut rig = reversed().rig();
    rig.command("ce");
    rig.until(10.0, "the loops close, or run away", |rig| {
        rig.control.snapshot().mode == Mode::Reference || !rig.messages().is_empty()
    });
    rig.start();
    rig.until(20.0, "the monitoring", |rig| {
        rig.messages().iter().any(|text| text.ends_with("3F"))
    });
    assert!(
        rig.messages()
            .contains(&"GROSS POSITIONING ERROR X 3F".to_owned()),
        "{:?}",
        rig.messages()
    );
    let command = "ce".parse().unwrap();
    rig.control.command(command);
    rig.seconds(0.1);
    assert!(
        rig.messages().iter().any(|text| text.ends_with("3F")),
        "CE does not clear it"
    );
    let mut rig = reversed().mp("1950=%00001").rig();
    rig.power_on();
    assert_eq!(rig.messages(), [""; 0]);
}

/// MP1980 [000:18508-18521]: in an EMERGENCY STOP at 12 m/min the loops brake while the drives have power; without it the
/// axis runs down against friction and brake.
#[test]
fn the_controller_brakes_in_an_emergency_stop() {
    let way = |mp1980: &str| {
        let mut rig = dig425().mp(mp1980).mp("1020.0=12000").rig();
        rig.power_on();
        rig.event("key X- press");
        rig.seconds(0.4);
        let from = rig.table('X');
        rig.event("emergency press");
        rig.seconds(1.5);
        assert!(rig.messages().contains(&"EXTERNAL EMERGENCY STOP".to_owned()) && !rig.bit("M2000"));
        assert_eq!(rig.control.observe(&"X.volts".parse().unwrap()), 0.0);
        (from - rig.table('X')).abs()
    };
    let (braked, coasted) = (way("1980=0.3"), way("1980=0"));
    // 200 mm/s: 20 ms until the chain has fallen, a lag of 2 mm, and 6.7 mm with 3 m/s².
    assert!(braked < 14.0, "{braked}");
    assert!(coasted > 2.0 * braked, "{braked} {coasted}");
}

/// `output step`: direction keys in MANUAL OPERATION put out a step at once, without MP1060; the position loop is off
/// meanwhile [000:18747-18756].
#[test]
fn direction_keys_put_out_a_step() {
    let mut rig = dig425().rig();
    rig.power_on();
    rig.event("key X- press");
    rig.seconds(0.012);
    let ramped = rig.control.observe(&"X.speed".parse().unwrap());
    rig.event("key X- release");
    rig.seconds(0.5);
    rig.command("output step 240");
    let from = rig.table('X');
    rig.event("key X- press");
    rig.seconds(0.05);
    let signal = |rig: &Rig, name: &str| rig.control.observe(&name.parse().unwrap());
    close(signal(&rig, "X.n-nominal"), -240.0, 1e-9);
    rig.seconds(0.45);
    close(signal(&rig, "X.n-actual"), -240.0, 10.0);
    // 4 mm/s for half a second.
    close(rig.table('X') - from, -2.0, 0.1);
    rig.event("key X- release");
    rig.seconds(0.5);
    let there = rig.table('X');
    rig.seconds(0.5);
    close(rig.table('X'), there, 0.003);
    rig.command("output ramp");
    assert!(ramped.abs() < 4000.0 && rig.messages().is_empty());
    // Another mode ends it.
    rig.command("output step 240");
    rig.event("key X- press");
    rig.seconds(0.1);
    rig.command("mode mdi");
    rig.seconds(0.3);
    assert!(signal(&rig, "X.n-actual").abs() < 5.0);
    assert!(
        !Build::mill()
            .rig()
            .control
            .command("output step 240".parse().unwrap()),
        "the mill has no such axis"
    );
}

/// MP1050 is inactive for axes with digital speed control [000:18360-18362]: with another one they move as before, to the bit.
#[test]
fn mp1050_is_inactive() {
    let positions = |volts: f64| {
        let mut build = dig425().program("1.H", "TOOL CALL 1 Z S800\nL X+40 Y+20 R0 FMAX\nL X+0 F3000");
        for axis in 0..3 {
            build = build.mp(&format!("1050.{axis}={volts}"));
        }
        let mut rig = build.rig();
        rig.power_on();
        for axis in ["X", "Y", "Z"] {
            rig.command(&format!("datum {axis} 0"));
        }
        rig.command("mode full");
        rig.command("select 1.H");
        rig.start();
        let mut positions = Vec::new();
        for _ in 0..1000 {
            rig.cycle();
            positions.push(['X', 'Y', 'Z'].map(|letter| rig.table(letter)));
        }
        positions
    };
    let (nine, other) = (positions(9.0), positions(1.5));
    assert_ne!(nine.first(), nine.last(), "the axes move");
    let differs = nine.iter().zip(&other).position(|(a, b)| a != b);
    assert_eq!(differs.map(|cycle| (cycle, nine[cycle], other[cycle])), None);
}
