//! What is wrong with a file: in its text, and what its execution comes to without a channel.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_path::{Axis, Position};
use bahn_text::Files;

use crate::decoder::{BlockFault, Decoder, MAX_FILES, Step, called_file};
use crate::program::{Fault, Program};
use crate::unit::{FunctionLetter, Variable, Variables};

/// Most blocks that are executed: without jumps no program is endless, but subroutines that call each other
/// many times are long.
const MAX_BLOCKS: u32 = 10_000_000;

/// What variables that nobody knows here are, in one run and in another one: what both come to is known.
const GUESSES: [f64; 2] = [0.0, 1234.567];

/// What was found in a file and in those that it calls.
#[derive(Clone, Debug)]
pub struct Examination {
    /// The faults, those of the file itself first, each by their lines.
    pub found: Vec<Found>,
    /// All programs of the file were executed to their ends.
    pub complete: bool,
    /// P parameters and variables that the programs gave values, by their names (`P10`, `V.G.M_FCT[5].SYNCH`), with the
    /// last one; `None` where it follows from what only a channel knows.
    pub values: BTreeMap<String, Option<f64>>,
}

/// A fault in one of the files.
#[derive(Clone, Debug)]
pub struct Found {
    /// The file.
    pub program: Arc<Program>,
    /// What is wrong, with line and column.
    pub fault: Fault,
}

/// Reads every block of a file and of those that it calls, and executes the programs of the file in turn, until
/// `interrupt` is set.
pub fn examine(program: &Arc<Program>, beside: &Arc<dyn Files>, interrupt: &AtomicBool) -> Examination {
    let [guess, other] = GUESSES;
    let run = Run::of(program, beside, interrupt, guess);
    let mut files = vec![Arc::clone(program)];
    for file in run.called {
        if files.iter().all(|known| known.name() != file.name()) {
            files.push(file);
        }
    }
    let mut found = read(&mut files, beside.as_ref());
    for (name, fault) in run.faults {
        let Some(file) = files.iter().find(|file| *file.name() == name) else {
            continue;
        };
        let is_known =
            |known: &Found| known.program.name() == file.name() && known.fault.span.line == fault.span.line;
        if !found.iter().any(is_known) {
            found.push(Found {
                program: Arc::clone(file),
                fault,
            });
        }
    }
    found.sort_by_key(|found| {
        let name = found.program.name();
        (name != program.name(), Arc::clone(name), found.fault.span)
    });
    let values = run.values.into_iter();
    let values = match run.is_unsure {
        false => values.map(|(name, value)| (name, Some(value))).collect(),
        true => {
            let otherwise = Run::of(program, beside, interrupt, other).values;
            let known = |name: &str, value| otherwise.get(name) == Some(&value);
            values
                .map(|(name, value)| {
                    let value = known(&name, value).then_some(value);
                    (name, value)
                })
                .collect()
        }
    };
    Examination {
        found,
        complete: run.complete,
        values,
    }
}

/// Reads files and all that their calls lead to, also after a fault; those that are found are put to the `files`.
fn read(files: &mut Vec<Arc<Program>>, beside: &dyn Files) -> Vec<Found> {
    let mut found = Vec::new();
    let mut macros = BTreeSet::new();
    let mut unknown_macros = Vec::new();
    let mut asked: BTreeMap<String, bool> = BTreeMap::new();
    let mut at = 0;
    while let Some(file) = files.get(at).map(Arc::clone) {
        let mut judged = file.judged();
        macros.append(&mut judged.macros);
        let of_file = |fault| Found {
            program: Arc::clone(&file),
            fault,
        };
        for call in judged.calls {
            if file.subroutine(&call.name).is_some() {
                continue;
            }
            let there = !call.local
                && *asked
                    .entry(call.name)
                    .or_insert_with_key(|name| add(files, beside, name));
            if !there {
                judged.faults.push(call.fault);
            }
        }
        found.extend(judged.faults.into_iter().map(of_file));
        let unknown = judged.unknown_macros.into_iter();
        unknown_macros.extend(unknown.map(|(name, fault)| (name, of_file(fault))));
        at += 1;
    }
    // One that is defined anywhere may be so at its time.
    let unknown = unknown_macros
        .into_iter()
        .filter(|(name, _)| !macros.contains(name));
    found.extend(unknown.map(|(_, fault)| fault));
    found
}

/// Puts the file that a call names to the others; false if there is none.
fn add(files: &mut Vec<Arc<Program>>, beside: &dyn Files, name: &str) -> bool {
    if files.len() > MAX_FILES {
        return true;
    }
    let Some(file) = called_file(beside, name) else {
        return false;
    };
    if files.iter().all(|known| known.name() != file.name()) {
        files.push(Arc::new(file));
    }
    true
}

/// What executing the programs of a file comes to.
#[derive(Default)]
struct Run {
    /// The faults with the files where they stand.
    faults: Vec<(Arc<str>, Fault)>,
    called: Vec<Arc<Program>>,
    values: BTreeMap<String, f64>,
    is_unsure: bool,
    complete: bool,
}

impl Run {
    /// Executes the programs with a value for each variable that is not known.
    fn of(program: &Arc<Program>, beside: &Arc<dyn Files>, interrupt: &AtomicBool, guess: f64) -> Run {
        let mut run = Run {
            complete: true,
            ..Run::default()
        };
        let mut position = Position::UNKNOWN;
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            position[axis] = 0.0;
        }
        for section in program.mains() {
            let mut decoder = Decoder::new(Arc::clone(program), section, position, Arc::clone(beside));
            let mut variables = Rehearsed::new(guess);
            let fault = execute(&mut decoder, &mut variables, interrupt, &mut run.complete);
            position = decoder.position();
            run.is_unsure |= variables.is_unsure.get();
            run.values.extend(
                decoder
                    .parameters()
                    .map(|(number, value)| (format!("P{number}"), value)),
            );
            run.called.extend(decoder.files().map(Arc::clone));
            let written = variables.values.iter();
            run.values
                .extend(written.map(|(variable, value)| (variable.to_string(), *value)));
            let Some(fault) = fault else { continue };
            run.complete = false;
            // A fault that may follow from a value that nobody knows here is none.
            if !variables.is_unsure.get() {
                let own = Fault {
                    span: fault.span(),
                    block: fault.place.block,
                    message: fault.message,
                };
                run.faults.push((fault.place.program, own));
            }
        }
        run
    }
}

/// Executes a program up to its first fault.
fn execute(
    decoder: &mut Decoder,
    variables: &mut Rehearsed,
    interrupt: &AtomicBool,
    complete: &mut bool,
) -> Option<BlockFault> {
    for block in 0..MAX_BLOCKS {
        if block % 1024 == 0 && interrupt.load(Ordering::Relaxed) {
            break;
        }
        match decoder.next(variables) {
            Step::Unit(_) => {}
            Step::End => return None,
            Step::Fault(fault) => return Some(fault),
        }
    }
    *complete = false;
    None
}

/// Variables of a channel that is not there: what was written is known, the rest is guessed.
struct Rehearsed {
    values: HashMap<Variable, f64>,
    guess: f64,
    /// What was read is not known.
    is_unsure: Cell<bool>,
}

impl Rehearsed {
    fn new(guess: f64) -> Rehearsed {
        Rehearsed {
            values: HashMap::new(),
            guess,
            is_unsure: Cell::new(false),
        }
    }
}

impl Variables for Rehearsed {
    fn read(&mut self, variable: &Variable) -> Result<f64, String> {
        let value = self.values.get(variable).copied();
        self.is_unsure.set(self.is_unsure.get() || value.is_none());
        Ok(value.unwrap_or(self.guess))
    }

    fn write(&mut self, variable: &Variable, value: f64) -> Result<(), String> {
        self.values.insert(variable.clone(), value);
        Ok(())
    }

    fn exists(&self, _letter: FunctionLetter, _number: u16) -> bool {
        self.is_unsure.set(true);
        self.guess == 0.0
    }
}
