//! Part programs of a System 900 (`P1000.900`, cycles `Z6.900`) as what a control feeds from.
//!
//! The face of this room:
//! - [`Reader900`]: executes a program of a channel with the [`Memory`](bahn_system900::Memory) of the control, which it has
//!   while it reads; what it does not execute is refused at its block and named;
//! - [`ChannelAxes`]: which axis of the path is which logical and which physical axis.
//!
//! ```
//! use std::sync::Arc;
//!
//! use bahn_interpreter900::Reader900;
//! use bahn_path::{Axis, ElementSource, Position, Step};
//! use bahn_system900::DataFile;
//! use bahn_text::MemoryFiles;
//!
//! let file = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nq111: $02020059\nq112: $0303005A\n");
//! let beside = Arc::new(MemoryFiles::default()); // No cycles.
//! let text = b"N100 P1:25\nN110 G1 X:P1 F2000\nN120 M30\n";
//! let mut run = Reader900::new("P1000.900", text, 1, Position::ZERO, beside);
//! run.give_memory(file.memory().clone());
//! if let Step::Element(element) = run.next() {
//!     assert_eq!(element.end[Axis::X], 25.0);
//! }
//! ```

mod ahead;
mod arc;
mod axes;
mod contour;
mod corner;
mod correction;
mod correction_rules;
mod drilling;
mod execute;
mod feeds;
mod file;
mod functions;
mod g_functions;
mod item;
mod modal;
mod motion;
mod numbers;
mod plain;
mod reader;
mod refusal;
mod run;
mod showing;
mod shown;
mod speeds;
mod turning;
mod words;
mod writes;

pub use axes::{ChannelAxes, ChannelAxis};
pub use reader::Reader900;
