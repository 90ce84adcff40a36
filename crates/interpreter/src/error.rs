//! What ends a run and what is only worth saying.

use bahn_parameters::{ControlModel, MessageId};
use bahn_path::BlockRef;

/// An error of the program, with the control's message and the block that causes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramError {
    /// The message.
    pub message: Message,
    /// Name of the program.
    pub program: String,
    /// The block.
    pub block: BlockRef,
    /// What exactly, in a few words; may be empty.
    pub detail: String,
}

/// What the control shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// A message of the control.
    Control(MessageId),
    /// The text of an FN14 number: `ERROR 12`, `PLC ERROR 05` ... [003:4364-4367].
    Numbered(String),
}

impl Message {
    /// The text on the screen of a model.
    pub fn text(&self, model: ControlModel) -> &str {
        match self {
            Message::Control(id) => id.text(model),
            Message::Numbered(text) => text,
        }
    }
}

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
}

impl Fault {
    pub fn new(message: MessageId, detail: impl Into<String>) -> Fault {
        Fault {
            message: Message::Control(message),
            detail: detail.into(),
            block: None,
            ahead: false,
        }
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

/// Something that does not stop the run but that the user should know.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Warning {
    /// The block.
    pub block: BlockRef,
    /// What.
    pub kind: WarningKind,
    /// How often it came up since it was last taken.
    pub count: u64,
}

/// Kinds of warnings of the interpreter.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum WarningKind {
    /// A cycle whose setup clearance or pecking depth has another sign than its depth [003:4902].
    CycleSign {
        /// Cycle number.
        cycle: u16,
    },
    /// A tool is called that is neither defined nor in a table; length and radius 0 are taken.
    ToolNotDefined {
        /// Tool number.
        tool: u32,
    },
    /// BLK FORM 0.1 stands without 0.2: there is no blank.
    BlankIncomplete,
    /// A blank was given in a called program only [003:7908-7912].
    BlankInCalledProgram,
    /// M2 or M30 stands in a called program, where it must not [003:3870-3902].
    EndInCalledProgram,
    /// A function that has no effect here, or only part of it.
    Function {
        /// Which, and what is missing.
        text: String,
    },
    /// What nothing here knows, or what would move differently on the control, was passed over as wanted:
    /// [`Settings::skip_unknown`](crate::Settings::skip_unknown).
    PassedOver {
        /// The words, or the function and why.
        what: String,
    },
}

impl std::fmt::Display for WarningKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            WarningKind::CycleSign { cycle } => {
                write!(
                    f,
                    "cycle {cycle}: setup clearance or pecking depth has another sign than the depth"
                )
            }
            WarningKind::ToolNotDefined { tool } => {
                write!(f, "tool {tool} is not defined: length 0 and radius 0 are taken")
            }
            WarningKind::Function { text } => f.write_str(text),
            WarningKind::PassedOver { what } => write!(f, "passed over: {what}"),
            WarningKind::BlankIncomplete => write!(f, "BLK FORM 0.2 is missing: there is no blank"),
            WarningKind::BlankInCalledProgram => {
                write!(
                    f,
                    "BLK FORM stands in a called program only; give it in the main program"
                )
            }
            WarningKind::EndInCalledProgram => {
                write!(
                    f,
                    "a called program must not contain M2 or M30: the whole run ends here"
                )
            }
        }
    }
}
