//! The tests of this room as one program: what they share is built and linked once.

#[path = "../common/mod.rs"]
mod common;
#[path = "../../benches/programs/mod.rs"]
mod programs;

mod accumulators;
mod applications;
mod errors;
mod fast;
mod flow;
mod macros;
mod stack_and_strings;
