//! Part-program languages, lowered to one list of canonical operations with their place in the source.
//!
//! The face of this room:
//! - [`Program`]: a file with a light index; decodes its blocks a [`Chunk`] at a time;
//! - [`Block`] and [`Operation`]: what a block does, the same whatever language or spelling it came from;
//! - [`BlockError`]: what is wrong with a block that cannot be read, and where;
//! - [`Program::diagnostics`]: all faults of a program in one pass; [`check_limits`] for one block;
//! - [`FeedDoubt`]: feeds of programs in inches that look ten times off;
//! - [`InputSteps`]: how fine the numbers of a program may be;
//! - [`format_program`]: the normalised listing.
//!
//! Reading never fails: a block that cannot be read is [`Operation::Invalid`], an error when it is executed.

mod check;
mod diagnostics;
mod error;
mod format;
mod inch_feed;
mod index;
mod lines;
mod operation;
mod parse;
mod program;
mod rounding;
mod sequence;
mod text;

pub use check::{LimitFault, Reading, check_limits, each_parameter};
pub use diagnostics::{Diagnostic, MAX_DIAGNOSTICS, Severity, Uncounted};
pub use error::BlockError;
pub use format::{FormatOptions, format_block, format_program};
pub use inch_feed::FeedDoubt;
pub use operation::*;
pub use program::{Chunk, NumberedBlock, Program};
pub use rounding::InputSteps;
