//! A System 900 on the kernel: up to eight channels and 32 axes that are data from end to end.
//!
//! It has no clock, no track, no gate, no interpolator and no servo of its own: those are the kernel's. What is here decides what
//! a parameter does while the machine runs.
//!
//! - [`Control900`] is the control: parameters in, programs in, cycles on a machine;
//! - [`Setup`] says which PLC program runs, [`Plc900`] with its [`Window900`], or what answers in its place: [`StandardAnswers`];
//! - [`Transfer`]s are M functions on their way to the PLC, [`Message`]s what the control says;
//! - [`AxisView`] is an axis as it is moved; [`ideal_machine`] is a machine of which nothing is known but its parameters.
//!
//! ```
//! use bahn_control900::{Control900, Mode, Setup, ideal_machine};
//! use bahn_system900::DataFile;
//!
//! let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nP12000: 1\nP12004: 6000\nP12015: $01000000\n");
//! let mut plant = ideal_machine(file.memory());
//! let mut control = Control900::new(file.memory().clone(), Setup::default());
//! control.write_operator("P8683".parse()?, "2".parse()?)?;
//! for _ in 0..10 {
//!     control.prepare();
//!     control.cycle(&mut plant);
//! }
//! // The standard answers have given the mode.
//! assert_eq!(control.mode(1), Mode::Sequence);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [002:403] look like links"
)]

mod answers;
mod axis_parameters;
mod axis_state;
mod branch;
mod channel;
mod command;
mod control;
mod coupling;
mod cycle;
mod enable;
mod hand;
mod kinematics;
mod language;
mod machine;
mod message;
mod monitor;
mod plc;
mod plc_modules;
mod plc_run;
mod plc_scan;
mod plc_window;
mod positions;
mod preparing;
mod restart;
mod restart_place;
mod setup;
mod spindles;
mod status;
mod transfer;
mod units;
mod view;

pub use channel::Mode;
pub use control::Control900;
pub use language::{Language, Open, language};
pub use message::{Kind, Message};
pub use plc_run::Plc900;
pub use plc_window::Window900;
pub use setup::{Setup, StandardAnswers};
pub use transfer::{Transfer, When};
pub use units::{cycle_us, ideal_machine, path_limits};
pub use view::AxisView;
