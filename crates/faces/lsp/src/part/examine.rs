//! What is wrong with a program, as `bahn check` finds it, and the Q parameters at the end of a run.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_interpreter::{Complete, Examination, Found, Settings};
use bahn_program::{CycleWord, Operation, Program};
use bahn_text::{Diagnostic, Span};

use super::{PROGRAM_CYCLE, PartProgram};
use crate::language::{Examined, led_to};
use crate::world::World;
use bahn_reader::Shelf;

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
    let library = Arc::new(Shelf::with_main(world.clone(), &program.program));
    let found = bahn_interpreter::examine(program.program.clone(), settings, library, interrupt);
    let faults = found
        .found
        .iter()
        .filter_map(|fault| located(program, &found, fault));
    Examined {
        faults: faults.collect(),
        not_listed: found.more.errors + found.more.warnings,
        complete: found.complete == Complete::Yes,
        values: found.q_values,
        ..Examined::default()
    }
}

/// A fault of this program at its place, one of another program at the call that leads there.
fn located(program: &PartProgram, all: &Examination, found: &Found) -> Option<Diagnostic> {
    let other = all.programs.get(found.program)?;
    let fault = found.diagnostic(other, program.model, Path::new(other.name()));
    Some(match found.program {
        0 => Diagnostic {
            span: program.text.span(&place_of(program, fault.span)),
            ..fault
        },
        _ => led_to(fault, program.text.span(&call_of(program, other))),
    })
}

/// The bytes that a fault marks.
fn place_of(program: &PartProgram, span: Span) -> Range<usize> {
    let line = (span.line as usize).saturating_sub(1);
    let end = program.text.text.len();
    let bytes = program.lines.get(line).cloned().unwrap_or(end..end);
    program
        .text
        .characters(bytes, span.column as usize, span.length as usize)
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
