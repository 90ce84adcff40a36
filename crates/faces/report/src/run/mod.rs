//! A part program on the simulated machine: what is seen of it cycle after cycle, and what is said in the end.
//!
//! - `session`: a host, cycle after cycle, with the script that it plays and those who follow it; `standstill`: whether it
//!   comes on;
//! - `beside`: the channels beside the first one, `module`: the positioning module beside the machine; `executed`: what was done of the path, with `turning`, how the spindle
//!   turned there; `table`: what lies on the table of the machine;
//! - `measured`: `deviation` from the contour with its `cause`, `threads` and `times`; `listed`: messages and keys;
//! - `recording`: signals over time; `scoped`: the control's oscilloscope;
//! - `report` and `reported`: what is said in the end.

mod beside;
mod cause;
mod deviation;
mod executed;
mod listed;
mod measured;
mod module;
mod recording;
mod report;
mod reported;
mod scoped;
mod session;
mod standstill;
mod table;
mod threads;
mod times;
mod turning;

pub use executed::Executed;
pub use module::ModuleRun;
pub use recording::{Recording, usual_signals};
pub use report::RunReport;
pub use reported::Reported;
pub use scoped::Scoped;
pub use session::{Ended, Patience, Session};
pub use table::Table;
