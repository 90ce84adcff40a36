//! What is wrong with a script.

use std::fmt;

/// What is wrong with a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptError {
    /// Line of the script, from 1.
    pub line: usize,
    /// First character of the line that is meant, from 1.
    pub column: usize,
    /// How many characters are meant.
    pub length: usize,
    /// What is wrong, in words.
    pub message: String,
    /// What to do about it, where that can be guessed.
    pub help: Option<String>,
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.line, self.column, self.message)
    }
}

impl std::error::Error for ScriptError {}
