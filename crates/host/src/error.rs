//! What cannot be done, and why.

use thiserror::Error;

/// Why something cannot be done.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum HostError {
    /// The folder of a state that another process has.
    #[error("{0}: the machine is switched on already")]
    SwitchedOn(String),
    /// A file cannot be read, written or used; which one and why.
    #[error("{0}")]
    File(String),
}

impl HostError {
    /// A file cannot be used; in words.
    pub(crate) fn new(text: impl Into<String>) -> HostError {
        HostError::File(text.into())
    }
}
