//! The PLC at the other side of the ranges: a script says what it does, or it does all in its process time.

mod script;

pub use script::{Script, ScriptError};
