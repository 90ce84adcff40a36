//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../support/mod.rs"]
mod support;

mod after_faults;
mod after_faults_led;
mod executed_path;
mod following;
mod inserted_tool_call;
mod knee_mill;
mod nc_memory;
mod oem_texts;
mod own_functions;
mod power_off;
mod refused_blocks;
mod replay;
mod rules_of_a_run;
mod scripts;
mod standard_plc;
mod system900_plc;
mod system900_portal;
mod tnc355;
mod twin;
