//! What keeps a report from being made.

use bahn_host::HostError;
use bahn_workpiece::WorkpieceError;

/// Why something cannot be run, read, drawn or written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReportError {
    /// The machine or a file.
    #[error(transparent)]
    Host(#[from] HostError),
    /// The resolution that is wanted does not fit the blank.
    #[error(transparent)]
    Workpiece(#[from] WorkpieceError),
    /// A recording has no signal of this name; those that it has.
    #[error("{0}: the recording has no such signal; there are {1}")]
    NoSignal(String, String),
    /// No sample lies in the time that was asked for; first and last time of the recording, s.
    #[error("the recording runs from {0} to {1} s")]
    OutOfTime(f64, f64),
    /// A recording does not have the way of these two axes.
    #[error("the recording has no {0}.actual and {1}.actual")]
    NoWay(String, String),
    /// What was asked for, in words.
    #[error("{0}")]
    Unfit(String),
}

impl ReportError {
    /// What was asked for cannot be done; why, in words.
    pub fn new(text: impl Into<String>) -> ReportError {
        ReportError::Unfit(text.into())
    }
}
