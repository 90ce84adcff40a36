//! `bahn check` of DIN 66025 programs: what is wrong in their text, and what their execution comes to.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_din::{Fault, Found, Program, examine, system900};
use bahn_interpreter::Complete;
use bahn_program::DinLanguage;
use bahn_text::{Diagnostic, Files, Severity, Span};

use super::{CheckReport, Entry, summary};
use crate::UsageError;
use crate::diagnostics;
use crate::files;
use crate::interrupt::Interrupt;
use crate::options::Format;

/// What a check has found.
struct Checked {
    blocks: u32,
    complete: Complete,
    found: Vec<Diagnostic>,
}

/// Checks a file and prints what is wrong.
pub(super) fn check(
    path: &Path,
    dialect: DinLanguage,
    format: Format,
    interrupt: &Interrupt,
) -> Result<CheckReport, UsageError> {
    let bytes = files::read_program(path)?;
    let Checked {
        blocks,
        complete,
        found,
    } = match dialect {
        DinLanguage::Tf5200 => tf5200(path, bytes.as_deref(), interrupt),
        DinLanguage::System900 => system_900(path, bytes.as_deref()),
    };
    let count = |severity| found.iter().filter(|found| found.severity == severity).count();
    let report = CheckReport {
        file: path.to_string_lossy().into_owned(),
        blocks,
        errors: count(Severity::Error),
        warnings: count(Severity::Warning),
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

/// Why the bytes of a file hold nothing that could be examined; `None` are those of one that is too large.
fn nothing(bytes: Option<&[u8]>) -> Option<&'static str> {
    match bytes {
        None => Some(files::TOO_LARGE),
        Some(bytes) if bytes.trim_ascii().is_empty() => Some(files::EMPTY),
        Some(_) => None,
    }
}

fn tf5200(path: &Path, bytes: Option<&[u8]>, interrupt: &Interrupt) -> Checked {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let program = Arc::new(Program::from_bytes(&name, bytes.unwrap_or_default()));
    let (found, complete) = match nothing(bytes) {
        Some(why) => (vec![whole(&program, why)], Complete::NotBegun),
        None => {
            let beside: Arc<dyn Files> = Arc::new(files::NcFolder::of(path));
            let examined = examine(&program, &beside, &interrupt.flag());
            let complete = match examined.complete {
                true => Complete::Yes,
                false => Complete::No,
            };
            (examined.found, complete)
        }
    };
    let diagnostics = found.iter().map(|found| diagnostic(found, &program, path));
    Checked {
        blocks: program.block_count(),
        complete,
        found: diagnostics.collect(),
    }
}

/// Every block is read; nothing is executed.
fn system_900(path: &Path, bytes: Option<&[u8]>) -> Checked {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let program = Arc::new(system900::Program::from_bytes(&name, bytes.unwrap_or_default()));
    let (found, complete) = match nothing(bytes) {
        Some(why) => {
            let diagnostic = Diagnostic::error(Span::new(1, 1, 1), why).at(path, program.line(1));
            (vec![diagnostic], Complete::NotBegun)
        }
        None => {
            let found = system900::examine(&program, &files::NcFolder::of(path));
            let diagnostics = found.iter().map(|found| {
                let file = beside(path, found.program.name(), program.name());
                found.program.diagnostic(found.severity, &found.fault, &file)
            });
            (diagnostics.collect(), Complete::Yes)
        }
    };
    Checked {
        blocks: program.block_count(),
        complete,
        found,
    }
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
    let file = beside(path, found.program.name(), main.name());
    found.fault.diagnostic(&found.program, &file)
}

/// Where a file lies that was examined with the one of a path: called programs lie beside their caller.
fn beside(path: &Path, name: &str, main: &str) -> PathBuf {
    match name == main {
        true => path.to_owned(),
        false => path.with_file_name(name),
    }
}
