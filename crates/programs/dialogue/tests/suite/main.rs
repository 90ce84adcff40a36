//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../desk/mod.rs"]
mod desk;

mod blocks;
mod comments;
mod editing;
mod iso;
mod laws;
mod operations;
mod program;
mod words;
