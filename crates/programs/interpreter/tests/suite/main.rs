//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

#[path = "../support/messages.rs"]
mod cases;
#[path = "../support/contour.rs"]
mod contour;
#[path = "../support/mod.rs"]
mod support;

mod availability;
mod checkpoints;
mod compensation;
mod contour_pockets;
mod corner_arcs;
mod cycles;
mod cylinder_surface;
mod din_iso;
mod din_iso_cycles;
mod examples;
mod functions;
mod growing;
mod long_contours;
mod messages;
mod messages_of_programs;
mod oem_cycles;
mod paths;
mod probing;
mod properties;
mod q_parameters;
mod readings;
mod rehearsal;
mod resolution;
mod sl_cycles;
mod sl_data_cycles;
mod spellings;
mod subprograms;
mod surface_normals;
mod tilting;
mod transformations;
