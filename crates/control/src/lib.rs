//! The kernel of the control.
mod axes;
mod command;
mod emergency;
mod feeder;
mod handshake;
mod overrides;
pub use command::{Command, CommandError, Mode};
mod markers;
mod message;
mod panel;
mod plc_link;
