//! The trait of what is fed from.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_path::{BlockRef, ElementSource, LiveData, Placement, Position, Step};
use bahn_program::{Program, Unit};

use crate::{MachineRules, ProgramError, Warning};

/// A state before a block, kept to go back to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// Count of executed blocks up to and with that block: the sequence of its elements.
    pub sequence: u64,
    /// The block of this count.
    pub at: BlockRef,
}

/// A program that is read block by block: what a control, a test run and the graphics feed from.
///
/// The sequence of an element counts the executed blocks and names the state before its block. A reader that was told to
/// [keep checkpoints](Reader::keep_checkpoints) goes back to each block whose elements were handed out, until it may
/// [forget](Reader::forget_before) it.
///
/// What one language alone has is no method here. Its reader is found by its type (`&dyn Any`), and whoever asks for it
/// says what is so with other readers.
pub trait Reader: ElementSource<Error = Box<ProgramError>> + Any + Send + Sync {
    /// A copy that goes on by itself.
    fn boxed(&self) -> Box<dyn Reader>;

    /// A program of the run as text, for whoever shows its blocks: 0 is the main program.
    fn program(&self, index: u16) -> Option<&Arc<Program>>;

    /// The block that is executed next.
    fn at(&self) -> BlockRef;

    /// Executed blocks: the sequence of the last one.
    fn blocks_executed(&self) -> u64;

    /// End of the last element that was handed out, workpiece coordinates, mm and degrees.
    fn position(&self) -> Position;

    /// Takes the warnings that came up since the last call.
    fn take_warnings(&mut self) -> Vec<Warning>;

    /// Goes on at a block of the main program, outside of all calls; executed blocks count on. What is in force there says
    /// the language: in a program of a TNC all that is in force now, in one of DIN 66025 nothing but where the path stands,
    /// and a block of a subroutine is refused by the next step.
    fn goto(&mut self, block: u32);

    /// Keeps the state before each block whose elements are on their way.
    fn keep_checkpoints(&mut self);

    /// Forgets the states before blocks that come before the one with a sequence: it is executed.
    fn forget_before(&mut self, sequence: u64);

    /// Goes back to the latest kept state of which something is so, if there is one; the kept states are forgotten.
    fn go_back(&mut self, so: &dyn Fn(Mark) -> bool);

    /// The block to which a run goes back for a sequence.
    fn block_at(&self, sequence: u64) -> BlockRef;

    /// After an error: the run goes on with the block that failed. A reader that [keeps no
    /// checkpoints](Reader::keep_checkpoints) may have no way to: the error comes again.
    fn retry(&mut self);

    /// The axes stand elsewhere than the path has led them, workpiece coordinates: after a stop inside a block, or after
    /// they were moved. What was on its way is dropped; the next block begins there.
    fn relocate(&mut self, position: &Position);

    /// The axes were moved at a barrier: the next block begins where they stand now, workpiece coordinates. Axes whose
    /// place is unknown stay.
    fn stand_at(&mut self, position: &Position);

    /// The program that is executed next is in inches.
    fn is_in_inches(&self) -> bool {
        let program = self.program(self.at().program);
        program.is_some_and(|program| program.unit() == Unit::Inch)
    }

    /// How the coordinates of the path stand in the machine at the block that comes next; `None` for upright.
    fn placement(&self) -> Option<&Arc<Placement>> {
        None
    }

    /// A block moves the axes beside the path: least and greatest place of the tool's tip, workpiece coordinates, mm; unknown
    /// where it does not. `None` for all other blocks.
    fn range(&self, _block: BlockRef) -> Option<[Position; 2]> {
        None
    }

    /// Where the machine has its zero, workpiece coordinates; unknown for axes whose place is not known.
    fn set_machine_zero(&mut self, _zero: &Position) {}

    /// Takes the values that the PLC has given, without going on.
    fn take_values(&mut self, _live: &LiveData) {}

    /// A long computation of the next step is done elsewhere, or is to be: nothing can be read meanwhile.
    fn is_computing(&self) -> bool {
        false
    }

    /// Machine parameters were changed by the PLC: their rules count for the blocks that are read from now on.
    fn set_machine_rules(&mut self, rules: MachineRules);

    /// Allows an amount of work until the next call, about one for a block; then the next step is [`Step::Starved`].
    fn allow(&mut self, work: u32);

    /// Lets a flag end the search for the next step with [`Step::Starved`] while it is set.
    fn set_interrupt(&mut self, flag: Arc<AtomicBool>);
}

impl ElementSource for Box<dyn Reader> {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Self::Error> {
        (**self).next()
    }

    fn resume(&mut self, live: LiveData) {
        (**self).resume(live);
    }
}

impl Clone for Box<dyn Reader> {
    fn clone(&self) -> Box<dyn Reader> {
        (**self).boxed()
    }
}
