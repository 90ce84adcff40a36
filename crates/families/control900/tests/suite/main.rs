//! The System 900 as its manual describes it.

#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

#[path = "../support/mod.rs"]
mod support;

mod axes;
mod by_hand;
mod couplings;
mod language;
mod m_functions;
mod monitors;
mod parameters_of_axes;
mod parameters_of_channels;
mod parameters_of_devices;
mod plc_program;
mod programs;
