//! Part-program languages, lowered to one list of canonical operations with their place in the source.

mod error;
mod operation;

pub use error::BlockError;
pub use operation::*;
