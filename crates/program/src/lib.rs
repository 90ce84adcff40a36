//! Part-program languages, lowered to one list of canonical operations with their place in the source.
//!
//! The face of this room:
//! - [`Program`]: a file with a light index; decodes its blocks a [`Chunk`] at a time;
//! - [`Block`] and [`Operation`]: what a block does, the same whatever language or spelling it came from;
//! - [`BlockError`]: what is wrong with a block that cannot be read, and where;
//! - [`format_program`]: the normalised listing.
//!
//! Reading never fails: a block that cannot be read is [`Operation::Invalid`], an error when it is executed.

mod check;
mod error;
mod format;
mod index;
mod lines;
mod operation;
mod parse;
mod program;
mod text;

pub use check::Limits;
pub use error::BlockError;
pub use format::{FormatOptions, format_block, format_program};
pub use operation::*;
pub use program::{Chunk, NumberedBlock, Program};
