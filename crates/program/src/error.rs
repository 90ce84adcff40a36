//! What can be wrong with a block's text.

use bahn_parameters::MessageId;

/// A fault in the text of a block.
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
