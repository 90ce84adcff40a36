//! Lines of source text: commands and their operands, tolerantly spelled.

mod form;
mod line;
mod memory;
mod operand;
mod words;

pub(crate) use form::{CASE_ENTRY_BYTES, Class, Cost, Mnemonic};
pub(crate) use line::{Command, has_old_letters, parse};
pub use line::{check_line, code_of_line, split_comment};
pub(crate) use operand::{LineError, MODULE_NUMBERS, Operand};
pub use words::{
    InstructionForm, LineOperand, LineWords, Nesting, instructions, line_words, listed_code, nesting,
};
