//! The program and the cycles that it has called, as texts: where a block stands in them.

use std::sync::Arc;

use bahn_din::system900;
use bahn_path::BlockRef;
use bahn_program::Program;
use bahn_reader::{Cause, Message, ProgramError};
use bahn_text::Files;

use crate::refusal::Refusal;

/// What to do about a block that is refused.
const CORRECT: &str = "Correct the block; `bahn check` tells all that is wrong in the text.";

/// The main program and the cycles, in the order of their first calls.
#[derive(Clone)]
pub(crate) struct Texts {
    files: Arc<dyn Files>,
    all: Vec<Text>,
}

/// One file, as blocks and as what is shown of it.
#[derive(Clone)]
struct Text {
    program: Arc<system900::Program>,
    shown: Arc<Program>,
}

impl Text {
    fn new(name: &str, bytes: &[u8]) -> Text {
        Text {
            program: Arc::new(system900::Program::from_bytes(name, bytes)),
            shown: Arc::new(Program::from_bytes(name, bytes.to_vec())),
        }
    }
}

impl Texts {
    pub fn new(name: &str, bytes: &[u8], files: Arc<dyn Files>) -> Texts {
        Texts {
            files,
            all: vec![Text::new(name, bytes)],
        }
    }

    /// What is shown of a file.
    pub fn shown(&self, index: u16) -> Option<&Arc<Program>> {
        self.all.get(usize::from(index)).map(|text| &text.shown)
    }

    /// The blocks of a file.
    pub fn program(&self, index: u16) -> Option<&Arc<system900::Program>> {
        self.all.get(usize::from(index)).map(|text| &text.program)
    }

    /// The cycle of a number, which is read when it is called first; `None` when there is none.
    pub fn cycle(&mut self, number: u16) -> Option<u16> {
        let name = format!("Z{number}.900");
        let is_it = |text: &Text| **text.program.name() == *name;
        let place = match self.all.iter().position(is_it) {
            Some(place) => place,
            None => {
                let file = self.files.read(&name)?;
                self.all.push(Text::new(&name, &file.bytes));
                self.all.len() - 1
            }
        };
        u16::try_from(place).ok()
    }

    /// The block that stands in a line of a file.
    pub fn block(&self, program: u16, line: u32) -> BlockRef {
        let block = self.shown(program).map_or(0, |shown| of_line(shown, line));
        BlockRef { program, block }
    }

    /// The line of a block of a file.
    pub fn line(&self, at: BlockRef) -> u32 {
        self.shown(at.program).map_or(1, |shown| shown.line_of(at.block))
    }

    /// A refusal with the block that causes it.
    pub fn failure(&self, refusal: Refusal, block: BlockRef) -> Box<ProgramError> {
        let name = self.shown(block.program).map(|shown| shown.name().to_owned());
        let (message, detail) = match refusal.number {
            Some(number) => (format!("M{number}"), refusal.detail),
            None => (refusal.detail, String::new()),
        };
        Box::new(ProgramError {
            message: Message::Numbered(message),
            program: name.unwrap_or_default(),
            block,
            detail,
            cause: Cause::Written(CORRECT),
        })
    }
}

/// The block that stands in a line. Block 0 is the begin that these programs do not write.
fn of_line(program: &Program, line: u32) -> u32 {
    let (mut from, mut to) = (1, program.block_count());
    while from < to {
        let middle = from + (to - from) / 2;
        match program.line_of(middle) < line {
            true => from = middle + 1,
            false => to = middle,
        }
    }
    from
}
