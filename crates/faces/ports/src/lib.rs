//! A machine that is on at its data interfaces: what [`bahn_link`] carries goes to the machine, and what the machine has to
//! say goes over the line. All but the drip feed are adapters of [`bahn_service`]: they know their protocol and that.
//!
//! The face of this room:
//! - [`open`]: ports as they are written, opened and set up as machine parameters say;
//! - [`serial_ports`]: RS-232-C and RS-422 of a machine that answers; [`PlcLines`]: its PLC at them;
//! - [`PanelPorts`]: the interfaces of a machine with a panel, where a transfer begins when the operator wants it;
//! - [`MachineDevice`]: a machine that is on as a host with LSV/2 sees it;
//! - [`screen_picture`]: its screen as pixels;
//! - [`dnc`]: a machine that executes a program while it is transferred, cycle by cycle; [`Trace`]: what passes over a line.
//!
//! ```
//! use bahn_link::Line;
//!
//! let spec = bahn_ports::open::spec("--port", "tcp:127.0.0.1:19000").unwrap();
//! assert!(matches!(spec.line, Line::Listen(_)));
//! assert!(bahn_ports::open::spec("--port", "somewhere").is_err());
//! ```
//!
//! Nothing here prints: lines for people go to a [`Tell`].

pub mod dnc;
mod error;
mod lsv2_device;
pub mod open;
mod panel_ports;
mod plc_lines;
pub mod screen_picture;
pub mod serial_ports;
mod trace;

pub use error::{PortError, Tell};
pub use lsv2_device::MachineDevice;
pub use panel_ports::{PanelPorts, RunningPorts};
pub use plc_lines::{PlcLines, PlcPort};
pub use trace::Trace;
