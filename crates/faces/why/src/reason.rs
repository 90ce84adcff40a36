//! Why a machine waits.

use serde::Serialize;

/// How much a reason matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Urgency {
    /// Something does not go on, and nothing is done about it.
    Stands,
    /// Something waits for the operator or for the PLC.
    Waits,
    /// It is so, and nothing waits for it.
    Reported,
}

/// Why something is as it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reason {
    /// How much it matters.
    pub urgency: Urgency,
    /// What is missing, in words, and who gives it.
    pub text: String,
    /// The marker, input or word that is missing, as `M2451`.
    pub marker: Option<String>,
    /// The machine parameter that says so, as `MP1340`.
    pub parameter: Option<String>,
    /// The lines of the PLC program that write the marker, as `MAIN.PLC:42`.
    pub lines: Vec<String>,
    /// What in the PLC program keeps it from being so, in words.
    pub causes: Vec<String>,
}
