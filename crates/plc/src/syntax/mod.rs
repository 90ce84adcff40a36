//! Lines of source text: commands and their operands, tolerantly spelled.

mod form;
mod line;
mod memory;
mod operand;

pub(crate) use form::{CASE_ENTRY_BYTES, Class, Cost, Mnemonic};
pub(crate) use line::{Command, parse};
pub(crate) use operand::{LineError, MODULE_NUMBERS, Operand};
