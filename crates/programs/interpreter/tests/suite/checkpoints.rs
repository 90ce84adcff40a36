//! States to go back to: kept where something is on its way, and nowhere else.

use std::sync::Arc;

use bahn_interpreter::{Interpreter, Message, NoPrograms, STATE_COST, Settings};
use bahn_parameters::MessageId;
use bahn_path::{Axis, ElementSource, LiveData, Position, Step};
use bahn_program::Program;

/// Blocks that take no time on a machine before a program is taken for an endless loop, here.
const BLOCKS: u64 = 3000;

fn run(blocks: &str) -> Interpreter {
    let text = format!("BEGIN PGM 1 MM\n{blocks}\nEND PGM 1 MM\n");
    let settings = Settings {
        start: Position::ZERO,
        tool_length_mm: Some(0.0),
        machine: true,
        max_blocks_without_motion: BLOCKS,
        ..Settings::default()
    };
    let program = Arc::new(Program::from_bytes("1.H", text.into()));
    let mut run = Interpreter::new(program, settings, Arc::new(NoPrograms));
    run.keep_checkpoints();
    run
}

/// Runs to the end; the largest count of states kept at once, and the last step.
fn most_kept(run: &mut Interpreter) -> (usize, Step<Box<bahn_interpreter::ProgramError>>) {
    let mut most = 0;
    loop {
        let step = run.next();
        most = most.max(run.checkpoints());
        match step {
            Step::Element(element) => run.forget_before(element.sequence),
            Step::Barrier(_) => run.resume(LiveData::default()),
            end => return (most, end),
        }
    }
}

/// Loops without a movement end as such, and keep no more states than a program that moves: those of the
/// block before, of one that is held back, and of the block that is executed.
#[test]
fn loops_without_movement_keep_no_states() {
    let bodies = [
        "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +0",
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+0",
        "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1",
        "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 1",
        "CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 90",
        "TOOL DEF 1 L+0 R+5",
        "L R0 F100",
        "L IX+0 R0 F100",
        "L M97",
        "L M103",
        "L M112",
    ];
    for body in bodies {
        for before in [
            "",
            "L X+10 R0 F100\n",
            "TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S1\nL X+0 RL F100\nL X+10\n",
        ] {
            let mut run = run(&format!(
                "{before}LBL 1\n{body}\nFN 9: IF +0 EQU +0 GOTO LBL 1\nL X+20 R0 F100"
            ));
            let (most, end) = most_kept(&mut run);
            // What cycle 13 tells the PLC waits after a compensated contour, as much of it as may wait there.
            let waiting = if body.contains("13.1") && before.contains("RL") {
                502
            } else {
                0
            };
            assert!(most <= 4 + waiting, "{before}{body}: {most} states");
            let Step::Error(error) = end else {
                panic!("{before}{body} ends with {end:?}")
            };
            assert_eq!(
                error.message,
                Message::Control(MessageId::EndlessLoop),
                "{before}{body}"
            );
        }
    }
}

/// A block whose elements are on their way can be gone back to, whatever came after it without a movement.
#[test]
fn the_state_before_an_element_on_its_way_is_kept() {
    let mut run =
        run("L X+10 R0 F100\nFN 0: Q1 = +1\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+5\nL X+20\nL X+30");
    let mut sequences = Vec::new();
    while let Step::Element(element) = run.next() {
        sequences.push((element.sequence, element.end[Axis::X]));
    }
    assert_eq!(sequences, [(1, 10.0), (5, 25.0), (6, 35.0)]);
    run.go_back(|state| state.sequence() <= 5);
    let mut here = Position::ZERO;
    here[Axis::X] = 12.0;
    run.relocate(&here);
    let Step::Element(again) = run.next() else {
        panic!("block 5 runs again")
    };
    assert_eq!(
        (again.sequence, again.start[Axis::X], again.end[Axis::X]),
        (5, 12.0, 25.0)
    );
}

/// Incremental coordinates count from where the block would have begun, X10, however often the axes are moved before it.
#[test]
fn increments_count_from_the_path() {
    let mut run = run("L X+10 R0 F100\nL IX+5");
    assert!(matches!(run.next(), Step::Element(_)));
    for x in [12.0, 13.0] {
        let mut here = Position::ZERO;
        here[Axis::X] = x;
        run.relocate(&here);
    }
    let Step::Element(element) = run.next() else {
        panic!("the second block runs")
    };
    assert_eq!((element.start[Axis::X], element.end[Axis::X]), (13.0, 15.0));
}

/// A hundred jumps are a hundred units of work and more: they need several turns.
#[test]
fn work_is_bounded() {
    let mut run =
        run("FN 0: Q1 = +0\nLBL 1\nFN 1: Q1 = +Q1 + +1\nFN 12: IF +Q1 LT +100 GOTO LBL 1\nL X+10 R0 F100");
    let mut turns = 0;
    let element = loop {
        run.allow(50);
        turns += 1;
        match run.next() {
            Step::Starved => assert!(turns < 100),
            step => break step,
        }
    };
    // BEGIN, FN 0, 100 times LBL, FN 1, FN 12, then the line with its state, in turns of 50.
    let work = 2 + 300 + STATE_COST;
    assert_eq!(turns, work.div_ceil(50));
    assert!(matches!(element, Step::Element(_)));
}

/// A loop that waits for the PLC, or that dwells, takes time: it is no endless one.
#[test]
fn a_loop_that_takes_time_goes_on() {
    for body in ["M70", "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1"] {
        let mut run = run(&format!("LBL 1\n{body}\nFN 9: IF +0 EQU +0 GOTO LBL 1"));
        for _ in 0..2 * BLOCKS {
            match run.next() {
                Step::Element(element) => run.forget_before(element.sequence),
                Step::Barrier(_) => run.resume(LiveData::default()),
                other => panic!("{body}: {other:?}"),
            }
        }
    }
}
