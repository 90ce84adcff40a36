//! Programming by dialogue: the operator's editor, without screen, files or threads.
//!
//! The face of this room:
//! - [`Key`]: every key of the control, by name, with what it does.

mod key;

pub use key::{Key, KeyGroup, Tongue};
