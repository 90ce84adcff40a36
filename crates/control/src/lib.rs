//! The kernel of the control: axes, operating modes, program run, PLC, messages.
//!
//! - [`Setup`] is what a control is made of, [`Control`] the control itself: [`Control::cycle`] spends one
//!   contour cycle on a machine ([`bahn_servo::Plant`]), [`Control::prepare`] plans ahead;
//! - [`Command`] is what an operator asks for, [`Snapshot`] what he sees, [`Message`] what the control says;
//! - [`Signal`] names what can be recorded.
//!
//! Time is a count of microseconds; there is no wall clock, no thread and no randomness here, so the same
//! setup, machine and commands give the same bits. What is decided once in a contour cycle stands in
//! `movement`; each operating mode has its file: `manual`, `reference`, `run`, `restore`.
//!
//! Citations like `[000:7188]` name the manual and the line of its text: `000` is the technical manual of
//! the TNC 407/415/425, `003` the user's manual of the TNC 360.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

mod axes;
mod block_time;
mod command;
mod compensation;
mod control;
mod datums;
mod emergency;
mod feeder;
mod follow;
mod functions;
mod gantry;
mod handshake;
mod life;
mod loops;
mod manual;
mod markers;
mod message;
mod movement;
mod operate;
mod overrides;
mod panel;
mod plc_link;
mod positioning;
mod probing;
mod q_transfer;
mod reference;
mod restore;
mod run;
mod setup;
mod signal;
mod snapshot;
mod spindle;
mod status;
mod strobes;
mod tables;
mod test_run;
mod thread;
mod tools;
mod upkeep;
mod watch;

pub use bahn_interpreter::{Done, Work};
pub use command::{Command, CommandError, Mode};
pub use compensation::{CompensationAssignment, CompensationError, CompensationTable};
pub use control::Control;
pub use datums::datum_shifts;
pub use feeder::Programs;
pub use handshake::{Handshake, Transfer, Waiting};
pub use life::ToolLife;
pub use manual::HANDWHEEL_STEPS;
pub use message::{Message, Shown};
pub use plc_link::NcFiles;
pub use run::RunState;
pub use setup::{Checking, MovedTool, Position0, Remembered, Setup, Tool, WrittenElement};
pub use signal::{AxisSignal, Signal, SignalError};
pub use snapshot::{AxisState, Snapshot};
pub use spindle::SpindleState;
pub use test_run::{TestReport, TestState};
