//! The labels of one file.

use std::collections::HashMap;

use super::Place;
use crate::PlcError;

/// Labels of a file: LBL, KFIELD, EXTERN and those of structures [000:12008-12009].
const LABELS_MAX: usize = 1000;

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Definition {
    /// An instruction of the file.
    Code(usize),
    /// A constants field of the file.
    Field(usize),
    /// A label of another file.
    Extern,
}

/// How a name is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    Jump,
    Call,
    Case,
    Submit,
    Field,
    Global,
}

#[derive(Debug)]
pub(super) struct Name {
    pub(super) text: String,
    pub(super) definition: Option<(Definition, Place)>,
}

#[derive(Debug)]
pub(super) struct Reference {
    pub(super) name: usize,
    pub(super) usage: Use,
    pub(super) place: Place,
}

/// The names of a file and where they are used.
#[derive(Debug, Default)]
pub(super) struct Labels {
    pub(super) names: Vec<Name>,
    indices: HashMap<String, usize>,
    pub(super) references: Vec<Reference>,
    /// Labels that count against the limit.
    count: usize,
}

impl Labels {
    /// Uses a name; returns its index.
    pub(super) fn refer(&mut self, text: &str, usage: Use, place: Place) -> usize {
        let name = self.index(text);
        self.references.push(Reference { name, usage, place });
        name
    }

    /// Defines a name, unless it is defined already.
    pub(super) fn define(&mut self, text: &str, definition: Definition, place: Place) -> Option<PlcError> {
        self.count += 1;
        if is_internal(text) {
            return Some(PlcError::LabelDefinedTwice);
        }
        let index = self.index(text);
        let name = self.names.get_mut(index)?;
        if name.definition.is_some() {
            return Some(PlcError::LabelDefinedTwice);
        }
        name.definition = Some((definition, place));
        None
    }

    /// Counts the invisible labels of a structure.
    pub(super) fn count_invisible(&mut self, count: usize) {
        self.count += count;
    }

    /// Whether there are more labels than a file may have.
    pub(super) fn too_many(&self) -> bool {
        self.count > LABELS_MAX
    }

    /// What a name stands for.
    pub(super) fn definition(&self, name: usize) -> Option<Definition> {
        self.names.get(name)?.definition.map(|(definition, _)| definition)
    }

    /// The error of a reference, if it has one.
    pub(super) fn check(&self, reference: &Reference) -> Option<PlcError> {
        let definition = self.definition(reference.name);
        match (reference.usage, definition) {
            (_, None) => Some(PlcError::LabelNotDefined),
            (Use::Field, Some(Definition::Field(_))) => None,
            // A name of the other kind does not define the one that is meant (inferred).
            (Use::Field, Some(_)) | (_, Some(Definition::Field(_))) => Some(PlcError::LabelNotDefined),
            (Use::Jump | Use::Submit, Some(Definition::Extern)) => Some(PlcError::ExternInJump),
            (Use::Case, Some(Definition::Extern)) => Some(PlcError::ExternInCase),
            (Use::Global, Some(Definition::Extern)) => Some(PlcError::LabelDefinedTwice),
            (_, Some(Definition::Code(_))) | (Use::Call, Some(Definition::Extern)) => None,
        }
    }

    fn index(&mut self, text: &str) -> usize {
        if let Some(index) = self.indices.get(text) {
            return *index;
        }
        let index = self.names.len();
        self.indices.insert(text.to_owned(), index);
        self.names.push(Name {
            text: text.to_owned(),
            definition: None,
        });
        index
    }
}

/// Whether a name is reserved for internal modules [000:11963-11965].
pub(super) fn is_internal(text: &str) -> bool {
    module_number(text).is_some()
}

/// The number of an internal module.
pub(super) fn module_number(text: &str) -> Option<u16> {
    let number: u16 = text.parse().ok()?;
    crate::syntax::MODULE_NUMBERS
        .contains(&number.into())
        .then_some(number)
}
