//! The servo loops of one axis or spindle, and what they drive.
//!
//! [`Plant`] is the seam to the machine: nominal value voltages, encoders, inputs and outputs. The
//! simulated machine implements it; a real machine would.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:4749] look like links"
)]

mod plant;

pub use plant::{Encoder, INPUTS, OUTPUTS, OperatorInputs, Plant};
