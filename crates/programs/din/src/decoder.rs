//! Executes programs, block by block.
//!
//! Decision: `L name` in a `.nc` program is a subroutine of the same file, else the file of this name, with `.nc` or
//! with `.sub` beside the program; `LL name` one of the same file
//!
//! Decision: Before a V.E. variable is read the block is handed on as a flush that waits, then again with what it
//! orders; every V.E. variable counts as synchronous
//!
//! Decision: A search for a block looks in the program itself, not in its subroutines; what is written into variables
//! before it counts, what is moved and switched does not happen

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_path::Position;
use bahn_text::{Files, Span};

use crate::block::{self, Block, WordKind};
use crate::execute::{self, State};
use crate::line::LineFault;
use crate::program::{Program, Section, not_found};
use crate::unit::{Command, Place, Unit, Variables};

/// What the next block is.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A block that is executed.
    Unit(Box<Unit>),
    /// A block that cannot be executed. Nothing comes behind it.
    Fault(BlockFault),
    /// Nothing is left to execute.
    End,
}

/// Why a block cannot be executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockFault {
    /// Place of the block.
    pub place: Place,
    /// Column of what is wrong, from 1.
    pub column: u32,
    /// How many characters it covers.
    pub length: u32,
    /// What is wrong, with the name of what is not known.
    pub message: String,
}

impl BlockFault {
    /// Where it stands in the file.
    pub fn span(&self) -> Span {
        Span {
            line: self.place.line,
            column: self.column,
            length: self.length,
        }
    }
}

/// Subroutines in subroutines end here (inferred).
const MAX_CALLS: usize = 20;

/// Most files with subroutines of a program (inferred).
pub(crate) const MAX_FILES: usize = 256;

/// Endings that the name of a file may lack in a call (inferred).
const ENDINGS: [&str; 3] = ["", ".nc", ".sub"];

/// Executes a program of a file.
#[derive(Clone)]
pub struct Decoder {
    beside: Arc<dyn Files>,
    /// The program from its beginning.
    main: Frame,
    /// Subroutines that were called from other files, by the name in the call.
    files: BTreeMap<String, Arc<Program>>,
    stack: Vec<Frame>,
    state: State,
    /// The block that comes next waits for everything before it; so much is said already.
    has_waited: bool,
    is_over: bool,
}

/// A program or subroutine under way.
#[derive(Clone, Debug)]
struct Frame {
    program: Arc<Program>,
    /// The line that comes next, and the one behind the last.
    line: u32,
    end: u32,
}

impl Decoder {
    /// Begins a program of a file. The path stands at `start`; an axis without a position there stands at 0 when it is
    /// programmed first (inferred).
    pub fn new(program: Arc<Program>, main: &Section, start: Position, beside: Arc<dyn Files>) -> Decoder {
        let frame = Frame::of(program, main);
        Decoder {
            beside,
            main: frame.clone(),
            files: BTreeMap::new(),
            stack: vec![frame],
            state: State::at(start),
            has_waited: false,
            is_over: false,
        }
    }

    /// Where the path stands after the blocks that were executed.
    pub fn position(&self) -> Position {
        self.state.position
    }

    /// The P parameters that have a value.
    pub fn parameters(&self) -> impl Iterator<Item = (u32, f64)> {
        self.state
            .parameters
            .iter()
            .map(|(number, value)| (*number, *value))
    }

    /// The files whose subroutines were called.
    pub fn files(&self) -> impl Iterator<Item = &Arc<Program>> {
        self.files.values()
    }

    /// Executes the next block that orders anything.
    pub fn next(&mut self, variables: &mut dyn Variables) -> Step {
        while !self.is_over {
            self.settle();
            let Some(frame) = self.stack.last() else { break };
            if frame.line >= frame.end {
                self.is_over = true;
                return Step::Unit(Box::new(frame.last_unit()));
            }
            let place = frame.place();
            match self.line(place.clone(), variables) {
                Ok(Some(unit)) => return Step::Unit(Box::new(unit)),
                Ok(None) => {}
                Err(fault) => {
                    self.is_over = true;
                    return Step::Fault(BlockFault {
                        place,
                        column: fault.column,
                        length: fault.length,
                        message: fault.message,
                    });
                }
            }
        }
        self.is_over = true;
        Step::End
    }

    /// Whether a block of this name, `N50` or `#12`, stands in the program itself, not only in its subroutines.
    pub fn has(&self, block: &str) -> bool {
        let Frame { program, line, end } = &self.main;
        (*line..*end).any(|line| program.glyphs(line).is_some() && *program.block_name(line) == *block)
    }

    /// Whether the next block is the one of this name, in the program itself if that [has](Decoder::has) it, otherwise in
    /// whatever subroutine is called first.
    pub fn next_is(&mut self, block: &str) -> bool {
        if self.is_over {
            return false;
        }
        self.settle();
        let depth = self.stack.len();
        let is_it = |frame: &Frame| frame.line < frame.end && *frame.program.block_name(frame.line) == *block;
        self.stack.last().is_some_and(is_it) && (depth == 1 || !self.has(block))
    }

    /// Where the block stands that is executed next; the end of the text after the last one.
    pub fn at(&self) -> Place {
        let next = self.stack.iter().rev().find_map(|frame| {
            let line = (frame.line..frame.end).find(|line| frame.program.is_block(*line))?;
            Some(
                Frame {
                    line,
                    ..frame.clone()
                }
                .place(),
            )
        });
        next.unwrap_or_else(|| self.main.last_unit().place)
    }

    /// Goes on at a line of the program itself, or the nearest one of it, out of all subroutines, with everything else as it
    /// is.
    pub fn goto(&mut self, line: u32) {
        let Frame { line: first, end, .. } = self.main;
        let line = line.clamp(first, end);
        self.stack = vec![Frame {
            line,
            ..self.main.clone()
        }];
        (self.has_waited, self.is_over) = (false, false);
    }

    /// Begins another program of the file, where the path is; nothing else is in force.
    pub fn begin_program(&mut self, main: &Section) {
        self.main = Frame::of(Arc::clone(&self.main.program), main);
        self.goto(self.main.line);
        self.files.clear();
        self.state = State {
            increments_from: self.state.increments_from,
            ..State::at(self.state.position)
        };
    }

    /// The path goes on from elsewhere: whoever follows it has moved axes. Incremental coordinates count from there, unless
    /// the path was [left](Decoder::relocate) before.
    pub fn set_position(&mut self, position: Position) {
        self.state.position = position;
    }

    /// The next motion begins elsewhere: the path was left, or the axes were moved. It ends where it would have: incremental
    /// coordinates, and an arc with its centre, count from where it would [begin](crate::Motion::begin).
    pub fn relocate(&mut self, position: Position) {
        self.state.increments_from.get_or_insert(self.state.position);
        self.state.position = position;
    }

    /// Where the program begins.
    pub fn begin(&self) -> Place {
        self.main.place()
    }

    /// Goes on to the next line that is a block, out of subroutines that are at their end.
    fn settle(&mut self) {
        while let Some(frame) = self.stack.last_mut() {
            while frame.line < frame.end && frame.program.glyphs(frame.line).is_none() {
                frame.line += 1;
            }
            if frame.line < frame.end || self.stack.len() <= 1 {
                return;
            }
            self.stack.pop();
        }
    }

    /// Executes a line, if it is a block.
    fn line(&mut self, place: Place, variables: &mut dyn Variables) -> Result<Option<Unit>, LineFault> {
        let Some(frame) = self.stack.last_mut() else {
            return Ok(None);
        };
        let Some(glyphs) = frame.program.glyphs(frame.line) else {
            frame.line += 1;
            return Ok(None);
        };
        let block = block::read(&glyphs, &self.state.macros)?;
        if !self.has_waited && block.words.iter().any(block::Word::reads_external) {
            self.has_waited = true;
            let mut unit = Unit::at(place);
            unit.commands.push(Command::Flush { wait: true });
            return Ok(Some(unit));
        }
        self.has_waited = false;
        frame.line += 1;
        let mut unit = Unit::at(place);
        let done = execute::block(&block, &mut self.state, &mut unit, variables)?;
        self.call(&block)?;
        if done.returns {
            self.stack.pop();
            unit.ends |= self.stack.is_empty();
        }
        if unit.ends {
            self.is_over = true;
        }
        Ok(Some(unit))
    }

    /// Begins a subroutine, after what else stands in its block (inferred).
    fn call(&mut self, block: &Block) -> Result<(), LineFault> {
        for word in &block.words {
            let WordKind::Call { local, name } = &word.kind else {
                continue;
            };
            let frame = self.frame(*local, name);
            let frame = frame.map_err(|message| crate::line::fault_at(word.column, word.length, message))?;
            self.stack.push(frame);
        }
        Ok(())
    }

    /// `LL` calls a subroutine of the same file (public); `L` one of another file [004:114], and one of the same file
    /// where it has this name (inferred).
    fn frame(&mut self, local: bool, name: &str) -> Result<Frame, String> {
        if self.stack.len() > MAX_CALLS {
            return Err(format!(
                "subroutine {name} is called too deep: {MAX_CALLS} in one another at most"
            ));
        }
        let own = self.stack.last().map(|frame| Arc::clone(&frame.program));
        if let Some(program) = own
            && let Some(section) = program.subroutine(name).cloned()
        {
            return Ok(Frame::of(program, &section));
        }
        if local {
            return Err(not_found(name));
        }
        let program = self.file(name)?.ok_or_else(|| not_found(name))?;
        let section = program.mains().next().cloned();
        let section = section.ok_or_else(|| format!("{name} has no program, only subroutines"))?;
        Ok(Frame::of(program, &section))
    }

    fn file(&mut self, name: &str) -> Result<Option<Arc<Program>>, String> {
        if let Some(known) = self.files.get(name) {
            return Ok(Some(Arc::clone(known)));
        }
        let Some(program) = called_file(&*self.beside, name) else {
            return Ok(None);
        };
        if self.files.len() >= MAX_FILES {
            return Err(format!("{name} is more than the {MAX_FILES} files of a program"));
        }
        let program = Arc::new(program);
        self.files.insert(name.to_owned(), Arc::clone(&program));
        Ok(Some(program))
    }
}

/// The file that a call names.
pub(crate) fn called_file(beside: &dyn Files, name: &str) -> Option<Program> {
    let mut found = ENDINGS
        .iter()
        .filter_map(|ending| beside.read(&format!("{name}{ending}")));
    let file = found.next()?;
    Some(Program::from_bytes(&file.name, &file.bytes))
}

impl Frame {
    fn of(program: Arc<Program>, section: &Section) -> Frame {
        Frame {
            program,
            line: section.lines.0,
            end: section.lines.1,
        }
    }

    fn place(&self) -> Place {
        Place {
            program: Arc::clone(self.program.name()),
            block: self.program.block_name(self.line),
            line: self.line,
        }
    }

    /// The end of the text, which ends the program where no M30 does.
    fn last_unit(&self) -> Unit {
        let line = self.end.saturating_sub(1).max(1);
        let mut unit = Unit::at(Frame { line, ..self.clone() }.place());
        unit.ends = true;
        unit
    }
}

impl Unit {
    /// A block that orders nothing yet.
    fn at(place: Place) -> Unit {
        Unit {
            place,
            motion: None,
            functions: Vec::new(),
            commands: Vec::new(),
            dwell_s: 0.0,
            ends: false,
        }
    }
}
