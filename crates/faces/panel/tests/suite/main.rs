//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../cross_table/mod.rs"]
mod cross_table;
#[path = "../support/mod.rs"]
mod support;

mod any_keys;
mod any_plant;
mod by_hand;
mod capture;
mod chaos;
mod commissioning;
mod contour;
mod din;
mod displays;
mod files;
mod first_steps;
mod graphics;
mod interfaces;
mod iso;
mod lessons;
mod lessons_tnc155;
mod live;
mod operation;
mod oscilloscope;
mod pages;
mod plc_files;
mod plc_mode;
mod program_run;
mod programming;
mod restoring;
mod session;
mod supplementary;
mod tables;
mod test_run;
mod texts;
mod texts_of_files;
mod timeline;
mod tnc155;
mod tnc155_mod;
mod transfers;
mod why;
