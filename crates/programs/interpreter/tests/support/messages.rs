//! Small programs and the message that each must raise.
#![allow(dead_code, reason = "every test file uses its own part of the support")]

use bahn_parameters::{ControlModel, MessageId};

use super::support::{Job, program};

/// What the program is, the message, the block, and the program itself, whose first line is block 1.
pub type Case<'a> = (&'a str, MessageId, u32, &'a str);

/// Tool of R10 at a start position: blocks 1 to 3.
pub const TOOL: &str = "TOOL DEF 1 L+0 R+10\nTOOL CALL 1 Z S1000\nL X+0 Y+0 R0 FMAX\n";

#[track_caller]
pub fn check(cases: &[Case]) {
    check_on(ControlModel::default(), cases);
}

#[track_caller]
pub fn check_on(model: ControlModel, cases: &[Case]) {
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
pub fn check_with_tool(cases: &[Case]) {
    check_with_tool_on(ControlModel::default(), cases);
}

#[track_caller]
pub fn check_with_tool_on(model: ControlModel, cases: &[Case]) {
    let texts: Vec<String> = cases.iter().map(|case| format!("{TOOL}{}", case.3)).collect();
    let cases: Vec<Case> = cases
        .iter()
        .zip(&texts)
        .map(|(case, text)| (case.0, case.1, case.2 + 3, text.as_str()))
        .collect();
    check_on(model, &cases);
}
