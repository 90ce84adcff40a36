//! An assignment of a list, and where it stands.

use bahn_text::{Diagnostic, Span};

use super::table::Definition;
use crate::synch::Synch;

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
    /// Where its name stands.
    pub(super) name: Span,
    /// Where its value stands.
    pub(super) at: Span,
}

impl Entry {
    pub(super) fn at_name(&self, message: String) -> Diagnostic {
        Diagnostic::warning(self.name, message)
    }

    pub(super) fn at_value(&self, message: String) -> Diagnostic {
        Diagnostic::warning(self.at, message)
    }
}
