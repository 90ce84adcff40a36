//! Part-program languages, lowered to one list of canonical operations with their place in the source.
//!
//! The face of this room:
//! - [`Program`]: a file with a light index; decodes its blocks a [`Chunk`] at a time;
//! - [`Block`] and [`Operation`]: what a block does, the same whatever language or spelling it came from;
//! - [`BlockError`]: what is wrong with a block that cannot be read, and where.
//!
//! Reading never fails: a block that cannot be read is [`Operation::Invalid`], an error when it is executed.

mod check;
mod error;
mod index;
mod lines;
mod operation;
mod parse;
mod program;
mod text;

pub use check::Limits;
pub use error::BlockError;
pub use operation::*;
pub use program::{Chunk, NumberedBlock, Program};
