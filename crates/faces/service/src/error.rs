//! Why something is not done.

use bahn_panel::Refusal;
use bahn_store::StoreError;

/// Why something is not done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ServiceError {
    /// Who asks may look, and nothing else.
    #[error("this token is for looking, not for operating")]
    OnlyLooks,
    /// The control refuses it, with its reason; so does a machine that has ended, or for which too many wait.
    #[error("{0}")]
    Refused(String),
    /// The keyboard has no such key.
    #[error("{0} is no key")]
    NoKey(String),
    /// There is no machine parameter of this number and index.
    #[error("there is no machine parameter {0}.{1}")]
    NoParameter(u16, u8),
    /// A machine parameter or an operand does not take the value.
    #[error("{0}")]
    BadValue(String),
    /// Something of a file.
    #[error(transparent)]
    File(#[from] StoreError),
    /// The medium does not take it.
    #[error("{0}")]
    NotWritten(String),
}

impl From<Refusal> for ServiceError {
    fn from(refusal: Refusal) -> ServiceError {
        ServiceError::Refused(refusal.0)
    }
}
