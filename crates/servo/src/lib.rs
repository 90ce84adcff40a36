//! The servo loops of one axis or spindle, and what they drive.
//!
//! - [`Plant`] is the seam to the machine: nominal value voltages, encoders, inputs and outputs. The
//!   simulated machine implements it; a real machine would;
//! - [`Axis`] is the position loop of one axis: in each contour cycle a nominal position comes in, in each
//!   servo step an encoder reading comes in and a voltage goes out;
//! - [`Gantry`] couples a slave axis to its master, [`ErrorTable`] and [`DistanceCode`] know scales and their
//!   errors, [`Fault`] is what monitoring finds;
//! - [`Spindle`] is the main spindle: gear, override, ramps, orientation; [`SpeedCode`] its coded output;
//! - [`Timing`] says in which cycles, and how fine the output is.
//!
//! mm stands for degrees on rotary axes. Nothing here allocates after construction, and the same inputs
//! give the same bits.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:4749] look like links"
)]

mod axis;
mod characteristic;
mod error_table;
mod fault;
mod gantry;
mod interpolation;
mod marks;
mod measuring;
mod monitor;
mod offset;
mod plant;
mod reversal;
mod spindle;
mod timing;

pub use axis::{Axis, Method};
pub use characteristic::Characteristic;
pub use error_table::ErrorTable;
pub use fault::{EncoderFault, Fault, GrossFault};
pub use gantry::Gantry;
pub use marks::DistanceCode;
pub use measuring::Mark;
pub use offset::OffsetInterval;
pub use plant::{Encoder, INPUTS, OUTPUTS, OperatorInputs, Plant};
pub use spindle::{Ramp, Rotation, SpeedCode, Spindle, Way, tapping_lead_s};
pub use timing::{OUTPUT_VOLTS, Timing};
