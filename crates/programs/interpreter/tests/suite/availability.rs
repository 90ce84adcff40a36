//! Functions that have no effect here, or only part of it: nothing is passed over in silence.

use crate::support::*;
use bahn_interpreter::{Settings, ToolState, WarningKind};
use bahn_parameters::ControlModel::{self, Tnc155, Tnc360, Tnc407, Tnc415b, Tnc425};
use bahn_parameters::MessageId::{BlockNotKnown, MaxToolLifeExpired, ToolLocked, WrongAxisProgrammed};
use bahn_parameters::{MessageId, ParameterList};
use bahn_path::{Function, ToolShape};

fn with(blocks: &str, change: impl FnOnce(&mut Settings)) -> Run {
    Job::new(program(blocks)).with(change).run()
}

/// Message and block of a program on a model.
fn on(model: ControlModel, blocks: &str) -> Option<(MessageId, u32)> {
    with(blocks, |settings| settings.model = model).message()
}

/// Blocks and texts of the warnings.
fn warnings(run: &Run) -> Vec<(u32, String)> {
    let warnings = run.warnings.iter();
    warnings
        .map(|warning| (warning.block.block, warning.kind.to_string()))
        .collect()
}

/// M96 has no effect: one warning at the first block that has it, however often it comes.
#[test]
fn no_effect_is_said_once() {
    let blocks = "L X+1 FMAX\nLBL 1\nL IX+1 FMAX M96\nCALL LBL 1 REP 5/5\nL X+0 FMAX M96";
    let run = run(blocks);
    let said = warnings(&run);
    assert_eq!(said.len(), 1, "{said:?}");
    assert_eq!(said[0].0, 3);
    assert!(said[0].1.starts_with("M96 has no effect here: "), "{said:?}");
    assert_eq!(run.warnings[0].count, 1);
    assert_eq!(run.moves().count(), 8);
}

/// M97 and M98 are for compensated corners [003:3467-3512], M101 for the lives in a tool table [000:9103]: without them they
/// do nothing, and that is said.
#[test]
fn functions_without_what_they_act_on() {
    let said = |blocks: &str| {
        let run = run(&format!(
            "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S100\nL X+0 Y+0 R0 FMAX\n{blocks}"
        ));
        run.assert_completed();
        warnings(&run)
    };
    for m in [97, 98] {
        let text = format!("M{m} has no effect without radius compensation");
        assert_eq!(said(&format!("L X+10 R0 F100 M{m}\nL Y+10")), [(4, text)]);
        assert_eq!(
            said(&format!("L X+10 RL F100\nL Y+10 M{m}\nL X+20\nL Y+20 R0")),
            []
        );
        let strict = with(&format!("L X+1 FMAX\nL X+2 FMAX M{m}"), |settings| {
            settings.strict = true
        });
        assert_eq!(strict.message(), Some((BlockNotKnown, 2)));
    }
    let text = "M101 has no effect without a tool table: tool lives and replacement tools stand there";
    assert_eq!(said("L X+10 FMAX M101\nL X+5 FMAX M102"), [(4, text.to_owned())]);
    let with_table = with("L X+10 FMAX M101", |settings| settings.tools = Some([].into()));
    assert_eq!(warnings(&with_table), []);
}

/// Cycle 31 of the release notes measures tools [000:838]: it has the blocks of a probe function, and as CYCL DEF it is refused
/// with a message that says so.
#[test]
fn cycle_31_is_a_probe_function() {
    let run = Job::new(program(
        "CYCL DEF 31.0 TOOL LENGTH\nCYCL DEF 31.1 CHECK: 0\nCYCL CALL",
    ))
    .run();
    assert_eq!(run.message(), Some((BlockNotKnown, 3)));
    let detail = run.error.map(|error| error.detail).unwrap_or_default();
    assert!(detail.contains("TCH PROBE 31 measures the length"), "{detail}");
    // Controls without a tool probe have none.
    assert_eq!(on(Tnc360, "CYCL DEF 31.0 TOOL LENGTH"), Some((BlockNotKnown, 1)));
}

/// With strict checking it is an error.
#[test]
fn strict_checking_refuses_it() {
    let run = with("L X+1 FMAX\nL X+2 FMAX M96", |settings| settings.strict = true);
    assert_eq!(run.message(), Some((BlockNotKnown, 2)));
}

const MOVES: &[&str] = &[
    "L X+5 FMAX M114",
    "L X+5 FMAX M116",
    "L X+5 FMAX M128",
    "L X+5 FMAX M200 V1",
    "L X+5 FMAX M202 FNR.5",
    "L X+5 FMAX M203 V5 TIME3",
    "CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+45",
    "CYCL DEF 27.0 CYLINDER SURFACE\nCYCL DEF 27.1 Q1=-5\nCYCL CALL",
];

/// What would move differently on the control is refused; passed over with a warning when that is wanted.
#[test]
fn what_would_move_differently_is_refused() {
    for blocks in MOVES {
        let text = format!("L X+1 FMAX\n{blocks}\nL X+2 FMAX");
        let refused = with(&text, |_| {});
        assert_eq!(
            refused.message().map(|(id, _)| id),
            Some(BlockNotKnown),
            "{blocks}"
        );
        let passed = with(&text, |settings| settings.skip_unknown = true);
        passed.assert_completed();
        let said = &passed.warnings;
        let is_passed =
            matches!(said.as_slice(), [one] if matches!(one.kind, WarningKind::PassedOver { .. }));
        assert!(is_passed, "{blocks}: {said:?}");
        // No word of the function is taken for a movement.
        assert_eq!(passed.position[bahn_path::Axis::X], 2.0, "{blocks}");
        assert!(passed.position[bahn_path::Axis::V].is_nan(), "{blocks}");
    }
}

/// A cycle that is passed over at its definition does nothing at its call, either: the cycle before it is no
/// longer in force.
#[test]
fn a_skipped_cycle_is_not_called() {
    let peck = "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -10\nCYCL DEF 1.3 PECKG -5\n\
                CYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100";
    let text = format!("L X+0 Y+0 Z+2 R0 FMAX\n{peck}\nCYCL DEF 99.0 OEM\nCYCL CALL M3\nL X+2 FMAX");
    let run = with(&text, |settings| settings.skip_unknown = true);
    run.assert_completed();
    assert_eq!(run.moves().count(), 2);
}

/// Unknown words are left out, unknown blocks passed over, each with its place.
#[test]
fn unknown_words_and_blocks_are_passed_over() {
    let text = "L X+1 FMAX\nL X+5 FOO Y+3 FMAX\nAPPR LCT X+1 Y+1 R2 RL F100\nL X+7 FMAX";
    let run = with(text, |settings| settings.skip_unknown = true);
    run.assert_completed();
    assert_eq!(
        warnings(&run),
        [
            (2, "passed over: FOO".to_owned()),
            (3, "passed over: APPR LCT X+1 Y+1 R2 RL F100".to_owned()),
        ]
    );
    assert_eq!(run.moves().count(), 3);
    // What is wrong otherwise stays an error.
    let run = with("L X+1..5 FMAX", |settings| settings.skip_unknown = true);
    assert!(run.error.is_some());
}

/// M100 to M204 that a model does not have [003:7459-7577] [001:554-558] [000:740-747].
#[test]
fn m_functions_of_other_controls() {
    for code in [100, 101, 103, 105, 109, 112, 114, 200] {
        for model in [Tnc155, Tnc360] {
            let block = format!("L X+1 FMAX M{code}");
            assert_eq!(on(model, &block), Some((BlockNotKnown, 1)), "{model} M{code}");
        }
    }
    for code in [100, 104, 119, 120, 128, 129, 150, 199, 205] {
        let block = format!("L X+1 FMAX M{code}");
        assert_eq!(on(Tnc425, &block), Some((BlockNotKnown, 1)), "M{code}");
    }
    assert_eq!(on(Tnc407, "L X+1 FMAX M127"), Some((BlockNotKnown, 1)));
    for model in [Tnc407, Tnc415b, Tnc425] {
        assert_eq!(on(model, "L X+1 FMAX M105"), None);
    }
}

/// Straight lines of 3 axes [001:167-173] [003:7761-7763] [000:139], on the TNC 415/425 of 5.
#[test]
fn more_axes_than_the_control_moves_together() {
    let five = "L X+1 Y+1 Z+1 A+1 C+1 R0 FMAX";
    let four = "L X+1 Y+1 Z+1 C+1 R0 FMAX";
    for model in [Tnc155, Tnc360, Tnc407] {
        assert_eq!(on(model, four), Some((WrongAxisProgrammed, 1)), "{model}");
        assert_eq!(on(model, "L X+1 Y+1 C+1 R0 FMAX"), None, "{model}");
    }
    assert_eq!(on(Tnc415b, five), None);
    let nine = "L X+1 FMAX\nL X+1 Y+1 Z+1 A+1 B+1 C+1 U+1 V+1 W+1 R0 FMAX\nL X+2 FMAX";
    assert_eq!(on(Tnc415b, nine), Some((WrongAxisProgrammed, 2)));
}

/// A TOOL CALL of the TNC 360 has no oversizes [003:1917-1952].
#[test]
fn oversizes_of_a_tool_call() {
    let call = "TOOL CALL 1 Z S100 DL+1 DR-0.1";
    assert_eq!(on(Tnc360, call), Some((BlockNotKnown, 1)));
    assert_eq!(on(Tnc407, call), None);
}

#[test]
fn tools_that_are_locked_or_worn() {
    let state = |state| {
        with("TOOL CALL 1 Z S100\nTOOL CALL 2 Z S100", |settings| {
            settings.barred_tools = [(2, state)].into();
        })
        .message()
    };
    assert_eq!(state(ToolState::Usable), None);
    assert_eq!(state(ToolState::Locked), Some((ToolLocked, 2)));
    assert_eq!(state(ToolState::Expired), Some((MaxToolLifeExpired, 2)));
    // The replacement tool is called; where it replaces itself there is none.
    assert_eq!(state(ToolState::Replaced(3)), None);
    assert_eq!(state(ToolState::Replaced(2)), Some((MaxToolLifeExpired, 2)));
}

/// The tools that TOOL DEF and TOOL CALL name to the PLC when tool 2 is worn: its replacement, or what replaces
/// that one [000:9168-9172].
#[test]
fn the_replacement_tool_is_called() {
    let called = |barred: &[(u32, ToolState)]| {
        let run = with(
            "TOOL DEF 2\nTOOL CALL 2 Z S100\nL X+5 Y+5 Z+0 R0 FMAX",
            |settings| {
                let shape = |radius| ToolShape {
                    radius,
                    ..ToolShape::default()
                };
                settings.tools = Some([2, 3, 4].map(|tool| (tool, shape(f64::from(tool)))).into());
                settings.barred_tools = barred.iter().copied().collect();
            },
        );
        let functions = run.elements.iter().flat_map(|element| element.functions());
        let called: Vec<(u32, f64)> = functions
            .filter_map(|function| match &function.function {
                Function::Tool(call) => Some((call.tool, call.shape.radius)),
                Function::NextTool(tool) => Some((*tool, 0.0)),
                _ => None,
            })
            .collect();
        (called, run.message())
    };
    use ToolState::{Expired, Locked, Replaced};
    assert_eq!(called(&[]), (vec![(2, 0.0), (2, 2.0)], None));
    assert_eq!(called(&[(2, Replaced(3))]), (vec![(3, 0.0), (3, 3.0)], None));
    let chain = [(2, Replaced(3)), (3, Replaced(4))];
    assert_eq!(called(&chain), (vec![(4, 0.0), (4, 4.0)], None));
    let end = |state| called(&[(2, Replaced(3)), (3, state)]).1;
    assert_eq!(end(Expired), Some((MaxToolLifeExpired, 2)));
    assert_eq!(end(Locked), Some((ToolLocked, 2)));
    assert_eq!(end(Replaced(2)), Some((MaxToolLifeExpired, 2)));
}

/// MP7245.0 bit n inhibits cycle n, MP7245.1 bit n cycle 16 + n [000:6655-6698]; MP7246 paraxial blocks
/// [000:7022-7029].
#[test]
fn inhibited_by_the_machine_builder() {
    let with_list = |assignment: &str, blocks: &str| {
        let mut list = ParameterList::reference(Tnc415b);
        list.assign(assignment).unwrap();
        with(blocks, |settings| {
            settings.rules = bahn_interpreter::Rules::of(&list)
        })
        .message()
    };
    let dwell = "L X+1 FMAX\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1";
    assert_eq!(with_list("7245.0=$200", dwell), Some((BlockNotKnown, 2)));
    assert_eq!(with_list("7245.0=$FDFF", dwell), None);
    let rigid = "CYCL DEF 17.0 RIGID TAPPING";
    assert_eq!(with_list("7245.1=2", rigid), Some((BlockNotKnown, 1)));
    assert_eq!(with_list("7245.1=1", rigid), None);
    // Bit 15: cycle 31 measures tools, by TCH PROBE 31.
    let measuring = "TOOL CALL 1 Z S1\nTCH PROBE 31.0 TOOL LENGTH";
    assert_eq!(with_list("7245.1=$8000", measuring), Some((BlockNotKnown, 2)));
    assert_eq!(with_list("7245.1=$4000", measuring), None);
    // MP7440 bit 3 enables M105 and M106, bit 4 M103 F; without it the function is not active [000:7292-7304].
    for (bit, blocks) in [
        (8, "L X+1 FMAX M105"),
        (8, "L X+1 FMAX M106"),
        (16, "L X+1 F100 M103 F25"),
    ] {
        let value = |bits: u32| format!("7440={bits}");
        assert_eq!(
            with_list(&value(0b11111 - bit), blocks),
            Some((BlockNotKnown, 1)),
            "{blocks}"
        );
        assert_eq!(with_list(&value(bit), blocks), None, "{blocks}");
    }
    // The tool axis is X, Y, Z or the 4th axis, never the 5th: MP410.4 = 5 is W [000:3410-3416] [000:3370].
    let tool_axis = |assignment| with_list(assignment, "TOOL CALL 0 W S100");
    assert_eq!(tool_axis("410.4=5"), Some((WrongAxisProgrammed, 1)));
    assert_eq!(tool_axis("410.4=4"), None);
    let paraxial = "TOOL CALL 0 Z S100\nX+20 R+ F100";
    assert_eq!(with_list("7246=1", paraxial), Some((BlockNotKnown, 2)));
    assert_eq!(with_list("7246=0", paraxial), None);
}

/// M95 and M96 of a TNC 151/155 change how a contour is approached and left; nothing is put out. Where no compensation is
/// in force there is nothing to change; with RL or RR the path would be another, and no manual describes it
/// [001:707-708].
#[test]
fn m95_and_m96_do_nothing_without_radius_compensation() {
    for m in [95, 96] {
        let run = with(&format!("L X+1 R0 F100 M{m}\nL X+2"), |settings| {
            settings.model = Tnc155;
            settings.strict = true;
        });
        run.assert_completed();
        assert_eq!(warnings(&run), []);
        assert!(
            run.elements.iter().all(|element| element.functions().is_empty()),
            "no output"
        );
        let tool = "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S100\n";
        let compensated = format!("{tool}L X+1 Y+0 RL F100\nL X+20 M{m}\nL Y+20 R0");
        assert_eq!(on(Tnc155, &compensated), Some((BlockNotKnown, 4)));
    }
}
