//! PLC programs: run on a bench or in the control of a machine, and what is told of them.
//!
//! - `bench`: program, memory and stand-in for the control together; `live`: the program in the control of a machine;
//!   `subject`: one of the two; `halt` and `failure`: why it does not go on;
//! - `run`: cycle by cycle on the bench; `trace`: executed lines; `record`: operands as a table; `diagram`: operands drawn;
//!   `breakpoint` and `trend`: where a program stops by itself, the course of its operands;
//! - `list` and `xref`: the program itself.

mod bench;
mod breakpoint;
pub mod diagram;
mod failure;
mod halt;
mod list;
mod live;
mod record;
mod run;
mod subject;
mod trace;
mod trend;
mod xref;

pub use bench::{Bench, Failure, last_cycle, operands};
pub use breakpoint::Breakpoints;
pub use failure::failure;
pub use halt::Halt;
pub use list::{Entry, Listing};
pub use live::Live;
pub use record::Record;
pub use run::{Report, Scans, Stop};
pub use subject::Subject;
pub use trace::{Line, Trace, up_to_cycle, up_to_trigger};
pub use trend::Trend;
pub use xref::Reference;
