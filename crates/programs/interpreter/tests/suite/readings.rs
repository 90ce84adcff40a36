//! What programs are read as where their writing leaves a choice: blanks, tools, radii.
//!
//! Decision: A subprogram within another one: the LBL 0 that is reached leads back, one that is jumped over does
//! nothing

use crate::support::*;
use bahn_interpreter::{Message, WarningKind, tool_key};
use bahn_parameters::MessageId;
use bahn_path::ToolShape;

/// A blank without size, as programs write it that want no graphics, is no error.
#[test]
fn a_blank_without_size_takes_only_the_graphics() {
    let blank = |max: &str| {
        Job::new(program(&format!(
            "BLK FORM 0.1 Z X+0 Y+0 Z+0\nBLK FORM 0.2 {max}\nL X+1 R0 F100"
        )))
        .run()
    };
    for max in ["X+0 Y+0 Z+0", "IX+0 IY+0 IZ+0"] {
        let run = blank(max);
        run.assert_completed();
        assert_eq!(run.warnings.len(), 1);
        assert_eq!(run.warnings[0].kind, WarningKind::BlankEmpty);
    }
    for max in ["X+10 Y+0 Z+0", "X+0 Y+0 Z-1"] {
        assert_eq!(
            blank(max).message(),
            Some((MessageId::BlkFormDefinitionIncorrect, 2))
        );
    }
}

/// R + DR below zero matters where the radius is used, not before.
#[test]
fn a_negative_radius_is_an_error_when_it_is_used() {
    let worn = ToolShape {
        length: 10.0,
        radius: -0.05,
        corner_radius: 0.0,
        ..ToolShape::default()
    };
    let run = |blocks: &str| {
        Job::new(program(&format!("TOOL CALL 5 Z S100 DR-0.1\n{blocks}")))
            .with(|settings| settings.tools = Some([(5, worn)].into()))
            .run()
    };
    run("L X+1 Y+0 R0 F100\nL X+5").assert_completed();
    let used = run("L X+1 Y+0 RL F100\nL X+5");
    assert_eq!(used.message(), Some((MessageId::EntryValueIncorrect, 2)));
    assert_eq!(used.error.unwrap().detail, "R + DR of tool 5 is -0.1500 mm");
}

/// Tool 253.1 of a table is its own tool; where no table has it, no control here knows it.
#[test]
fn tools_with_an_index() {
    let shape = |radius| ToolShape {
        length: 0.0,
        radius,
        corner_radius: 0.0,
        ..ToolShape::default()
    };
    let blocks = "TOOL CALL 253.1 Z S100\nFN0: Q1 = +Q108\nTOOL CALL 253 Z S100\nFN0: Q2 = +Q108";
    let run = Job::new(program(blocks))
        .with(|settings| settings.tools = Some([(253, shape(5.0)), (tool_key(253, 1), shape(2.0))].into()))
        .run();
    run.assert_completed();
    assert_eq!((run.q[1], run.q[2]), (2.0, 5.0));
    let unknown = Job::new(program(blocks)).run();
    assert_eq!(unknown.message(), Some((MessageId::EntryValueIncorrect, 1)));
}

/// A pocket with a tool of radius 0 names the tool that is not defined.
#[test]
fn a_radius_of_zero_names_the_undefined_tool() {
    let pocket = "CYCL DEF 5.0 POCKET\nCYCL DEF 5.1 SET UP -2\nCYCL DEF 5.2 DEPTH -5\nCYCL DEF 5.3 PECKG -5 F80\n\
                  CYCL DEF 5.4 RADIUS 20\nCYCL DEF 5.5 F100 DR+\nL X+0 Y+0 Z+2 R0 F100 M99";
    let detail = |tool: &str| {
        let run = Job::new(program(&format!("{tool}\n{pocket}"))).run();
        let error = run.error.unwrap();
        assert_eq!(error.message, Message::Control(MessageId::ToolRadiusTooLarge));
        error.detail
    };
    assert!(detail("TOOL CALL 7 Z S100").ends_with("tool 7 is not defined, so its radius is 0"));
    assert!(detail("TOOL DEF 7 L+0 R 0\nTOOL CALL 7 Z S100").ends_with("the radius of tool 7 is 0"));
}

/// The first approach on an arc needs a position to come from [003:7984-7987].
#[test]
fn a_rounded_approach_from_nowhere() {
    let tool = "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S100";
    for (blocks, at) in [
        ("L X+50 Y+0 RL F100\nRND R2\nL X+50 Y+50\nL X+0", 3),
        ("L X+50 Y+0 RL F100", 3),
        ("L X+50 RL F100\nL Y+50\nL X+0", 3),
    ] {
        let run = Job::new(program(&format!("{tool}\n{blocks}"))).run();
        if let Some(found) = run.message() {
            assert_eq!(found, (MessageId::ProgramStartUndefined, at), "{blocks}");
        }
        assert_sound(&run);
    }
    let rounded = Job::new(program(&format!(
        "{tool}\nL X+50 Y+0 RL F100\nRND R2\nL X+50 Y+50\nL X+0"
    )))
    .run();
    assert_eq!(rounded.message(), Some((MessageId::ProgramStartUndefined, 3)));
}

/// "In the preceding and subsequent blocks both coordinates should lie in the plane of the arc" [003:2964, 3032]; the blocks at
/// a chamfer must [003:2668]. A block that moves the tool axis, too, gives its direction in the plane: the corner is worked at
/// the depth at which the first block ends, and what is cut off shortens it in the plane alone. CT takes the depth along as
/// a helix. A block of the tool axis alone has no direction (`messages.rs`).
#[test]
fn corners_after_a_block_that_moves_the_tool_axis() {
    let corner = |between: &str| {
        let run = Job::new(program(&format!(
            "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+5 R0 F500\nL X+20 Z-5\n{between}\nL X+50 Y+30"
        )))
        .run();
        run.assert_completed();
        let ends: Vec<[f64; 3]> = run.moves().map(|e| xyz(&e.end)).collect();
        ends[1..].to_vec()
    };
    // The corner (20,0) between the directions 0° and 45°: R5 cuts off 5 tan 22.5° of both.
    let (cut, part) = (5.0 * 22.5_f64.to_radians().tan(), std::f64::consts::FRAC_1_SQRT_2);
    let arc = [20.0 + cut * part, cut * part, -5.0];
    close_points(
        &corner("RND R5"),
        &[[20.0 - cut, 0.0, -5.0], arc, [50.0, 30.0, -5.0]],
        1e-9,
    );
    let chamfer = [20.0 + 3.0 * part, 3.0 * part, -5.0];
    close_points(
        &corner("L 3"),
        &[[17.0, 0.0, -5.0], chamfer, [50.0, 30.0, -5.0]],
        1e-9,
    );
    // Tangent along X at (20,0): an arc to (50,30) has its centre above, at (20,30).
    let tangent = Job::new(program(
        "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+5 R0 F500\nL X+20 Z-5\nCT X+50 Y+30 Z-8",
    ))
    .run();
    tangent.assert_completed();
    let last = *tangent.moves().collect::<Vec<_>>().last().unwrap();
    close_points(&[arc_of(last).0], &[[20.0, 30.0]], 1e-9);
    close_points(&[xyz(&last.end)], &[[50.0, 30.0, -8.0]], 1e-9);
}

/// A subprogram with LBL 0 must not stand in another one [003:3942]. Where it does the LBL 0 that is reached leads back
/// [003:3637]; one that is jumped over does nothing.
#[test]
fn a_subprogram_in_another_one() {
    let early = Job::new(program(
        "L X+0 R0 FMAX\nCALL LBL 1\nL X+30 FMAX M2\nLBL 1\nL X+10 FMAX\nLBL 2\nLBL 0\nL X+20 FMAX\nLBL 0",
    ))
    .run();
    early.assert_completed();
    let ends: Vec<f64> = early.moves().map(|e| e.end[bahn_path::Axis::X]).collect();
    assert_eq!(ends, [0.0, 10.0, 30.0]);
    let run = Job::new(program(
        "L X+0 R0 FMAX\nCALL LBL 1\nL X+30 FMAX M2\nLBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 2\nLBL 0\nLBL 2\nL X+20 FMAX\nLBL 0",
    ))
    .run();
    run.assert_completed();
    let ends: Vec<f64> = run.moves().map(|e| e.end[bahn_path::Axis::X]).collect();
    assert_eq!(ends, [0.0, 20.0, 30.0]);
}

/// No element has an end or a centre that is no number, but for axes that were never programmed.
fn assert_sound(run: &Run) {
    let mut known = bahn_path::PerAxis::splat(false);
    for element in &run.elements {
        for axis in bahn_path::Axis::ALL {
            let end = element.end[axis];
            assert!(
                end.is_finite() || (end.is_nan() && !known[axis]),
                "{axis}: {element:?}"
            );
            known[axis] |= end.is_finite();
        }
        if let bahn_path::Curve::Arc(arc) = element.curve {
            assert!(arc.centre.iter().all(|value| value.is_finite()), "{element:?}");
            assert!(arc.sweep_deg.is_finite(), "{element:?}");
        }
        let length = element.curve.linear_length(&element.start, &element.end);
        assert!(length.is_finite(), "{element:?}");
        if let bahn_path::FeedRate::Programmed(feed) = element.feed {
            assert!(feed.is_finite(), "{element:?}");
        }
    }
}

const BLOCKS: &[&str] = &[
    "L X+50 Y+0 RL F100",
    "L X+5",
    "L Y-5",
    "L Z-2",
    "L X+0 Y+0 R0 F200",
    "L IX+3 IY-2",
    "L X+Q1 Y+Q2",
    "RND R2",
    "RND R0.5",
    "L5",
    "CC X+10 Y+10",
    "CC",
    "C X+20 Y+10 DR+",
    "CR X+9 Y+9 R+20 DR-",
    "CT X+7 Y+30",
    "LP PR+10 PA+30",
    "LP IPR+5 PA+Q1",
    "CP IPA+90 DR+",
    "CTP PR+3 PA+10",
    "CP IPA+720 DR+ IZ-5",
    "X+5 R+",
    "Y-5 R-",
    "L X+5 RR",
    "L X+1 M91",
    "L Y+1 M93",
    "L C+90",
    "L M112 T0.1",
    "M109",
    "M97",
    "TOOL CALL 2 Y S50",
    "TOOL CALL 1 Z S100",
    "CYCL DEF 7.0 D\nCYCL DEF 7.1 X+Q1",
    "CYCL DEF 8.0 M\nCYCL DEF 8.1 X",
    "CYCL DEF 10.0 R\nCYCL DEF 10.1 ROT+30",
    "CYCL DEF 11.0 S\nCYCL DEF 11.1 SCL Q3",
    "FN0: Q1 = +1000000000000000",
    "FN3: Q1 = +Q1 * +Q1",
    "FN4: Q2 = +Q1 DIV +Q2",
    "FN8: Q1 = +Q1 LEN +Q2",
    "FN6: Q2 = SIN +Q1",
    "FN0: Q3 = +0.5",
    "Q2 = EXP 600",
    "Q1 = Q2 ^ Q1",
    "CYCL DEF 1.0 P\nCYCL DEF 1.1 S-2\nCYCL DEF 1.2 D-Q1\nCYCL DEF 1.3 P-5\nCYCL DEF 1.4 V Q1\nCYCL DEF 1.5 FQ1",
    "CYCL DEF 5.0 P\nCYCL DEF 5.1 S-2\nCYCL DEF 5.2 D-5\nCYCL DEF 5.3 P-5 F9\nCYCL DEF 5.4 R 20\nCYCL DEF 5.5 F9",
    "CYCL CALL",
    "L X+20 M99",
    "TCH PROBE 0.0 R Q5 X-\nTCH PROBE 0.1 X+5 Y+0 Z-5",
];

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(400))]

    /// Whatever blocks follow each other, no element holds what is no number.
    #[test]
    fn random_programs_have_sound_paths(
        blocks in proptest::collection::vec(proptest::sample::select(BLOCKS), 1..14)
    ) {
        let mut text = "TOOL DEF 1 L+0 R+2\nTOOL DEF 2 L+10 R+0.5\nTOOL CALL 1 Z S100\n".to_owned();
        for block in blocks {
            text.push_str(block);
            text.push('\n');
        }
        let run = Job::new(program(&text)).surfaces(&[1.0, 2.0]).run();
        assert_sound(&run);
        assert!(run.q.iter().all(|value| value.is_finite()));
        // A rehearsal ends whatever it is given.
        let program = std::sync::Arc::new(bahn_program::Program::from_bytes("T", program(&text).into_bytes()));
        bahn_interpreter::rehearse(
            program,
            bahn_interpreter::Settings::default(),
            std::sync::Arc::new(bahn_interpreter::NoPrograms),
            &std::sync::atomic::AtomicBool::new(false),
        );
    }
}
