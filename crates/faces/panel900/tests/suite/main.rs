//! The panel of the portal by keys alone.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

#[path = "../support/mod.rs"]
mod support;

mod keys;
mod pages;
mod run;
mod service;
