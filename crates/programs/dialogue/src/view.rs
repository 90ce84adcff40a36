//! What an editor shows.

use bahn_parameters::MessageId;

/// A block of the listing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Its number; none for a block that is still being entered.
    pub number: Option<u32>,
    /// What stands before it: its number, or `N120`.
    pub label: String,
    /// Its text, without the number.
    pub text: String,
    /// The block between the two lines of the screen [003:574-588].
    pub current: bool,
    /// It belongs to the marked section.
    pub marked: bool,
}

/// A part of the current block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownWord {
    /// Its text, with what stands before it.
    pub text: String,
    /// The word is shown inverse.
    pub highlighted: bool,
}

/// The question in the header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    /// Id of the prompt in the table of [`prompts`](crate::prompts), for help.
    pub id: &'static str,
    /// What is being made: `L`, `CYCL DEF 4`, `TCH PROBE 0`; empty where no block is.
    pub about: String,
    /// The prompt; that of a cycle of the machine builder is his text.
    pub prompt: String,
    /// What was entered so far.
    pub entered: String,
}

/// A list to choose from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List {
    /// The lines of the list, from above.
    pub lines: Vec<String>,
    /// The line that ENT takes.
    pub at: usize,
}

/// What an editor shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct View {
    /// The blocks around the cursor, with those that are being entered.
    pub rows: Vec<Row>,
    /// The words of the current block, or of the block that is being entered.
    pub words: Vec<ShownWord>,
    /// The question of the dialogue, while one is open.
    pub question: Option<Question>,
    /// The list to choose from, while one is open.
    pub list: Option<List>,
    /// The message in the header.
    pub message: Option<MessageId>,
    /// The soft keys; empty where a key does nothing.
    pub soft_keys: [String; 8],
    /// The row of soft keys that is shown, from 0, and how many there are.
    pub soft_row: (usize, usize),
}
