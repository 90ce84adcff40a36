//! `bahn check` of a DIN 66025 program: what is wrong in its text, and what its execution comes to.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_din::{Decoder, Fault, Program, Shelf, Step, Variable, Variables};
use bahn_path::{Axis, Position};

use super::{CheckReport, Complete, Entry, summary};
use crate::UsageError;
use crate::diagnostics::{self, FileFault, Marked};
use crate::files;
use crate::interrupt::Interrupt;
use crate::options::Format;

/// Most blocks that are executed: without jumps no program is endless, but subroutines that call each other
/// many times are long.
const MAX_BLOCKS: u32 = 10_000_000;

/// A fault in one of the files.
struct Found {
    program: Arc<Program>,
    fault: Fault,
}

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
        false => examine(&program, path, interrupt),
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

/// Reads every block, and executes the programs of the file in turn.
fn examine(program: &Arc<Program>, path: &Path, interrupt: &Interrupt) -> (Vec<Found>, Complete) {
    let mut found = faults(program);
    let mut complete = Complete::Yes;
    let shelf: Arc<dyn Shelf> = Arc::new(NcFolder::of(path));
    let mut position = Position::UNKNOWN;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        position[axis] = 0.0;
    }
    let mut called: Vec<Arc<Program>> = Vec::new();
    for section in program.mains() {
        let mut decoder = Decoder::new(Arc::clone(program), section, position, Arc::clone(&shelf));
        let fault = execute(&mut decoder, interrupt, &mut complete);
        position = decoder.position();
        for file in decoder.files() {
            if called.iter().all(|known| known.name() != file.name()) {
                found.extend(faults(file));
                called.push(Arc::clone(file));
            }
        }
        let Some(fault) = fault else { continue };
        complete = Complete::No;
        let mut files = called.iter().chain([program]);
        let Some(file) = files.find(|file| *file.name() == fault.place.program) else {
            continue;
        };
        let is_known =
            |known: &Found| known.program.name() == file.name() && known.fault.line == fault.place.line;
        if !fault.message.is_empty() && !found.iter().any(is_known) {
            found.push(Found {
                program: Arc::clone(file),
                fault: Fault {
                    line: fault.place.line,
                    column: fault.column,
                    length: fault.length,
                    block: fault.place.block,
                    message: fault.message,
                },
            });
        }
    }
    found.sort_by_key(|found| (found.program.name() != program.name(), found.fault.line));
    (found, complete)
}

fn faults(program: &Arc<Program>) -> Vec<Found> {
    let of_program = |fault| Found {
        program: Arc::clone(program),
        fault,
    };
    program.faults().into_iter().map(of_program).collect()
}

/// Executes a program. A fault that may follow from a value that nobody knows here has no message.
fn execute(
    decoder: &mut Decoder,
    interrupt: &Interrupt,
    complete: &mut Complete,
) -> Option<bahn_din::BlockFault> {
    let mut variables = Rehearsed::default();
    for block in 0..MAX_BLOCKS {
        if block % 1024 == 0 && interrupt.is_requested() {
            break;
        }
        match decoder.next(&mut variables) {
            Step::Unit(_) => {}
            Step::End => return None,
            Step::Fault(mut fault) => {
                if variables.is_unsure.get() {
                    fault.message.clear();
                }
                return Some(fault);
            }
        }
    }
    *complete = Complete::No;
    None
}

/// Variables of a channel that is not there: what was written is known, the rest is 0.
#[derive(Default)]
struct Rehearsed {
    values: HashMap<Variable, f64>,
    /// What was read is not known.
    is_unsure: Cell<bool>,
}

impl Variables for Rehearsed {
    fn read(&mut self, variable: &Variable) -> Result<f64, String> {
        let value = self.values.get(variable).copied();
        self.is_unsure.set(self.is_unsure.get() || value.is_none());
        Ok(value.unwrap_or_default())
    }

    fn write(&mut self, variable: &Variable, value: f64) -> Result<(), String> {
        self.values.insert(variable.clone(), value);
        Ok(())
    }

    fn exists(&self, _m: bool, _number: u16) -> bool {
        self.is_unsure.set(true);
        true
    }
}

/// Subroutines that lie beside a program, or in folders below.
pub(crate) struct NcFolder(PathBuf);

impl NcFolder {
    /// The folder of a program.
    pub(crate) fn of(program: &Path) -> NcFolder {
        NcFolder(program.parent().unwrap_or(Path::new("")).to_owned())
    }
}

impl Shelf for NcFolder {
    fn text(&self, name: &str) -> Option<(String, Vec<u8>)> {
        let relative = name.replace('\\', "/");
        let inside = relative
            .split('/')
            .all(|part| !part.is_empty() && part != ".." && !part.contains(':'));
        let path = self.0.join(&relative);
        if !inside || !path.is_file() {
            return None;
        }
        let bytes = files::read_program(&path).ok()??;
        Some((relative, bytes))
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
        help: String::new(),
    }
}

/// The number of a block, without one its line.
fn number(fault: &Fault) -> u32 {
    let digits = fault.block.trim_start_matches(['N', '#']);
    digits.parse().unwrap_or(fault.line)
}

fn print(found: &Found, main: &Program, path: &Path) {
    let fault = &found.fault;
    diagnostics::print_fault(&FileFault {
        severity: diagnostics::Severity::Error,
        title: fault.message.clone(),
        path: match found.program.name() == main.name() {
            true => path.to_owned(),
            // Called programs lie beside their caller.
            false => path.with_file_name(&**found.program.name()),
        },
        marked: Marked {
            line: fault.line,
            text: found.program.line(fault.line).to_owned(),
            columns: Some((fault.column, fault.length)),
        },
        label: format!("block {}", fault.block),
        help: None,
        opened: None,
    });
}
