//! Every message that the rules of programming can raise, raised by a small program at the block that causes
//! it [003:7866-8033].

mod support;

use bahn_interpreter::{Message, WarningKind};
use bahn_parameters::{ControlModel, MessageId};
use support::*;

/// What the program is, the message, the block, and the program itself, whose first line is block 1.
type Case<'a> = (&'a str, MessageId, u32, &'a str);

/// Tool of R10 at a start position: blocks 1 to 3.
const TOOL: &str = "TOOL DEF 1 L+0 R+10\nTOOL CALL 1 Z S1000\nL X+0 Y+0 R0 FMAX\n";

#[track_caller]
fn check(cases: &[Case]) {
    check_on(ControlModel::default(), cases);
}

#[track_caller]
fn check_on(model: ControlModel, cases: &[Case]) {
    let mut wrong = Vec::new();
    for (what, message, block, text) in cases {
        let run = Job::new(program(text)).with(|s| s.model = model).run();
        if run.message() != Some((*message, *block)) {
            wrong.push(format!(
                "{what}: {:?} instead of {message:?} in block {block}",
                run.error
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Cases that begin with [`TOOL`]; blocks count from its end.
#[track_caller]
fn check_with_tool(cases: &[Case]) {
    check_with_tool_on(ControlModel::default(), cases);
}

#[track_caller]
fn check_with_tool_on(model: ControlModel, cases: &[Case]) {
    let texts: Vec<String> = cases.iter().map(|case| format!("{TOOL}{}", case.3)).collect();
    let cases: Vec<Case> = cases
        .iter()
        .zip(&texts)
        .map(|(case, text)| (case.0, case.1, case.2 + 3, text.as_str()))
        .collect();
    check_on(model, &cases);
}

/// A cycle 1 whose lines can be changed.
const DRILL: &str = "CYCL DEF 1.0 PECKING
CYCL DEF 1.1 SET UP -2
CYCL DEF 1.2 DEPTH -10
CYCL DEF 1.3 PECKG -10
CYCL DEF 1.4 DWELL 0
CYCL DEF 1.5 F80
L Z+2 FMAX
CYCL CALL";

#[test]
fn angle_reference_missing() {
    use MessageId::AngleReferenceMissing as M;
    check_with_tool(&[
        ("C without DR", M, 2, "CC X+10 Y+0\nC X+20 Y+0 F100"),
        ("CR without R", M, 1, "CR X+20 Y+0 DR+ F100"),
        ("LP without PA", M, 2, "CC X+10 Y+0\nLP PR+10 F100"),
        ("CP without PA", M, 2, "CC X+10 Y+0\nCP DR+ F100"),
        ("CTP without PA", M, 3, "CC X+10 Y+0\nL X+5 F100\nCTP PR+10"),
        ("CR to where it is", M, 1, "CR X+0 Y+0 R+10 DR+ F100"),
        ("IPA against DR", M, 2, "CC X+10 Y+0\nCP IPA-90 DR+ F100"),
    ]);
}

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
fn chamfer_not_permitted() {
    use MessageId::ChamferNotPermitted as M;
    check_with_tool(&[
        (
            "before an arc",
            M,
            3,
            "CC X+50 Y+50\nL X+50 F100\nL 5\nC X+100 Y+50 DR+",
        ),
        ("at the end of the program", M, 2, "L X+50 F100\nL 5"),
        (
            "before a movement of the tool axis",
            M,
            2,
            "L X+50 F100\nL 5\nL Z+5",
        ),
        ("twice", M, 3, "L X+50 F100\nL 5\nL 5\nL Y+50"),
        ("longer than a side", M, 2, "L X+50 F100\nL 5\nL Y+4"),
    ]);
}

#[test]
fn circle_end_pos_incorrect() {
    use MessageId::CircleEndPosIncorrect as M;
    check_with_tool(&[
        ("not on the circle", M, 2, "CC X+10 Y+0\nC X+20.1 Y+0 DR+ F100"),
        ("radius too small for the way", M, 1, "CR X+20 Y+0 R+9.9 DR+ F100"),
    ]);
    // 0.016 mm are tolerated [003:2801].
    run(&format!("{TOOL}CC X+10 Y+0\nC X+20.015 Y+0 DR+ F100"));
}

#[test]
fn cycl_incomplete() {
    use MessageId::CyclIncomplete as M;
    let without = |line: &str| DRILL.replace(&format!("{line}\n"), "");
    let swapped = DRILL
        .replace("1.2 DEPTH", "1.3 DEPTH")
        .replace("1.3 PECKG", "1.2 PECKG");
    check_with_tool(&[
        ("not defined", M, 1, "CYCL CALL"),
        ("not defined, M99", M, 1, "L X+5 FMAX M99"),
        (
            "a transformation",
            M,
            3,
            "CYCL DEF 7.0 DATUM\nCYCL DEF 7.1 X+5\nCYCL CALL",
        ),
        ("a block is missing", M, 7, &without("CYCL DEF 1.2 DEPTH -10")),
        ("the last block is missing", M, 7, &without("CYCL DEF 1.5 F80")),
        ("the title is missing", M, 7, &without("CYCL DEF 1.0 PECKING")),
        ("out of order", M, 8, &swapped),
        ("pecking 0", M, 8, &DRILL.replace("PECKG -10", "PECKG -0")),
        ("a transformation without its title", M, 1, "CYCL DEF 7.1 X+5"),
        (
            "rough-out without contour",
            M,
            6,
            "CYCL DEF 6.0 ROUGH\nCYCL DEF 6.1 SET UP -2 DEPTH -10\nCYCL DEF 6.2 PECKG -5 F100 ALLOW +0\nCYCL DEF 6.3 ANGLE +0 F100\nL Z+2 FMAX\nCYCL CALL",
        ),
        ("probe point without probe", M, 1, "TCH PROBE 0.1 X+0 Y+0 Z+0"),
    ]);
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
    // The call in level 8: behind 2 blocks and seven subprograms of 3 blocks, the second block of its own.
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
fn path_offset() {
    check_with_tool(&[
        (
            "begun in an arc",
            MessageId::PathOffsetWronglyStarted,
            2,
            "CC X+50 Y+0\nC X+100 Y+0 DR+ RL F100",
        ),
        (
            "begun in CP",
            MessageId::PathOffsetWronglyStarted,
            2,
            "CC X+50 Y+0\nCP PA+90 DR- RL F100",
        ),
        (
            "ended in an arc",
            MessageId::PathOffsetWronglyEnded,
            4,
            "L X+0 Y+50 RL F100\nL X+50\nCC X+50 Y+100\nC X+50 Y+150 DR- R0",
        ),
        (
            "from RL to RR",
            MessageId::PathOffsetWronglyStarted,
            3,
            "L X+0 Y+50 RL F100\nL X+50\nL Y+100 RR",
        ),
        (
            "chamfer at the start",
            MessageId::PathOffsetWronglyStarted,
            2,
            "L X+0 Y+50 RL F100\nL 5\nL X+50",
        ),
        (
            "chamfer at the end",
            MessageId::PathOffsetWronglyStarted,
            3,
            "L X+0 Y+50 RL F100\nL X+50\nL 5\nL X+80 Y+100 R0",
        ),
    ]);
}

#[test]
fn plane_wrongly_defined() {
    use MessageId::PlaneWronglyDefined as M;
    check_with_tool(&[
        ("CC with one axis", M, 1, "CC X+10"),
        ("CC with three axes", M, 1, "CC X+10 Y+10 Z+10"),
        ("CC with parallel axes", M, 1, "CC X+10 U+10"),
        (
            "arc in another plane than CC",
            M,
            2,
            "CC X+10 Y+0\nC X+20 Z+0 DR+ F100",
        ),
        (
            "compensated arc in Z/X",
            M,
            4,
            "L Z+0 FMAX\nL X+5 Y+0 RL F100\nCC X+15 Z+0\nC X+25 Z+0 DR+",
        ),
        ("no CC at all", M, 1, "C X+20 Y+0 DR+ F100"),
        (
            "new tool axis while rotated",
            M,
            3,
            "CYCL DEF 10.0 ROT\nCYCL DEF 10.1 ROT +10\nTOOL CALL 1 X S100",
        ),
    ]);
}

#[test]
fn radius_compensation_undefined() {
    let text = format!(
        "{TOOL}CYCL DEF 14.0 GEOM\nCYCL DEF 14.1 CONTOUR LABEL 1\nCYCL DEF 6.0 ROUGH\nCYCL DEF 6.1 SET UP -2 DEPTH -10
        CYCL DEF 6.2 PECKG -5 F100 ALLOW +0\nCYCL DEF 6.3 ANGLE +0 F100\nL Z+2 FMAX\nCYCL CALL M3\nL Z+50 FMAX M2
        LBL 1\nL X+0 Y+0\nL X+50\nL Y+50\nL X+0 Y+0\nLBL 0"
    );
    // Block 14 is the first of the contour.
    check(&[("no RL or RR", MessageId::RadiusCompensationUndefined, 14, &text)]);
}

#[test]
fn roundings() {
    check_with_tool(&[
        (
            "RND behind nothing",
            MessageId::RoundingOffNotDefined,
            2,
            "L Z+5 FMAX\nRND R5\nL X+50 F100",
        ),
        (
            "RND before the tool axis",
            MessageId::RoundingOffNotDefined,
            2,
            "L X+50 F100\nRND R5\nL Z+5",
        ),
        (
            "RND at the end",
            MessageId::RoundingOffNotDefined,
            2,
            "L X+50 F100\nRND R5",
        ),
        (
            "CT without tangent",
            MessageId::RoundingOffNotDefined,
            2,
            "L Z+0 FMAX\nCT X+50 Y+50 F100",
        ),
        (
            "too large for a side",
            MessageId::RoundingRadiusTooLarge,
            2,
            "L X+50 F100\nRND R20\nL Y+10",
        ),
        (
            "two that overlap",
            MessageId::RoundingRadiusTooLarge,
            4,
            "L X+50 F100\nRND R20\nL Y+30\nRND R15\nL X+0",
        ),
        (
            "approach from within its circle",
            MessageId::RoundingRadiusTooLarge,
            3,
            "L X-20 FMAX\nL X+5 Y+5 RL F100\nRND R30\nL X+5 Y+100\nL X-20 R0",
        ),
    ]);
}

#[test]
fn tool_radius_too_large() {
    use MessageId::ToolRadiusTooLarge as M;
    let pocket = |cycle: &str| format!("{cycle}\nL Z+2 FMAX M3\nCYCL CALL");
    let slot = "CYCL DEF 3.0 SLOT\nCYCL DEF 3.1 SET UP -2\nCYCL DEF 3.2 DEPTH -10\nCYCL DEF 3.3 PECKG -5 F80\nCYCL DEF 3.4 X+80\nCYCL DEF 3.5 Y+18\nCYCL DEF 3.6 F100";
    let rectangle = "CYCL DEF 4.0 POCKET\nCYCL DEF 4.1 SET UP -2\nCYCL DEF 4.2 DEPTH -10\nCYCL DEF 4.3 PECKG -5 F80\nCYCL DEF 4.4 X+80\nCYCL DEF 4.5 Y+19\nCYCL DEF 4.6 F100 DR+ RADIUS 0";
    let circle = "CYCL DEF 5.0 CIRCLE\nCYCL DEF 5.1 SET UP -2\nCYCL DEF 5.2 DEPTH -10\nCYCL DEF 5.3 PECKG -5 F80\nCYCL DEF 5.4 RADIUS 9\nCYCL DEF 5.5 F100 DR+";
    let contour = "CYCL DEF 14.0 GEOM\nCYCL DEF 14.1 CONTOUR LABEL 1\nCYCL DEF 6.0 ROUGH\nCYCL DEF 6.1 SET UP -2 DEPTH -10
        CYCL DEF 6.2 PECKG -5 F100 ALLOW +0\nCYCL DEF 6.3 ANGLE +0 F100\nL Z+2 FMAX\nCYCL CALL M3\nL Z+50 FMAX M2
        LBL 1\nL X+0 Y+0 RL\nL X+19\nL Y+19\nL X+0\nL Y+0\nLBL 0";
    check_with_tool(&[
        (
            "arc inside",
            M,
            2,
            "L X+20 Y+0 RR F100\nCR X+38 Y+0 R+9 DR-\nL Y-40 R0",
        ),
        (
            "rounding inside",
            M,
            3,
            "L X+20 Y+0 RR F100\nL Y+50\nRND R9\nL X+80\nL Y-40 R0",
        ),
        (
            "a groove narrower than the tool",
            M,
            3,
            "L X+20 Y+0 RR F100\nL Y+50\nL X+39\nL Y+0\nL Y-40 R0",
        ),
        (
            "a step on top",
            M,
            3,
            "L X+0 Y+50 RL F100\nL X+30\nL Y+45\nL X+80\nL Y+0 R0",
        ),
        ("slot", M, 9, &pocket(slot)),
        (
            "slot too wide for the tool",
            M,
            9,
            &pocket(&slot.replace("Y+18", "Y+41")),
        ),
        ("rectangular pocket", M, 9, &pocket(rectangle)),
        ("circular pocket", M, 8, &pocket(circle)),
        ("contour pocket", M, 8, contour),
    ]);
}

#[test]
fn wrong_axis_programmed() {
    use MessageId::WrongAxisProgrammed as M;
    let slot = |length: &str, width: &str| {
        format!(
            "CYCL DEF 3.0 SLOT\nCYCL DEF 3.1 SET UP -2\nCYCL DEF 3.2 DEPTH -10\nCYCL DEF 3.3 PECKG -5 F80\nCYCL DEF 3.4 {length}\nCYCL DEF 3.5 {width}\nCYCL DEF 3.6 F100\nL Z+2 FMAX\nCYCL CALL"
        )
    };
    check_with_tool(&[
        ("slot along the tool axis", M, 9, &slot("Z+50", "Y+20")),
        ("slot across the tool axis", M, 9, &slot("X+50", "Z+20")),
        ("slot along and across one axis", M, 9, &slot("X+50", "X+20")),
        (
            "pocket outside the plane",
            M,
            9,
            "CYCL DEF 4.0 POCKET\nCYCL DEF 4.1 SET UP -2\nCYCL DEF 4.2 DEPTH -10\nCYCL DEF 4.3 PECKG -5 F80\nCYCL DEF 4.4 X+80\nCYCL DEF 4.5 Z+40\nCYCL DEF 4.6 F100 DR+ RADIUS 0\nL Z+2 FMAX\nCYCL CALL",
        ),
        ("mirrored tool axis", M, 2, "CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 Z"),
        (
            "mirrored rotary axis",
            M,
            2,
            "CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 C",
        ),
        ("negative chamfer", M, 2, "L X+50 F100\nL -5\nL Y+50"),
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
        .with(|s| s.rules.speed_max_rpm = 6000.0)
        .run();
    assert_eq!(run.message(), Some((MessageId::WrongRpm, 1)));
}

#[test]
fn wrong_sign_programmed() {
    for text in [
        DRILL.replace("SET UP -2", "SET UP +2"),
        DRILL.replace("PECKG -10", "PECKG +10"),
    ] {
        let text = program(&format!("{TOOL}{text}"));
        let strict = Job::new(text.clone()).with(|s| s.strict = true).run();
        assert_eq!(strict.message(), Some((MessageId::WrongSignProgrammed, 11)));
        let lenient = Job::new(text).run();
        lenient.assert_completed();
        assert_eq!(lenient.warnings.len(), 1);
        assert_eq!(lenient.warnings[0].kind, WarningKind::CycleSign { cycle: 1 });
        assert_eq!(lenient.warnings[0].block.block, 11);
    }
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
            ("M function", M, 1, "L X+1 FMAX M100"),
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

/// A contour of cycle 14 that ends elsewhere than it began.
#[test]
fn a_contour_that_does_not_close() {
    let text = format!(
        "{TOOL}CYCL DEF 14.0 GEOM\nCYCL DEF 14.1 CONTOUR LABEL 1\nCYCL DEF 6.0 ROUGH\nCYCL DEF 6.1 SET UP -2 DEPTH -10
        CYCL DEF 6.2 PECKG -5 F100 ALLOW +0\nCYCL DEF 6.3 ANGLE +0 F100\nL Z+2 FMAX\nCYCL CALL M3\nL Z+50 FMAX M2
        LBL 1\nL X+0 Y+0 RL\nL X+90\nL Y+90\nL X+0\nL Y+0.5\nLBL 0"
    );
    let run = Job::new(program(&text)).run();
    // The last block of the contour.
    assert_eq!(run.message(), Some((MessageId::CyclIncomplete, 18)));
    assert!(run.error.unwrap().detail.contains("0.500"));
}

/// Blocks of other controls are an error where they are executed, not before.
#[test]
fn blocks_of_other_controls() {
    let run = Job::new(program("L X+1 FMAX\nFUNCTION TCPM F TCP AXIS POS\nL X+2 FMAX")).run();
    assert_eq!(run.message().map(|(_, block)| block), Some(2));
    assert_eq!(run.moves().count(), 1);
    // Jumped over it does no harm.
    let jumped = Job::new(program(
        "FN 9: IF +1 EQU +1 GOTO LBL 1\nAPPR LCT X+1 Y+1 R2 RL F100\nLBL 1\nL X+2 FMAX",
    ))
    .run();
    jumped.assert_completed();
    let formula = Job::new(program("Q1 = 1 + 2"))
        .with(|s| s.model = ControlModel::Tnc360)
        .run();
    assert_eq!(formula.message(), Some((MessageId::BlockNotKnown, 1)));
}

/// A tool that is defined nowhere: a warning, in strict checking an error.
#[test]
fn tool_not_defined() {
    let text = program("TOOL CALL 7 Z S100\nL X+1 FMAX");
    let lenient = Job::new(text.clone()).run();
    lenient.assert_completed();
    assert_eq!(lenient.warnings[0].kind, WarningKind::ToolNotDefined { tool: 7 });
    let strict = Job::new(text).with(|s| s.strict = true).run();
    assert_eq!(strict.message(), Some((MessageId::ToolNotDefined, 1)));
    // Compensation without any tool.
    check(&[(
        "RL without a tool",
        MessageId::ProgramStartUndefined,
        2,
        "L X+0 Y+0 FMAX\nL X+10 RL F100",
    )]);
}

/// What was complete before an error is still executed.
#[test]
fn the_path_before_an_error() {
    let run = Job::new(program(&format!(
        "{TOOL}L X+0 Y+50 RL F100\nL X+30\nL X+60 Y+80\nCALL LBL 9"
    )))
    .run();
    assert_eq!(run.message(), Some((MessageId::LabelNumberNotAllocated, 7)));
    assert_eq!(run.of_block(6).len(), 1);
}
