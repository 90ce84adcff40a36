//! What is wrong with a file: in its text, and what its execution comes to without a channel.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_path::{Axis, Position};

use crate::decoder::{BlockFault, Decoder, Step};
use crate::program::{Fault, Program};
use crate::unit::{Shelf, Variable, Variables};

/// Most blocks that are executed: without jumps no program is endless, but subroutines that call each other
/// many times are long.
const MAX_BLOCKS: u32 = 10_000_000;

/// What was found in a file and in those that it calls.
#[derive(Clone, Debug)]
pub struct Examination {
    /// The faults, those of the file itself first, each by their lines.
    pub found: Vec<FileFault>,
    /// All programs of the file were executed to their ends.
    pub complete: bool,
}

/// A fault in one of the files.
#[derive(Clone, Debug)]
pub struct FileFault {
    /// The file.
    pub program: Arc<Program>,
    /// What, and where.
    pub fault: Fault,
}

/// Reads every block, and executes the programs of the file in turn, until `interrupt` is set.
pub fn examine(program: &Arc<Program>, shelf: &Arc<dyn Shelf>, interrupt: &AtomicBool) -> Examination {
    let mut found = faults(program);
    let mut complete = true;
    let mut position = Position::UNKNOWN;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        position[axis] = 0.0;
    }
    let mut called: Vec<Arc<Program>> = Vec::new();
    for section in program.mains() {
        let mut decoder = Decoder::new(Arc::clone(program), section, position, Arc::clone(shelf));
        let fault = execute(&mut decoder, interrupt, &mut complete);
        position = decoder.position();
        for file in decoder.files() {
            if called.iter().all(|known| known.name() != file.name()) {
                found.extend(faults(file));
                called.push(Arc::clone(file));
            }
        }
        let Some(fault) = fault else { continue };
        complete = false;
        let mut files = called.iter().chain([program]);
        let Some(file) = files.find(|file| *file.name() == fault.place.program) else {
            continue;
        };
        let is_known =
            |known: &FileFault| known.program.name() == file.name() && known.fault.line == fault.place.line;
        if !fault.message.is_empty() && !found.iter().any(is_known) {
            found.push(FileFault {
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
    Examination { found, complete }
}

fn faults(program: &Arc<Program>) -> Vec<FileFault> {
    let of_program = |fault| FileFault {
        program: Arc::clone(program),
        fault,
    };
    program.faults().into_iter().map(of_program).collect()
}

/// Executes a program. A fault that may follow from a value that nobody knows here has no message.
fn execute(decoder: &mut Decoder, interrupt: &AtomicBool, complete: &mut bool) -> Option<BlockFault> {
    let mut variables = Rehearsed::default();
    for block in 0..MAX_BLOCKS {
        if block % 1024 == 0 && interrupt.load(Ordering::Relaxed) {
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
    *complete = false;
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
