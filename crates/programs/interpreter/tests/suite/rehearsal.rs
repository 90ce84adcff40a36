//! A rehearsal finds all faults of a program, and none that is only the consequence of another.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::support::*;
use bahn_interpreter::{NoPrograms, Rehearsal, Settings, rehearse};
use bahn_parameters::{ControlModel, MessageId};
use bahn_program::Program;

fn rehearsed(text: String) -> Rehearsal {
    let program = Arc::new(Program::from_bytes("TEST.H", text.into_bytes()));
    rehearse(
        program,
        Settings::default(),
        Arc::new(NoPrograms),
        &AtomicBool::new(false),
    )
}

/// Blocks and messages of the errors.
fn errors(blocks: &str) -> Vec<(u32, String)> {
    let model = ControlModel::default();
    rehearsed(program(blocks))
        .errors
        .iter()
        .map(|error| (error.block.block, error.message.text(model).to_owned()))
        .collect()
}

fn error(block: u32, message: MessageId) -> (u32, String) {
    (block, message.text(ControlModel::default()).to_owned())
}

/// Five faults of a beginner: BLK FORM 0.2 without 0.1, no feed, no tool for RL, no CC, a cycle call without
/// cycle. Each is found, each once, each with the help that fits its cause.
#[test]
fn five_faults_are_five_errors() {
    let blocks = "\
        BLK FORM 0.2 X+100 Y+100 Z+0
        L X+0 Y+0 R0
        L X+10 Y+0
        L X+20 Y+5 RL F200
        L X+30
        L X+40 RL
        C X+40 Y+20 DR+
        C X+40 Y+40 DR+
        L X+0 Y+0 R0 FMAX
        CYCL CALL
        L X+50 M99";
    let found = rehearsed(program(blocks));
    let blocks: Vec<u32> = found.errors.iter().map(|error| error.block.block).collect();
    assert_eq!(blocks, [1, 2, 4, 7, 10]);
    let helps: Vec<&str> = found.errors.iter().filter_map(|error| error.remedy()).collect();
    for (help, word) in helps
        .iter()
        .zip(["BLK FORM 0.1", "FMAX", "TOOL CALL", "CC", "CYCL DEF"])
    {
        assert!(help.contains(word), "{help} does not speak of {word}");
    }
    assert!(found.complete);
}

/// What follows from a fault is none: the block after a TOOL CALL, CC or F that cannot be read or executed.
#[test]
fn consequences_are_not_reported() {
    use MessageId::*;
    let tool = "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S100\n";
    for (blocks, expected) in [
        (
            "TOOL CALL 300 Z S100\nL X+0 Y+0 RL F100\nL X+9",
            vec![error(1, EntryValueIncorrect)],
        ),
        (
            "TOOL CALL 1 Z Sx\nL X+0 Y+0 RL F100\nL X+9",
            vec![error(1, UnexpectedText)],
        ),
        (
            "CC X+1O Y+0\nL X+0 Y+0 R0 F100\nC X+9 Y+5 DR+",
            vec![error(1, UnexpectedText)],
        ),
        ("L X+0 R0 F1O0\nL X+9\nL X+12", vec![error(1, UnexpectedText)]),
        (
            "L X+1O Y+0 R0 F100\nCC X+0 Y+0\nC X+0 Y+10 DR+\nL X+0 Y+0\nC X+5 Y+5 DR+",
            vec![error(1, UnexpectedText), error(5, CircleEndPosIncorrect)],
        ),
        (
            "CALL PGM 7\nL X+5\nC X+7 Y+8 DR+",
            vec![error(1, ProgramNotFound)],
        ),
        (
            "FN4: Q1 = +1 DIV +0\nTOOL CALL Q1 Z S100\nL X+Q1 FQ1",
            vec![error(1, ArithmeticalError)],
        ),
    ] {
        assert_eq!(errors(blocks), expected, "{blocks}");
    }
    // An arc whose end is wrong ends where it was meant to.
    let arcs = format!("{tool}L X+0 Y+0 R0 F100\nCC X+10 Y+0\nC X+25 Y+0 DR+\nCC X+30 Y+0\nC X+35 Y+0 DR+");
    assert_eq!(errors(&arcs), [error(5, CircleEndPosIncorrect)]);
}

/// BLK FORM 0.2 before 0.1 is one error; the blank that is missing then is no second one.
#[test]
fn a_blank_the_other_way_round_is_one_fault() {
    let found = rehearsed(program("BLK FORM 0.2 X+9 Y+9 Z+0\nBLK FORM 0.1 Z X+0 Y+0 Z-9"));
    let blocks: Vec<u32> = found.errors.iter().map(|error| error.block.block).collect();
    assert_eq!(
        (blocks, found.warnings.len()),
        (vec![1], 0),
        "{:?}",
        found.warnings
    );
    let alone = rehearsed(program("BLK FORM 0.1 Z X+0 Y+0 Z-9"));
    assert_eq!((alone.errors.len(), alone.warnings.len()), (0, 1));
}

/// Values that the program does not set itself may come from its caller.
#[test]
fn unknown_parameters_cause_no_errors() {
    assert_eq!(
        errors(
            "TOOL CALL Q1 Z SQ2\nL X+Q3 Y+0 R0 FQ4\nFN4: Q5 = +1 DIV +Q6\nCC X+Q3 Y+5\nC X+9 Y+9 DR+\nRND R2"
        ),
        []
    );
    assert_eq!(errors("L X+1 FQ1"), []);
    assert_eq!(
        errors("FN0: Q1 = +0\nL X+1 FQ1"),
        [error(2, MessageId::FeedRateIsMissing)]
    );
}

#[test]
fn flow_is_followed() {
    use MessageId::*;
    assert_eq!(
        errors("CALL LBL 9\nL X+1 F100\nCALL LBL 1 REP 3/3\nLBL 1\nM2"),
        [
            error(1, LabelNumberNotAllocated),
            error(3, ExcessiveSubprogramming)
        ]
    );
    // A subprogram without LBL 0, called twice, is one error.
    assert_eq!(
        errors("CALL LBL 1\nCALL LBL 1\nM2\nLBL 1\nL X+1 F100"),
        [error(6, ExcessiveSubprogramming)]
    );
    // A fault in a loop is one error; the loop ends.
    assert_eq!(
        errors("LBL 1\nL X+1 R0\nCALL LBL 1 REP 60000/60000\nL Y+1"),
        [error(2, FeedRateIsMissing)]
    );
    let endless = rehearsed(program("LBL 1\nFN9: IF +0 EQU +0 GOTO LBL 1"));
    assert!(endless.errors.is_empty() && !endless.complete);
}

/// Cycles are looked at without being machined: a pocket of a square metre with an infeed of a micrometre.
#[test]
fn cycles_make_no_path() {
    let blocks = "TOOL DEF 1 L+0 R+0.1\nTOOL CALL 1 Z S100\nCYCL DEF 5.0 POCKET\nCYCL DEF 5.1 SET UP +2\n\
                  CYCL DEF 5.2 DEPTH -50\nCYCL DEF 5.3 PECKG -0.001 F80\nCYCL DEF 5.4 RADIUS 500\n\
                  CYCL DEF 5.5 F100 DR+\nL X+0 Y+0 Z+2 R0 F100 M99\nL X+9 F0 M99";
    let found = rehearsed(program(blocks));
    assert_eq!(
        found
            .errors
            .iter()
            .map(|error| error.block.block)
            .collect::<Vec<_>>(),
        [10]
    );
    assert_eq!(found.warnings.len(), 1, "the sign, once: {:?}", found.warnings);
}

/// Every program of the manual is without error.
#[test]
fn programs_of_the_manual_are_without_error() {
    let folder = format!("{}/tests/programs", env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let runs = Job::new(manual(&name)).run().error.is_none();
        if runs {
            let found = rehearsed(manual(&name));
            assert!(found.errors.is_empty(), "{name}: {:?}", found.errors);
            count += 1;
        }
    }
    assert!(count > 10);
}
