//! Why a block cannot be executed.

use bahn_system900::SpaceError;

/// Why a block cannot be executed: a message of the control by its number, where the manual has one.
#[derive(Clone, Debug)]
pub(crate) struct Refusal {
    pub number: Option<u16>,
    pub detail: String,
}

impl Refusal {
    /// In words alone.
    pub fn of(detail: impl Into<String>) -> Refusal {
        Refusal {
            number: None,
            detail: detail.into(),
        }
    }

    /// With the number of a message that the manual names.
    pub fn numbered(number: u16, detail: impl Into<String>) -> Refusal {
        Refusal {
            number: Some(number),
            detail: detail.into(),
        }
    }

    /// What the manual names and does not explain, or what this control does not execute yet.
    pub fn not_executed(word: impl std::fmt::Display, why: &str) -> Refusal {
        Refusal::of(format!("{word} is not executed: {why}"))
    }
}

impl From<SpaceError> for Refusal {
    fn from(error: SpaceError) -> Refusal {
        Refusal::of(error.to_string())
    }
}
