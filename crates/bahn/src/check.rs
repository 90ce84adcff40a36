//! `bahn check`: all errors of programs that can be found without machining anything.
//!
//! Every block is read, and the program is rehearsed: executed without geometry, beyond its errors.

mod din;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_interpreter::{Cause, Message, ProgramError, Rehearsal, Settings, Warning, rehearse};
use bahn_parameters::{ControlModel, MessageId};
use bahn_path::BlockRef;
use bahn_program::{Diagnostic as Fault, MAX_DIAGNOSTICS, Program, Reading, Severity, Uncounted};

use crate::diagnostics::{self, FileFault, Marked};
use crate::files::{self, FileLibrary, Loaded};
use crate::interrupt::Interrupt;
use crate::options::{CheckOptions, Format};
use crate::{Outcome, UsageError, console};

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
    let mut outcome = Outcome::Fine;
    let mut reports = Vec::new();
    for path in &options.files {
        match check(path, &how, &interrupt) {
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
        if interrupt.is_requested() {
            outcome = Outcome::Interrupted;
            break;
        }
    }
    if options.format == Format::Json {
        console::print_json(&reports)?;
    }
    Ok(outcome)
}

/// What is wrong with one file.
#[derive(Debug, serde::Serialize)]
pub(crate) struct CheckReport {
    file: String,
    blocks: u32,
    pub errors: usize,
    warnings: usize,
    /// The end was reached, whatever the faults on the way.
    complete: bool,
    diagnostics: Vec<Entry>,
}

#[derive(Debug, serde::Serialize)]
struct Entry {
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

/// A fault in one of the programs of the run.
struct Found {
    /// Number of the program; 0 is the file itself.
    program: usize,
    /// The headline.
    title: String,
    fault: Fault,
}

/// Checks a file and prints what is wrong.
pub(crate) fn check(path: &Path, how: &Check, interrupt: &Interrupt) -> Result<CheckReport, UsageError> {
    if files::extension(path) == "nc" {
        return din::check(path, how.format, interrupt);
    }
    let (programs, found, more, complete) = match files::load_program(path)? {
        Loaded::Program(program) => examine(program, &how.settings, interrupt),
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
    let count = |severity| {
        found
            .iter()
            .filter(|found| found.fault.severity == severity)
            .count()
    };
    let report = CheckReport {
        file: path.to_string_lossy().into_owned(),
        blocks: match complete {
            Complete::NotBegun => 0,
            _ => programs.first().map_or(0, |program| program.block_count()),
        },
        errors: count(Severity::Error) + more.errors,
        warnings: count(Severity::Warning) + more.warnings,
        complete: complete == Complete::Yes,
        diagnostics: found
            .iter()
            .map(|found| entry(found, &programs, how.settings.model))
            .collect(),
    };
    if how.format == Format::Text {
        for found in found.iter().take(diagnostics::PRINTED_MAX) {
            print(found, &programs, path, how.settings.model);
        }
        summary(&report, complete);
    }
    Ok(report)
}

/// Whether a program was executed to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Complete {
    Yes,
    No,
    /// There is nothing to execute.
    NotBegun,
}

type Examined = (Vec<Arc<Program>>, Vec<Found>, Uncounted, Complete);

/// Reads every block and rehearses the program.
fn examine(program: Arc<Program>, settings: &Settings, interrupt: &Interrupt) -> Examined {
    let (faults, more) = program.counted_diagnostics(Some(Reading {
        limits: settings.model.limits(),
        inch_feed: settings.inch_feed(),
    }));
    if program.refused().is_some() || faults.len() >= MAX_DIAGNOSTICS {
        // Not a program that can be executed.
        return (
            vec![program],
            faults.into_iter().map(of_file).collect(),
            more,
            Complete::NotBegun,
        );
    }
    let library = Box::new(FileLibrary::with_main(&program));
    let rehearsal = rehearse(program, settings.clone(), library, &interrupt.flag());
    let found = merged(faults, &rehearsal, settings.model);
    let complete = if rehearsal.complete {
        Complete::Yes
    } else {
        Complete::No
    };
    (rehearsal.programs, found, more, complete)
}

/// What was read and what was rehearsed, in the order of programs and blocks. What reading has found at a
/// block is not said again.
fn merged(read: Vec<Fault>, rehearsal: &Rehearsal, model: ControlModel) -> Vec<Found> {
    let is_error = |fault: &&Fault| fault.severity == Severity::Error;
    let known = |error: &ProgramError| {
        read.iter().filter(is_error).any(|fault| {
            let incomplete = fault.message == MessageId::CyclIncomplete
                && error.message == Message::Control(MessageId::CyclIncomplete)
                && error.cause == Cause::Message;
            incomplete || (error.block.program == 0 && error.block.block == fault.block)
        })
    };
    let mut found: Vec<Found> = Vec::new();
    for error in rehearsal.errors.iter().filter(|error| !known(error)) {
        found.extend(rehearsed_error(error, rehearsal, model));
    }
    for warning in &rehearsal.warnings {
        found.extend(rehearsed_warning(warning, rehearsal));
    }
    found.extend(read.into_iter().map(of_file));
    found.sort_by_key(|found| (found.program, found.fault.block));
    found
}

fn of_file(fault: Fault) -> Found {
    Found {
        program: 0,
        title: String::new(),
        fault,
    }
}

fn rehearsed_error(error: &ProgramError, rehearsal: &Rehearsal, model: ControlModel) -> Option<Found> {
    let program = program_of(rehearsal, error.block)?;
    let message = match error.message {
        Message::Control(id) => id,
        Message::Numbered(_) => MessageId::ErrorBlock,
    };
    let mut fault = program.diagnostic(message, Severity::Error, error.block.block, "", &error.detail);
    fault.help = error.remedy().unwrap_or_default();
    Some(Found {
        program: usize::from(error.block.program),
        title: error.message.text(model).to_owned(),
        fault,
    })
}

fn rehearsed_warning(warning: &Warning, rehearsal: &Rehearsal) -> Option<Found> {
    let program = program_of(rehearsal, warning.block)?;
    let block = warning.block.block;
    let fault = program.diagnostic(MessageId::UnexpectedText, Severity::Warning, block, "", "");
    Some(Found {
        program: usize::from(warning.block.program),
        title: warning.kind.to_string(),
        fault,
    })
}

fn program_of(rehearsal: &Rehearsal, block: BlockRef) -> Option<&Arc<Program>> {
    rehearsal.programs.get(usize::from(block.program))
}

impl Found {
    fn title(&self, model: ControlModel) -> &str {
        match self.title.as_str() {
            "" => self.fault.message.text(model),
            title => title,
        }
    }
}

fn entry(found: &Found, programs: &[Arc<Program>], model: ControlModel) -> Entry {
    let fault = &found.fault;
    let program = programs.get(found.program);
    Entry {
        severity: match fault.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        message: found.title(model).to_owned(),
        program: program.map_or(String::new(), |program| files::short_name(program).to_owned()),
        block: program.map_or(fault.block, |program| program.number_of(fault.block)),
        line: fault.line,
        column: fault.column,
        length: fault.length,
        detail: fault.detail.to_string(),
        help: help(fault).unwrap_or_default().to_owned(),
    }
}

/// Warnings say themselves what to do.
fn help(fault: &Fault) -> Option<&'static str> {
    (fault.severity == Severity::Error && !fault.help.is_empty()).then_some(fault.help)
}

fn print(found: &Found, programs: &[Arc<Program>], path: &Path, model: ControlModel) {
    let fault = &found.fault;
    let Some(program) = programs.get(found.program) else {
        return;
    };
    let number = program.number_of(fault.block);
    let path: PathBuf = match found.program {
        0 => path.to_owned(),
        // Called programs lie beside their caller.
        _ => path.with_file_name(files::short_name(program)),
    };
    diagnostics::print_fault(&FileFault {
        severity: match fault.severity {
            Severity::Error => diagnostics::Severity::Error,
            Severity::Warning => diagnostics::Severity::Warning,
        },
        title: found.title(model).to_owned(),
        path,
        marked: Marked {
            line: fault.line,
            text: program.text_of_line(fault.line),
            columns: Some((fault.column, fault.length)),
        },
        label: match &*fault.detail {
            "" => format!("block {number}"),
            detail => format!("block {number}: {detail}"),
        },
        help: help(fault).map(str::to_owned),
        opened: None,
    });
}

/// A fault of the whole file, which holds nothing to be examined.
fn nothing(program: Arc<Program>, message: MessageId, detail: &str) -> Examined {
    let fault = Fault {
        line: 1,
        column: 1,
        length: 1,
        ..program.diagnostic(message, Severity::Error, 0, "", detail)
    };
    (
        vec![program],
        vec![of_file(fault)],
        Uncounted::default(),
        Complete::NotBegun,
    )
}

fn summary(report: &CheckReport, complete: Complete) {
    let count = |number: usize, what: &str| match number {
        1 => format!("1 {what}"),
        _ => format!("{number} {what}s"),
    };
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
