//! What is wrong with a file and with the cycles that it calls.
//!
//! Decision: A cycle `Zn` is the file `Zn.900` beside the program. G69 and G71 to G75 need theirs; those of the drilling
//! functions, of tool changes and of M functions above 30 are read where they lie beside the program, since only the
//! machine knows whether it calls them

use std::sync::Arc;

use bahn_text::{Files, Severity, Span};

use super::block::WordKind;
use super::program::Program;
use super::table::{self, Part};
use crate::line::fault_at;
use crate::program::{Fault, MAX_FAULTS};

/// A fault in one of the files.
#[derive(Clone, Debug)]
pub struct Found {
    /// The file.
    pub program: Arc<Program>,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, with line and column.
    pub fault: Fault,
}

/// Most cycles of a program (inferred).
const MAX_CYCLES: usize = 256;

/// M functions up to this number call no cycle [002:5499-5501].
const NO_CYCLE: u16 = 30;

/// Reads every block of a program and of the cycles that it calls; the faults of the program come first.
pub fn examine(program: &Arc<Program>, beside: &dyn Files) -> Vec<Found> {
    let mut files = vec![Arc::clone(program)];
    let mut asked: Vec<u16> = Vec::new();
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(file) = files.get(at).map(Arc::clone) {
        at += 1;
        let findings = file.findings();
        let mut faults = findings.faults;
        let mut missing = Vec::new();
        for call in calls(&file) {
            if !asked.contains(&call.cycle) && asked.len() < MAX_CYCLES {
                asked.push(call.cycle);
                files.extend(cycle(beside, call.cycle).map(Arc::new));
            }
            let name = file_name(call.cycle);
            let is_there = files.iter().any(|file| **file.name() == *name);
            if call.is_needed && !is_there {
                missing.push(call.missing(&file, &name));
            }
        }
        faults.append(&mut missing);
        faults.sort_by_key(|fault| fault.span);
        let of_file = |severity: Severity, fault: Fault| Found {
            program: Arc::clone(&file),
            severity,
            fault,
        };
        let mut own: Vec<Found> = faults
            .into_iter()
            .map(|fault| of_file(Severity::Error, fault))
            .collect();
        own.extend(
            findings
                .warnings
                .into_iter()
                .map(|fault| of_file(Severity::Warning, fault)),
        );
        own.sort_by_key(|found| found.fault.span);
        found.append(&mut own);
    }
    found
}

/// A word that may call a cycle.
struct Call {
    cycle: u16,
    /// Whether nothing else does what the word orders.
    is_needed: bool,
    span: Span,
}

impl Call {
    fn missing(&self, file: &Program, name: &str) -> Fault {
        let message = format!(
            "G{} calls the cycle {name}, which does not lie beside the program",
            self.cycle
        );
        file.fault(
            self.span.line,
            fault_at(self.span.column, self.span.length, message),
        )
    }
}

/// The cycles that a file calls [002:5493-5501] [002:1731-1735], a row for each word of those that it needs, once of others.
fn calls(file: &Program) -> Vec<Call> {
    let mut calls: Vec<Call> = Vec::new();
    let lines = (1..=file.line_count()).flat_map(|line| file.words_read(line));
    for word in lines {
        let (cycle, is_needed) = match word.kind {
            WordKind::G(number) => match table::g_function(number).map(|row| row.part) {
                Some(Part::MakerCycle) => (number, true),
                _ if (81..=89).contains(&number) => (number, false),
                _ => continue,
            },
            WordKind::M(function) if function.number > NO_CYCLE || function.number == 6 => {
                (function.number, false)
            }
            _ => continue,
        };
        if is_needed || !calls.iter().any(|call| call.cycle == cycle) {
            calls.push(Call {
                cycle,
                is_needed,
                span: word.span,
            });
        }
        if calls.len() >= MAX_FAULTS {
            break;
        }
    }
    calls
}

/// The file name of a cycle.
fn file_name(cycle: u16) -> String {
    format!("Z{cycle}.900")
}

fn cycle(beside: &dyn Files, cycle: u16) -> Option<Program> {
    let file = beside.read(&file_name(cycle))?;
    Some(Program::from_bytes(&file_name(cycle), &file.bytes))
}
