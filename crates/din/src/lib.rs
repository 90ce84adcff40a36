//! DIN 66025 as a TF5200 reads it: `.nc` programs with subroutines, expressions, variables and macros.
//!
//! A [`Program`] is the text of one file: its [`Section`]s are programs and subroutines, [`Program::faults`] tells what is
//! wrong in it with line and column. A [`Decoder`] executes one program block by block and gives for each a
//! [`Unit`]: what it moves, which functions it orders, what else it commands. Whoever follows it answers for the
//! variables of the channel ([`Variables`]) and finds subroutines ([`Shelf`]).
//!
//! [`examine`] tells all that is wrong with a file and those that it calls, without a channel.
//!
//! What the manual does not show is an error at its block with its name; nothing is skipped.

mod block;
mod circle;
mod command;
mod cursor;
mod decoder;
mod examine;
mod execute;
mod expression;
mod line;
mod program;
mod unit;
mod words;

pub use decoder::{BlockFault, Decoder, Found, Step};
pub use examine::{Examination, FileFault, examine};
pub use program::{Fault, Landmark, LandmarkKind, MAX_FAULTS, Program, Section};
pub use unit::{
    Command, Function, Independent, Kind, Motion, Place, Shelf, SpindleOrder, Target, Unit, Variable,
    Variables,
};
pub use words::{Span, SpanKind, words};
