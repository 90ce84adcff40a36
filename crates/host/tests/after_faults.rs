//! What the fault campaign found, each as the few things that lead to it.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod support;

use bahn_control::{Control, RunState};
use bahn_host::{Deed, Host, Source};
use bahn_parameters::fault::FaultId;
use bahn_path::Axis;
use support::{mill, seconds};

fn give(host: &mut Host, what: &str) {
    host.act(Source::Script, Deed::parse(what).unwrap()).unwrap();
}

fn until(host: &mut Host, what: &str, holds: impl Fn(&Control) -> bool) {
    let end_us = host.control().time_us() + 60_000_000;
    while !holds(host.control()) {
        assert!(host.control().time_us() < end_us, "{what} does not come");
        host.step().unwrap();
    }
}

fn commanded(control: &Control, axis: Axis) -> f64 {
    control.first().commanded()[axis]
}

/// EMERGENCY STOP, release, CE, NC start.
fn stop_and_go_on(host: &mut Host) {
    give(host, "emergency press");
    seconds(host, 1.0);
    give(host, "emergency release");
    seconds(host, 0.5);
    give(host, "ce");
    seconds(host, 0.3);
    assert_eq!(host.control().run_state(), RunState::Interrupted);
    give(host, "key NC_START tap");
}

/// The table is clamped (M10) when EMERGENCY STOP comes: its clamp holds it, so that it need not go back to the contour,
/// and the run goes on to its end.
#[test]
fn a_clamped_axis_holds_no_run_up_behind_an_emergency_stop() {
    let mut host = mill("L C+45 F2000 M11\nL Z+100 R0 FMAX M10\nL Z+40 F300\nL Z+100 FMAX");
    until(&mut host, "the clamped table", |control| {
        let third = control.element().is_some_and(|element| element.block.block == 3);
        let below = third && commanded(control, Axis::Z) < 80.0;
        below
            && control.run_state() == RunState::Running
            && control
                .first()
                .watch()
                .any(|axis| axis.axis == Axis::C && !axis.closed)
    });
    stop_and_go_on(&mut host);
    until(&mut host, "the end", Control::has_ended);
    assert_eq!(commanded(host.control(), Axis::C), 45.0);
}

/// EMERGENCY STOP while the path waits for an M function: the axes are taken over from where they stand, within their
/// window, and go back to the programmed positions before the path goes on, not only by the next block that names them.
#[test]
fn axes_that_wait_for_a_function_go_back_to_the_contour() {
    let mut host =
        mill("L X+10 Y+20 R0 FMAX\nL C+45 F2000 M11\nL Z+100 R0 FMAX M10\nL Z+40 F300\nL Z+100 FMAX");
    until(&mut host, "the strobe of M10", |control| {
        control.waiting().is_some()
            && commanded(control, Axis::Z) == 100.0
            && commanded(control, Axis::C) == 45.0
    });
    stop_and_go_on(&mut host);
    until(&mut host, "the next block", |control| {
        commanded(control, Axis::Z) < 99.0 && control.run_state() == RunState::Running
    });
    let control = host.control();
    assert_eq!(
        (commanded(control, Axis::X), commanded(control, Axis::Y)),
        (10.0, 20.0)
    );
}

/// The door takes the feed enable away in rapid traverse: 0 V at once, and X runs on by what its drive needs,
/// v²/(2a) = 250²/(2 · 7000) = 4.5 mm, less than MP1710 = 9. MP1410 = 0.5 is the limit of pre-control, which does not
/// control then. Behind the door the run goes on.
#[test]
fn a_door_in_rapid_traverse_is_no_positioning_error() {
    let mut host = mill("L X-100 Y+0 Z+100 R0 FMAX\nL X+300 FMAX");
    until(&mut host, "rapid traverse", |control| {
        commanded(control, Axis::X) > 50.0 && control.run_state() == RunState::Running
    });
    give(&mut host, "switch door open");
    let mut farthest: f64 = 0.0;
    for _ in 0..400 {
        host.step().unwrap();
        let lag = host
            .control()
            .first()
            .watch()
            .find(|axis| axis.axis == Axis::X)
            .unwrap()
            .lag;
        farthest = farthest.max(lag.abs());
    }
    assert!((0.5..9.0).contains(&farthest), "{farthest}");
    let shown = host.control().shown();
    assert!(
        !shown.iter().any(|shown| shown.fault() == FaultId::Positioning),
        "{shown:?}"
    );
    give(&mut host, "switch door closed");
    seconds(&mut host, 1.5);
    for _ in 0..3 {
        give(&mut host, "ce");
        give(&mut host, "key NC_START tap");
        seconds(&mut host, 0.5);
    }
    until(&mut host, "the end", Control::has_ended);
    assert_eq!(commanded(host.control(), Axis::X), 300.0);
}

/// CE while the path still comes to a standstill behind POSITIONING ERROR: X is taken over from where it is, and no
/// nominal position jumps, 250 mm/s is the rapid traverse. Behind NC start it goes back, and the run goes on.
#[test]
fn ce_on_the_ramp_makes_no_axis_jump() {
    let mut host = mill("L X-100 Y+0 Z+100 R0 FMAX\nL X+300 FMAX\nL X+310 F500");
    until(&mut host, "rapid traverse", |control| {
        commanded(control, Axis::X) > 0.0 && control.run_state() == RunState::Running
    });
    give(&mut host, "fault encoder X stuck");
    let shows = |control: &Control| {
        control
            .shown()
            .iter()
            .any(|shown| shown.fault() == FaultId::Positioning)
    };
    until(&mut host, "POSITIONING ERROR", shows);
    give(&mut host, "repair X");
    give(&mut host, "ce");
    let x = |host: &Host| {
        host.control()
            .first()
            .watch()
            .find(|axis| axis.axis == Axis::X)
            .unwrap()
    };
    for _ in 0..400 {
        host.step().unwrap();
        assert!(x(&host).speed_mm_s.abs() <= 250.0 + 1e-6, "{:?}", x(&host));
    }
    assert_eq!(
        host.control().run_state(),
        RunState::Interrupted,
        "{:?}",
        host.control().shown()
    );
}
