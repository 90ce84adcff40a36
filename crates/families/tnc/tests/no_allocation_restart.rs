//! A contour cycle allocates nothing where a run is left and taken up again: the path taken back after the axes were
//! moved, stop and restart, selection of a program, block scan, return to the contour, a thread.

#[path = "support/stand.rs"]
mod stand;
mod support;

use bahn_tnc::RunState;
use stand::*;
use support::{Build, Rig};

/// A cycle; it must not allocate.
fn cycle(rig: &mut Rig, what: &str) {
    rig.control.prepare();
    let allocated = allocation_counter::measure(|| rig.control.cycle(&mut rig.machine));
    assert_eq!(
        allocated.count_total,
        0,
        "{what}: {:?} {:?}",
        rig.messages(),
        rig.control.snapshot()
    );
}

/// Cycles until something is so.
fn until(rig: &mut Rig, seconds: f64, what: &str, so: impl Fn(&Rig) -> bool) {
    let end = rig.control.time_us() + (seconds * 1e6) as u64;
    while !so(rig) {
        assert!(
            rig.control.time_us() < end,
            "not within {seconds} s: {what}; {:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
        cycle(rig, what);
    }
}

fn seconds(rig: &mut Rig, seconds: f64, what: &str) {
    let end = rig.control.time_us() + (seconds * 1e6) as u64;
    until(rig, seconds + 1.0, what, |rig| rig.control.time_us() >= end);
}

fn ended(rig: &Rig) -> bool {
    rig.control.snapshot().ended
}

/// The PLC has moved Z during M70: the path is taken back and goes on from there, with the functions of its blocks.
#[test]
fn recall() {
    let program = "L X+60 R0 F6000 M70\nL X+70\nL X+80 Y+60 M71\nL Z+40 M72\nL X+60";
    let mut rig = bench_with(&plc_moves_z(), program);
    rig.start();
    until(&mut rig, 10.0, "PLC positioning and recall", ended);
    near(display(&rig, 'Z'), 40.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// NC stop, internal stop, restart with the interrupted block, another program, an override that never rests.
#[test]
fn stop_restart_and_select() {
    let program = "L X+100 Y+70 R0 F6000 M8\nCC X+100 Y+80\nC X+100 Y+90 DR+\nL X+50 M9\nL X+60";
    let build = bench(ACKNOWLEDGE)
        .program("1.H", program)
        .program("2.H", "L X+80 R0 F3000 M8\nL X+50");
    let mut rig = ready(build);
    rig.start();
    seconds(&mut rig, 0.3, "start");
    rig.event("key NC_STOP tap");
    seconds(&mut rig, 0.5, "NC stop");
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    rig.start();
    seconds(&mut rig, 0.1, "on");
    rig.event("key NC_STOP tap");
    seconds(&mut rig, 0.5, "NC stop");
    rig.command("stop");
    seconds(&mut rig, 0.1, "internal stop");
    assert_eq!(rig.control.snapshot().run, RunState::Idle);
    rig.start();
    for percent in 0..100 {
        rig.event(&format!("override feed {}", percent * 7 % 150));
        seconds(&mut rig, 0.02, "override");
    }
    rig.event("override feed 150");
    until(&mut rig, 10.0, "the end", ended);
    near(display(&rig, 'X'), 60.0);
    rig.command("select 2.H");
    seconds(&mut rig, 0.1, "selected");
    rig.start();
    seconds(&mut rig, 0.1, "another program");
    until(&mut rig, 10.0, "its end", ended);
    near(display(&rig, 'X'), 50.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Block scan, with a dwell and a stop in it, RESTORE POSITION and on.
#[test]
fn block_scan_and_return() {
    let program = "TOOL CALL 2 Z S1000\nFN 0: Q1 = +30\nL X+80 Y+60 R0 F3000 M3\nCYCL DEF 9.0 DWELL TIME\n\
                   CYCL DEF 9.1 DWELL 0.2\nSTOP\nL X+90 M8\nL X+Q1\nL Y+20 M9";
    let build = bench(ACKNOWLEDGE).mp("7680=%0000110").program("1.H", program);
    let mut rig = ready(build);
    rig.command("restore-at 9");
    seconds(&mut rig, 1.0, "scan to the stop");
    rig.start();
    seconds(&mut rig, 1.0, "scan");
    assert_eq!(rig.number("W260"), 8);
    rig.command("restore-position");
    seconds(&mut rig, 0.1, "RESTORE POSITION");
    rig.start();
    until(&mut rig, 20.0, "the contour", |rig| !rig.bit("M2019"));
    near(display(&rig, 'X'), 30.0);
    seconds(&mut rig, 0.3, "there");
    rig.start();
    until(&mut rig, 10.0, "the end", ended);
    near(display(&rig, 'Y'), 20.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// Rigid tapping on the mill, stopped in the thread and led on.
#[test]
fn thread() {
    let program = "TOOL CALL 3 Z S600\nCYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP -3\n\
                   CYCL DEF 17.2 DEPTH -20\nCYCL DEF 17.3 PITCH +1.5\nL X+20 Y+20 R0 FMAX\nL Z+3 FMAX M3\nCYCL CALL";
    let mut rig = Build::mill().program("1.H", program).rig();
    rig.power_on();
    rig.seconds(0.5);
    for (axis, value) in [("X", 0.0), ("Y", 0.0), ("Z", 100.0)] {
        rig.command(&format!("datum {axis} {value}"));
    }
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    until(&mut rig, 60.0, "the thread", |rig| {
        rig.bit("M2095") && rig.control.snapshot().feed_mm_min > 800.0
    });
    rig.event("key NC_STOP tap");
    seconds(&mut rig, 1.0, "stop in the thread");
    assert!(rig.bit("M2095") && rig.control.snapshot().feed_mm_min == 0.0);
    rig.start();
    until(&mut rig, 60.0, "the end", ended);
    assert_eq!(rig.messages(), [""; 0]);
}
