//! Why a block is not executed.

use bahn_path::BlockRef;
use bahn_reader::{Cause, Message};

/// What to do about a block that says something wrong.
const CORRECT: &str = "Correct the block; `bahn check` tells all that is wrong in the file.";

/// Why a block cannot be executed.
#[derive(Clone, Debug)]
pub(crate) enum Refusal {
    /// What the block, or a parameter that it uses, says wrongly.
    Wrong(String),
    /// What nothing here executes yet, by its name.
    NotYet(String),
    /// A message that the manual numbers: its number and what it says.
    Numbered(u16, &'static str),
    /// What an earlier block has done wrong, as a later one shows.
    Earlier(BlockRef, Box<Refusal>),
}

impl Refusal {
    /// The same about an earlier block.
    pub fn of(self, block: BlockRef) -> Refusal {
        match self {
            Refusal::Earlier(..) => self,
            other => Refusal::Earlier(block, Box::new(other)),
        }
    }

    /// The block that it is about, where that is another than the one that is executed.
    pub fn block(&self) -> Option<BlockRef> {
        match self {
            Refusal::Earlier(block, _) => Some(*block),
            _ => None,
        }
    }

    /// What is shown, and what it is about. Messages of a TNC are none of this control.
    pub fn said(self) -> (Message, Cause) {
        let (text, cause) = match self {
            Refusal::Earlier(_, refusal) => return refusal.said(),
            Refusal::Wrong(text) => (text, Cause::Written(CORRECT)),
            Refusal::NotYet(what) => (format!("{what} is not executed here"), Cause::default()),
            Refusal::Numbered(number, text) => (format!("M{number} {text}"), Cause::default()),
        };
        (Message::Numbered(text), cause)
    }
}

impl From<bahn_system900::SpaceError> for Refusal {
    fn from(error: bahn_system900::SpaceError) -> Refusal {
        Refusal::Wrong(error.to_string())
    }
}

/// A block that says something wrong.
pub(crate) fn wrong<T>(detail: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal::Wrong(detail.into()))
}
