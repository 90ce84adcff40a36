//! The tests of this room as one program: what they share is built and linked once.

#[path = "../common/mod.rs"]
mod common;

mod gantry;
mod lag;
mod laws;
mod measuring;
mod monitoring;
mod offset;
mod precontrol;
mod spindle;
mod spindle_movement;
