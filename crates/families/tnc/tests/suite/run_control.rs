//! Program run: single block, stops, restart, errors, limits, feed enable, EMERGENCY STOP.

use crate::stand::*;
use crate::support::*;
use bahn_tnc::{Mode, RunState};

fn state(rig: &Rig) -> RunState {
    rig.control.snapshot().run
}

fn stop(rig: &mut Rig) {
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
}

/// Starts and runs until the path stands or the run has ended.
fn start_block(rig: &mut Rig) {
    rig.start();
    rig.until(1.0, "the block begins", |rig| state(rig) == RunState::Running);
    rig.until(10.0, "the block ends", |rig| state(rig) != RunState::Running);
    rig.seconds(0.3);
}

/// Each START executes one block; a cycle call is one block however many movements it has.
#[test]
fn single_block() {
    let cycle = "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SETUP -2\nCYCL DEF 1.2 DEPTH -6\nCYCL DEF 1.3 PECKG -3\nCYCL DEF 1.4 DWELL 0.2\nCYCL DEF 1.5 F3000";
    let program = format!(
        "TOOL CALL 0 Z S0\n{cycle}\nL X+60 R0 F6000 M3\nL Z+2 M8\nCYCL CALL M7\nL X+70 M99\nL X+80 M9"
    );
    let mut rig = bench_with(ACKNOWLEDGE, &program);
    rig.command("mode single");
    start_block(&mut rig);
    assert_eq!(state(&rig), RunState::BlockEnd, "TOOL CALL");
    for (x, z) in [(60.0, 50.0), (60.0, 2.0), (60.0, 2.0), (70.0, 2.0), (80.0, 2.0)] {
        start_block(&mut rig);
        near(display(&rig, 'X'), x);
        near(display(&rig, 'Z'), z);
    }
    if state(&rig) == RunState::BlockEnd {
        start_block(&mut rig);
    }
    assert!(rig.control.snapshot().ended);
}

/// Switched to single block while it runs, the run stops at the end of its block; switched back, the next
/// START runs on to the end.
#[test]
fn full_sequence_to_single_block_and_back() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+60 R0 F3000\nL X+70\nL X+80\nL X+90\nL X+100");
    rig.start();
    rig.until(3.0, "block 2", |rig| nominal(rig, 'X') > 65.0);
    rig.command("mode single");
    rig.until(3.0, "the end of the block", |rig| {
        state(rig) == RunState::BlockEnd
    });
    near(display(&rig, 'X'), 70.0);
    start_block(&mut rig);
    near(display(&rig, 'X'), 80.0);
    rig.command("mode full");
    rig.seconds(0.5);
    near(display(&rig, 'X'), 80.0);
    rig.start();
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 100.0);
}

/// Back in full sequence before the block has ended, the run does not stop.
#[test]
fn back_in_time() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+60 R0 F3000\nL X+70\nL X+80");
    rig.start();
    rig.until(3.0, "block 2", |rig| nominal(rig, 'X') > 62.0);
    rig.command("mode single");
    rig.seconds(0.05);
    rig.command("mode full");
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 80.0);
}

/// NC stop on a circle at any place: the axes brake along it with MP1060 at most, `*` flashes; START goes on,
/// and the circle is the circle.
#[test]
fn stop_on_a_circle() {
    let mut rig = bench_with(ACKNOWLEDGE, "CC X+50 Y+30\nC X+50 Y+50 DR- R0 F3000");
    rig.start();
    let mut before = [50.0, 50.0];
    let mut speed = [0.0, 0.0];
    for cycle in 0.. {
        rig.cycle();
        let at = [nominal(&rig, 'X'), nominal(&rig, 'Y')];
        let radius = (at[0] - 50.0).hypot(at[1] - 30.0);
        assert!((radius - 20.0).abs() < 0.002, "{at:?}");
        let now = [(at[0] - before[0]) / 0.003, (at[1] - before[1]) / 0.003];
        let change = (now[0] - speed[0]).hypot(now[1] - speed[1]) / 0.003;
        // sqrt(1² + 1²) m/s² are 1414 mm/s².
        assert!(change < 1450.0, "{change}");
        (before, speed) = (at, now);
        match cycle % 500 {
            200 => rig.event("key NC_STOP tap"),
            330 => {
                assert_eq!(state(&rig), RunState::Interrupted);
                assert!(rig.bit("M2183") && rig.bit("M2184"));
                assert_eq!(now, [0.0, 0.0]);
            }
            400 => rig.start(),
            _ => {}
        }
        if rig.control.snapshot().ended {
            break;
        }
    }
    near(display(&rig, 'X'), 50.0);
    near(display(&rig, 'Y'), 50.0);
}

/// The feed override acts at any time: at 0 the path stands, 150 % of F2000 are 3000.
#[test]
fn feed_override() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+150 R0 F2000");
    rig.start();
    for (percent, feed) in [(100, 2000.0), (0, 0.0), (50, 1000.0), (150, 3000.0)] {
        rig.event(&format!("override feed {percent}"));
        rig.seconds(0.4);
        near(rig.control.snapshot().feed_mm_min, feed);
        assert_eq!(rig.control.snapshot().programmed_feed_mm_min, Some(2000.0));
        assert_eq!(f64::from(rig.number("W766")), f64::from(percent));
    }
}

/// A numerical feed remains in effect until a block with another one: rapid traverse counts in its block only, and at a
/// stop the feed is still there [003:2164]. Another program has its own.
#[test]
fn the_feed_stays_at_a_stop() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+150 R0 F2000\nL X+100 FMAX\nSTOP\nL X+50 F500");
    let feed = |rig: &Rig| rig.control.snapshot().programmed_feed_mm_min;
    rig.start();
    rig.until(20.0, "rapid traverse", |rig| feed(rig).is_none());
    rig.until(20.0, "the stop", |rig| {
        rig.control.run_state() == RunState::Stopped
    });
    rig.settle();
    assert_eq!(feed(&rig), Some(2000.0));
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.settle();
    assert_eq!(feed(&rig), Some(500.0));
    rig.command("goto 0");
    assert_eq!(feed(&rig), Some(0.0));
}

/// Rapid traverse never exceeds MP1010, and falls with the override; D596 limits it for the PLC
/// [000:4812-4814].
#[test]
fn rapid_override() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       IFT\n         L     K+6000\n         = D596\n       ENDI"
    );
    let mut rig = bench_with(&plc, "L X+450 R0 FMAX\nL X+50 FMAX");
    rig.start();
    for (percent, feed) in [(100, 15_000.0), (150, 15_000.0), (20, 3000.0)] {
        rig.event(&format!("override feed {percent}"));
        rig.seconds(0.5);
        near(rig.control.snapshot().feed_mm_min, feed);
    }
    assert!(rig.bit("M2151"));
    rig.event("override feed 100");
    rig.event("key A press");
    rig.seconds(0.5);
    near(rig.control.snapshot().feed_mm_min, 6000.0);
}

/// After internal stop the next START begins with the interrupted block from where the axes stand, with Q as
/// of that block: a second pass through `FN1: Q1 = Q1 + 10` would give X+90.
#[test]
fn internal_stop_and_restart() {
    let program = "FN 0: Q1 = +60\nL X+55 R0 F3000\nFN 1: Q1 = +Q1 + +10\nL X+Q1\nFN 1: Q1 = +Q1 + +10\nL IX+20 IY+5\nL X+Q1";
    let mut rig = bench_with(ACKNOWLEDGE, program);
    rig.start();
    rig.until(3.0, "block 4", |rig| nominal(rig, 'X') > 62.0);
    stop(&mut rig);
    let x = nominal(&rig, 'X');
    rig.command("stop");
    rig.seconds(0.1);
    assert!(!rig.bit("M2184") && state(&rig) == RunState::Idle);
    assert_eq!(nominal(&rig, 'X'), x);
    rig.start();
    rig.until(3.0, "block 6", |rig| nominal(rig, 'X') > 80.0);
    near(nominal(&rig, 'Y').floor(), 52.0);
    // Inside an incremental block: it ends where it was programmed to.
    stop(&mut rig);
    rig.command("stop");
    rig.start();
    rig.until(3.0, "its end", |rig| nominal(rig, 'X') == 90.0);
    near(nominal(&rig, 'Y'), 55.0);
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 80.0);
}

/// After internal stop at a programmed stop the next START goes on after it.
#[test]
fn internal_stop_at_a_programmed_stop() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+55 R0 F3000\nSTOP\nL X+60");
    rig.start();
    rig.until(3.0, "STOP", |rig| state(rig) == RunState::Stopped);
    rig.seconds(0.3);
    rig.command("stop");
    rig.start();
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 60.0);
}

/// GOTO block starts there; MDI executes its block and leaves the program as it is.
#[test]
fn goto_and_mdi() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+55 R0 F3000\nL Y+60 F3000\nL X+60");
    rig.command("goto 2");
    run(&mut rig, 3.0);
    near(display(&rig, 'X'), 60.0);
    near(display(&rig, 'Y'), 60.0);
    rig.command("mode mdi");
    rig.command("mdi L Y+40 R0 F3000 M8");
    run(&mut rig, 3.0);
    near(display(&rig, 'Y'), 40.0);
    rig.command("mode full");
    run(&mut rig, 3.0);
    near(display(&rig, 'Y'), 60.0);
}

/// MDI between an internal stop and the restart: the program goes on with its interrupted block.
#[test]
fn mdi_while_a_program_is_interrupted() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+55 R0 F3000\nL X+70\nL X+80");
    rig.start();
    rig.until(3.0, "block 2", |rig| nominal(rig, 'X') > 60.0);
    stop(&mut rig);
    rig.command("stop");
    rig.command("mode mdi");
    rig.command("mdi L Y+40 R0 F3000");
    run(&mut rig, 3.0);
    near(display(&rig, 'Y'), 40.0);
    rig.command("mode single");
    start_block(&mut rig);
    near(display(&rig, 'X'), 70.0);
    near(display(&rig, 'Y'), 40.0);
}

/// START while an axis still brakes from manual operation waits until it stands.
#[test]
fn start_while_an_axis_brakes() {
    let plc = format!(
        "{ACKNOWLEDGE}       L     I20\n       = M2456\n       =N M2472\n       L     I14\n       = M2449\n       =N M2465"
    );
    let mut rig = bench_with(&plc, "L X+150 R0 F3000");
    rig.command("mode manual");
    rig.event("key RAPID press");
    rig.event("key A press");
    rig.seconds(0.5);
    rig.command("mode full");
    rig.start();
    let mut before = nominal(&rig, 'X');
    let mut speed = f64::NAN;
    for _ in 0..3000 {
        rig.cycle();
        let now = (nominal(&rig, 'X') - before) / 0.003;
        before = nominal(&rig, 'X');
        assert!(
            speed.is_nan() || (now - speed).abs() / 0.003 < 1001.0,
            "{speed} {now}"
        );
        speed = now;
    }
    assert!(
        rig.control.snapshot().ended,
        "{:?} {:?}",
        rig.messages(),
        rig.control.snapshot()
    );
    near(display(&rig, 'X'), 150.0);
}

/// An error stops the run at the end of the block before; message with program and block; CE, START try the
/// block again.
#[test]
fn error_in_the_program() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+55 R0 F3000\nFN 4: Q1 = +1 DIV +Q2\nL X+60");
    rig.start();
    rig.seconds(1.0);
    assert_eq!(state(&rig), RunState::Interrupted);
    near(display(&rig, 'X'), 55.0);
    let messages = rig.messages();
    assert!(
        messages[0].starts_with("ARITHMETICAL ERROR program 1.H block 2"),
        "{messages:?}"
    );
    rig.command("ce");
    rig.start();
    rig.seconds(0.5);
    assert_eq!(rig.messages(), messages);
}

/// A block beyond the software limit is refused before it moves: the others go to their end. Back from the
/// limit, CE and GOTO.
#[test]
fn software_limit() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+55 Y+60 R0 F6000\nL X+600\nL X+40");
    rig.start();
    rig.seconds(1.5);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"]);
    near(display(&rig, 'X'), 55.0);
    near(display(&rig, 'Y'), 60.0);
    assert_eq!(state(&rig), RunState::Interrupted);
    rig.command("ce");
    rig.start();
    rig.seconds(0.5);
    assert_eq!(rig.messages(), ["LIMIT SWITCH X+"], "the same block");
    rig.command("ce");
    rig.command("goto 3");
}

/// Without feed enable the axes stand at once; with it the path goes on, and ends where it should.
#[test]
fn feed_enable_lost_on_the_path() {
    let plc = format!("{ACKNOWLEDGE}       L     I20\n       =N M2451\n       L     I20\n       = M2467");
    let mut rig = bench_with(&plc, "L X+100 Y+70 R0 F6000\nL X+50");
    rig.start();
    rig.until(2.0, "half the way", |rig| nominal(rig, 'X') > 70.0);
    rig.event("key A press");
    rig.seconds(0.3);
    let (x, y) = (nominal(&rig, 'X'), nominal(&rig, 'Y'));
    rig.seconds(0.3);
    assert_eq!((nominal(&rig, 'X'), nominal(&rig, 'Y')), (x, y));
    assert!(
        ((x - 50.0) * 2.0 - (y - 50.0) * 5.0).abs() < 0.05,
        "on the path: {x} {y}"
    );
    rig.event("key A release");
    rig.until(4.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
    near(display(&rig, 'X'), 50.0);
    near(display(&rig, 'Y'), 70.0);
}

/// EMERGENCY STOP in a block; after the voltage is back CE, START go on from where the axes stand.
#[test]
fn emergency_stop() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+100 Y+70 R0 F6000\nL X+50");
    rig.start();
    rig.until(2.0, "half the way", |rig| nominal(rig, 'X') > 70.0);
    rig.event("emergency press");
    rig.seconds(1.0);
    assert_eq!(rig.messages()[0], "EXTERNAL EMERGENCY STOP");
    assert_eq!(state(&rig), RunState::Interrupted);
    assert!(!rig.control.snapshot().axes[0].closed);
    rig.event("emergency release");
    rig.seconds(0.5);
    // The drives had no power to brake: POSITIONING ERROR is permitted [000:6157].
    while !rig.messages().is_empty() {
        rig.command("ce");
    }
    rig.seconds(0.5);
    assert!(rig.control.snapshot().axes[0].closed);
    assert_eq!(rig.control.snapshot().mode, Mode::FullSequence);
    rig.start();
    rig.until(4.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 50.0);
    near(display(&rig, 'Y'), 70.0);
}

/// The first blocks take their time as all others, however long the control was on before [000:143]: N lines of 0.01 mm at 6000 mm/min,
/// 0.1 ms each, with 40 ms for a block take 40 ms for each of them, also after a pause.
#[test]
fn block_processing_time_counts_from_the_first_block() {
    for blocks in [100_u32, 200, 300] {
        let lines = (1..=blocks).map(|block| format!("L X+{:.2} R0 F6000", 50.0 + f64::from(block) * 0.01));
        let program = lines.collect::<Vec<_>>().join("\n");
        let mut rig = bench_with(ACKNOWLEDGE, &format!("L X+50 R0 F6000\n{program}"));
        rig.control.set_block_time(40_000);
        rig.seconds(30.0);
        for _ in 0..2 {
            rig.start();
            rig.until(1.0, "the run begins", |rig| state(rig) == RunState::Running);
            let begin_us = rig.control.time_us();
            rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
            let seconds = (rig.control.time_us() - begin_us) as f64 / 1e6;
            let least = f64::from(blocks) * 0.040;
            assert!(
                seconds > least - 0.1 && seconds < least + 4.0,
                "{blocks} blocks: {seconds} s"
            );
            rig.seconds(20.0);
        }
    }
}
