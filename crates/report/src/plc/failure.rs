//! Run-time errors of a PLC program, at their lines.

use bahn_host::{FileFault, Marked, Severity};
use bahn_plc::{PlcProgram, RuntimeError};

/// A run-time error with its line.
pub fn failure(program: &PlcProgram, error: &RuntimeError) -> FileFault {
    let file = program.files.iter().find(|file| file.name == error.file);
    let index = (error.line as usize).saturating_sub(1);
    let text = file
        .and_then(|file| file.lines.get(index))
        .cloned()
        .unwrap_or_default();
    let code = bahn_plc::split_comment(&text).0;
    let start = code.chars().take_while(|c| c.is_whitespace()).count();
    let length = code.trim().chars().count();
    FileFault {
        severity: Severity::Error,
        title: format!("{} {}", error.error.number(), error.error.text()),
        path: error.file.as_str().into(),
        marked: Marked {
            line: error.line,
            columns: Some((
                u32::try_from(start + 1).unwrap_or(1),
                u32::try_from(length).unwrap_or(1),
            )),
            text,
        },
        label: match error.job {
            Some(job) => format!("submit job {job} stopped the PLC here"),
            None => "the PLC stopped here".to_owned(),
        },
        help: Some(format!("{} {}", error.error.cause(), error.error.cure())),
        opened: None,
    }
}
