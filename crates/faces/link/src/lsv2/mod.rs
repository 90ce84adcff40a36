//! LSV/2: telegrams between a control and hosts, on TCP and on a serial line (docs/lsv2.md).
//!
//! - [`Telegram`] is what travels, [`TcpReader`] and [`SerialLine`] are how;
//! - [`Session`] is one connection to a [`Device`], with its logins ([`Level`], [`Passwords`]);
//! - [`Server`] serves a device on TCP, [`SerialServer`] on a serial line, [`Client`] asks one.

mod access;
mod client;
mod commands;
mod device;
mod error;
mod file_commands;
mod keys;
mod machine_commands;
mod memory;
mod peer;
mod serial;
mod serial_server;
mod server;
mod session;
mod still;
mod tcp;
mod telegram;
#[cfg(test)]
mod tests;
mod transfer;

pub use access::{Level, Passwords};
pub use client::{Client, ClientError, RemoteEntry, TcpTransport, Transport};
pub use device::{
    Area, Device, EVENTS, Event, EventKind, Execution, Identity, Message, PlcMessage, ProgramState, Run, Tool,
};
pub use error::ErrorNumber;
pub use keys::name as key_name;
pub use peer::Features;
pub use serial::{ANSWER, LineEvent, LineFault, NEXT, SerialLine, Side, frame};
pub use serial_server::SerialServer;
pub use server::{OpenPort, Server, ServerOptions};
pub use session::{Session, Site};
#[doc(hidden)]
pub use still::StillDevice;
pub use tcp::{DATA_MAX, TcpReader, TooLong, encode};
pub use telegram::{Command, Fields, Telegram};
