//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../support/mod.rs"]
mod support;

mod axis_and_spindle;
mod conformance;
mod consistency;
mod every_number;
mod list_text;
mod plc_and_operation;
mod reference_lists;
mod swivels;
mod technology;
mod terminals;
mod text_form;
