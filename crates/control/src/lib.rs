//! The kernel of the control.
mod command;
mod emergency;
mod feeder;
mod handshake;
pub use command::{Command, CommandError, Mode};
mod markers;
mod message;
mod panel;
mod plc_link;
