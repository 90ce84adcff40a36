//! The System 900 as its manual describes it.

#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod list;
mod m_functions;
mod programs;
mod rig;
