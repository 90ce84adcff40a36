//! Data interfaces: the control speaks with the devices of its time and with clients of today, and plays such a device for
//! a real control.
//!
//! ```
//! use bahn_link::FileType;
//!
//! let types: Vec<_> = FileType::all().filter(|kind| kind.code() == 'A').collect();
//! assert_eq!(types.len(), 5); // texts, messages and dialogues share a letter
//! ```
//!
//! - [`dnc`] is the drip feed: programs that are executed while they are transferred;
//! - [`Channel`] carries bytes: a socket, a pseudo terminal or a serial port, written as a [`Spec`]; [`Characters`] are
//!   their bits and time, [`Settings`] what machine parameters say for a [`Mode`];
//! - a [`Protocol`] is one side of a line, without clock and channel: the control and the device of the [`standard`]
//!   protocol and of the [`blockwise`] one with check characters, [`Passive`] what obeys; [`drive`] puts it on a channel,
//!   [`Files`] are what it transfers;
//! - a [`Monitor`] says in words what passes;
//! - [`HardCopy`] speaks to the printer of a TNC 155, [`PrintOut`] brings it what is printed;
//! - [`PlcLine`] is the PLC at a line, [`Resting`] a line that nobody uses;
//! - a [`PositioningModule`] is a second control at the RS-422 of the first one;
//! - [`lsv2`] are the telegrams of LSV/2.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

pub mod blockwise;
mod channel;
mod characters;
pub mod dnc;
mod drive;
mod files;
mod frame;
mod hard_copy;
pub mod lsv2;
mod module;
mod monitor;
mod passive;
mod plc_line;
mod print_out;
mod protocol;
mod resting;
mod settings;
mod shared_port;
pub mod standard;
mod text;

/// What is connected to a port.
pub use bahn_parameters::interfaces::Mode;
pub use bahn_store::FileType;
pub use channel::{Channel, ChannelError, Faults, Happened, Line, Spec, SpecError};
pub use characters::{AFTER_DC3, Characters, DC1, DC3, Parity};
pub use drive::{Attendant, Tap, drive};
pub use files::{Files, Listed, Memory, NewFile, OfKinds};
pub use hard_copy::HardCopy;
pub use module::PositioningModule;
pub use monitor::Monitor;
pub use passive::{Passive, peripheral};
pub use plc_line::PlcLine;
pub use print_out::PrintOut;
pub use protocol::{Ended, Event, Protocol, Question, Shown};
pub use resting::Resting;
pub use settings::{PATIENCE, Settings};
pub use shared_port::{PlcHold, SharedPort};
