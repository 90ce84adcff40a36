//! Part programs of a System 900 (`P1000.900`, cycles `Z6.900`) as what a contouring control feeds from.
//!
//! [`Reader900`] makes path elements of the blocks of a channel. It reads and writes the parameters of the control while it
//! looks ahead: zero points, planes, feeds, tools, conditions. The memory belongs to the control, which
//! [gives](Reader900::give_memory) it to the reader and [takes](Reader900::take_memory) it back; a test run leaves it there.
//! What is written when the path comes to it, and what branches there, goes with the elements as a function.
//!
//! Positions are those of the control: program coordinates with zero point, shifts and tool length, mm and degrees. A word that
//! the manual does not explain is refused at its block with its name.
//!
//! ```
//! use std::sync::Arc;
//!
//! use bahn_interpreter900::Reader900;
//! use bahn_path::{Axis, ElementSource, Step};
//! use bahn_system900::DataFile;
//! use bahn_text::MemoryFiles;
//!
//! let data = DataFile::read(b"q102: 10000\nq103: 5000\nq110: $01010058\nq111: $02020059\n");
//! let files = Arc::new(MemoryFiles::default()); // No cycles.
//! let program = b"N10 P500:12.5\nN20 G1 X:P500 Y4 F1000\nN30 M30\n";
//! let mut run = Reader900::new("P1000.900", program, 1, files);
//! run.give_memory(data.memory().clone());
//! if let Step::Element(element) = run.next() {
//!     assert_eq!((element.end[Axis::X], element.end[Axis::Y]), (12.5, 4.0));
//! }
//! assert!(matches!(run.next(), Step::End));
//! ```

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [002:403] look like links"
)]

mod block;
mod circle;
mod drilling;
mod frame;
mod functions;
mod modal;
mod motion;
mod reader;
mod refusal;
mod run;
mod texts;
mod tool;

pub use reader::Reader900;
