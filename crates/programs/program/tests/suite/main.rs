//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../generate/mod.rs"]
mod generate;
#[path = "../laws/mod.rs"]
mod laws;

mod diagnostics;
mod din;
mod din_iso;
mod editing;
mod listing;
mod programs;
mod round_trip;
