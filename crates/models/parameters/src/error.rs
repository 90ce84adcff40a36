//! What can be wrong with a machine parameter or a list of them.

use bahn_text::Span;

use crate::ParameterId;

/// What is wrong with one machine parameter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// The line or assignment does not start with a machine parameter.
    #[error("no machine parameter number found")]
    NoNumber,
    /// The control model has no such parameter.
    #[error("{0} is no machine parameter of this control")]
    UnknownNumber(ParameterId),
    /// The parameter has one value for each index, and none is given.
    #[error("{0} needs an index, as {0}.0")]
    IndexMissing(ParameterId),
    /// Something stands after the value that is not a comment.
    #[error("{0}: no separator `;` found before `{1}`")]
    NoSeparator(ParameterId, String),
    /// The value is no number.
    #[error("{0}: `{1}` is no number")]
    NotANumber(ParameterId, String),
    /// The value is outside the parameter's range.
    #[error("{id}: {value} is not between {min} and {max}")]
    OutOfRange {
        /// The parameter that the entry names.
        id: ParameterId,
        /// The value of the entry, in the parameter's unit.
        value: f64,
        /// Least value that its row allows.
        min: f64,
        /// Greatest value that its row allows.
        max: f64,
    },
    /// The value has a fraction, and the parameter takes whole numbers.
    #[error("{0}: {1} is no whole number")]
    NotWhole(ParameterId, f64),
    /// The value lies between those that the parameter takes.
    #[error("{0} takes no {1}")]
    NoChoice(ParameterId, f64),
    /// The value needs more bits than there are.
    #[error("{0}: {1} cannot be stored")]
    NotStorable(ParameterId, f64),
    /// The list does not define a parameter of the model.
    #[error("{0} is not defined")]
    NotDefined(ParameterId),
    /// More parameters are given to the operator than there can be: the 17th of a TNC 151/155 [001:1309-1313].
    #[error("{0}: TOO MANY USER PARAMETERS")]
    TooManyUserParameters(ParameterId),
    /// An option or a later software has the parameter, or its value.
    #[error("{id} = {value} is {why}")]
    Lacking {
        /// The parameter that the entry names.
        id: ParameterId,
        /// The value of the entry, in the parameter's unit.
        value: f64,
        /// What the control lacks.
        why: String,
    },
    /// The list gives the parameter twice; the first value counts.
    #[error("{id} is already defined in line {first_line}")]
    DoublyDefined {
        /// The parameter that has two entries.
        id: ParameterId,
        /// Line of the list, from 1, that defines it first.
        first_line: usize,
    },
}

impl ParameterError {
    /// The number by which the control shows the error in its list editor [000:10054-10062].
    pub fn number(&self) -> u8 {
        match self {
            ParameterError::NoNumber => 0,
            ParameterError::UnknownNumber(_)
            | ParameterError::IndexMissing(_)
            | ParameterError::Lacking { .. } => 1,
            ParameterError::NoSeparator(..) => 2,
            ParameterError::NotANumber(..)
            | ParameterError::OutOfRange { .. }
            | ParameterError::NotWhole(..)
            | ParameterError::NoChoice(..) => 3,
            ParameterError::DoublyDefined { .. } => 4,
            ParameterError::NotDefined(_) => 5,
            ParameterError::NotStorable(..) => 6,
            ParameterError::TooManyUserParameters(_) => 7,
        }
    }

    /// The text that the control shows with [`ParameterError::number`] [000:10056-10062].
    pub fn control_text(&self) -> &'static str {
        const TEXTS: [&str; 8] = [
            "No MP number found",
            "Invalid MP number",
            "No separator \";\" found",
            "Entry value incorrect",
            "MP doubly defined",
            "MP not defined",
            "MP can not be stored",
            "TOO MANY USER PARAMETERS",
        ];
        TEXTS.get(usize::from(self.number())).copied().unwrap_or_default()
    }

    /// The parameter that is meant, when its number could be read.
    pub fn id(&self) -> Option<ParameterId> {
        match *self {
            ParameterError::NoNumber => None,
            ParameterError::UnknownNumber(id)
            | ParameterError::IndexMissing(id)
            | ParameterError::NoSeparator(id, _)
            | ParameterError::NotANumber(id, _)
            | ParameterError::OutOfRange { id, .. }
            | ParameterError::Lacking { id, .. }
            | ParameterError::NotWhole(id, _)
            | ParameterError::NoChoice(id, _)
            | ParameterError::NotStorable(id, _)
            | ParameterError::NotDefined(id)
            | ParameterError::TooManyUserParameters(id)
            | ParameterError::DoublyDefined { id, .. } => Some(id),
        }
    }

    /// The parameter whose value it is that cannot be read; none of a line that names no parameter of the control, or one
    /// that has its value in another line.
    pub fn entry_id(&self) -> Option<ParameterId> {
        match *self {
            ParameterError::NoSeparator(id, _)
            | ParameterError::NotANumber(id, _)
            | ParameterError::OutOfRange { id, .. }
            | ParameterError::Lacking { id, .. }
            | ParameterError::NotWhole(id, _)
            | ParameterError::NoChoice(id, _)
            | ParameterError::NotStorable(id, _) => Some(id),
            ParameterError::NoNumber
            | ParameterError::UnknownNumber(_)
            | ParameterError::IndexMissing(_)
            | ParameterError::NotDefined(_)
            | ParameterError::TooManyUserParameters(_)
            | ParameterError::DoublyDefined { .. } => None,
        }
    }
}

/// An error in the text of a list of machine parameters.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {}: {error}", .span.line)]
pub struct ListError {
    /// Where it stands.
    pub span: Span,
    /// What is wrong there.
    pub error: ParameterError,
}
