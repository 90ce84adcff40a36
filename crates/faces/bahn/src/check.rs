//! `bahn check`: all errors of programs that can be found without machining anything.
//!
//! Every block is read, and the program is rehearsed: executed without geometry, beyond its errors.

pub(crate) mod din;
mod report;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_interpreter::{Complete, Examination, Found, Settings, examine};
use bahn_parameters::{ControlModel, MessageId};
use bahn_program::{Fault, Program, Uncounted};
use bahn_text::{Diagnostic, Severity, Span};

use crate::diagnostics;
use crate::files::{self, Loaded};
use crate::interrupt::Interrupt;
use crate::options::{CheckOptions, Format};
use crate::reports::Reports;
use crate::{Outcome, UsageError};

pub(crate) use report::CheckReport;
use report::{Entry, summary};

/// How programs are checked.
pub(crate) struct Check {
    pub settings: Settings,
    pub format: Format,
}

/// Checks files and prints what is wrong.
pub(crate) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let interrupt = Interrupt::on_ctrl_c();
    let how = Check {
        settings: Settings {
            model: options.model,
            inch_feed: options.inch_feed.map(Into::into),
            strict: options.strict,
            skip_unknown: options.skip_unknown,
            ..Settings::default()
        },
        format: options.format,
    };
    let mut reports = Reports::new();
    for path in &options.files {
        reports.add(path, check(path, &how, &interrupt));
        if interrupt.is_requested() {
            break;
        }
    }
    let outcome = reports.end(options.format, |report| report.errors > 0)?;
    Ok(match interrupt.is_requested() {
        true => Outcome::Interrupted,
        false => outcome,
    })
}

/// Checks a file and prints what is wrong.
pub(crate) fn check(path: &Path, how: &Check, interrupt: &Interrupt) -> Result<CheckReport, UsageError> {
    // What cannot be read is said by whoever reads it next.
    let dialect = std::fs::read(path)
        .ok()
        .and_then(|bytes| files::dialect(path, &bytes));
    if let Some(dialect) = dialect {
        return din::check(path, dialect, how.format, interrupt);
    }
    let examination = match files::load_program(path)? {
        Loaded::Program(program) => examined(program, &how.settings, interrupt),
        Loaded::Empty(program) => nothing(program, MessageId::EndOfProgramMissing, files::EMPTY),
        Loaded::TooLarge => {
            let program = Arc::new(Program::from_bytes("", Vec::new()));
            nothing(
                program,
                MessageId::FurtherProgramEntryImpossible,
                files::TOO_LARGE,
            )
        }
    };
    let Examination {
        programs,
        found,
        more,
        complete,
        ..
    } = examination;
    let found: Vec<Diagnostic> = found
        .iter()
        .filter_map(|found| diagnostic(found, &programs, path, how.settings.model))
        .collect();
    let count = |severity| found.iter().filter(|found| found.severity == severity).count();
    let report = CheckReport {
        file: path.to_string_lossy().into_owned(),
        blocks: match complete {
            Complete::NotBegun => 0,
            _ => programs.first().map_or(0, |program| program.block_count()),
        },
        errors: count(Severity::Error) + more.errors,
        warnings: count(Severity::Warning) + more.warnings,
        complete: complete == Complete::Yes,
        diagnostics: found.iter().map(Entry::from).collect(),
    };
    if how.format == Format::Text {
        let shown = found.iter().take(diagnostics::PRINTED_MAX);
        shown.for_each(diagnostics::print_fault);
        summary(&report, complete);
    }
    Ok(report)
}

/// Reads every block and rehearses the program.
fn examined(program: Arc<Program>, settings: &Settings, interrupt: &Interrupt) -> Examination {
    let library = Arc::new(files::beside(&program));
    examine(program, settings.clone(), library, &interrupt.flag())
}

/// A fault at its place in the file that was examined, or in one beside it.
fn diagnostic(
    found: &Found,
    programs: &[Arc<Program>],
    path: &Path,
    model: ControlModel,
) -> Option<Diagnostic> {
    let program = programs.get(found.program)?;
    let path: PathBuf = match found.program {
        0 => path.to_owned(),
        // Called programs lie beside their caller.
        _ => path.with_file_name(files::short_name(program)),
    };
    Some(found.diagnostic(program, model, &path))
}

/// A fault of the whole file, which holds nothing to be examined.
fn nothing(program: Arc<Program>, message: MessageId, detail: &str) -> Examination {
    let fault = Fault {
        span: Span::new(1, 1, 1),
        ..program.diagnostic(message, Severity::Error, 0, "", detail)
    };
    Examination {
        programs: vec![program],
        found: vec![fault.into()],
        more: Uncounted::default(),
        complete: Complete::NotBegun,
        q_values: Vec::new(),
    }
}
