//! The tests of this room as one program: what they share is built and linked once.

#[path = "../common/mod.rs"]
mod common;

mod chain;
mod events;
mod heights;
mod mesh;
mod point;
mod touch;
mod views;
mod volume;
