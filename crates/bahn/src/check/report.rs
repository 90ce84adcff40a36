//! What a check has found.

use bahn_interpreter::Complete;

use crate::diagnostics;
use bahn_report::count;

/// What is wrong with one file.
#[derive(Debug, serde::Serialize)]
pub(crate) struct CheckReport {
    pub(super) file: String,
    pub(super) blocks: u32,
    pub errors: usize,
    pub(super) warnings: usize,
    /// The end was reached, whatever the faults on the way.
    pub(super) complete: bool,
    pub(super) diagnostics: Vec<Entry>,
}

#[derive(Debug, serde::Serialize)]
pub(super) struct Entry {
    pub(super) severity: &'static str,
    pub(super) message: String,
    pub(super) program: String,
    pub(super) block: u32,
    pub(super) line: u32,
    pub(super) column: u32,
    pub(super) length: u32,
    pub(super) detail: String,
    pub(super) help: String,
}

pub(super) fn summary(report: &CheckReport, complete: Complete) {
    let all = report.errors + report.warnings;
    let printed = report.diagnostics.len().min(diagnostics::PRINTED_MAX);
    let more = match all - printed {
        0 => String::new(),
        rest => format!(", {rest} of them not shown"),
    };
    let followed = match complete {
        Complete::No => "; loops were not followed to their end",
        Complete::Yes | Complete::NotBegun => "",
    };
    diagnostics::print_text(&format!(
        "{}: {} blocks, {}, {}{more}{followed}",
        report.file,
        report.blocks,
        count(report.errors, "error"),
        count(report.warnings, "warning"),
    ));
}
