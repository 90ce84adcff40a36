//! The fast form: a compiled program translated once more, for scans that nobody traces.
//!
//! What makes it fast:
//! - neighbouring bit instructions become one [`bits::BitStep`] strip that runs without a branch per instruction;
//! - a load, what is calculated with it and where it goes become one operation;
//! - nominal time is not added up per instruction: [`translate`] knows the sum before every place, and only
//!   transfers of control look at it.
//!
//! Rare instructions go to the reference interpreter one by one, so that their rules are written once. The
//! reference interpreter is also what this form is tested against: memory, times and errors are the same.

mod bits;
mod execute;
mod operation;
mod translate;
mod words;

use crate::program::PlcProgram;
use crate::run::Processor;

use operation::{CaseEntry, FastOp, Leap};
pub(crate) use operation::{FastProgram, Run};

impl FastProgram {
    /// Translates a program. It must be run with the same program.
    pub(crate) fn new(program: &PlcProgram) -> FastProgram {
        translate::translate(program)
    }

    /// Runs the cyclic program from its start to its end. An error is [`PlcError::TimeOut`] when the run
    /// takes longer than `budget` ns.
    pub(crate) fn run(&self, processor: &mut Processor<'_, '_>, budget: u64) -> Run {
        execute::run(self, processor, budget)
    }
}
