//! Blockwise transfer with execution (DNC): a program that is executed while it is transferred
//! [000:16951-16968] [003:1650-1690] [001:1970-2135].
//!
//! - [`Drip`] is the control's side: blocks go from a [`BlockLine`], which is what a protocol makes of a channel, to a
//!   [`Machine`], no faster than that takes them; [`Executing`] is one, a host that executes them;
//! - [`Sending`] is a program that a peripheral sends, and how far the machine has come.

mod drip;
mod executing;
mod line;
mod spool;

pub use drip::{Drip, DripState};
pub use executing::Executing;
pub use line::{Arrival, BlockLine, Machine};
pub use spool::Sending;
