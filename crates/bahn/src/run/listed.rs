//! What a session lists for its report.

use serde::Serialize;

/// A message of the control.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Said {
    pub time_s: f64,
    pub text: String,
    pub place: Option<String>,
    pub flashing: bool,
    /// The program that ran; empty when none did.
    pub program: String,
    pub block: Option<u32>,
}

/// A key that the operator pressed because the run waited for him.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Confirmed {
    pub time_s: f64,
    pub key: String,
    pub why: &'static str,
    pub block: u32,
}

/// An expectation of the script that did not hold.
#[derive(Clone, Debug, Serialize)]
pub(super) struct FailedExpectation {
    pub line: u32,
    pub text: String,
    pub actual: String,
    pub time_s: f64,
}
