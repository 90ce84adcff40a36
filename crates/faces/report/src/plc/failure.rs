//! Run-time errors of a PLC program, at their lines.

use bahn_plc::{PlcProgram, RuntimeError};
use bahn_text::{Diagnostic, Span};

/// A run-time error with its line.
pub fn failure(program: &PlcProgram, error: &RuntimeError) -> Diagnostic {
    let file = program.files.iter().find(|file| file.name == error.file);
    let index = (error.line as usize).saturating_sub(1);
    let text = file
        .and_then(|file| file.lines.get(index))
        .cloned()
        .unwrap_or_default();
    let code = bahn_plc::split_comment(&text).0;
    let start = code.chars().take_while(|c| c.is_whitespace()).count();
    let length = code.trim().chars().count();
    let label = match error.job {
        Some(job) => format!("submit job {job} stopped the PLC here"),
        None => "the PLC stopped here".to_owned(),
    };
    Diagnostic::error(
        Span::new(error.line as usize, start + 1, length),
        error.error.to_string(),
    )
    .with_code(format!("PLC {}", error.error.number()))
    .with_detail(label)
    .with_help(Some(format!("{} {}", error.error.cause(), error.error.cure())))
    .at(error.file.as_str(), text)
}
