//! A program that is executed while it is transferred: however its text comes, the path is that of the whole program.

use crate::support::*;
use bahn_parameters::ControlModel;
use bahn_path::{Axis, PathElement};
use bahn_tnc::{Command, Dnc, DripFeedLine, DripFeedState, RunState};

/// Lines, arcs and roundings under RL, a jump ahead, Q parameters, a dwell, a cycle and M functions.
const BLOCKS: &str = "TOOL DEF 1 L+0 R+3
TOOL CALL 1 Z S1000
FN 0: Q1 = +200
L X+180 Y+100 Z+200 R0 FMAX M3
L X+190 Y+110 RL F3000
RND R4
L X+200 Y+112
CC X+200 Y+122
C X+210 Y+122 DR+
L IX-10 IY+10 M8
FN 9: IF +Q1 EQU +200 GOTO LBL 3
L X+500
LBL 3
L X+180 Y+100 R0 F2000
CYCL DEF 9.0 DWELL TIME
CYCL DEF 9.1 DWELL 0.1
CYCL DEF 1.0 PECKING
CYCL DEF 1.1 SET UP -2
CYCL DEF 1.2 DEPTH -6
CYCL DEF 1.3 PECKG -3
CYCL DEF 1.4 DWELL 0
CYCL DEF 1.5 F800
CYCL CALL
L X+210 R0 FMAX M9
L X+Q1 M5";

fn text(blocks: &str) -> String {
    format!(
        "0 BEGIN PGM 1 MM\r\n{}\r\n9 END PGM 1 MM\r\n",
        blocks.replace('\n', "\r\n")
    )
}

fn rig(build: Build) -> Rig {
    let mut build = build;
    build.tools = None;
    let mut rig = build.rig();
    rig.power_on();
    rig.control.keep_path(true);
    rig.command("mode full");
    rig
}

fn state(rig: &Rig) -> DripFeedState {
    rig.control.first().drip_feed().unwrap()
}

fn give(rig: &mut Rig, text: &str) -> bool {
    rig.control
        .command(Command::Dnc(Dnc::Text(text.as_bytes().into())))
}

/// What a test does with a machine on which a program runs.
struct Line<'a> {
    rest: &'a str,
    seed: u64,
    /// Cycles until the next piece.
    pause: u64,
    ended: bool,
}

impl<'a> Line<'a> {
    fn new(text: &'a str, seed: u64) -> Line<'a> {
        Line {
            rest: text,
            seed,
            pause: 0,
            ended: false,
        }
    }

    fn random(&mut self, below: u64) -> u64 {
        self.seed = self.seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.seed >> 33) % below
    }

    /// Some bytes come, or none for a while.
    fn turn(&mut self, rig: &mut Rig) {
        if self.pause > 0 {
            self.pause -= 1;
        } else if !self.rest.is_empty() && state(rig).wants_more {
            let most = if self.random(8) == 0 { 4000 } else { 60 };
            let size = (1 + self.random(most) as usize).min(self.rest.len());
            let (piece, rest) = self.rest.split_at(size);
            assert!(give(rig, piece));
            self.rest = rest;
            self.pause = if self.random(6) == 0 {
                self.random(400)
            } else {
                self.random(8)
            };
        } else if self.rest.is_empty() && !self.ended {
            rig.command("dnc end");
            self.ended = true;
        }
    }
}

/// The elements of a path as the bits of their numbers.
fn bits(path: &[PathElement]) -> Vec<(u64, u32, [u64; 6], String)> {
    let of = |element: &PathElement| {
        let ends = [Axis::X, Axis::Y, Axis::Z].map(|axis| element.end[axis].to_bits());
        let starts = [Axis::X, Axis::Y, Axis::Z].map(|axis| element.start[axis].to_bits());
        let [a, b, c] = starts;
        let [d, e, f] = ends;
        let how = format!("{:?} {:?} {:?}", element.curve, element.feed, element.functions());
        (element.sequence, element.block.block, [a, b, c, d, e, f], how)
    };
    path.iter().map(of).collect()
}

fn whole(blocks: &str) -> Vec<PathElement> {
    let mut rig = rig(Build::mill().program("1.H", blocks));
    rig.command("select 1.H");
    rig.start();
    let mut path = Vec::new();
    while !rig.control.has_ended() {
        rig.cycle();
        path.extend(rig.control.take_path(0));
        assert!(rig.control.time_us() < 600_000_000, "{:?}", rig.messages());
    }
    path
}

/// Any way the text is cut, and whatever pauses: the same path to the bit. NC stop and single block come in between.
#[test]
fn the_path_is_that_of_the_whole_program() {
    let expected = bits(&whole(BLOCKS));
    assert!(expected.len() > 15, "{}", expected.len());
    let text = text(BLOCKS);
    for seed in 0..12 {
        let mut rig = rig(Build::mill());
        rig.command("dnc begin 1.H");
        rig.start();
        let mut line = Line::new(&text, seed);
        let mut path = Vec::new();
        let mut cycles = 0;
        while !rig.control.has_ended() {
            if rig.control.first().drip_feed().is_some() {
                line.turn(&mut rig);
            }
            rig.cycle();
            path.extend(rig.control.take_path(0));
            cycles += 1;
            match (seed % 3, cycles % 997) {
                (1, 300) => rig.event("key NC_STOP tap"),
                (1, 400) | (2, 600) => rig.start(),
                (2, 500) if rig.control.run_state() == RunState::Running => rig.command("mode single"),
                (2, 590) => rig.command("mode full"),
                _ => {}
            }
            assert!(
                cycles < 300_000,
                "{seed}: {:?} {:?}",
                rig.messages(),
                rig.control.snapshot()
            );
        }
        assert!(bits(&path) == expected, "{seed}");
        rig.cycle();
        assert_eq!(rig.control.first().drip_feed(), None, "{seed}: it is erased");
    }
}

/// What starves slows down on its way, stands at the end of what is known, and leaves the straight line nowhere; with
/// enough known it never stands.
#[test]
fn a_path_that_starves_slows_to_a_stop_and_goes_on() {
    let start = "BEGIN PGM 1 MM\nTOOL CALL 0 Z\nL X+100 Y+100 Z+200 R0 F6000\n";
    let blocks: Vec<String> = (0..200)
        .map(|at| format!("L X+{} Y+100\n", 100.0 + f64::from(at)))
        .collect();
    for pause in [0, 150] {
        let mut rig = rig(Build::mill());
        rig.command("dnc begin 1.H");
        assert!(give(&mut rig, start));
        for block in &blocks[..100] {
            assert!(give(&mut rig, block));
        }
        rig.start();
        let mut stood = 0;
        let mut next = 100;
        let (mut moved, mut waits) = (false, 0);
        while rig.machine_position('X') < 290.0 {
            rig.cycle();
            let element = rig.control.element().map(|element| element.block.block);
            moved |= element.is_some_and(|block| block > 5);
            let view = rig.control.first().snapshot();
            let y = view.axes[1].nominal;
            assert!(!moved || (y - 100.0).abs() < 1e-9, "{y}");
            let stands = moved && view.feed_mm_min == 0.0;
            stood += u32::from(stands);
            if state(&rig).starved {
                assert!(pause > 0 || next == 200, "{next}");
                waits += 1;
            }
            if next < 200 && (pause == 0 || waits >= pause) {
                assert!(give(&mut rig, &blocks[next]));
                next += 1;
                waits = 0;
            }
            assert!(
                rig.control.time_us() < 400_000_000,
                "{:?} {next} {pause} {:?}",
                rig.messages(),
                rig.control.snapshot()
            );
        }
        assert_eq!(stood > 0, pause > 0, "{pause}: {stood}");
    }
}

/// MP7228.1 = 2 kByte: full at 2048 bytes, and 256 of them must be free before more is wanted. No more than one piece lies above.
#[test]
fn a_full_memory_wants_more_when_256_bytes_are_free() {
    let mut rig = rig(Build::mill().mp("MP7228.1=2"));
    rig.command("dnc begin 1.H");
    let start = "BEGIN PGM 1 MM\nTOOL CALL 0 Z\nL X+100 Y+100 Z+200 R0 F3000\n";
    assert!(give(&mut rig, start));
    let mut at = 0;
    let mut next = || {
        at += 1;
        format!("L X+{} Y+{}\n", 100 + at % 50, 100 + at % 7)
    };
    let mut given = start.len();
    while state(&rig).wants_more {
        let block = next();
        given += block.len();
        assert!(give(&mut rig, &block));
    }
    assert_eq!(state(&rig).bytes, given as u64);
    assert!((2048..2048 + 20).contains(&given), "{given}");
    // Refused, and nothing is lost by it.
    assert!(!give(&mut rig, "L X+1\n"));
    assert_eq!(rig.messages(), ["KEY NON-FUNCTIONAL"]);
    rig.command("ce");
    rig.start();
    let mut resumed = 0;
    for _ in 0..20_000 {
        let before = state(&rig);
        rig.cycle();
        let now = state(&rig);
        if !before.wants_more && now.wants_more {
            resumed += 1;
            assert!(now.bytes <= 2048 - 256, "{now:?}");
        }
        assert!(
            before.wants_more || now.wants_more || now.bytes > 2048 - 256,
            "{now:?}"
        );
        if now.wants_more && resumed > 0 {
            while state(&rig).wants_more {
                let block = next();
                assert!(give(&mut rig, &block));
            }
            assert!(state(&rig).bytes < 2048 + 20);
        }
    }
    assert!(resumed > 10, "{resumed}");
}

/// MP7228.0 kByte must be there, and what the run waits for must find room.
#[test]
fn program_memory_overflow() {
    let mut rig = rig(Build::mill().mp("MP7228.0=11").mp("MP7228.1=10"));
    rig.command("dnc begin 1.H");
    assert!(give(&mut rig, "BEGIN PGM 1 MM\nL X+100 R0 F1000\nL X+110\n"));
    rig.start();
    rig.seconds(0.5);
    assert_eq!(rig.messages(), ["Program Memory Overflow"]);
    assert!(!rig.control.first().run_state().eq(&RunState::Running));

    let mut rig = self::rig(Build::mill().mp("MP7228.1=1"));
    rig.command("dnc begin 1.H");
    assert!(give(
        &mut rig,
        "BEGIN PGM 1 MM\nL X+100 R0 F3000\nFN 9: IF +0 EQU +0 GOTO LBL 9\n"
    ));
    rig.start();
    while state(&rig).wants_more {
        assert!(give(&mut rig, "L X+110\n"));
        rig.cycle();
    }
    rig.until(60.0, "the label does not come", |rig| rig.control.is_broken());
    assert!(
        rig.messages()[0].starts_with("Program Memory Overflow"),
        "{:?}",
        rig.messages()
    );
}

/// What a TNC 360 does not execute in a program that is transferred, and what others do.
#[test]
fn limits_of_programs_that_are_transferred() {
    let tools = |count: u32| {
        (1..=count)
            .map(|tool| format!("TOOL DEF {tool} L+0 R+1\n"))
            .collect::<String>()
    };
    let refused = "NOT IN BLOCKWISE TRANSFER";
    let cases = [
        (
            "LBL 1\nL X+20 R0 F1000\nLBL 0\nCALL LBL 1\n".to_owned(),
            Some(refused),
            Some(refused),
        ),
        (
            "LBL 1\nL X+20 R0 F1000\nCALL LBL 1 REP 2/2\n".into(),
            Some(refused),
            Some(refused),
        ),
        (
            "LBL 1\nFN 9: IF +0 EQU +0 GOTO LBL 1\n".into(),
            Some("LABEL NUMBER NOT ALLOCATED"),
            Some("LABEL NUMBER NOT ALLOCATED"),
        ),
        ("FN 15: PRINT 1\n".into(), Some(refused), None),
        ("TCH PROBE 5.0 RANGE\n".into(), Some(refused), None),
        (tools(20), None, None),
        (tools(21), Some(refused), None),
        ("65534 L X+10 R0 F1000\n1 L X+11\n".into(), None, None),
        (
            "L X+10 R0 F1000\n65535 L X+11\n".into(),
            Some("ENTRY VALUE INCORRECT"),
            None,
        ),
        ("CALL PGM 7\n".into(), None, None),
        (
            "CALL PGM 8\n".into(),
            Some("PROGRAM NOT FOUND"),
            Some("PROGRAM NOT FOUND"),
        ),
    ];
    for (blocks, on_360, on_415) in cases {
        for (model, expected) in [(ControlModel::Tnc360, on_360), (ControlModel::Tnc415b, on_415)] {
            let build = match model {
                ControlModel::Tnc360 => Build::of("mill-tnc360", model),
                _ => Build::mill(),
            };
            let mut rig = rig(build.program("7", "LBL 4\nL X+15 R0 F1000\nLBL 0\nCALL LBL 4\n"));
            rig.command("dnc begin 1.H");
            assert!(give(
                &mut rig,
                &format!("0 BEGIN PGM 1 MM\n{blocks}END PGM 1 MM\n")
            ));
            rig.command("dnc end");
            rig.start();
            rig.until(60.0, &blocks, |rig| {
                rig.control.has_ended() || rig.control.is_broken()
            });
            let found = rig.messages();
            match expected {
                Some(message) => assert!(
                    found.iter().any(|found| found.starts_with(message)),
                    "{model} {blocks}: {found:?}"
                ),
                None => assert!(
                    rig.control.has_ended() && found.is_empty(),
                    "{model} {blocks}: {found:?}"
                ),
            }
        }
    }
}

/// The line breaks: what has come runs, the message stands; the line is there again: nothing is lost and nothing doubled.
#[test]
fn a_broken_line_goes_on_where_it_was() {
    let expected = bits(&whole(BLOCKS));
    let text = text(BLOCKS);
    for cut in [40, 150, 301, 420] {
        let mut rig = rig(Build::mill());
        rig.command("dnc begin 1.H");
        assert!(give(&mut rig, &text[..cut]));
        rig.start();
        rig.command("dnc broken");
        rig.until(120.0, "what is known is executed", |rig| state(rig).starved);
        rig.seconds(1.0);
        assert_eq!(rig.messages(), ["PROGRAM INCOMPLETE"]);
        assert_eq!(
            (state(&rig).line, state(&rig).wants_more),
            (DripFeedLine::Broken, false)
        );
        assert!(!give(&mut rig, "L X+1\n"));
        rig.command("ce");
        rig.command("dnc begin 1.H");
        assert!(give(&mut rig, &text[cut..]));
        rig.command("dnc end");
        rig.until(120.0, "the program ends", |rig| rig.control.has_ended());
        assert!(bits(&rig.control.take_path(0)) == expected, "{cut}");
    }
}

/// Nothing more comes: what is known is executed to its last block, and the run has not ended.
#[test]
fn what_is_known_is_executed_when_nothing_more_comes() {
    let mut rig = rig(Build::mill());
    rig.command("dnc begin 1.H");
    assert!(give(
        &mut rig,
        "BEGIN PGM 1 MM\nL X+100 R0 F3000\nL X+110\nL X+120\n"
    ));
    rig.start();
    rig.command("dnc broken");
    rig.command("dnc end");
    rig.until(60.0, "it stands", |rig| rig.control.is_broken());
    assert_eq!(rig.control.take_path(0).last().unwrap().end[Axis::X], 120.0);
    assert_eq!(rig.messages(), ["PROGRAM INCOMPLETE"]);
    assert!(!rig.control.has_ended());
}

/// INTERNAL STOP, EMERGENCY STOP and NC start again go on with the block; power-off erases the program.
#[test]
fn stops_in_between() {
    let text = text(BLOCKS);
    for how in ["stop", "emergency"] {
        let mut rig = rig(Build::mill());
        rig.command("dnc begin 1.H");
        rig.start();
        assert!(give(&mut rig, &text));
        rig.until(60.0, "the contour", |rig| {
            rig.control.element().is_some_and(|e| e.block.block == 7)
        });
        match how {
            "stop" => {
                rig.event("key NC_STOP tap");
                rig.seconds(0.5);
                rig.command("stop");
            }
            _ => {
                rig.event("emergency press");
                rig.seconds(0.5);
                rig.event("emergency release");
                rig.seconds(0.5);
                rig.command("ce");
                rig.seconds(1.0);
            }
        }
        rig.start();
        rig.command("dnc end");
        rig.until(60.0, how, |rig| rig.control.has_ended());
        assert!(
            (rig.control.first().snapshot().axes[0].nominal - 200.0).abs() < 1e-6,
            "{how}"
        );
    }
    let mut rig = rig(Build::mill());
    rig.command("dnc begin 1.H");
    assert!(give(&mut rig, &text));
    rig.command("power off");
    rig.seconds(0.5);
    rig.command("power on");
    assert_eq!(rig.control.first().drip_feed(), None);
    assert!(!give(&mut rig, "L X+1\n"));
}

/// The run starts at a block: the ones before it are not executed, and take no memory [003:1686-1688].
#[test]
fn earlier_blocks_are_ignored() {
    let lines: String = (1..2000)
        .map(|at| format!("{at} L X+{} F3000\n", 100 + at % 40))
        .collect();
    let text = format!("BEGIN PGM 1 MM\n{lines}L X+123\nEND PGM 1 MM\n");
    for from in ["goto 1990", "restore-at 1990"] {
        let mut rig = rig(Build::mill().mp("MP7228.1=4").mp("MP7680=%0000110"));
        rig.command("dnc begin 1.H");
        let mut line = Line::new(&text, 1);
        if from.starts_with("goto") {
            rig.command(from);
            rig.start();
        } else {
            assert!(give(&mut rig, &text[..100]));
            line.rest = &text[100..];
            rig.cycle();
            rig.command(from);
        }
        let mut path = Vec::new();
        let mut stood = 0;
        while !rig.control.has_ended() {
            if rig
                .control
                .first()
                .drip_feed()
                .is_some_and(|feed| feed.wants_more)
                || line.rest.is_empty() && !line.ended
            {
                line.pause = 0;
                line.turn(&mut rig);
            }
            rig.cycle();
            path.extend(rig.control.take_path(0));
            if line.ended && from.starts_with("restore") {
                stood += 1;
                match stood {
                    500 => rig.command("restore-position"),
                    600 | 4000 => rig.start(),
                    _ => {}
                }
            }
            assert!(
                rig.control.time_us() < 300_000_000,
                "{from} {:?} {:?}",
                rig.messages(),
                rig.control.snapshot()
            );
        }
        let executed: Vec<u32> = path
            .iter()
            .map(|element| element.block.block)
            .filter(|block| *block >= 1990)
            .collect();
        assert_eq!(executed, (1990..=2000).collect::<Vec<u32>>(), "{from}");
        assert_eq!(path.last().unwrap().end[Axis::X], 123.0);
    }
}

/// Text comes between cycles, and no cycle allocates: not while the path starves, and not when it goes on.
#[test]
fn cycles_allocate_nothing_while_text_comes() {
    let mut rig = rig(Build::mill());
    rig.control.keep_path(false);
    rig.command("dnc begin 1.H");
    let start = "BEGIN PGM 1 MM\nTOOL CALL 0 Z\nL X+100 Y+100 Z+200 R0 F6000\n";
    assert!(give(&mut rig, start));
    rig.start();
    rig.seconds(1.0);
    let mut next = 0_u32;
    for cycle in 0..20_000 {
        // Much for a while, then nothing.
        if cycle % 2000 < 600 {
            next += 1;
            let block = format!("L X+{} Y+{}\n", 100 + next % 50, 100 + next % 7);
            assert!(give(&mut rig, &block));
        }
        rig.control.prepare();
        let allocated = allocation_counter::measure(|| rig.control.cycle(&mut rig.machine));
        assert_eq!(allocated.count_total, 0, "{cycle} {:?}", rig.messages());
    }
    assert!(rig.control.element().is_some() || state(&rig).starved);
    assert!(next > 5000, "{next}");
}
