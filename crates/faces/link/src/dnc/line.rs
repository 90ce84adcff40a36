//! What the drip feed asks of its two ends.

use std::time::Duration;

/// What has come over a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// Nothing, or not all of a block.
    Nothing,
    /// A block, checked. The other side waits until it is [acknowledged](BlockLine::acknowledge).
    Block(Vec<u8>),
    /// The end of the program; the line is idle again.
    End,
    /// The transfer is broken off; what the control says of that.
    Broken(String),
}

/// The control's side of a protocol that reads a program, block by block.
pub trait BlockLine {
    /// Whether a device is connected.
    fn is_connected(&mut self) -> bool;

    /// Asks the other side for a program by its name without extension.
    fn ask_for(&mut self, name: &str);

    /// Looks at what has come, and waits for it as long as this at most.
    fn look(&mut self, at_most: Duration) -> Arrival;

    /// Looks whether the line is still there while a block waits for room, as long as this at most; what the control says when it
    /// is not.
    fn watch(&mut self, at_most: Duration) -> Option<String>;

    /// The block that came last is taken: the next one may come.
    fn acknowledge(&mut self);

    /// Nothing more is wanted: ends the transfer; the line is idle again.
    fn give_up(&mut self);
}

/// The machine that executes the program.
pub trait Machine {
    /// It has room for more text.
    fn wants_more(&self) -> bool;

    /// The run has come to its end, or was broken off for good: nothing more is needed.
    fn has_ended(&self) -> bool;

    /// Takes text; `false` when it does not.
    fn take(&mut self, text: &[u8]) -> bool;

    /// The program has come whole.
    fn complete(&mut self);

    /// The line is broken.
    fn broken(&mut self);
}
