//! Standard output that may close at any time (`bahn fmt part.h | head`).

use std::io::{self, Write};

use bahn_text::printable_lines;

use crate::diagnostics;
use crate::{UsageError, refused};

/// Prints text for people to standard output. Names and texts in it may come from anywhere: nothing in it steers the
/// terminal.
pub(crate) fn print(text: &str) -> Result<(), UsageError> {
    print_bytes(printable_lines(text).as_bytes())
}

/// Prints what the control says, for people: to standard output, beside JSON to standard error.
pub(crate) fn print_line(line: &str) -> Result<(), UsageError> {
    refused::message(line);
    if refused::json_is_wanted() {
        diagnostics::print_line(line);
        return Ok(());
    }
    print(&format!("{line}\n"))
}

/// Prints bytes to standard output: files, JSON, and what has colours of ours. A reader that has gone away is no error; a full disk is one.
pub(crate) fn print_bytes(bytes: &[u8]) -> Result<(), UsageError> {
    refused::has_printed();
    let mut out = io::stdout().lock();
    finish(out.write_all(bytes).and_then(|()| out.flush()))
}

/// Prints a report as JSON.
pub(crate) fn print_json(report: &impl serde::Serialize) -> Result<(), UsageError> {
    print_bytes(bahn_report::text::json(report)?.as_bytes())
}

/// Prints a value as one line of JSON, since lines of others may stand before it and after it.
pub(crate) fn print_json_line(value: &impl serde::Serialize) -> Result<(), UsageError> {
    let line = serde_json::to_string(value)
        .map_err(|error| UsageError::new(format!("cannot write the report: {error}")))?;
    print_bytes((line + "\n").as_bytes())
}

/// Prints something that writes itself piece by piece.
pub(crate) fn print_display(value: &impl std::fmt::Display) -> Result<(), UsageError> {
    refused::has_printed();
    let mut out = io::BufWriter::with_capacity(1 << 16, io::stdout().lock());
    finish(write!(out, "{value}").and_then(|()| out.flush()))
}

fn finish(result: io::Result<()>) -> Result<(), UsageError> {
    match result {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(UsageError::new(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}
