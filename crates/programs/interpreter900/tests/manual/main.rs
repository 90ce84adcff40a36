//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "what fails in a helper fails the test"
)]

mod support;

mod any_text;
mod cycles;
mod flow;
mod functions;
mod paths;
mod reader;
mod zero_points;
