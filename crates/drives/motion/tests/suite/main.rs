//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../common/mod.rs"]
mod common;

mod examples;
mod glide;
mod laws;
mod online;
mod online_laws;
mod placed;
mod point_to_point;
mod scan;
mod steps;
mod synchronisation;
mod threads;
