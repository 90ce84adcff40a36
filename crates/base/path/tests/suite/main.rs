//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../common/mod.rs"]
mod common;

mod bounds;
mod region_boolean;
mod region_brute_force;
mod region_hatch;
mod region_offset;
mod region_scaling;
mod region_superimpose;
mod swivels;
