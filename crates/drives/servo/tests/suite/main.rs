//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../common/mod.rs"]
mod common;

mod gantry;
mod lag;
mod laws;
mod measuring;
mod monitoring;
mod offset;
mod precontrol;
mod spindle;
mod spindle_movement;
