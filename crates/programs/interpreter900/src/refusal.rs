//! Why a block is not executed.

use bahn_parameters::MessageId;
use bahn_reader::{Cause, Message};

/// What to do about a text that is wrong.
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
}

impl Refusal {
    /// What the control shows, what exactly, and what it is about.
    pub fn said(self) -> (Message, String, Cause) {
        match self {
            Refusal::Wrong(detail) => (
                Message::Control(MessageId::WrongProgramData),
                detail,
                Cause::Written(CORRECT),
            ),
            Refusal::NotYet(what) => (
                Message::Control(MessageId::BlockNotSupported),
                format!("{what} is not executed here"),
                Cause::default(),
            ),
            Refusal::Numbered(number, text) => (
                Message::Numbered(format!("M{number} {text}")),
                String::new(),
                Cause::default(),
            ),
        }
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
