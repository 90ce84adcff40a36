//! Labels, section repeats, program calls: the manual's programs and its lists of executed steps.

use crate::support::*;
use bahn_path::{Axis, Function};

/// Where holes are drilled: X, Y and lowest Z of each plunge that goes below zero, once per place.
fn holes(run: &Run, blocks: impl Fn(u32) -> bool) -> Vec<[f64; 3]> {
    let mut holes: Vec<[f64; 3]> = Vec::new();
    for e in run
        .moves()
        .filter(|e| blocks(e.block.block) && !is_rapid(e) && e.end[Axis::Z] < 0.0)
    {
        let at = xyz(&e.end);
        match holes.last_mut() {
            Some(last) if last[0] == at[0] && last[1] == at[1] => last[2] = last[2].min(at[2]),
            _ => holes.push(at),
        }
    }
    holes
}

/// Four holes at the corners of a square of 20 mm.
fn group(x: f64, y: f64, z: f64) -> [[f64; 3]; 4] {
    [
        [x, y, z],
        [x + 20.0, y, z],
        [x + 20.0, y + 20.0, z],
        [x, y + 20.0, z],
    ]
}

/// P10: three groups of four holes by a subprogram [003:3708-3743].
#[test]
fn p10_groups_of_holes() {
    let run = run_manual("P10");
    let expected = [
        group(15.0, 10.0, -10.0),
        group(45.0, 60.0, -10.0),
        group(75.0, 10.0, -10.0),
    ]
    .concat();
    close_points(&holes(&run, |_| true), &expected, 1e-9);
    // One infeed and back to Z+2 for each.
    let in_cycle = run.of_blocks(21..=24);
    assert_eq!(in_cycle.iter().filter(|e| !is_rapid(e)).count(), 12);
    let backs: Vec<_> = in_cycle
        .iter()
        .filter(|e| is_rapid(e) && e.start[Axis::Z] < 0.0)
        .collect();
    assert!(backs.len() == 12 && backs.iter().all(|e| e.end[Axis::Z] == 2.0));
}

/// P11: six holes by repeating a section five times [003:3798-3810].
#[test]
fn p11_row_of_holes() {
    let run = run_manual("P11");
    let expected: Vec<[f64; 3]> = (0..6).map(|k| [5.0 + 15.0 * f64::from(k), 10.0, -10.0]).collect();
    close_points(&holes(&run, |_| true), &expected, 1e-9);
    // Block 9 runs six times: the call repeats the section five times more.
    assert_eq!(run.blocks_executed, 6 + 6 * 5 + 1);
}

/// P12: three tools with one subprogram for approaching and one for machining [003:3946-3975].
#[test]
fn p12_three_tools() {
    let run = run_manual("P12");
    let calls = run.tool_calls();
    assert_eq!(calls.iter().map(|call| call.tool).collect::<Vec<_>>(), [1, 2, 3]);
    let mut expected = Vec::new();
    for depth in [-3.0, -15.0, -10.0] {
        for (x, y) in [(15.0, 10.0), (45.0, 60.0), (75.0, 10.0)] {
            expected.extend(group(x, y, depth));
        }
    }
    close_points(&holes(&run, |_| true), &expected, 1e-9);
    // Tapping turns the spindle round at the bottom and above each hole.
    let reversals = run
        .functions()
        .into_iter()
        .filter(|(_, f)| **f == Function::M(4))
        .count();
    assert_eq!(reversals, 12);
}

/// A program whose blocks move X to their own number, except those that are given.
fn marked(blocks: u32, given: &[(u32, &str)]) -> String {
    let mut text = "0 BEGIN PGM MARKED MM\n".to_owned();
    for number in 1..blocks {
        let block = match given.iter().find(|(at, _)| *at == number) {
            Some((_, block)) => (*block).to_owned(),
            None => format!("L X+{number} FMAX"),
        };
        text.push_str(&format!("{number} {block}\n"));
    }
    text + &format!("{blocks} END PGM MARKED MM\n")
}

/// Moving blocks in the order of execution.
fn trace(text: String) -> Vec<u32> {
    let run = Job::new(text).run();
    run.assert_completed();
    let trace: Vec<u32> = run.moves().map(|e| e.end[Axis::X] as u32).collect();
    assert!(run.moves().all(|e| e.block.block == e.end[Axis::X] as u32));
    trace
}

/// The moving blocks of ranges one after the other.
fn steps(ranges: &[std::ops::RangeInclusive<u32>], given: &[(u32, &str)]) -> Vec<u32> {
    let moves = |n: &u32| given.iter().all(|(at, block)| at != n || block.contains("M2"));
    ranges.iter().cloned().flatten().filter(moves).collect()
}

/// P14a: a subprogram called within a subprogram [003:3931-3938].
#[test]
fn p14_subprogram_in_subprogram() {
    let given = [
        (17, "CALL LBL 1"),
        (35, "L X+35 FMAX M2"),
        (36, "LBL 1"),
        (39, "CALL LBL 2"),
        (45, "LBL 0"),
        (46, "LBL 2"),
        (62, "LBL 0"),
    ];
    let expected = steps(&[1..=17, 36..=39, 46..=62, 40..=45, 18..=35], &given);
    assert_eq!(trace(marked(63, &given)), expected);
}

/// P14b: a repeat within a repeat starts with its full count each time [003:3991-3997].
#[test]
fn p14_repeat_in_repeat() {
    let given = [
        (15, "LBL 1"),
        (20, "LBL 2"),
        (27, "CALL LBL 2 REP 2/2"),
        (35, "CALL LBL 1 REP 1/1"),
        (50, "L X+50 FMAX M2"),
    ];
    let expected = steps(
        &[
            1..=27,
            20..=27,
            20..=27,
            28..=35,
            15..=27,
            20..=27,
            20..=27,
            28..=35,
            36..=50,
        ],
        &given,
    );
    let trace = trace(marked(51, &given));
    assert_eq!(trace, expected);
    assert_eq!(trace.iter().filter(|block| **block == 21).count(), 6);
}

/// P14c: a subprogram called in a section that is repeated [003:4011-4021].
#[test]
fn p14_subprogram_in_repeat() {
    let given = [
        (10, "LBL 1"),
        (11, "CALL LBL 2"),
        (12, "CALL LBL 1 REP 2/2"),
        (19, "L X+19 FMAX M2"),
        (20, "LBL 2"),
        (28, "LBL 0"),
    ];
    let expected = steps(&[1..=11, 20..=28, 12..=12, 20..=28, 20..=28, 13..=19], &given);
    assert_eq!(trace(marked(29, &given)), expected);
}

/// The label of a subprogram that stands in the way is passed over, its LBL 0 too [003:3644-3650].
#[test]
fn a_subprogram_in_the_way_runs_once() {
    let given = [
        (3, "LBL 1"),
        (5, "LBL 0"),
        (7, "CALL LBL 1"),
        (9, "L X+9 FMAX M2"),
    ];
    let expected = steps(&[1..=7, 4..=4, 8..=9], &given);
    assert_eq!(trace(marked(10, &given)), expected);
}

/// REP may be a Q parameter, and repeats 0 times when it is 0; empty REP is a plain call.
#[test]
fn repeats_by_q() {
    let text =
        "FN 0: Q7 = +3\nLBL 1\nL IX+1 FMAX\nCALL LBL 1 REP Q7\nFN 0: Q7 = +0\nCALL LBL 1 REP Q7\nL Z+1 FMAX";
    let run = run(text);
    assert_eq!(run.of_block(3).len(), 4);
}

/// P21: a jump to another program is a jump to a label with CALL PGM after it [003:4319-4331].
#[test]
fn p21_jump_to_another_program() {
    let main = program(
        "L X+1 FMAX
         FN 12: IF +Q5 LT +0 GOTO LBL 5
         L X+2 FMAX M2
         LBL 5
         CALL PGM 100
         L X+3 FMAX",
    );
    let other = "0 BEGIN PGM 100 MM\n1 L X+100 FMAX\n2 END PGM 100 MM\n";
    let ends = |q5: f64| {
        let run = Job::new(main.clone())
            .library("100", other)
            .with(|s| s.q_values = vec![(5, q5)])
            .run();
        run.assert_completed();
        run.moves().map(|e| e.end[Axis::X]).collect::<Vec<_>>()
    };
    assert_eq!(ends(-0.001), [1.0, 100.0, 3.0]);
    assert_eq!(ends(0.0), [1.0, 2.0]);
}

/// P37: cycle 12 makes a program a cycle; it is called like one [003:6476-6494].
#[test]
fn p37_program_as_cycle() {
    let run = Job::new(manual("P37")).library("50", manual("P37-50")).run();
    run.assert_completed();
    let slots: Vec<_> = run.moves().filter(|e| e.block.program == 1).collect();
    let expected = [20.0, 60.0]
        .map(|x| {
            [
                [x, 50.0, -5.0],
                [x + 10.0, 50.0, -5.0],
                [x, 50.0, -5.0],
                [x, 50.0, 2.0],
            ]
        })
        .concat();
    close_points(
        &slots.iter().map(|e| xyz(&e.end)).collect::<Vec<_>>(),
        &expected,
        1e-9,
    );
}

/// A called program in inches is converted; Q113 keeps the unit of the main program [003:7631-7637].
#[test]
fn a_called_inch_program() {
    let inch = "0 BEGIN PGM 8 INCH\n1 L IX+1 F10\n2 FN 0: Q1 = +Q113\n3 END PGM 8 INCH\n";
    let run = Job::new(program("L X+100 F500\nCALL PGM 8\nL IX+1"))
        .library("8", inch)
        .run();
    run.assert_completed();
    let ends: Vec<_> = run.moves().map(|e| e.end[Axis::X]).collect();
    assert!(
        ends.iter()
            .zip([100.0, 125.4, 126.4])
            .all(|(a, b)| (a - b).abs() < 1e-9),
        "{ends:?}"
    );
    assert_eq!(run.q[1], 0.0);
    // F10 in an inch program is one inch/min.
    let feeds: Vec<_> = run.moves().map(|e| e.feed).collect();
    assert_eq!(feeds[1], bahn_path::FeedRate::Programmed(25.4));
    // That is slow for a program; it is said once for the program however often it is called.
    let slow: Vec<_> = run
        .warnings
        .iter()
        .map(|w| (w.block.program, w.block.block, w.count))
        .collect();
    assert_eq!(slow, [(1, 1, 1)]);
}

/// Called programs share Q parameters, transformations, tool, pole and cycle definition with their callers
/// (inferred).
#[test]
fn what_a_called_program_leaves() {
    let called = "0 BEGIN PGM 9 MM\n1 FN 0: Q1 = +5\n2 CYCL DEF 7.0 DATUM\n3 CYCL DEF 7.1 X+100\n4 CC X+1 Y+2\n5 END PGM 9 MM\n";
    let run = Job::new(program("CALL PGM 9\nL X+Q1 Y+0 FMAX\nLP PR+10 PA+0 FMAX"))
        .library("9", called)
        .run();
    run.assert_completed();
    let ends: Vec<_> = run.moves().map(|e| [e.end[Axis::X], e.end[Axis::Y]]).collect();
    close_points(&ends, &[[105.0, 0.0], [111.0, 2.0]], 1e-9);
}

/// M2 in a called program ends the whole run, with a warning [003:3870-3902].
#[test]
fn m2_in_a_called_program() {
    let called = "0 BEGIN PGM 9 MM\n1 L X+1 FMAX M2\n2 END PGM 9 MM\n";
    let run = Job::new(program("CALL PGM 9\nL X+2 FMAX"))
        .library("9", called)
        .run();
    run.assert_completed();
    assert_eq!(run.moves().count(), 1);
    assert!(
        run.warnings
            .iter()
            .any(|w| w.kind == bahn_interpreter::WarningKind::EndInCalledProgram)
    );
}
