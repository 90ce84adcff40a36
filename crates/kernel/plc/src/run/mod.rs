//! Running a program.

mod clock;
mod machine;
mod memory;
mod processor;
mod registers;
mod submit;
mod text;
mod trace;

pub(crate) use machine::percent;
pub use machine::{Machine, ProcessingTime, RuntimeError, ScanReport, Start};
pub(crate) use memory::read_number;
pub(crate) use processor::Processor;
pub use registers::Registers;
pub(crate) use registers::{CALLS_MAX, DataStack, Text};
pub use trace::{CodeTrace, Executed, OperandContent, TraceStep, Tracer};
