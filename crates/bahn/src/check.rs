//! `bahn check`: all errors of programs that can be found without running them.

use std::path::Path;

use bahn_interpreter::Judgement;
use bahn_parameters::{ControlModel, MessageId};
use bahn_program::{Diagnostic as Fault, MAX_DIAGNOSTICS, Program, Severity};

use crate::cli::{CheckOptions, Format};
use crate::diagnostics::{self, Diagnostic, Marked};
use crate::files::{self, Loaded};
use crate::{Outcome, UsageError, conformance, console};

/// Checks files and prints what is wrong.
pub(crate) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let mut outcome = Outcome::Fine;
    let mut reports = Vec::new();
    for path in &options.files {
        match check(path, options) {
            Ok(report) => {
                if report.errors > 0 && outcome == Outcome::Fine {
                    outcome = Outcome::ProgramError;
                }
                reports.push(report);
            }
            // The other files are checked all the same.
            Err(error) => {
                diagnostics::print_usage_error(&error.to_string());
                outcome = Outcome::WrongUse;
            }
        }
    }
    if options.format == Format::Json {
        let json = serde_json::to_string_pretty(&reports)
            .map_err(|error| UsageError::new(format!("cannot write the report: {error}")))?;
        console::print(&(json + "\n"))?;
    }
    Ok(outcome)
}

/// What is wrong with one file.
#[derive(Debug, serde::Serialize)]
struct CheckReport {
    file: String,
    blocks: u32,
    errors: usize,
    warnings: usize,
    diagnostics: Vec<Entry>,
}

#[derive(Debug, serde::Serialize)]
struct Entry {
    severity: &'static str,
    message: String,
    block: u32,
    line: u32,
    column: u32,
    length: u32,
    detail: String,
}

fn check(path: &Path, options: &CheckOptions) -> Result<CheckReport, UsageError> {
    let program = files::load_program(path)?;
    let mut found = match &program {
        Loaded::Program(program) => program.diagnostics(Some(options.model.limits())),
        Loaded::Empty(_) => vec![whole_file(MessageId::EndOfProgramMissing, files::EMPTY)],
        Loaded::TooLarge => vec![whole_file(
            MessageId::FurtherProgramEntryImpossible,
            files::TOO_LARGE,
        )],
    };
    if let Loaded::Program(program) = &program {
        found.extend(functions(program, &found, options));
        found.sort_by_key(|fault| (fault.block, fault.severity == Severity::Warning));
    }
    let count = |severity| found.iter().filter(|fault| fault.severity == severity).count();
    let report = CheckReport {
        file: path.to_string_lossy().into_owned(),
        blocks: program.program().map_or(0, |program| program.block_count()),
        errors: count(Severity::Error),
        warnings: count(Severity::Warning),
        diagnostics: found.iter().map(|fault| entry(fault, options.model)).collect(),
    };
    if options.format == Format::Text {
        let empty = Program::from_bytes("", Vec::new());
        let program = program.program().map_or(&empty, |program| program);
        for fault in &found {
            print(fault, program, path, options.model);
        }
        summary(&report);
    }
    Ok(report)
}

/// Functions that are not executed here, or not wholly, each at its first block; where that has an error
/// already, it is said.
fn functions(program: &Program, found: &[Fault], options: &CheckOptions) -> Vec<Fault> {
    let has_error = |block| {
        let mut errors = found.iter().filter(|fault| fault.severity == Severity::Error);
        errors.any(|fault| fault.block == block)
    };
    let mut faults = Vec::new();
    for (block, feature, judgement) in conformance::remarks(program, options.model, options.strict) {
        let (is_error, detail) = match judgement {
            Judgement::Executed => continue,
            Judgement::Remarked(text) | Judgement::PassedOver(text) => (false, text),
            Judgement::Refused(text) => (!options.skip_unknown, text),
        };
        if has_error(block) {
            continue;
        }
        let line = program.line_of(block);
        let text = program.text_of_line(line);
        let word = feature.to_string();
        let at = text.to_ascii_uppercase().find(&word).unwrap_or(0);
        let column = text.get(..at).unwrap_or_default().chars().count() + 1;
        faults.push(Fault {
            message: MessageId::BlockNotKnown,
            severity: if is_error {
                Severity::Error
            } else {
                Severity::Warning
            },
            block,
            line,
            column: u32::try_from(column).unwrap_or(u32::MAX),
            length: u32::try_from(word.len().min(text.chars().count())).unwrap_or(u32::MAX),
            detail: detail.into(),
        });
    }
    faults
}

fn entry(fault: &Fault, model: ControlModel) -> Entry {
    Entry {
        severity: match fault.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        message: fault.message.text(model).to_owned(),
        block: fault.block,
        line: fault.line,
        column: fault.column,
        length: fault.length,
        detail: fault.detail.to_string(),
    }
}

fn print(fault: &Fault, program: &Program, path: &Path, model: ControlModel) {
    diagnostics::print(&Diagnostic {
        severity: match fault.severity {
            Severity::Error => diagnostics::Severity::Error,
            Severity::Warning => diagnostics::Severity::Warning,
        },
        title: fault.message.text(model),
        path: &path.to_string_lossy(),
        marked: Marked {
            line: fault.line,
            text: program.text_of_line(fault.line),
            columns: Some((fault.column, fault.length)),
        },
        label: format!("block {}: {}", fault.block, fault.detail),
        help: (fault.severity == Severity::Error).then(|| fault.message.remedy()),
    });
    diagnostics::print_line("");
}

/// A fault of the whole file.
fn whole_file(message: MessageId, detail: &str) -> Fault {
    Fault {
        message,
        severity: Severity::Error,
        block: 0,
        line: 1,
        column: 1,
        length: 1,
        detail: detail.into(),
    }
}

fn summary(report: &CheckReport) {
    let count = |number: usize, what: &str| match number {
        1 => format!("1 {what}"),
        _ => format!("{number} {what}s"),
    };
    let most = if report.diagnostics.len() >= MAX_DIAGNOSTICS {
        ", perhaps more"
    } else {
        ""
    };
    diagnostics::print_line(&format!(
        "{}: {} blocks, {}, {}{most}",
        report.file,
        report.blocks,
        count(report.errors, "error"),
        count(report.warnings, "warning"),
    ));
}
