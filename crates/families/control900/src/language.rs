//! Part programs of a System 900 as its control feeds from them.

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::{BlockRef, Position};
use bahn_reader::Reader;
use bahn_system900::Memory;
use bahn_text::Files;

/// What reads a program: of its name, its bytes, its channel from 1 on, and the files beside it.
pub type Open = fn(&str, &[u8], u8, Arc<dyn Files>) -> Box<dyn Reader>;

/// A language of programs that read and write parameters: while a program is read it has all of them, and gives them back.
#[derive(Clone, Copy, Debug)]
pub struct Language {
    /// Reads a program.
    pub open: Open,
    /// Gives a program the parameters; they come back when it is of another language.
    pub give: fn(&mut dyn Reader, Memory) -> Option<Memory>,
    /// Takes them back; `None` when it has none.
    pub take: fn(&mut dyn Reader) -> Option<Memory>,
    /// A program goes back before the block of a place in the order of execution, and on at a block of the same program, from
    /// where the axes stand.
    pub branch: fn(&mut dyn Reader, u64, u32, &Position),
    /// Shows what is in force in the block of a place in the order of execution.
    pub show: fn(&dyn Reader, u64, &mut Memory),
    /// A program starts at the block of this number, 0 for its first one.
    pub start: fn(&mut dyn Reader, u32),
    /// The number of a block as programs write it.
    pub number: fn(&dyn Reader, BlockRef) -> u32,
}

/// The language of `P1000.900`: its programs have the parameters while they are read.
pub fn language() -> Language {
    Language {
        open: |name, bytes, channel, beside| {
            Box::new(Reader900::new(name, bytes, channel, Position::ZERO, beside))
        },
        give: |reader, memory| match Reader900::of_mut(reader) {
            Some(reader) => {
                reader.note_write();
                reader.give_memory(memory);
                None
            }
            None => Some(memory),
        },
        take: |reader| Reader900::of_mut(reader)?.take_memory().map(|memory| *memory),
        branch: |reader, sequence, target, position| match Reader900::of_mut(reader) {
            Some(reader) => reader.branch(sequence, target, position),
            None => reader.goto(target),
        },
        show: |reader, sequence, memory| {
            if let Some(reader) = Reader900::of(reader) {
                reader.show_executed(sequence, memory);
            }
        },
        start: |reader, number| match Reader900::of_mut(reader) {
            Some(reader) => reader.start_at(number),
            None if number > 0 => reader.goto(number),
            None => {}
        },
        number: |reader, block| Reader900::of(reader).map_or(block.block, |reader| reader.number_of(block)),
    }
}
