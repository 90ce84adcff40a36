//! What programs are read as where their writing leaves a choice: blanks, tools, radii.

mod support;

use bahn_interpreter::{Message, WarningKind, tool_key};
use bahn_parameters::MessageId;
use bahn_path::ToolShape;
use support::*;

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
