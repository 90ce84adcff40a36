//! In real time: part programs are read on a thread of their own.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod support;

use std::sync::Arc;
use std::time::Duration;

use bahn_host::{Action, Answer, Attendance, Clock, Host, Job, Operator, PowerOn, Source};
use bahn_program::Program;
use bahn_tnc::{Programs, RunState};
use support::*;

/// A contour under RL, many times; what is read comes to 20 (steps of 5) in Q1.
const CONTOUR: &str = "TOOL CALL 2 Z S1000
L X+0 Y+0 R0 FMAX
LBL 1
L X+10 Y+10 RL F6000
L X+50 Y+10
RND R15
L X+50 Y+40
CC X+50 Y+60
C X+50 Y+80 DR+
L X+0 Y+80
L X+0 Y+0 R0
FN 1: Q1 = +Q1 + +5
CALL LBL 1 REP 3
L X+Q1 R0 F6000";

/// Steps until something is so; a machine that hangs fails the test.
fn until(host: &mut Host, mut so: impl FnMut(&mut Host) -> bool) {
    let end_us = host.control().time_us() + 60_000_000;
    while !so(host) {
        let state = host.control().snapshot();
        assert!(host.control().time_us() < end_us, "{state:?}");
        host.step().unwrap();
    }
}

/// Steps until the program cuts.
fn cuts(host: &mut Host) {
    until(host, |host| {
        let state = host.control().snapshot();
        state.feed_mm_min > 1000.0 && state.run == RunState::Running
    });
}

/// All elements of the run to its end.
fn ends(host: &mut Host) -> Vec<[u64; 2]> {
    let mut ends = Vec::new();
    let axes = [bahn_path::Axis::X, bahn_path::Axis::Y];
    until(host, |host| {
        let path = host.take_prepared(0).elements.into_iter();
        ends.extend(path.map(|element| axes.map(|axis| element.end[axis].to_bits())));
        host.control().has_ended()
    });
    ends
}

/// What is read on the thread is what is read in turn; a machine in a hurry gives the thread little time.
#[test]
fn the_path_is_that_of_a_free_clock() {
    let run = |clock: Clock| {
        let mut host = mill(CONTOUR);
        host.keep_path();
        host.set_clock(clock);
        ends(&mut host)
    };
    let free = run(Clock::Free);
    assert!(free.len() > 25, "{}", free.len());
    assert_eq!(run(Clock::Wall(100.0)), free);
}

/// INTERNAL STOP finds the program: it is waited for.
#[test]
fn a_run_is_broken_off() {
    let mut host = mill(CONTOUR);
    cuts(&mut host);
    host.set_clock(Clock::Wall(50.0));
    let act = |host: &mut Host, text: &str| {
        let answer = host.act(Source::Script, Action::parse(text).unwrap()).unwrap();
        assert_eq!(answer, Answer::Done, "{text}");
    };
    act(&mut host, "key NC_STOP tap");
    until(&mut host, |host| {
        let state = host.control().snapshot();
        state.run == RunState::Interrupted && state.feed_mm_min == 0.0
    });
    seconds(&mut host, 0.5);
    act(&mut host, "stop");
    assert_eq!(host.control().run_state(), RunState::Idle);
    let saved = host.save().unwrap();
    seconds(&mut host, 0.5);
    host.restore(&saved).unwrap();
    act(&mut host, "mode manual");
}

/// Programs on a medium that takes its time.
struct Slow(Arc<Texts>);

const SLOW: Duration = Duration::from_millis(1500);

impl Programs for Slow {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        if name.starts_with('2') {
            std::thread::sleep(SLOW);
        }
        self.0.open(name, caller)
    }
}

/// A called program comes from a slow medium while the block before it is cut: no cycle waits for it. 200 mm at
/// 6000 mm/min take 2 s, the medium 1.5 s.
#[test]
fn a_slow_medium_holds_no_cycle() {
    let machine = machine("mill");
    let first = "TOOL CALL 1 Z S1000\nL X+0 Y+0 R0 FMAX\nL X+50 R0 F6000\nSTOP\nL X-150\nCALL PGM 2\nL X+60";
    let texts = Texts::new(&[("1.H", first), ("2", "L Y+10 R0 F6000")]);
    let operator = Operator::new(
        Attendance::Full,
        machine.folder.operator.clone(),
        Some(Job::whole("1.H")),
    );
    let mut host = Host::new(
        &machine,
        PowerOn::fresh(&machine),
        Arc::new(Slow(texts)),
        operator,
    )
    .unwrap();
    until(&mut host, |host| host.control().run_state() == RunState::Stopped);
    host.set_clock(Clock::Wall(1.0));
    until(&mut host, |host| host.control().has_ended());
    let lateness = host.lateness().unwrap();
    assert!(
        lateness.worst_lateness_ms < SLOW.as_secs_f64() * 1e3 / 2.0,
        "{lateness:?}"
    );
}
