//! Feed rate release E18 of a TNC 151/155: opening it ramps the feed to zero with MP54, closing it lets the movement go
//! on [001:509-516].

use crate::support::bench::close;
use crate::support::knee::*;
use crate::support::*;
use bahn_tnc::{Mode, RunState};

/// MP54 = 0.5 m/s² in mm/s².
const RAMP: f64 = 500.0;

/// The greatest change of the commanded speed of X between two contour cycles until it stands, mm/s², and how long that takes, s.
fn brake(rig: &mut Rig) -> (f64, f64) {
    let cycle_s = f64::from(rig.control.cycle_us()) * 1e-6;
    let from = rig.control.time_us();
    let mut before = commanded(rig);
    let mut steepest = 0.0_f64;
    while commanded(rig) != 0.0 {
        rig.cycle();
        steepest = steepest.max((commanded(rig) - before).abs() / cycle_s);
        before = commanded(rig);
        assert!(rig.control.time_us() - from < 5_000_000, "{before}");
    }
    (steepest, (rig.control.time_us() - from) as f64 * 1e-6)
}

/// Commanded speed of X, mm/s.
fn commanded(rig: &Rig) -> f64 {
    let axes = rig.control.first().watch();
    axes.into_iter().next().map_or(0.0, |axis| axis.speed_mm_s)
}

/// F3000 is 50 mm/s: with 500 mm/s² the axis stands after 0.1 s and 50² / 1000 = 2.5 mm, not at once. It goes on by itself.
#[test]
fn a_program_comes_down_on_the_ramp_and_goes_on() {
    let program = "L X-50 R0 F3000\nL X+50";
    let mut rig = asked(knee("").program("1", program).mps("44=300 45=-300"));
    reference(&mut rig);
    rig.command("mode full");
    rig.command("select 1");
    rig.start();
    rig.until(2.0, "X is at its feed", |rig| {
        (commanded(rig).abs() - 50.0).abs() < 1e-6
    });
    let before = rig.axis('X').nominal;
    rig.event("key NO_FEED press");
    rig.until(0.1, "the release opens", |rig| !rig.axis('X').enabled);
    let (steepest, time) = brake(&mut rig);
    assert!(steepest <= RAMP * 1.02, "{steepest} mm/s²");
    assert!((0.09..0.13).contains(&time), "{time} s");
    let way = (rig.axis('X').nominal - before).abs();
    // A scan and a little more passes before the ramp begins: 50 mm/s for up to 26 ms.
    assert!((2.4..4.0).contains(&way), "{way} mm");
    rig.seconds(1.0);
    assert_eq!(commanded(&rig), 0.0);
    assert_eq!(rig.messages(), [""; 0]);
    assert_eq!(rig.control.snapshot().run, RunState::Running);
    rig.event("key NO_FEED release");
    rig.until(10.0, "it goes on by itself", |rig| rig.control.snapshot().ended);
    close(rig.axis('X').nominal, 50.0, 0.001);
}

/// A direction button: the same ramp; the axis goes on while the button is held. F 1200 is 20 mm/s: 0.04 s.
#[test]
fn by_hand_it_is_the_same() {
    let mut rig = asked(knee(""));
    reference(&mut rig);
    rig.event("key X- press");
    rig.until(1.0, "X is at its feed", |rig| {
        (commanded(rig) + 20.0).abs() < 1e-6
    });
    rig.event("key NO_FEED press");
    rig.until(0.1, "the release opens", |rig| !rig.axis('X').enabled);
    let (steepest, time) = brake(&mut rig);
    assert!(steepest <= RAMP * 1.02, "{steepest} mm/s²");
    assert!((0.03..0.06).contains(&time), "{time} s");
    rig.seconds(0.5);
    rig.event("key NO_FEED release");
    rig.until(1.0, "it goes on", |rig| (commanded(rig) + 20.0).abs() < 1e-6);
    rig.event("key X- release");
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
}

/// The reference run: 3 m/min are 50 mm/s.
#[test]
fn the_reference_run_waits_on_the_ramp() {
    let mut rig = asked(knee(""));
    rig.start();
    rig.until(1.0, "X is at its feed", |rig| {
        (commanded(rig) - 50.0).abs() < 1e-6
    });
    rig.event("key NO_FEED press");
    rig.until(0.1, "the release opens", |rig| !rig.axis('X').enabled);
    let (steepest, time) = brake(&mut rig);
    assert!(steepest <= RAMP * 1.02, "{steepest} mm/s²");
    assert!((0.09..0.13).contains(&time), "{time} s");
    rig.seconds(0.5);
    assert_eq!(rig.control.snapshot().mode, Mode::Reference);
    rig.event("key NO_FEED release");
    rig.until(20.0, "the run goes on by itself", |rig| {
        rig.control.snapshot().mode == Mode::Manual
    });
}
