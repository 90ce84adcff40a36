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
pub(crate) use registers::DataStack;
pub use registers::Registers;
pub use trace::{OperandContent, TraceStep, Tracer};
