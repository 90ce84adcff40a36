//! `bahn check` of a DIN 66025 program: what is wrong in its text, and what its execution comes to.

use std::path::Path;
use std::sync::Arc;

use bahn_din::{Fault, FileFault as Found, Program, Shelf, examine};
use bahn_interpreter::Complete;

use super::{CheckReport, Entry, summary};
use crate::UsageError;
use crate::diagnostics::{self, FileFault, Marked};
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
            let shelf: Arc<dyn Shelf> = Arc::new(files::NcFolder::of(path));
            let examined = examine(&program, &shelf, &interrupt.flag());
            let complete = match examined.complete {
                true => Complete::Yes,
                false => Complete::No,
            };
            (examined.found, complete)
        }
    };
    let report = CheckReport {
        file: path.to_string_lossy().into_owned(),
        blocks: program.block_count(),
        errors: found.len(),
        warnings: 0,
        complete: complete == Complete::Yes,
        diagnostics: found.iter().map(entry).collect(),
    };
    if format == Format::Text {
        for found in found.iter().take(diagnostics::PRINTED_MAX) {
            print(found, &program, path);
        }
        summary(&report, complete);
    }
    Ok(report)
}

/// A fault of the whole file.
fn whole(program: &Arc<Program>, message: &str) -> Found {
    let fault = Fault {
        line: 1,
        column: 1,
        length: 1,
        block: program.block_name(1),
        message: message.to_owned(),
    };
    Found {
        program: Arc::clone(program),
        fault,
    }
}

fn entry(found: &Found) -> Entry {
    let fault = &found.fault;
    Entry {
        severity: "error",
        message: fault.message.clone(),
        program: found.program.name().to_string(),
        block: number(fault),
        line: fault.line,
        column: fault.column,
        length: fault.length,
        detail: String::new(),
        help: found.program.cure(fault).unwrap_or_default(),
    }
}

/// The number of a block, without one its line.
fn number(fault: &Fault) -> u32 {
    let digits = fault.block.trim_start_matches(['N', '#']);
    digits.parse().unwrap_or(fault.line)
}

fn print(found: &Found, main: &Program, path: &Path) {
    let path = match found.program.name() == main.name() {
        true => path.to_owned(),
        // Called programs lie beside their caller.
        false => path.with_file_name(&**found.program.name()),
    };
    diagnostics::print_fault(&located(&found.fault, &found.program, &path));
}

/// A fault of a program with its line.
pub(crate) fn located(fault: &Fault, program: &Program, path: &Path) -> FileFault {
    FileFault {
        severity: diagnostics::Severity::Error,
        title: fault.message.clone(),
        path: path.to_owned(),
        marked: Marked {
            line: fault.line,
            text: program.line(fault.line).to_owned(),
            columns: Some((fault.column, fault.length)),
        },
        label: format!("block {}", fault.block),
        help: program.cure(fault),
        opened: None,
    }
}
