//! What can be wrong with a block's text.

use bahn_parameters::MessageId;
use bahn_text::Span;

/// A fault in the text of a block. Its place is one within the block, whose line in the file nobody knows while it is read.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockError {
    /// What the control says to it.
    pub message: MessageId,
    /// Line within the block, 0 for its first; greater only in blocks of several lines joined by `~`.
    pub line: u32,
    /// Column in the line, in characters counted from 1.
    pub column: u32,
    /// Number of characters it covers, at least 1.
    pub length: u32,
    /// What exactly, in a few words for people.
    pub detail: Box<str>,
    /// What to do about it, where the message's own remedy would mislead.
    pub help: Option<&'static str>,
}

impl BlockError {
    /// Its place in the file where the block begins in a line.
    pub(crate) fn span(&self, line: u32) -> Span {
        Span {
            line: line.saturating_add(self.line),
            column: self.column,
            length: self.length,
        }
    }
}
