//! Machines on trial: switched on again and again, so that something is found out about them.
//!
//! - [`tuning`]: circle tests, stops and threads that find machine parameters, as at commissioning;
//! - [`interferometer`]: axis errors as a laser interferometer measures them, and the tables that compensate them;
//! - [`torture`]: the fault campaign, that holds every contour cycle to rules while random things fail.
//!
//! ```
//! use std::path::Path;
//! use bahn_host::LoadedMachine;
//! use bahn_trials::torture::Campaign;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill"));
//! let machine = LoadedMachine::load(folder)?.map_err(|faults| faults[0].message.clone())?;
//! assert!(Campaign::new(machine, &["CIRCLE.H".to_owned()]).is_ok());
//! # Ok(())
//! # }
//! ```
//!
//! What is tried keeps nothing, and what is found out is data: its words are the caller's.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

pub mod interferometer;
pub mod torture;
mod trial;
pub mod tuning;
