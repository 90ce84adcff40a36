//! What is found out about programs and told of it: data in, data out.
//!
//! The face of this room:
//! - [`test_run`]: programs run without a machine; [`shelf`]: many of them as a table;
//! - [`run`]: a program on the simulated machine, with what is measured of it;
//! - [`plc`]: PLC programs, on a bench or in a machine;
//! - [`scope`]: recorded signals, drawn and summed up;
//! - [`record`]: what is collected of a run, and its report; [`text`]: the report for people;
//! - [`technology`], [`tune`], [`torture`], [`convert`]: what is told of a run with M functions, of a commissioning, of a fault campaign,
//!   of a conversion;
//! - [`explain`], [`conformance`], [`faults`]: what is told of messages, functions and faults of the controls;
//! - [`count`]: numbers of things in words; [`paragraph`]: labelled text in 80 columns;
//! - [`junit`]: expectations for build servers; [`solid`]: what a stylus feels.
//!
//! ```
//! use bahn_report::text::clock;
//!
//! assert_eq!(clock(3.0 * 3600.0 + 25.0 * 60.0 + 7.0), "3:25:07");
//! ```
//!
//! Nothing here prints, knows options or ends the process: who runs something gives a [`Follower`] that sees how far it is,
//! and a [`Stop`] that ends it; what cannot be done is a [`ReportError`].

mod block_time;
pub mod conformance;
pub mod convert;
mod count;
mod error;
pub mod explain;
pub mod faults;
mod follower;
pub mod junit;
mod names900;
pub mod paragraph;
mod path_csv;
mod path_svg;
pub mod plc;
pub mod record;
pub mod run;
pub mod run900;
pub mod scope;
pub mod shelf;
pub mod solid;
mod stop;
pub mod technology;
pub mod test_run;
pub mod text;
pub mod torture;
pub mod tune;

pub use count::count;
pub use error::ReportError;
pub use follower::Follower;
pub use names900::machine_names900;
pub use stop::Stop;
