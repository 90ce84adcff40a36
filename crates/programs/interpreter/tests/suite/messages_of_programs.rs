//! Messages of program flow, input values and calculations, raised by a small program at the block that
//! causes them [003:7866-8033].

use crate::cases::{TOOL, check, check_with_tool, check_with_tool_on};
use crate::support::*;
use bahn_interpreter::{Message, WarningKind};
use bahn_parameters::{ControlModel, MessageId};

#[test]
fn arithmetical_error() {
    use MessageId::ArithmeticalError as M;
    check(&[
        ("division by zero", M, 2, "FN 0: Q2 = +0\nFN 4: Q1 = +8 DIV +Q2"),
        ("root of a negative number", M, 1, "FN 5: Q1 = SQRT -4"),
    ]);
    let formulas = |text: &str| {
        let run = Job::new(program(text))
            .with(|s| s.model = ControlModel::Tnc415b)
            .run();
        run.message()
    };
    assert_eq!(formulas("Q1 = 1 / ( 2 - 2 )"), Some((M, 1)));
    assert_eq!(formulas("Q1 = SQRT ( 1 - 2 )"), Some((M, 1)));
    assert_eq!(formulas("Q1 = LN 0"), Some((M, 1)));
    assert_eq!(formulas("Q1 = ASIN 1.5"), Some((M, 1)));
}

#[test]
fn axis_double_programmed() {
    use MessageId::AxisDoubleProgrammed as M;
    check(&[
        ("twice", M, 2, "L Z+1 FMAX\nL X+1 X+2 FMAX"),
        ("absolute and incremental", M, 1, "L X+1 IX+2 FMAX"),
        ("in CC", M, 1, "CC X+1 X+2"),
        ("in an arc", M, 2, "CC X+0 Y+0\nC X+1 X+2 DR+ F10"),
    ]);
}

#[test]
fn blk_form_definition_incorrect() {
    use MessageId::BlkFormDefinitionIncorrect as M;
    check(&[
        (
            "MIN above MAX",
            M,
            2,
            "BLK FORM 0.1 Z X+0 Y+0 Z+0\nBLK FORM 0.2 X+100 Y+100 Z-20",
        ),
        (
            "a side without length",
            M,
            2,
            "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+0 Y+100 Z+0",
        ),
        (
            "sides 84:1",
            M,
            2,
            "BLK FORM 0.1 Z X+0 Y+0 Z+0\nBLK FORM 0.2 X+84 Y+10 Z+1",
        ),
        (
            "MIN incremental",
            M,
            1,
            "BLK FORM 0.1 Z IX+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+100 Z+0",
        ),
        ("MAX alone", M, 1, "BLK FORM 0.2 X+100 Y+100 Z+0"),
        (
            "an axis is missing",
            M,
            2,
            "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Z+0",
        ),
    ]);
    // 83.9:1 is allowed, and MAX may be incremental.
    run("BLK FORM 0.1 Z X+0 Y+0 Z+0\nBLK FORM 0.2 IX+83.9 IY+10 IZ+1");
    // A blank in a called program only is none: the run says so.
    let called =
        "0 BEGIN PGM 7 MM\n1 BLK FORM 0.1 Z X+0 Y+0 Z-20\n2 BLK FORM 0.2 X+100 Y+100 Z+0\n3 END PGM 7 MM\n";
    let run = Job::new(program("CALL PGM 7")).library("7", called).run();
    run.assert_completed();
    assert!(
        run.warnings
            .iter()
            .any(|w| w.kind == WarningKind::BlankInCalledProgram)
    );
}

#[test]
fn excessive_subprogramming() {
    use MessageId::ExcessiveSubprogramming as M;
    // Subprogram n calls n+1.
    let nested = |levels: u32| {
        let mut text = "CALL LBL 1\nL X+0 FMAX M2\n".to_owned();
        for n in 1..=levels {
            let call = if n < levels {
                format!("CALL LBL {}\n", n + 1)
            } else {
                String::new()
            };
            text.push_str(&format!("LBL {n}\n{call}LBL 0\n"));
        }
        text
    };
    run(&nested(8));
    // The call in level 8: after 2 blocks and seven subprograms of 3 blocks, the second block of its own.
    check(&[
        ("nine levels", M, 2 + 7 * 3 + 2, &nested(9)),
        (
            "a subprogram calls itself",
            M,
            3,
            "CALL LBL 1\nLBL 1\nCALL LBL 1\nLBL 0",
        ),
        (
            "two subprograms call each other",
            M,
            7,
            "CALL LBL 1\nL X+0 FMAX M2\nLBL 1\nCALL LBL 2\nLBL 0\nLBL 2\nCALL LBL 1\nLBL 0",
        ),
        (
            "LBL 0 is missing",
            M,
            5,
            "CALL LBL 1\nL X+0 FMAX M2\nLBL 1\nL X+1 FMAX",
        ),
        (
            "a subprogram with REP",
            M,
            1,
            "CALL LBL 1 REP 2/2\nL X+0 FMAX M2\nLBL 1\nLBL 0",
        ),
        (
            "a section without REP",
            M,
            3,
            "LBL 1\nL X+0 FMAX\nCALL LBL 1\nL X+1 FMAX",
        ),
    ]);
}

#[test]
fn excessive_program_calls() {
    use MessageId::ExcessiveSubprogramming as M;
    let call = |name: &str, next: &str| format!("0 BEGIN PGM {name} MM\n1 {next}\n2 END PGM {name} MM\n");
    let job = |last: &str| {
        Job::new(program("CALL PGM P1"))
            .library("P1", call("P1", "CALL PGM P2"))
            .library("P2", call("P2", "CALL PGM P3"))
            .library("P3", call("P3", "CALL PGM P4"))
            .library("P4", call("P4", last))
            .library("P5", call("P5", "L X+1 FMAX"))
    };
    // Four levels [003:3915-3921].
    job("L X+1 FMAX").run().assert_completed();
    let fifth = job("CALL PGM P5").run();
    assert_eq!(fifth.message(), Some((M, 1)));
    assert_eq!(fifth.error.unwrap().program, "P4");
    // Recursion, of another program and of the main program itself.
    let recursion = Job::new(program("CALL PGM P1"))
        .library("P1", call("P1", "CALL PGM P1"))
        .run();
    assert_eq!(recursion.message().map(|(id, _)| id), Some(M));
    let of_main = Job::new(program("CALL PGM TEST")).run();
    assert_eq!(of_main.message(), Some((M, 1)));
}

#[test]
fn feed_rate_is_missing() {
    use MessageId::FeedRateIsMissing as M;
    check_with_tool(&[
        ("no feed at all", M, 1, "L X+10"),
        ("FMAX holds for one block", M, 2, "L X+10 FMAX\nL X+20"),
        ("an arc", M, 2, "CC X+10 Y+0\nC X+20 Y+0 DR+"),
        ("feed 0", M, 1, "L X+10 F0"),
    ]);
}

#[test]
fn labels() {
    check(&[
        (
            "CALL LBL 0",
            MessageId::JumpToLabelZeroNotPermitted,
            1,
            "CALL LBL 0",
        ),
        (
            "jump to 0",
            MessageId::JumpToLabelZeroNotPermitted,
            1,
            "FN 9: IF +1 EQU +1 GOTO LBL 0",
        ),
        (
            "set twice",
            MessageId::LabelNumberAllocated,
            3,
            "CALL LBL 4\nLBL 4\nLBL 4\nLBL 0",
        ),
        (
            "set twice, jump",
            MessageId::LabelNumberAllocated,
            3,
            "FN 9: IF +1 EQU +1 GOTO LBL 4\nLBL 4\nLBL 4",
        ),
        (
            "not set",
            MessageId::LabelNumberNotAllocated,
            2,
            "LBL 1\nCALL LBL 2",
        ),
        (
            "not set, jump",
            MessageId::LabelNumberNotAllocated,
            1,
            "FN 9: IF +1 EQU +1 GOTO LBL 2",
        ),
        (
            "not set, repeat",
            MessageId::LabelNumberNotAllocated,
            1,
            "CALL LBL 2 REP 3",
        ),
        (
            "not set, cycle 14",
            MessageId::LabelNumberNotAllocated,
            11,
            &format!(
                "{TOOL}CYCL DEF 14.0 GEOM\nCYCL DEF 14.1 CONTOUR LABEL 9\nCYCL DEF 6.0 ROUGH\nCYCL DEF 6.1 SET UP -2 DEPTH -10\nCYCL DEF 6.2 PECKG -5 F100 ALLOW +0\nCYCL DEF 6.3 ANGLE +0 F100\nL Z+2 FMAX\nCYCL CALL"
            ),
        ),
    ]);
}

#[test]
fn wrong_rpm() {
    check(&[
        (
            "too fast",
            MessageId::WrongRpm,
            2,
            "FN 0: Q1 = +100000\nTOOL CALL 0 Z SQ1",
        ),
        (
            "negative",
            MessageId::WrongRpm,
            2,
            "FN 0: Q1 = -1\nTOOL CALL 0 Z SQ1",
        ),
        (
            "rigid tapping without speed",
            MessageId::WrongRpm,
            7,
            "TOOL CALL 0 Z\nCYCL DEF 17.0 TAP\nCYCL DEF 17.1 SET UP -2\nCYCL DEF 17.2 DEPTH -20\nCYCL DEF 17.3 PITCH +1\nL Z+2 FMAX\nCYCL CALL",
        ),
    ]);
    // A machine with a slower spindle.
    let run = Job::new(program("TOOL CALL 0 Z S6001"))
        .with(|s| s.rules.machine.speed_max_rpm = 6000.0)
        .run();
    assert_eq!(run.message(), Some((MessageId::WrongRpm, 1)));
}

#[test]
fn entry_value_incorrect() {
    use MessageId::EntryValueIncorrect as M;
    // The limits of the TNC 360.
    check_with_tool_on(
        ControlModel::Tnc360,
        &[
            ("coordinate", M, 1, "L X+30000.001 FMAX"),
            ("sum of increments", M, 2, "L X+29999 FMAX\nL IX+2 FMAX"),
            ("calculated coordinate", M, 2, "FN 0: Q1 = +30001\nL X+Q1 FMAX"),
            ("Q number", M, 1, "FN 0: Q124 = +1"),
            ("Q number in a coordinate", M, 1, "L X+Q200 FMAX"),
            ("feed", M, 1, "L X+1 F30000"),
            ("calculated feed", M, 2, "FN 0: Q1 = +30000\nL X+1 FQ1"),
            ("negative feed", M, 2, "FN 0: Q1 = -1\nL X+1 FQ1"),
            ("tool number", M, 1, "TOOL CALL 255 Z S100"),
            ("label", M, 1, "LBL 255"),
            ("repeat count", M, 2, "LBL 1\nCALL LBL 1 REP 65535"),
            ("negative tool radius", M, 1, "TOOL DEF 2 L+0 R-1"),
            ("rotation", M, 2, "CYCL DEF 10.0 ROT\nCYCL DEF 10.1 ROT +361"),
            ("scaling factor", M, 2, "CYCL DEF 11.0 SCL\nCYCL DEF 11.1 SCL 0"),
            (
                "scaling factor too large",
                M,
                2,
                "CYCL DEF 11.0 SCL\nCYCL DEF 11.1 SCL 100",
            ),
            ("dwell", M, 2, "CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 30001"),
            ("polar angle of CP", M, 2, "CC X+10 Y+0\nCP IPA+5401 DR+ F100"),
            (
                "13 subcontours",
                M,
                2,
                "CYCL DEF 14.0 GEOM\nCYCL DEF 14.1 CONTOUR LABEL 1/2/3/4/5/6/7/8/9/10/11/12/13",
            ),
            ("error number", M, 1, "FN 14: ERROR = 500"),
            ("radius of CR", M, 1, "CR X+10 Y+0 R+30001 DR+ F100"),
        ],
    );
}

/// The texts of FN14 [003:4364-4367].
#[test]
fn numbered_errors() {
    for (number, text) in [
        (0, "ERROR 0"),
        (254, "ERROR 254"),
        (299, "ERROR 299"),
        (300, "PLC ERROR 00"),
        (399, "PLC ERROR 99"),
        (401, "DIALOG 1"),
        (483, "DIALOG 83"),
        (484, "USER PARAMETER 15"),
        (499, "USER PARAMETER 0"),
    ] {
        let text_of = format!("L X+1 FMAX\nFN 14: ERROR = {number}\nL X+2 FMAX");
        let run = Job::new(program(&text_of))
            .with(|s| s.model = ControlModel::Tnc360)
            .run();
        let error = run.error.as_ref().unwrap();
        assert_eq!(error.message, Message::Numbered(text.to_owned()));
        assert_eq!((error.block.block, run.moves().count()), (2, 1));
    }
}

#[test]
fn programs() {
    let missing = Job::new(program("L X+1 FMAX\nCALL PGM 4711")).run();
    assert_eq!(missing.message(), Some((MessageId::ProgramNotFound, 2)));
    let by_cycle = Job::new(program(
        "CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM 4711\nCYCL CALL",
    ))
    .run();
    assert_eq!(by_cycle.message(), Some((MessageId::ProgramNotFound, 3)));
    // An error in a called program names it and its block.
    let called = "0 BEGIN PGM 7 MM\n1 L X+1 FMAX\n2 CALL LBL 5\n3 END PGM 7 MM\n";
    let run = Job::new(program("CALL PGM 7")).library("7", called).run();
    assert_eq!(run.message(), Some((MessageId::LabelNumberNotAllocated, 2)));
    assert_eq!(run.error.unwrap().program, "7");
}

/// A loop that moves nothing ends with a message; one that moves does not.
#[test]
fn endless_loop() {
    let text = program("LBL 1\nFN 1: Q1 = +Q1 + +1\nFN 9: IF +1 EQU +1 GOTO LBL 1");
    let run = Job::new(text).with(|s| s.max_blocks_without_motion = 1000).run();
    assert_eq!(run.message().map(|(id, _)| id), Some(MessageId::EndlessLoop));
    assert!(run.blocks_executed <= 1001);
    let text = program("LBL 1\nL IX+1 FMAX\nCALL LBL 1 REP 5000/5000");
    Job::new(text)
        .with(|s| s.max_blocks_without_motion = 1000)
        .run()
        .assert_completed();
    // Two programs cannot call each other for ever.
    let a = "0 BEGIN PGM A MM\n1 CALL PGM B\n2 END PGM A MM\n";
    let b = "0 BEGIN PGM B MM\n1 CALL PGM A\n2 END PGM B MM\n";
    let run = Job::new(program("CALL PGM A"))
        .library("A", a)
        .library("B", b)
        .run();
    assert_eq!(
        run.message().map(|(id, _)| id),
        Some(MessageId::ExcessiveSubprogramming)
    );
}

/// A label that is set twice is found when it is run over, too, and what ran before it counts [003:7881-7883].
#[test]
fn label_set_twice_is_found_in_passing() {
    let run = Job::new(program("L X+5 R0 FMAX\nLBL 7\nLBL 0\nLBL 7\nLBL 0")).run();
    assert_eq!(run.message(), Some((MessageId::LabelNumberAllocated, 4)));
    let run = Job::new(program("L X+5 R0 FMAX\nCALL LBL 7\nLBL 7\nLBL 0\nLBL 7\nLBL 0")).run();
    assert_eq!(run.message(), Some((MessageId::LabelNumberAllocated, 5)));
    assert_eq!(run.moves().count(), 1);
}

/// PA of LP takes -360 to +360 degrees as a typed number [003:3089]; a calculated angle may count on, as
/// the hole circle of the manual does.
#[test]
fn polar_angle_limit() {
    let typed = Job::new(program("CC X+0 Y+0\nLP PR+10 PA+400 R0 F100")).run();
    assert_eq!(typed.message(), Some((MessageId::EntryValueIncorrect, 2)));
    run("FN 0: Q1 = +400\nCC X+0 Y+0\nLP PR+10 PA+Q1 R0 F100").assert_completed();
}
