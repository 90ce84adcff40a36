//! What is wrong in the files of a run, each with its place: before the run the texts, after it the block that ended it.

use std::path::Path;

use bahn_technology::{ChannelList, Fault};
use serde::Serialize;

use super::programs::Sources;
use crate::channel;
use crate::check::din;
use crate::diagnostics::{FileFault, Marked, Severity};

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

/// What is wrong in a file, for programs.
#[derive(Debug, Serialize)]
pub(super) struct Item<'a> {
    severity: &'static str,
    file: String,
    line: u32,
    column: u32,
    length: u32,
    message: &'a str,
    help: &'a str,
}

/// The faults as JSON has them.
pub(super) fn items(faults: &[FileFault]) -> Vec<Item<'_>> {
    faults.iter().map(item).collect()
}

fn item(fault: &FileFault) -> Item<'_> {
    let Marked { line, text, columns } = &fault.marked;
    let whole = || (1, u32::try_from(text.chars().count()).unwrap_or(u32::MAX));
    let (column, length) = columns.unwrap_or_else(whole);
    Item {
        severity: match fault.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        file: fault.path.to_string_lossy().into_owned(),
        line: *line,
        column,
        length,
        message: &fault.title,
        help: fault.help.as_deref().unwrap_or_default(),
    }
}

/// What is wrong in the list and in the texts of the programs.
pub(super) fn of_texts(list: &ChannelList, path: &Path, sources: &Sources) -> Vec<FileFault> {
    let mut faults = channel::faults(list, path);
    for (path, program) in &sources.files {
        let of_file = program.faults();
        faults.extend(of_file.iter().map(|fault| din::located(fault, program, path)));
    }
    faults
}

/// The fault that ended a run, with its line; `None` where that is told already, or none is known.
pub(super) fn of_run(error: &Fault, sources: &Sources, reported: &[FileFault]) -> Option<FileFault> {
    if error.line == 0 {
        return None;
    }
    let (path, program) = sources.file(&error.program)?;
    let is_same = |fault: &FileFault| fault.path == path && fault.marked.line == error.line;
    if reported
        .iter()
        .any(|fault| fault.severity == Severity::Error && is_same(fault))
    {
        return None;
    }
    let cure = CURES.iter().find(|(code, _)| *code == error.code);
    Some(FileFault {
        severity: Severity::Error,
        title: format!("{} ({})", error.message, error.code),
        path,
        marked: Marked {
            line: error.line,
            text: program.line(error.line).to_owned(),
            columns: None,
        },
        label: format!("block {}", error.block),
        help: cure.map(|(_, help)| (*help).to_owned()),
        opened: None,
    })
}
