//! DIN 66025 as a TF5200 reads it: `.nc` programs with subroutines, expressions, variables and macros.
//!
//! A [`Program`] is the text of one file: its [`Section`]s are programs and subroutines, [`Program::faults`] tells what is
//! wrong in it with line and column. A [`Decoder`] executes one program block by block and gives for each a
//! [`Unit`]: what it moves, which functions it orders, what else it commands. Whoever follows it answers for the
//! variables of the channel ([`Variables`]) and finds subroutines ([`Files`](bahn_text::Files)).
//!
//! [`examine`] tells all that is wrong with a file and those that it calls, without a channel.
//!
//! [`Program::listing`] is the text as it is written tidily: the same program.
//!
//! What the manual does not show is an error at its block with its name; nothing is skipped.
//!
//! ```
//! use std::sync::Arc;
//!
//! use bahn_din::{Decoder, FunctionLetter, Kind, Program, Step, Variable, Variables};
//! use bahn_path::{Axis, Position};
//! use bahn_text::MemoryFiles;
//!
//! /// A channel without variables.
//! struct Bare;
//!
//! impl Variables for Bare {
//!     fn read(&mut self, variable: &Variable) -> Result<f64, String> {
//!         Err(format!("{} is not known", variable.name))
//!     }
//!     fn write(&mut self, variable: &Variable, _value: f64) -> Result<(), String> {
//!         Err(format!("{} is not known", variable.name))
//!     }
//!     fn exists(&self, _letter: FunctionLetter, _number: u16) -> bool {
//!         false
//!     }
//! }
//!
//! let program = Arc::new(Program::from_bytes("part.nc", b"N10 G01 X25 F2000 M7=3\nN20 M30\n"));
//! assert!(program.faults().is_empty());
//! if let Some(main) = program.mains().next() {
//!     let beside = Arc::new(MemoryFiles::default());
//!     let mut decoder = Decoder::new(Arc::clone(&program), main, Position::ZERO, beside);
//!     if let Step::Unit(unit) = decoder.next(&mut Bare) {
//!         assert_eq!(&*unit.place.block, "N10");
//!         assert_eq!(unit.motion.map(|motion| motion.end[Axis::X]), Some(25.0));
//!         assert_eq!((unit.functions[0].kind, unit.functions[0].value), (Kind::M(7), Some(3)));
//!     }
//! }
//! ```

mod block;
mod circle;
mod command;
mod cure;
mod cursor;
mod decoder;
mod examine;
mod execute;
mod expression;
mod line;
mod listing;
mod program;
mod rewriting;
mod source;
pub mod system900;
mod unit;
mod words;

pub use decoder::{BlockFault, Decoder, Step};
pub use examine::{Examination, Found, examine};
pub use program::{Fault, Landmark, LandmarkKind, MAX_FAULTS, Program, Section};
pub use unit::{
    Command, Function, FunctionLetter, Independent, Kind, Motion, Place, SpindleOrder, Target, Unit,
    Variable, Variables,
};
pub use words::{Span, SpanKind, words};
