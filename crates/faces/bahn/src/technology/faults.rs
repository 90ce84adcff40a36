//! What is wrong in the files of a run, each with its place: before the run the texts, after it the block that ended it.

use std::path::Path;

use bahn_technology::{ChannelList, Fault};
use bahn_text::{Diagnostic, Severity, Span};

use super::programs::Sources;
use crate::channel;

/// What to do about the faults of blocks.
const CURES: [(&str, &str); 6] = [
    (
        "P-ERR-20157",
        "give the function a type in the channel parameter list, as `m_synch[25] MVS_SVS`",
    ),
    (
        "P-ERR-21548",
        "name a spindle of the list, or write it there with `spindel[0].bezeichnung`",
    ),
    (
        "licence",
        "set the lead to 0, or P-CHAN-00600 to `FCT_DEFAULT | FCT_M_PRE_OUTPUT`",
    ),
    (
        "micro-joint",
        "take MEP_SVS or MEP_MOS for a lead in the range of an axis",
    ),
    ("endless", "--max-time and --max-blocks allow more"),
    ("plc", "`bahn plc check` tells what is wrong in the PLC program"),
];

/// What is wrong in the list and in the texts of the programs.
pub(super) fn of_texts(list: &ChannelList, path: &Path, sources: &Sources) -> Vec<Diagnostic> {
    let mut faults = channel::faults(list, path);
    for (path, program) in &sources.files {
        let of_file = program.faults();
        faults.extend(of_file.iter().map(|fault| fault.diagnostic(program, path)));
    }
    faults
}

/// The fault that ended a run, with its line; `None` where that is told already, or none is known.
pub(super) fn of_run(error: &Fault, sources: &Sources, reported: &[Diagnostic]) -> Option<Diagnostic> {
    if error.line == 0 {
        return None;
    }
    let (path, program) = sources.file(&error.program)?;
    let is_same = |fault: &Diagnostic| fault.file == path && fault.span.line == error.line;
    if reported
        .iter()
        .any(|fault| fault.severity == Severity::Error && is_same(fault))
    {
        return None;
    }
    let cure = CURES.iter().find(|(code, _)| *code == error.code);
    let fault = Diagnostic::error(
        Span::line(error.line as usize),
        format!("{} ({})", error.message, error.code),
    );
    let fault = fault
        .with_code(error.code.as_str())
        .in_block(error.block.as_str())
        .with_help(cure.map(|(_, help)| *help));
    Some(fault.at(path, program.line(error.line)))
}
