//! What a check has found.

use bahn_interpreter::Complete;
use bahn_text::Diagnostic;

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
    severity: &'static str,
    message: String,
    program: String,
    block: u32,
    line: u32,
    column: u32,
    length: u32,
    detail: String,
    help: String,
}

impl From<&Diagnostic> for Entry {
    fn from(fault: &Diagnostic) -> Entry {
        let program = fault.file.file_name().unwrap_or_default();
        // `12`, `N40`, without a number the line: `#12`.
        let block = fault.block.trim_start_matches(['N', '#']);
        Entry {
            severity: fault.severity.name(),
            message: fault.message.clone(),
            program: program.to_string_lossy().into_owned(),
            block: block.parse().unwrap_or(fault.span.line),
            line: fault.span.line,
            column: fault.span.column,
            length: fault.span.length,
            detail: fault.detail.clone(),
            help: fault.help.clone().unwrap_or_default(),
        }
    }
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
