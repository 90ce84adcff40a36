//! The tests of this room as one program: what they share is built and linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "what fails in a helper fails the test"
)]

mod checks;
mod control;
mod events;
mod files;
mod flash;
mod laws;
mod layout;
mod locks;
mod memory;
mod messages;
mod portal;
mod table;
mod traffic;
mod units;
