//! A program that is executed while it is transferred: its text comes piece by piece, what is executed is erased
//! [000:16951-16968] [003:1650-1690].
//!
//! Text waits here until the next preparation, which gives the interpreter a longer version of the program and takes from
//! it what nobody needs any more. How much waits is what a peripheral is held back by.
//!
//! Decision: The memory of a transferred program holds the text from the first block on to which the run may go back;
//! MP7228 counts kByte, MP7228.1 = 0 takes all of the model's program memory, 22 bytes for a block. What waits for
//! something that finds no room is PROGRAM MEMORY OVERFLOW (also `parameters/src/settings/interfaces.rs`)

use std::sync::Arc;

use bahn_parameters::interfaces::DripFeedMemory;
use bahn_parameters::{Blockwise, MessageId};
use bahn_program::Program;

/// Text that one command brings at most, bytes.
const TEXT_MAX: usize = 1 << 16;
/// So much text is given to the interpreter at once while it has enough to do, bytes: the blocks at the end of what is
/// known are read again with every version.
const BATCH: usize = 1 << 12;
/// So few known blocks are not enough to do.
const FEW_BLOCKS: u32 = 128;

/// Whether more text comes over the line from which a program is executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DripFeedLine {
    /// More may come.
    Open,
    /// The line is broken: nothing more comes.
    Broken,
    /// Everything has come.
    Complete,
}

/// A program that is executed while it is transferred, as of now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DripFeedState {
    /// Whether more text comes.
    pub line: DripFeedLine,
    /// More text is wanted: its memory is not full, or 256 bytes of a full one are free again [000:16961].
    pub wants_more: bool,
    /// Bytes of text that wait or are still needed.
    pub bytes: u64,
    /// The run waits for text.
    pub starved: bool,
}

/// What has come of a program.
#[derive(Clone, Debug)]
pub struct DripFeed {
    name: String,
    /// As far as it was looked at.
    program: Arc<Program>,
    /// What has come since.
    inbox: Vec<u8>,
    line: DripFeedLine,
    memory: DripFeedMemory,
    numbers: BlockNumbers,
    /// Bytes of the program that are still needed.
    held: u64,
    /// The memory was full, and not enough of it is free again.
    full: bool,
    starved: bool,
    /// It ends before its END PGM, and why that is.
    broken_by: Option<MessageId>,
    /// The interpreter does not know the program as it is now.
    grown: bool,
}

impl DripFeed {
    /// A program of which nothing has come; `path` is what programs that it calls lie beside.
    pub fn new(name: String, path: String, memory: DripFeedMemory, rules: Blockwise) -> DripFeed {
        DripFeed {
            name,
            program: Arc::new(Program::growing(path)),
            inbox: Vec::new(),
            line: DripFeedLine::Open,
            memory,
            numbers: BlockNumbers::new(rules.block_number_max),
            held: 0,
            full: false,
            starved: false,
            broken_by: None,
            grown: false,
        }
    }

    /// Whether a program is what has come.
    pub fn brings(&self, program: &Arc<Program>) -> bool {
        Arc::ptr_eq(&self.program, program)
    }

    /// How far it has come.
    pub fn state(&self) -> DripFeedState {
        DripFeedState {
            line: self.line,
            wants_more: self.line == DripFeedLine::Open && !self.full,
            bytes: self.bytes(),
            starved: self.starved,
        }
    }

    /// A run may begin: it is known what the program is measured in, or the memory is full of what comes before that.
    pub fn is_ready(&mut self) -> bool {
        if self.program.begin().is_none() && !self.inbox.is_empty() {
            self.look_at();
        }
        self.full || !self.program.is_growing() || self.program.known().end > 0
    }

    /// The program for a run from a block on.
    ///
    /// # Errors
    /// Why there is none.
    pub fn open(&self, block: u32) -> Result<Arc<Program>, MessageId> {
        if !self.memory.is_enough() {
            return Err(MessageId::ProgramMemoryOverflow);
        }
        if self.program.known().start > block {
            // It is erased.
            return Err(MessageId::SelectedBlockNotAddressed);
        }
        Ok(Arc::clone(&self.program))
    }

    /// It ends where the transfer was broken off.
    pub fn is_incomplete(&self) -> bool {
        self.line == DripFeedLine::Complete && self.broken_by.is_some()
    }

    /// The line of a program is there again; `false` when it was not broken.
    pub fn reopen(&mut self, name: &str) -> bool {
        let broken = self.line == DripFeedLine::Broken && self.name == name;
        if broken {
            self.line = DripFeedLine::Open;
            self.broken_by = None;
        }
        broken
    }

    /// More text, and what is to be said of it.
    ///
    /// # Errors
    /// It is not wanted now, or too long.
    pub fn take(&mut self, text: &[u8]) -> Result<Option<MessageId>, Refused> {
        if !self.state().wants_more || text.len() > TEXT_MAX {
            return Err(Refused);
        }
        let good = self.numbers.good(text);
        self.inbox.extend_from_slice(text.get(..good).unwrap_or_default());
        self.weigh();
        let said = (good < text.len()).then(|| self.break_off(MessageId::EntryValueIncorrect));
        Ok(said.flatten())
    }

    /// The transfer is broken off; what is to be said of that.
    pub fn break_off(&mut self, message: MessageId) -> Option<MessageId> {
        if self.line != DripFeedLine::Open {
            return None;
        }
        self.line = DripFeedLine::Broken;
        self.broken_by = Some(message);
        self.broken_by
    }

    /// Nothing more comes; what has come is executed to its end. What is to be said of that.
    pub fn end(&mut self) -> Option<MessageId> {
        let said_before = self.broken_by.is_some();
        self.line = DripFeedLine::Complete;
        self.look_at();
        if self.program.end().is_none() && !said_before {
            // A program in another language has no END PGM that could be missing.
            self.broken_by = Some(match self.program.refused() {
                Some(_) => MessageId::BlockNotSupported,
                None => MessageId::ProgramIncomplete,
            });
            return self.broken_by;
        }
        None
    }

    /// The next version of the program, when the interpreter is to know it: it has `read` the blocks up to one, or
    /// `starves`. Blocks before `needed` are erased.
    pub fn grow(&mut self, needed: u32, read: u32, starves: bool) -> Option<Arc<Program>> {
        let hungry = starves || read.saturating_add(FEW_BLOCKS) >= self.program.known().end;
        if !self.inbox.is_empty() && (hungry || self.inbox.len() >= BATCH) {
            self.look_at();
        }
        if self.grown {
            self.program = Arc::new(self.program.forget(needed));
        }
        self.held = self.program.bytes_from(needed);
        self.starved = starves && !self.grown && self.program.is_growing();
        self.weigh();
        std::mem::take(&mut self.grown).then(|| Arc::clone(&self.program))
    }

    /// Starving, it has no room for what would let it go on.
    pub fn is_stuck(&self) -> bool {
        self.starved && self.full && self.line == DripFeedLine::Open
    }

    /// Makes blocks of what has come.
    fn look_at(&mut self) {
        let mut program = self.program.more(&self.inbox);
        self.held += self.inbox.len() as u64;
        self.inbox.clear();
        if self.line == DripFeedLine::Complete {
            program = program.completed();
        }
        self.program = Arc::new(program);
        self.grown = true;
    }

    fn bytes(&self) -> u64 {
        self.held + self.inbox.len() as u64
    }

    /// A full memory takes more when 256 bytes are free again [000:16961].
    fn weigh(&mut self) {
        let max = self.memory.max_bytes;
        let resumes = max.saturating_sub(DripFeedMemory::RESUMES_BYTES);
        self.full = self.bytes() >= if self.full { resumes + 1 } else { max };
    }
}

/// Text is not wanted now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refused;

/// Looks for block numbers that are too high [003:1662].
#[derive(Clone, Debug)]
struct BlockNumbers {
    max: Option<u32>,
    /// The number at the beginning of the line, as far as it has come; `None` after it.
    number: Option<u32>,
}

impl BlockNumbers {
    fn new(max: Option<u32>) -> BlockNumbers {
        BlockNumbers { max, number: Some(0) }
    }

    /// How many bytes of a text come before a number that is too high.
    fn good(&mut self, text: &[u8]) -> usize {
        let Some(max) = self.max else {
            return text.len();
        };
        for (at, byte) in text.iter().enumerate() {
            self.number = match (byte, self.number) {
                (b'\n' | b'\r', _) => Some(0),
                (b'0'..=b'9', Some(number)) => {
                    Some(number.saturating_mul(10).saturating_add(u32::from(byte - b'0')))
                }
                (b' ' | b'N', Some(0)) => Some(0),
                _ => None,
            };
            if self.number.is_some_and(|number| number > max) {
                let line = text
                    .get(..at)
                    .and_then(|text| text.iter().rposition(|byte| *byte == b'\n'));
                return line.map_or(0, |line| line + 1);
            }
        }
        text.len()
    }
}
