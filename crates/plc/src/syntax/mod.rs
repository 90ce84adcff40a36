//! Lines of source text: commands and their operands, tolerantly spelled.

mod form;
mod line;
mod memory;

pub(crate) use form::{CASE_ENTRY_BYTES, Class, Cost, Mnemonic};
pub(crate) use line::{Command, LineError, MODULE_NUMBERS, Operand, parse};
