//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

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
