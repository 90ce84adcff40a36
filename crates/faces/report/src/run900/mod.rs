//! Programs on a machine with a System 900: what is seen of them cycle after cycle, and what is said in the end.
//!
//! - `session`: a host, cycle after cycle, with the script that it plays and those who follow it; `standstill`: whether it comes on;
//! - `executed`: what was done of the path of a channel; `listed`: messages, refusals and transfers;
//! - `recording`: parameters over time; `report`: what is said in the end.

mod executed;
mod listed;
mod recording;
mod report;
mod session;
mod standstill;

pub use recording::{Recording900, usual_parameters};
pub use report::RunReport900;
pub use session::{Ended900, Session900};
