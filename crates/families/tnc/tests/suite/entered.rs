//! What the operator enters beside a run: AXIS LIMIT, Q parameters, elements of tables; and what the status display shows
//! of transformations.

use crate::stand::*;
use crate::support::Rig;
use crate::support::bench as by_hand;
use bahn_path::Axis;
use bahn_tnc::{AxisLimit, Command, RunState};

fn state(rig: &Rig) -> RunState {
    rig.control.snapshot().run
}

fn refused(rig: &mut Rig, command: &str) -> bool {
    !rig.control.command(command.parse::<Command>().unwrap())
}

/// AXIS LIMIT allows less than MP910 and MP920, by hand and in a program, and survives power-off [003:7115-7157].
#[test]
fn axis_limit() {
    let mut rig = by_hand::bench("").ready();
    for wrong in [
        "axis-limit X 1 50 50",
        "axis-limit X 1 -500 -400",
        "axis-limit V 1 0 1",
    ] {
        assert!(refused(&mut rig, wrong), "{wrong}");
    }
    rig.control.command(Command::Ce);
    // The software limit of X+ is 170; another range does not count.
    rig.command("axis-limit X 1 20 120");
    rig.command("axis-limit X 2 0 60");
    rig.event("key RAPID press");
    rig.event("key X+ press");
    rig.seconds(2.5);
    by_hand::close(rig.table('X'), 120.0, 0.005);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    rig.event("key X+ release");
    let own = AxisLimit {
        axis: Axis::X,
        range: 1,
        limits: [20.0, 120.0],
    };
    assert_eq!(rig.control.remember().axis_limits[0], own);
    rig.command("axis-limit X 1 off");
    rig.event("key X+ press");
    rig.seconds(2.5);
    by_hand::close(rig.table('X'), 170.0, 0.005);
}

#[test]
fn a_block_beyond_axis_limit_is_refused() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+60 R0 F6000\nL X+80\nL X+60");
    let zero = rig.machine_position('X') - 50.0;
    rig.command(&format!("axis-limit X 1 -400 {}", zero + 70.0));
    rig.start();
    rig.until(5.0, "the block is refused", |rig| !rig.messages().is_empty());
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    near(display(&rig, 'X'), 60.0);
}

/// Interrupted in the midst of a block, what was read ahead with the old value is read again.
#[test]
fn a_q_parameter_is_changed_while_a_run_is_interrupted() {
    let blocks = "FN 0: Q1=+90\nL X+60 R0 F3000\nL X+Q1";
    let mut rig = bench_with(ACKNOWLEDGE, blocks);
    rig.start();
    rig.until(3.0, "block 2", |rig| nominal(rig, 'X') > 55.0);
    for command in ["q 1 70", "axis-limit X 1 0 200"] {
        assert!(refused(&mut rig, command), "{command} while it runs");
    }
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    rig.control.command(Command::Ce);
    let stopped = display(&rig, 'X');
    assert!(stopped < 60.0 && state(&rig) == RunState::Interrupted);
    rig.command("q 1 70");
    assert_eq!(rig.control.first().q_value(1), 70.0);
    rig.seconds(0.2);
    near(display(&rig, 'X'), stopped);
    rig.start();
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 70.0);
    // Between runs.
    rig.command("q 2 -3.5");
    assert_eq!(rig.control.first().q_value(2), -3.5);
}

#[test]
fn a_q_parameter_is_changed_at_a_stop_and_between_blocks() {
    let blocks = "FN 0: Q1=+90\nL X+60 R0 F6000\nSTOP\nL X+Q1";
    let mut rig = bench_with(ACKNOWLEDGE, blocks);
    rig.start();
    rig.until(3.0, "the stop", |rig| state(rig) == RunState::Stopped);
    rig.command("q 1 75");
    rig.start();
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 75.0);

    let mut rig = bench_with(ACKNOWLEDGE, "FN 0: Q1=+90\nL X+60 R0 F6000\nL X+Q1\nL X+55");
    rig.command("mode single");
    for expected in [60.0, 65.0, 55.0] {
        while (display(&rig, 'X') - expected).abs() > 0.01 {
            rig.start();
            rig.until(3.0, "the block", |rig| state(rig) == RunState::Running);
            rig.until(5.0, "its end", |rig| state(rig) != RunState::Running);
            rig.seconds(0.3);
        }
        if expected == 60.0 {
            rig.command("q 1 65");
        }
    }
}

/// An element of a table counts at once: the next call of the tool has it. Its file says so, too: nothing of it is kept
/// beside, as what the PLC writes is.
#[test]
fn an_element_of_the_tool_table() {
    let mut rig = bench_with(ACKNOWLEDGE, "TOOL CALL 1 Z S0\nL Z+60 R0 F6000");
    let before = rig.control.remember().written.len();
    rig.command("table T 1 L 30");
    rig.seconds(0.1);
    assert_eq!(rig.control.remember().written.len(), before);
    run(&mut rig, 10.0);
    // The tip of a tool of 30 mm at Z+60.
    let datum = rig.control.first().datum()[Axis::Z];
    near(rig.machine_position('Z') - datum, 60.0 + 30.0);
    assert!(refused(&mut rig, "table T 77 L 1"), "there is no such tool");
}

/// The flags are those of the block that is executed, not of what is read ahead [003:1297].
#[test]
fn transformations_in_force() {
    let shift = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 Y+5";
    let mirror = "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X";
    let scale = "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.5";
    let turn = "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+30";
    let blocks = format!("L X+60 R0 F600\n{shift}\nL X+61\n{mirror}\n{scale}\n{turn}\nL X+62");
    let mut rig = bench_with(ACKNOWLEDGE, &blocks);
    rig.start();
    let shown = |rig: &Rig| rig.control.first().in_force().unwrap();
    rig.until(2.0, "block 1", |rig| nominal(rig, 'X') > 52.0);
    let first = shown(&rig);
    assert!(first.shifted.is_empty() && first.mirrored.is_empty() && !first.scaled && !first.rotated);
    assert_eq!(first.tool_axis, Axis::Z);
    rig.until(5.0, "block 2", |rig| nominal(rig, 'X') > 60.2);
    let second = shown(&rig);
    assert_eq!((second.shifted, second.mirrored), (vec![Axis::Y], vec![]));
    rig.until(5.0, "block 3", |rig| shown(rig).scaled);
    let last = shown(&rig);
    assert_eq!((last.shifted, last.mirrored), (vec![Axis::Y], vec![Axis::X]));
    assert!(last.scaled && last.rotated);
}
