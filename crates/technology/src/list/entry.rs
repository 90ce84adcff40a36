//! An assignment of a list, and where it stands.

use super::table::Definition;
use crate::synch::Synch;

/// What is wrong or odd in a list, with its place there.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ListFault {
    /// The line, from 1 on.
    pub line: usize,
    /// The column in characters, from 1 on.
    pub column: usize,
    /// How many characters are meant.
    pub length: usize,
    /// What is wrong, in words.
    pub message: String,
    /// What to do about it, where that can be guessed.
    pub help: Option<String>,
}

/// A parameter with its indices.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub(super) definition: &'static Definition,
    pub(super) indices: Vec<u32>,
    /// In the form of a start-up list, of a channel that is not the first.
    pub(super) is_of_other_channel: bool,
}

impl Place {
    pub(super) fn name(&self) -> String {
        self.definition.name_with(&self.indices)
    }
}

/// What stands after a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Value {
    /// A synchronisation type; `None` is `NOT_VALID`.
    Synch(Option<Synch>),
    Number(u32),
    Flag(bool),
    Name(String),
    Functions(Vec<String>),
}

/// A line that could be read.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) place: Place,
    pub(super) value: Value,
    pub(super) line: usize,
    pub(super) name: (usize, usize),
    pub(super) column: usize,
    pub(super) length: usize,
}

impl Entry {
    pub(super) fn at_name(&self, message: String) -> ListFault {
        ListFault {
            line: self.line,
            column: self.name.0,
            length: self.name.1,
            message,
            help: None,
        }
    }

    pub(super) fn at_value(&self, message: String) -> ListFault {
        ListFault {
            line: self.line,
            column: self.column,
            length: self.length,
            message,
            help: None,
        }
    }
}
