//! Blockwise transfer with execution (DNC): a program that is executed while it is transferred
//! [000:16951-16968] [003:1650-1690] [001:1970-2135].
//!
//! - [`Drip`] is the control's side: blocks go from a [`BlockLine`] to a [`Machine`], no faster than that takes them;
//! - [`ProtocolLine`] is such a line, what a protocol makes of a channel; [`Executing`] such a machine, a host;
//! - [`Spool`] is what a peripheral sends, and [`Spooled`] says which block is in the machine.

mod drip;
mod executing;
mod line;
mod protocol_line;
mod spool;

pub use drip::{Drip, DripState};
pub use executing::Executing;
pub use line::{Arrival, BlockLine, Machine};
pub use protocol_line::ProtocolLine;
pub use spool::{Progress, Spool, Spooled};
