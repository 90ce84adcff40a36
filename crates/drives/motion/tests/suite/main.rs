//! The tests of this room as one program: what they share is built and linked once.

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
