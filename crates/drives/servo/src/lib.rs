//! The servo loops of one axis or spindle, and what they drive.
//!
//! - [`Plant`] is the seam to the machine: in each servo step [`Commands`] go out and what is [`Measured`] comes
//!   back. The simulated machine implements it; a real machine would; [`IdealAxes`] is the shortest one;
//! - [`Axis`] is the position loop of one axis: in each contour cycle a nominal position comes in, in each
//!   servo step an encoder reading comes in and a voltage goes out;
//! - [`Gantry`] couples a slave axis to its master, [`ErrorTable`] and [`DistanceCode`] know scales and their
//!   errors, [`Fault`] is what monitoring finds;
//! - [`Spindle`] is the main spindle: gear, override, ramps, orientation; [`SpeedCode`] its coded output;
//! - [`Timing`] says in which cycles, and how fine the output is;
//! - [`settings`] and [`spindle_settings`] are what they are told of their machine, in physical units. Machine parameters
//!   are made into them where they are known.
//!
//! ```
//! use bahn_parameters::{ControlModel, ParameterList};
//! use bahn_servo::{Axis, Encoder};
//!
//! let mut list = ParameterList::reference(ControlModel::Tnc415b);
//! for entry in ["710.0=0", "720.0=0", "1010.0=5000", "1050.0=9", "1810.0=2"] {
//!     list.assign(entry)?;
//! }
//! let timing = ControlModel::Tnc415b.timing();
//! let mut axis = Axis::new(list.axis_parameters(0).settings(), timing);
//! // An ideal machine: 9 V are 5000 mm/min, an encoder counts 51 200 steps for 1 mm.
//! let mut table_mm = 0.0;
//! let mut read = |volts: f64| {
//!     table_mm += volts / 9.0 * 5000.0 / 60.0 * f64::from(timing.step_us()) * 1e-6;
//!     Encoder { count: (table_mm * 51_200.0) as i64, ..Encoder::default() }
//! };
//! axis.measure(read(0.0));
//! axis.transfer();
//! axis.close();
//! for cycle in 1..=400 {
//!     axis.command(0.25 * f64::from(cycle)); // 0.25 mm in 3 ms are 5000 mm/min
//!     for _ in 0..timing.steps() {
//!         let volts = axis.step();
//!         axis.measure(read(volts));
//!     }
//! }
//! // 5 m/min / 2 (m/min)/mm [000:4881-4891].
//! assert!((axis.volts() - 9.0).abs() < 0.01);
//! # assert_eq!(axis.fault(), None);
//! # Ok::<(), bahn_parameters::ParameterError>(())
//! ```
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
mod handwheel;
mod ideal;
mod interpolation;
mod marks;
mod measuring;
mod method;
mod monitor;
mod offset;
mod plant;
mod reversal;
pub mod rounding;
mod run_up;
pub mod settings;
mod speed_loop;
mod spindle;
mod timing;

pub use axis::Axis;
pub use characteristic::Characteristic;
pub use error_table::ErrorTable;
pub use fault::{EncoderFault, Fault, GrossFault};
pub use gantry::Gantry;
pub use handwheel::{HandwheelInputs, HandwheelKey, HandwheelKeys, WHEELS};
pub use ideal::{IdealAxes, IdealDrive};
pub use marks::DistanceCode;
pub use measuring::Mark;
pub use method::Method;
pub use offset::OffsetInterval;
pub use plant::{
    ANALOGUE_INPUTS, AxisCommand, Commands, Drive, ENCODERS, Encoder, INPUTS, Measured, NOMINALS, OUTPUTS,
    OperatorInputs, Plant, Probe, Step,
};
pub use speed_loop::SpeedState;
pub use spindle::settings as spindle_settings;
pub use spindle::{Ramp, Rotation, SpeedCode, Spindle, Way};
pub use timing::{OUTPUT_VOLTS, Timing};
