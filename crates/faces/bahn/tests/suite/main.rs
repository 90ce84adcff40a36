//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../support/mod.rs"]
mod support;

mod any_file;
mod channel;
mod check_and_format;
mod check_din;
mod check_system900;
mod compensate;
mod contour_deviation;
mod convert;
mod cuts;
mod digitizing;
mod din_iso;
mod documented_commands;
mod gantry;
mod hard_to_break;
mod hardware;
mod json_refusals;
mod machine_folder;
mod machines;
mod mp;
mod nc_on_a_machine;
mod oem_cycles;
mod oem_eprom;
mod oscilloscope;
mod pallets;
mod plc;
mod plc_diagram;
mod plc_examples;
mod plc_machine;
mod positioning_module;
mod power_off;
mod q;
mod recording;
mod run;
mod run_rules;
mod scope;
mod scripts;
mod shelf;
mod system900_machine;
mod system900_portal;
mod system900_run;
mod tables;
mod technology;
mod test_on_a_machine;
mod test_run;
mod threads;
mod tune;
mod tune_spindle;
mod twin;
mod workpieces;
