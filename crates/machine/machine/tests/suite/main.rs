//! The tests of this room as one program: what they share is built and linked once.

#[path = "../common/mod.rs"]
mod common;

mod axes;
mod description;
mod digital;
mod laws;
mod magazine;
mod mill;
mod spindle;
mod terminals;
mod things;
