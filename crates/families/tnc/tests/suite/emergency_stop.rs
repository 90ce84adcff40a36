//! The "control is ready" circuit: test at power-on, EMERGENCY STOP from outside [000:6149-6228]
//! [000:7033-7040].

use crate::support::bench::*;
use crate::support::*;
use bahn_parameters::ControlModel;
use bahn_tnc::{Mode, RunState};

/// A bench whose relay takes so long to fall, as a model.
fn relay(model: ControlModel, drop_out_ms: u32) -> Rig {
    let mut build = bench("").plant("drop_out_ms = 50", &format!("drop_out_ms = {drop_out_ms}"));
    build.model = model;
    let mut rig = build.rig();
    rig.seconds(1.5);
    rig
}

/// X42/4 must fall within 114 ms after X41/34 on the TNC 415, within 146 ms on the TNC 407
/// [000:6177-6228].
#[test]
fn the_relay_must_fall_in_time() {
    use ControlModel::{Tnc407, Tnc415b};
    for (model, in_time, too_late) in [(Tnc415b, 113, 115), (Tnc407, 145, 147)] {
        let rig = relay(model, in_time);
        assert_eq!(rig.messages(), [""; 0], "{model:?}");
        assert!(rig.bit("M2000"), "the loops are closed");
        let rig = relay(model, too_late);
        assert_eq!(rig.messages(), ["EMERGENCY STOP DEFECTIVE"], "{model:?}");
        assert!(rig.control.snapshot().messages[0].flashing);
        assert!(!rig.control.snapshot().axes.iter().any(|axis| axis.closed));
        assert!(!rig.machine.control_voltage(), "X41/34 is off");
    }
}

/// A relay that does not fall at all.
#[test]
fn a_welded_relay_is_found() {
    let mut rig = bench("").rig();
    rig.event("fault relay welded");
    rig.seconds(1.0);
    assert_eq!(rig.messages(), ["EMERGENCY STOP DEFECTIVE"]);
    assert!(
        !rig.control.command("ce".parse().unwrap()),
        "only power-off clears it"
    );
}

/// POWER INTERRUPTED waits for CE, and the PLC with it; then the voltage is waited for.
#[test]
fn messages_of_power_on() {
    let mut rig = bench("").mp("7212=0").rig();
    rig.event("voltage off");
    rig.seconds(0.5);
    assert_eq!(rig.messages(), ["POWER INTERRUPTED"]);
    assert_eq!(rig.number("W272"), 0, "the PLC does not run");
    rig.command("ce");
    rig.seconds(0.5);
    assert_eq!(rig.messages(), ["RELAY EXT. DC VOLTAGE MISSING"]);
    assert!(rig.bit("M2190"), "the PLC runs");
    assert!(!rig.bit("M2000"));
    assert!(
        !rig.control.command("ce".parse().unwrap()),
        "the voltage clears it, not CE"
    );
    rig.event("voltage on");
    rig.until(2.0, "the output is tested", |rig| rig.bit("M2000"));
    assert_eq!(rig.control.snapshot().mode, Mode::Reference);
    let shown: Vec<_> = rig
        .control
        .take_messages()
        .iter()
        .map(|shown| rig.control.message_text(&shown.message))
        .collect();
    assert_eq!(
        shown,
        [
            "POWER INTERRUPTED",
            "RELAY EXT. DC VOLTAGE MISSING",
            "KEY NON-FUNCTIONAL"
        ]
    );
}

/// With MP7212 = 1 there is no POWER INTERRUPTED.
#[test]
fn power_interrupted_can_be_suppressed() {
    let rig = bench("").rig();
    assert_eq!(rig.messages(), [""; 0]);
}

/// Standing: the message comes, M2190 and M2191; the loops open. CE works only when the voltage is back;
/// then the loops close where the axes stand.
#[test]
fn emergency_stop_while_standing() {
    let mut rig = bench("").ready();
    rig.event("emergency press");
    rig.seconds(0.2);
    assert_eq!(rig.messages(), ["EXTERNAL EMERGENCY STOP"]);
    assert!(rig.bit("M2190") && rig.bit("M2191") && !rig.bit("M2000"));
    assert!(!rig.control.command("ce".parse().unwrap()));
    rig.event("emergency release");
    rig.seconds(0.2);
    assert!(!rig.bit("M2000"), "CE is waited for");
    rig.command("ce");
    rig.command("ce"); // KEY NON-FUNCTIONAL of the first one
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(rig.bit("M2000") && !rig.bit("M2190") && !rig.bit("M2191"));
    assert_eq!(
        rig.control.snapshot().mode,
        Mode::Manual,
        "the marks are not asked for again"
    );
}

/// A moving axis: the nominal position is ramped down with MP1060, 0.1 s from 6000 mm/min, then the loop
/// opens. It moves no more when the voltage is back and CE was pressed, though its key was held.
#[test]
fn emergency_stop_while_moving() {
    let mut rig = bench("").ready();
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.5);
    close(rig.speed('X'), -6000.0, 50.0);
    rig.event("emergency press");
    rig.seconds(0.07);
    assert_eq!(rig.messages(), ["EXTERNAL EMERGENCY STOP"]);
    assert!(rig.axis('X').closed, "ramped under control");
    rig.event("key X- release");
    rig.seconds(0.3);
    assert!(!rig.axis('X').closed);
    rig.event("emergency release");
    rig.seconds(0.1);
    rig.command("ce");
    let stands = rig.table('X');
    rig.seconds(0.5);
    close(rig.table('X'), stands, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(rig.bit("M2000"));
}

/// The speed of an axis is that which is, also when its loop is open: while it runs out, when it stands, and when the
/// loop closes again.
#[test]
fn the_speed_of_an_axis_without_loop() {
    // A drive that friction stops.
    let friction = "time_constant_ms = 2\nreset_ms = 25\nmass = 500\nfriction = 600\nforce = 6000";
    let mut rig = bench("").with("").plant("time_constant_ms = 2", friction).ready();
    let observe = |rig: &Rig, signal: &str| rig.control.observe(&signal.parse().unwrap());
    rig.event("key RAPID press");
    rig.event("key X- press");
    rig.seconds(0.5);
    rig.event("emergency press");
    rig.event("key X- release");
    let mut before = observe(&rig, "X.actual");
    let (mut ran_out, mut stood) = (false, 0);
    for cycle in 0..600 {
        if cycle == 400 {
            rig.event("emergency release");
        }
        if cycle == 450 {
            rig.command("ce");
        }
        let at_start = before;
        rig.cycle();
        before = observe(&rig, "X.actual");
        let speed = observe(&rig, "X.speed");
        // The cycle before this one, as its first servo step saw it: at most what the drive brakes within a cycle beside it.
        let now = (before - at_start) / 0.003 * 60.0;
        assert!(
            (speed - now).abs() < 700.0,
            "cycle {cycle}: {speed} mm/min, {now}"
        );
        ran_out |= !rig.axis('X').closed && now < -10.0;
        if cycle > 200 {
            assert!(speed.abs() < 1.0, "cycle {cycle}: {speed} mm/min while it stands");
            stood += 1;
        }
        assert_eq!(observe(&rig, "path.speed"), 0.0);
    }
    assert!(ran_out && stood > 300);
}

/// A program run is interrupted; after CE the axes go back to where the path left them, and NC start goes on
/// to the end.
#[test]
fn emergency_stop_in_a_program() {
    let mut rig = bench("")
        .mps("4220.0=2000 4220.1=2000 4220.2=2000")
        .program("1.H", "L X+20 Y+20 R0 F3000\nL X+120 F2000\nL Y+60")
        .ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.until(10.0, "the second block", |rig| {
        rig.table('Y') < 20.1 && rig.table('X') > 50.0
    });
    rig.event("emergency press");
    rig.seconds(0.5);
    // Without power the axis cannot follow its ramp: the lag trips, too [000:6157].
    assert_eq!(rig.messages(), ["EXTERNAL EMERGENCY STOP", "POSITIONING ERROR X"]);
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    assert!(rig.bit("M2183"), "* flashes");
    // Somebody moves the axis while it has no power.
    rig.event("force Y 1");
    rig.seconds(0.3);
    rig.event("force Y 0");
    rig.event("emergency release");
    rig.seconds(0.1);
    rig.command("ce");
    rig.command("ce");
    rig.settle();
    let pushed = rig.table('Y');
    assert!(pushed > 20.5, "{pushed}");
    assert_eq!(
        rig.messages(),
        [""; 0],
        "the loop has closed where the axis stands"
    );
    rig.start();
    rig.until(5.0, "back on the path", |rig| rig.speed('X') > 1000.0);
    close(rig.table('Y'), 20.0, 0.02);
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.table('X'), 120.0, 0.01);
    close(rig.table('Y'), 60.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// After EMERGENCY STOP the run can be broken off with INTERNAL STOP instead.
#[test]
fn internal_stop_after_emergency_stop() {
    let mut rig = bench("").program("1.H", "L X+120 R0 F1000").ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.seconds(1.0);
    rig.event("emergency press");
    rig.seconds(0.5);
    rig.event("emergency release");
    rig.seconds(0.1);
    rig.command("ce");
    rig.command("stop");
    rig.command("mode manual");
    rig.event("key X+ press");
    rig.seconds(0.5);
    close(rig.speed('X'), 1200.0, 10.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// M2827: the loss of X42/4 is not reported; NC stop and open loops instead, until it is back
/// [000:5403-5421].
#[test]
fn m2827_suppresses_the_message() {
    let mut rig = bench("       L I30\n       = M2827\n").ready();
    rig.input("I30", true);
    rig.scan();
    rig.event("emergency press");
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(!rig.bit("M2000") && !rig.bit("M2191"));
    rig.event("emergency release");
    rig.seconds(0.2);
    assert!(rig.bit("M2000"));
}

/// M2830: NC stop, all loops and that of the spindle open [000:5403-5421].
#[test]
fn m2830_opens_all_loops() {
    let mut rig = bench("       L I30\n       = M2830\n")
        .program("1.H", "L X+120 R0 F1000")
        .ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig.seconds(1.0);
    rig.input("I30", true);
    rig.seconds(0.1);
    assert!(!rig.bit("M2000") && !rig.bit("M2001") && rig.bit("M2183"));
    assert_eq!(rig.messages(), [""; 0]);
    rig.input("I30", false);
    rig.seconds(0.1);
    assert!(rig.bit("M2000"));
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    close(rig.table('X'), 120.0, 0.01);
    assert_eq!(rig.messages(), [""; 0]);
}

/// PLC positioning ends with EMERGENCY STOP: the NC resets the strobe [000:4013-4019].
#[test]
fn emergency_stop_ends_plc_positioning() {
    let mut rig = bench(
        "       L K+1500000\n       = D528\n       L K+1000\n       = W560\n       L I30\n       AN M100\n       S M2704\n       L I30\n       = M100\n",
    )
    .ready();
    rig.input("I30", true);
    rig.seconds(0.5);
    assert!(rig.bit("M2704"));
    rig.event("emergency press");
    rig.seconds(0.3);
    assert!(!rig.bit("M2704"));
    rig.event("emergency release");
    rig.seconds(0.1);
    rig.command("ce");
    rig.seconds(0.05);
    let stands = rig.table('X');
    rig.seconds(0.5);
    close(rig.table('X'), stands, 0.01);
}
