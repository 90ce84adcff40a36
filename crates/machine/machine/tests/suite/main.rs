//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../common/mod.rs"]
mod common;

mod axes;
mod description;
mod digital;
mod interlock;
mod laws;
mod magazine;
mod mill;
mod numbered_axes;
mod spindle;
mod terminals;
mod things;
