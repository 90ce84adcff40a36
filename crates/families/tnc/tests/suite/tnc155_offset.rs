//! Offset adjustment of a TNC 151/155: steps of 2.44 mV each MP252 times 20 ms [001:2573-2610].

use crate::support::bench::close;
use crate::support::knee::*;
use crate::support::*;

/// A step of the converter: 10 V in 12 bits, V.
const STEP: f64 = 10.0 / 4096.0;

/// The mill with an offset of X's amplifier; MP252 = 50 is 1 s.
fn drifting(offset_mv: f64, mps: &str) -> Build {
    knee("")
        .plant("[axis.X]", &format!("[axis.X]\noffset_mv = {offset_mv}"))
        .mps("252=50")
        .mps(mps)
}

/// Steps of compensation of X so far.
fn steps(rig: &Rig) -> i32 {
    (rig.control.remember().offsets_volts[0].abs() / STEP).round() as i32
}

/// 11 mV are 4.5 steps. While nothing has moved each second brings one; half a step stays.
#[test]
fn each_pass_compensates_one_step() {
    let mut rig = asked(drifting(11.0, ""));
    rig.until(1.5, "the first pass", |rig| steps(rig) == 1);
    close(rig.control.remember().offsets_volts[0].abs(), STEP, 1e-9);
    rig.seconds(0.1);
    let mut seen = vec![steps(&rig)];
    for _ in 0..5 {
        rig.seconds(1.0);
        seen.push(steps(&rig));
    }
    assert_eq!(seen, [1, 2, 3, 4, 4, 4]);
}

/// MP252 = 65535 are 22 minutes: one pass comes before, when the axes have passed their marks.
#[test]
fn one_pass_follows_the_reference_marks() {
    let mut rig = asked(drifting(11.0, "252=65535"));
    rig.start();
    rig.until(30.0, "the last mark", |rig| rig.axis('Z').referenced);
    assert_eq!(steps(&rig), 0);
    rig.seconds(10.0);
    assert_eq!(steps(&rig), 1);
}

/// Not with MP252 = 0, not while an axis moves.
#[test]
fn no_adjustment_without_mp252_or_while_an_axis_moves() {
    let mut rig = asked(drifting(11.0, "252=0"));
    reference(&mut rig);
    rig.seconds(3.0);
    assert_eq!(steps(&rig), 0);
    let mut rig = asked(drifting(11.0, ""));
    reference(&mut rig);
    let before = steps(&rig);
    rig.event("key Y- press");
    rig.seconds(4.0);
    assert_eq!(steps(&rig), before);
}

/// 60 mV of 9 V at 6 m/min and kv 2 are 60 / 9000 * 6000 / 2000 = 20 µm of lag, outside a window of 10 µm: the adjustment
/// waits until the nominal value is at its target for more than 5 s.
#[test]
fn an_axis_outside_its_window_waits_five_seconds() {
    let mut rig = asked(drifting(60.0, ""));
    rig.start();
    rig.until(30.0, "the last mark", |rig| rig.axis('Z').referenced);
    rig.until(1.0, "all stand", |rig| rig.control.stands());
    rig.event("key X- press");
    rig.seconds(0.5);
    rig.event("key X- release");
    rig.until(1.0, "X stands", |rig| rig.control.stands());
    let before = steps(&rig);
    rig.seconds(4.9);
    assert_eq!(steps(&rig), before);
    rig.seconds(30.0);
    assert_eq!(steps(&rig), 24, "60 mV / 2.44 mV = 24.6");
}

/// 110 mV: 41 steps are 100.1 mV, GROSS POSITIONING ERROR E.
#[test]
fn a_hundred_millivolt_are_error_e() {
    let mut rig = asked(drifting(110.0, "252=5"));
    rig.start();
    rig.until(60.0, "error E", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["GROSS POSITIONING ERROR X E"]);
    assert_eq!(steps(&rig), 41);
}

/// Code 75368 shows the offsets in units of 2.44 mV: 2 for 4.88 mV; ENT compensates them [001:2575-2583].
#[test]
fn the_code_number_shows_steps() {
    let mut rig = asked(drifting(2.0 * STEP * 1e3, "252=0"));
    reference(&mut rig);
    rig.command("code 75368");
    let shown = rig.control.offsets_shown().unwrap();
    assert_eq!([0, 1, 2].map(|axis: usize| shown[axis].abs()), [2, 0, 0]);
    close(rig.control.offset_unit_volts(), STEP, 1e-12);
    rig.command("offset adjust");
    assert_eq!(steps(&rig), 2);
}
