//! All that can be said of a program without machining anything: what reading finds, and what rehearsing finds, each
//! mistake once.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_parameters::{ControlModel, MessageId};
use bahn_path::BlockRef;
use bahn_program::{Fault, MAX_DIAGNOSTICS, Program, Reading, Uncounted};
use bahn_reader::Programs;
use bahn_text::{Diagnostic, Severity};

use crate::error::{Cause, Message, ProgramError, Warning};
use crate::rehearsal::{Rehearsal, rehearse};
use crate::settings::Settings;

/// What is wrong with a program and with those that it calls.
#[derive(Debug)]
pub struct Examination {
    /// The programs of the run by their number; 0 is the one that was examined.
    pub programs: Vec<Arc<Program>>,
    /// What was found, in the order of programs and blocks.
    pub found: Vec<Found>,
    /// Faults that were counted only.
    pub more: Uncounted,
    /// How far it was executed.
    pub complete: Complete,
    /// The Q parameters after the last block that was executed, by their number; none where only the machine knows.
    pub q_values: Vec<Option<f64>>,
}

/// Whether a program was executed to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Complete {
    /// It was executed to its end.
    Yes,
    /// A loop was not followed any farther.
    No,
    /// There is nothing to execute.
    NotBegun,
}

/// A fault in one of the programs of a run.
#[derive(Clone, Debug)]
pub struct Found {
    /// Number of the program; 0 is the one that was examined.
    pub program: usize,
    /// The fault, with its block and line.
    pub fault: Fault,
    /// The headline, where it is not that of the message.
    title: Box<str>,
}

impl Found {
    /// In the words of a control, as people and programs get it; `program` is the one it is in, `file` where that lies.
    pub fn diagnostic(&self, program: &Program, model: ControlModel, file: &Path) -> Diagnostic {
        let fault = self.fault.diagnostic(program, model, file);
        match &*self.title {
            "" => fault,
            title => Diagnostic {
                message: title.to_owned(),
                ..fault
            },
        }
    }
}

impl From<Fault> for Found {
    /// A fault of the program that is examined.
    fn from(fault: Fault) -> Found {
        Found {
            program: 0,
            title: "".into(),
            fault,
        }
    }
}

/// Reads every block of a program and rehearses it, until `interrupt` is set.
///
/// ```
/// use std::sync::Arc;
/// use std::sync::atomic::AtomicBool;
/// use bahn_interpreter::{Complete, NoPrograms, Settings, examine};
/// use bahn_program::Program;
///
/// let text = "BEGIN PGM 1 MM\nFN 0: Q5 = +2\nFN 3: Q5 = +Q5 * +4\nL X+5 Y+9 R0 FMAX Q\nEND PGM 1 MM\n";
/// let program = Arc::new(Program::from_bytes("1.H", text.into()));
/// let found = examine(program, Settings::default(), Arc::new(NoPrograms), &AtomicBool::new(false));
/// assert_eq!((found.complete, found.found[0].fault.span.line), (Complete::Yes, 4));
/// assert_eq!(found.q_values[5], Some(8.0));
/// ```
pub fn examine(
    program: Arc<Program>,
    settings: Settings,
    programs: Arc<dyn Programs>,
    interrupt: &AtomicBool,
) -> Examination {
    let (faults, more) = program.counted_diagnostics(Some(Reading {
        limits: settings.model.limits(),
        inch_feed: settings.inch_feed(),
    }));
    if program.refused().is_some() || faults.len() >= MAX_DIAGNOSTICS {
        // Not a program that can be executed.
        return Examination {
            programs: vec![program],
            found: faults.into_iter().map(Found::from).collect(),
            more,
            complete: Complete::NotBegun,
            q_values: Vec::new(),
        };
    }
    let model = settings.model;
    let rehearsal = rehearse(program, settings, programs, interrupt);
    let found = merged(faults, &rehearsal, model);
    Examination {
        programs: rehearsal.programs,
        found,
        more,
        complete: match rehearsal.complete {
            true => Complete::Yes,
            false => Complete::No,
        },
        q_values: rehearsal.q_values,
    }
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
    found.extend(read.into_iter().map(Found::from));
    found.sort_by_key(|found| (found.program, found.fault.block));
    found
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
        title: error.message.text(model).into(),
        fault,
    })
}

fn rehearsed_warning(warning: &Warning, rehearsal: &Rehearsal) -> Option<Found> {
    let program = program_of(rehearsal, warning.block)?;
    let block = warning.block.block;
    let fault = program.diagnostic(MessageId::UnexpectedText, Severity::Warning, block, "", "");
    Some(Found {
        program: usize::from(warning.block.program),
        title: warning.kind.to_string().into(),
        fault,
    })
}

fn program_of(rehearsal: &Rehearsal, block: BlockRef) -> Option<&Arc<Program>> {
    rehearsal.programs.get(usize::from(block.program))
}
