//! What programs of a System 900 do to path, parameters and machine.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::indexing_slicing,
    reason = "a helper that panics fails its test"
)]

mod by_the_manual;
mod drilling;
mod functions;
mod going_back;
mod parameters;
mod path;
mod random;
mod shown;
mod support;
mod zero_points;
