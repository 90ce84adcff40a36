//! `bahn check` of a DIN 66025 program: what is wrong in its text, and what its execution comes to.

use std::path::Path;
use std::sync::Arc;

use bahn_din::{Fault, Found, Program, examine};
use bahn_interpreter::Complete;
use bahn_text::{Diagnostic, Files, Span};

use super::{CheckReport, Entry, summary};
use crate::UsageError;
use crate::diagnostics;
use crate::files;
use crate::interrupt::Interrupt;
use crate::options::Format;

/// Checks a file and prints what is wrong.
pub(super) fn check(path: &Path, format: Format, interrupt: &Interrupt) -> Result<CheckReport, UsageError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let bytes = files::read_program(path)?;
    let is_too_large = bytes.is_none();
    let bytes = bytes.unwrap_or_default();
    let program = Arc::new(Program::from_bytes(&name, &bytes));
    let (found, complete) = match is_too_large {
        true => (vec![whole(&program, files::TOO_LARGE)], Complete::NotBegun),
        false if bytes.trim_ascii().is_empty() => (vec![whole(&program, files::EMPTY)], Complete::NotBegun),
        false => {
            let beside: Arc<dyn Files> = Arc::new(files::NcFolder::of(path));
            let examined = examine(&program, &beside, &interrupt.flag());
            let complete = match examined.complete {
                true => Complete::Yes,
                false => Complete::No,
            };
            (examined.found, complete)
        }
    };
    let found: Vec<Diagnostic> = found
        .iter()
        .map(|found| diagnostic(found, &program, path))
        .collect();
    let report = CheckReport {
        file: path.to_string_lossy().into_owned(),
        blocks: program.block_count(),
        errors: found.len(),
        warnings: 0,
        complete: complete == Complete::Yes,
        diagnostics: found.iter().map(Entry::from).collect(),
    };
    if format == Format::Text {
        let shown = found.iter().take(diagnostics::PRINTED_MAX);
        shown.for_each(diagnostics::print_fault);
        summary(&report, complete);
    }
    Ok(report)
}

/// A fault of the whole file.
fn whole(program: &Arc<Program>, message: &str) -> Found {
    let fault = Fault {
        span: Span::new(1, 1, 1),
        block: program.block_name(1),
        message: message.to_owned(),
    };
    Found {
        program: Arc::clone(program),
        fault,
    }
}

/// A fault at its place in the file that was examined, or in one beside it.
fn diagnostic(found: &Found, main: &Program, path: &Path) -> Diagnostic {
    let path = match found.program.name() == main.name() {
        true => path.to_owned(),
        // Called programs lie beside their caller.
        false => path.with_file_name(&**found.program.name()),
    };
    found.fault.diagnostic(&found.program, &path)
}
