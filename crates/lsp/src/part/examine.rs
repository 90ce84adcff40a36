//! What is wrong with a program, as `bahn check` finds it, and the Q parameters at the end of a run.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_interpreter::{Complete, Examination, Found, Settings};
use bahn_program::{CycleWord, Diagnostic, Operation, Program, Severity as Degree};

use super::shelf::Shelf;
use super::{PROGRAM_CYCLE, PartProgram};
use crate::language::{Examined, Fault, Place, Related, Severity};
use crate::world::World;

pub(super) fn examine(program: &PartProgram, world: &World, interrupt: &AtomicBool) -> Examined {
    if program.text.text.trim().is_empty() {
        // A new file: nothing is wrong with it yet.
        return Examined::default();
    }
    let settings = Settings {
        model: program.model,
        strict: world.settings.strict,
        skip_unknown: world.settings.skip_unknown,
        ..Settings::default()
    };
    let library = Box::new(Shelf::with(&program.program, world));
    let found = bahn_interpreter::examine(program.program.clone(), settings, library, interrupt);
    let faults = found.found.iter().map(|fault| located(program, &found, fault));
    Examined {
        faults: faults.collect(),
        not_listed: found.more.errors + found.more.warnings,
        complete: found.complete == Complete::Yes,
        values: found.q_values,
        ..Examined::default()
    }
}

/// A fault of this program at its place, one of another program at the call that leads there.
fn located(program: &PartProgram, all: &Examination, found: &Found) -> Fault {
    let fault = &found.fault;
    let severity = match fault.severity {
        Degree::Error => Severity::Error,
        Degree::Warning => Severity::Warning,
    };
    let mut message = found.title(program.model).to_owned();
    for (sign, more) in [(": ", &*fault.detail), ("\n", found.help().unwrap_or_default())] {
        if !more.is_empty() {
            message += sign;
            message += more;
        }
    }
    let code = fault.message.name().to_owned();
    if found.program == 0 {
        return Fault {
            range: place_of(program, fault),
            severity,
            code,
            message,
            related: Vec::new(),
        };
    }
    let other = all.programs.get(found.program);
    let name = other.map_or("", |other| short_name(other));
    let block = other.map_or(fault.block, |other| other.number_of(fault.block));
    let column = fault.column.saturating_sub(1);
    let related = Related {
        path: other.map(|other| PathBuf::from(other.name())),
        place: Place::There {
            line: fault.line.saturating_sub(1),
            characters: column..column.saturating_add(fault.length),
        },
        message: message.clone(),
    };
    Fault {
        range: other.map_or(0..0, |other| call_of(program, other)),
        severity,
        code,
        message: format!("{name}, block {block}: {message}"),
        related: vec![related],
    }
}

/// The bytes that a fault marks.
fn place_of(program: &PartProgram, fault: &Diagnostic) -> Range<usize> {
    let line = (fault.line as usize).saturating_sub(1);
    let end = program.text.text.len();
    let bytes = program.lines.get(line).cloned().unwrap_or(end..end);
    program
        .text
        .characters(bytes, fault.column as usize, fault.length as usize)
}

/// The first block that calls a program, else the first of all: another program may have called it.
fn call_of(program: &PartProgram, called: &Arc<Program>) -> Range<usize> {
    let stem = |name: &str| Path::new(name).file_stem().map(|stem| stem.to_ascii_lowercase());
    let wanted = stem(called.name());
    let calls = |operation: &Operation| match operation {
        Operation::CallProgram(name) => stem(name) == wanted,
        Operation::Cycle(cycle) => cycle.words.iter().any(|word| match word {
            CycleWord::Text(name) => (cycle.number, cycle.sub) == PROGRAM_CYCLE && stem(name) == wanted,
            _ => false,
        }),
        _ => false,
    };
    let found = program
        .each()
        .find(|block| block.operation.parts().iter().any(calls));
    let place = found.map(|block| block.place.bytes.clone());
    place
        .or_else(|| program.blocks.first().map(|first| first.bytes.clone()))
        .unwrap_or_default()
}

fn short_name(program: &Program) -> &str {
    let name = program.name();
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}
