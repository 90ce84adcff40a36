//! Part programs are read on another thread: the path is the same, and what comes meanwhile is not lost.

use crate::support::*;
use bahn_tnc::{ReadAhead, RunState};

/// Lines, arcs and roundings under RL, with a loop, a Q parameter, a dwell, M functions and a programmed stop.
const PROGRAM: &str = "TOOL DEF 1 L+0 R+3
TOOL CALL 1 Z S1000
FN 0: Q1 = +0
L X+180 Y+100 R0 FMAX
LBL 1
L X+190 Y+110 RL F3000
RND R4
L X+200 Y+112
CC X+200 Y+122
C X+210 Y+122 DR+
L IX-10 IY+10 M8
L X+180 Y+100 R0 F2000
CYCL DEF 9.0 DWELL TIME
CYCL DEF 9.1 DWELL 0.1
FN 1: Q1 = +Q1 + +1
CALL LBL 1 REP 150
STOP
L X+210 R0 FMAX M9
L X+Q1";

/// A driver that keeps what is lent for some cycles.
struct Slow {
    seed: u64,
    away: Option<(ReadAhead, u64)>,
    loans: u32,
}

impl Slow {
    fn new(seed: u64) -> Slow {
        Slow {
            seed,
            away: None,
            loans: 0,
        }
    }

    /// What is lent comes back after 0 to 20 cycles.
    fn turn(&mut self, rig: &mut Rig) {
        if let Some((mut read, cycles)) = self.away.take() {
            match cycles {
                0 => {
                    read.read();
                    rig.control.take_back(read);
                }
                _ => self.away = Some((read, cycles - 1)),
            }
        }
        if self.away.is_none() {
            self.seed = self.seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let cycles = (self.seed >> 33) % 21;
            self.away = rig.control.hand_over_reading().map(|read| (read, cycles));
            self.loans += u32::from(self.away.is_some());
        }
    }

    fn settle(&mut self, rig: &mut Rig) {
        if let Some((mut read, _)) = self.away.take() {
            read.read();
            rig.control.take_back(read);
        }
    }
}

fn started(program: &str, beside: bool) -> Rig {
    let mut build = Build::mill().program("1.H", program);
    build.tools = None;
    let mut rig = build.rig();
    rig.power_on();
    rig.control.keep_path(true);
    rig.control.read_beside(beside);
    rig.command("mode full");
    rig.command("select 1.H");
    rig.start();
    rig
}

/// Goes on until something is so.
fn until(rig: &mut Rig, slow: &mut Slow, what: &str, mut so: impl FnMut(&Rig) -> bool) {
    let end = rig.control.time_us() + 60_000_000;
    while !so(rig) {
        assert!(rig.control.time_us() < end, "{what}: {:?}", rig.messages());
        slow.turn(rig);
        rig.cycle();
    }
}

/// The ends of all elements, X and Y, bit by bit; NC start at the programmed stop.
fn ends(rig: &mut Rig, slow: &mut Slow) -> Vec<[u64; 2]> {
    let mut ends = Vec::new();
    let axes = [bahn_path::Axis::X, bahn_path::Axis::Y];
    for _ in 0..1_000_000 {
        slow.turn(rig);
        rig.cycle();
        let path = rig.control.take_path(0).into_iter();
        ends.extend(path.map(|element| axes.map(|axis| element.end[axis].to_bits())));
        if rig.control.run_state() == RunState::Stopped {
            rig.start();
        }
        if rig.control.has_ended() {
            return ends;
        }
    }
    panic!("it does not end: {:?}", rig.messages())
}

/// However long the program is away, the path is that of a control that reads it itself.
#[test]
fn the_path_is_the_same() {
    let own = ends(&mut started(PROGRAM, false), &mut Slow::new(0));
    assert!(own.len() > 100, "{}", own.len());
    for seed in 1..4 {
        let mut slow = Slow::new(seed);
        assert!(ends(&mut started(PROGRAM, true), &mut slow) == own, "seed {seed}");
        assert!(slow.loans > 10, "{}", slow.loans);
    }
}

/// Nothing is lent when the control reads itself.
#[test]
fn nothing_is_handed_over_unasked() {
    let mut rig = started(PROGRAM, false);
    rig.seconds(1.0);
    assert!(rig.control.hand_over_reading().is_none());
}

/// Without a reader the path ends where what was read ends, without a mark in it: the axes brake, and go on when it is
/// back. Elements of 0.1 mm at 6 m/min last 1 ms each; a thousand that were read ahead last 1 s.
#[test]
fn a_reader_that_does_not_come_back_holds_the_path() {
    let blocks = "TOOL CALL 1 Z S1000\nL X+200 Y+100 R0 FMAX\nLBL 1\nL IX+0.1 IY+0.01 R0 F6000\nL IX+0.1 IY-0.01\nCALL LBL 1 REP 800\nL X+200";
    let mut rig = started(&format!("TOOL DEF 1 L+0 R+3\n{blocks}"), true);
    let mut slow = Slow::new(1);
    until(&mut rig, &mut slow, "it cuts", |rig| {
        rig.control.snapshot().feed_mm_min > 5900.0
    });
    slow.settle(&mut rig);
    rig.cycle();
    let Some(mut read) = rig.control.hand_over_reading().or_else(|| {
        rig.seconds(1.0);
        rig.control.hand_over_reading()
    }) else {
        panic!("there is more to read")
    };
    rig.until(5.0, "what was read is over", |rig| {
        rig.control.snapshot().feed_mm_min == 0.0
    });
    assert_eq!(rig.control.run_state(), RunState::Running);
    assert!(
        !rig.control.command("stop".parse().unwrap()),
        "the program is away"
    );
    read.read();
    rig.control.take_back(read);
    assert!(ends(&mut rig, &mut slow).len() > 100);
}

/// NC stop while the program is away, INTERNAL STOP when it is back; the next start goes on with the block.
#[test]
fn internal_stop_and_start_again() {
    let mut rig = started(PROGRAM, true);
    let mut slow = Slow::new(7);
    until(&mut rig, &mut slow, "it cuts", |rig| {
        rig.control.snapshot().feed_mm_min > 2000.0
    });
    rig.event("key NC_STOP press");
    until(&mut rig, &mut slow, "it stands", |rig| {
        rig.control.run_state() == RunState::Interrupted && rig.control.snapshot().feed_mm_min == 0.0
    });
    rig.event("key NC_STOP release");
    rig.seconds(0.2);
    slow.settle(&mut rig);
    let block = rig.control.element().unwrap().block;
    rig.command("stop");
    assert_eq!(rig.control.run_state(), RunState::Idle);
    rig.start();
    let mut first = None;
    until(&mut rig, &mut slow, "it cuts again", |rig| {
        first = first.or(rig
            .control
            .element()
            .filter(|_| rig.control.run_state() == RunState::Running)
            .map(|element| element.block));
        rig.control.snapshot().feed_mm_min > 1000.0
    });
    assert_eq!(first.map(|first| first.block), Some(block.block));
    assert!(ends(&mut rig, &mut slow).len() > 10);
}
