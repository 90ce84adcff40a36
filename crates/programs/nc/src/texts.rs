//! The programs of a run as text: where a block stands in them.
//!
//! Decision: A block of a `.nc` program is called by its number N, the first one of a program where several have it,
//! one without by its place among the lines that are not empty: that is what stands in the file and on the screen.
//! Subroutines number their blocks themselves (also `program/src/din.rs`)

use std::sync::Arc;

use bahn_din::Place;
use bahn_parameters::MessageId;
use bahn_path::BlockRef;
use bahn_program::Program;
use bahn_reader::{Cause, Message, ProgramError};

use crate::functions::Refusal;

/// What to do about a text that is wrong.
const CORRECT: &str = "Correct the block; `bahn check` tells all that is wrong in the file.";

/// The main program and the files whose subroutines were called, in the order of their calls.
#[derive(Clone)]
pub(crate) struct Texts(Vec<Arc<Program>>);

impl Texts {
    pub fn new(name: &str, bytes: &[u8]) -> Texts {
        Texts(vec![Arc::new(Program::of_din(name, bytes.to_vec()))])
    }

    pub fn get(&self, index: u16) -> Option<&Arc<Program>> {
        self.0.get(usize::from(index))
    }

    /// Takes the files in that are called for the first time.
    pub fn take<'a>(&mut self, files: impl Iterator<Item = &'a Arc<bahn_din::Program>>) {
        for file in files {
            if self.0.iter().any(|known| *known.name() == **file.name()) {
                continue;
            }
            let lines: Vec<&str> = (1..=file.line_count()).map(|line| file.line(line)).collect();
            let bytes = file.encoded(&lines.join("\n"));
            self.0.push(Arc::new(Program::of_din(&**file.name(), bytes)));
        }
    }

    /// Where a block stands: each line that is not empty is one, from 1.
    pub fn block(&self, place: &Place) -> BlockRef {
        let is_it = |program: &Arc<Program>| *program.name() == *place.program;
        let index = self.0.iter().position(is_it).unwrap_or_default();
        let block = self
            .0
            .get(index)
            .map_or(0, |program| of_line(program, place.line));
        BlockRef {
            program: u16::try_from(index).unwrap_or(u16::MAX),
            block,
        }
    }

    /// A refusal with the block that causes it.
    pub fn failure(&self, refusal: Refusal, block: BlockRef) -> Box<ProgramError> {
        let program = self.get(block.program);
        Box::new(ProgramError {
            message: Message::Control(refusal.message),
            program: program.map_or_else(String::new, |program| program.name().to_owned()),
            block,
            detail: refusal.detail,
            cause: match refusal.message {
                // The remedy of the message speaks of the cassette unit.
                MessageId::WrongProgramData => Cause::Written(CORRECT),
                _ => Cause::default(),
            },
        })
    }

    /// The line of a block of the main program.
    pub fn line(&self, block: u32) -> u32 {
        self.0.first().map_or(1, |program| program.line_of(block))
    }
}

/// The block that stands in a line. Block 0 is the begin that these programs do not write, and one more stands for their
/// end, on the last line.
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
