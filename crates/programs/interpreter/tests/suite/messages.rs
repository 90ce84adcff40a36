//! Messages of contours, compensation and cycles, raised by a small program at the block that causes them
//! [003:7889-8033].

use crate::cases::{TOOL, check, check_with_tool};
use crate::support::*;
use bahn_interpreter::WarningKind;
use bahn_parameters::{ControlModel, MessageId};

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

/// The parameter is named as in the dialogue, with its block.
#[test]
fn missing_parameters_of_cycles_are_named() {
    const SLOT: &str = "CYCL DEF 3.0 SLOT\nCYCL DEF 3.1 SET UP -2\nCYCL DEF 3.2 DEPTH -10\nCYCL DEF 3.3 PECKG -5 F80\n\
        CYCL DEF 3.4 X+50\nCYCL DEF 3.5 Y+15\nCYCL DEF 3.6 F200\nCYCL CALL";
    for (cycle, block, without, detail) in [
        (
            DRILL,
            "1.1 SET UP -2",
            "1.1 SET UP",
            "CYCL DEF 1.1: SET UP is missing",
        ),
        (
            DRILL,
            "1.4 DWELL 0",
            "1.4 DWELL",
            "CYCL DEF 1.4: DWELL is missing",
        ),
        (
            SLOT,
            "3.3 PECKG -5 F80",
            "3.3 F80",
            "CYCL DEF 3.3: PECKG is missing",
        ),
        (
            SLOT,
            "3.3 PECKG -5 F80",
            "3.3 PECKG -5",
            "CYCL DEF 3.3: F is missing",
        ),
        (SLOT, "3.5 Y+15", "3.5", "CYCL DEF 3.5: a value is missing"),
    ] {
        let text = program(&format!("{TOOL}{}", cycle.replace(block, without)));
        let run = Job::new(text).run();
        assert_eq!(run.error.map(|error| error.detail), Some(detail.to_owned()));
    }
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
            "RND after nothing",
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
        (
            "pocket with both sides on one axis",
            M,
            9,
            "CYCL DEF 4.0 POCKET\nCYCL DEF 4.1 SET UP -2\nCYCL DEF 4.2 DEPTH -10\nCYCL DEF 4.3 PECKG -5 F80\nCYCL DEF 4.4 X+80\nCYCL DEF 4.5 X+40\nCYCL DEF 4.6 F100 DR+ RADIUS 0\nL Z+2 FMAX\nCYCL CALL",
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
fn wrong_sign_programmed() {
    for text in [
        DRILL.replace("SET UP -2", "SET UP +2"),
        DRILL.replace("PECKG -10", "PECKG +10"),
    ] {
        let text = program(&format!("{TOOL}{text}"));
        let strict = Job::new(text.clone()).with(|s| s.strict = true).run();
        assert_eq!(strict.message(), Some((MessageId::WrongSignProgrammed, 11)));
        let definition = text
            .lines()
            .position(|line| line.contains("CYCL DEF 1.0"))
            .unwrap();
        let lenient = Job::new(text).run();
        lenient.assert_completed();
        assert_eq!(lenient.warnings.len(), 1);
        assert_eq!(lenient.warnings[0].kind, WarningKind::CycleSign { cycle: 1 });
        assert_eq!(lenient.warnings[0].block.block as usize, definition);
    }
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
    check(&[
        (
            "stored by a control",
            MessageId::ErrorBlock,
            2,
            "L X+1 FMAX\nERROR = L X+5 FMAX",
        ),
        (
            "not a number",
            MessageId::EntryValueIncorrect,
            2,
            "L X+1 FMAX\nL Xnan FMAX",
        ),
        (
            "a number out of this world",
            MessageId::EntryValueIncorrect,
            1,
            "L X+99999999999999999999999 FMAX",
        ),
    ]);
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
