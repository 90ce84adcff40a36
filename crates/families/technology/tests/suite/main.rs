//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../common/mod.rs"]
mod common;

mod ahead;
mod anything;
mod backward;
mod blockwise;
mod json;
mod laws;
mod leads;
mod lists;
mod micro_joint;
mod ranges;
mod script;
mod search;
mod single;
mod window;
