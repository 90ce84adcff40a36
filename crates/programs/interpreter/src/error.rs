//! A fault before it is known where it stands.

use bahn_parameters::MessageId;
use bahn_path::BlockRef;

pub use bahn_reader::{Cause, Message, ProgramError, Warning, WarningKind};

/// A fault found while executing, before it is known where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub message: Message,
    pub detail: String,
    /// The block that causes it, when that is not the one being executed: errors found by looking
    /// ahead name the block of the contour element that causes them.
    pub block: Option<BlockRef>,
    /// Found by the contour stages: what they hold back can no longer be finished.
    pub ahead: bool,
    pub cause: Cause,
}

impl Fault {
    pub fn new(message: MessageId, detail: impl Into<String>) -> Fault {
        Fault {
            message: Message::Control(message),
            detail: detail.into(),
            block: None,
            ahead: false,
            cause: Cause::Message,
        }
    }

    /// Whether it is this message of the control.
    pub fn is(&self, message: MessageId) -> bool {
        matches!(self.message, Message::Control(id) if id == message)
    }

    /// Says what the fault is about.
    pub fn because(self, cause: Cause) -> Fault {
        Fault { cause, ..self }
    }

    pub fn found_ahead(self) -> Fault {
        Fault { ahead: true, ..self }
    }

    pub fn at(mut self, block: BlockRef) -> Fault {
        self.block.get_or_insert(block);
        self
    }
}

impl From<MessageId> for Fault {
    fn from(message: MessageId) -> Fault {
        Fault::new(message, "")
    }
}
