//! How a command ended, and what was wrong with its use.

use std::fmt;

use bahn_host::HostError;
use bahn_ports::PortError;
use bahn_report::ReportError;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// No error.
    Fine,
    /// A program has an error.
    ProgramError,
    /// An option or a file is wrong.
    WrongUse,
    /// Ctrl-C.
    Interrupted,
}

impl Outcome {
    /// The exit code.
    pub(super) fn code(self) -> u8 {
        match self {
            Outcome::Fine => 0,
            Outcome::ProgramError => 1,
            Outcome::WrongUse => 2,
            // As shells count a process ended by SIGINT: 128 + 2.
            Outcome::Interrupted => 130,
        }
    }
}

/// Wrong use: what is wrong with an option or a file, in words for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UsageError(String);

impl UsageError {
    pub(super) fn new(text: impl Into<String>) -> UsageError {
        UsageError(text.into())
    }
}

impl From<HostError> for UsageError {
    fn from(error: HostError) -> UsageError {
        match error {
            HostError::SwitchedOn(_) => {
                UsageError(format!("{error}; --fresh runs beside it without its state"))
            }
            other => UsageError(other.to_string()),
        }
    }
}

/// What does not fit was asked for with an option, which is named.
impl From<ReportError> for UsageError {
    fn from(error: ReportError) -> UsageError {
        let option = match &error {
            ReportError::Host(error) => return error.clone().into(),
            ReportError::Unfit(_) => "",
            ReportError::Workpiece(_) => "--resolution: ",
            ReportError::NoSignal(..) => "--signals ",
            ReportError::OutOfTime(..) => "--from, --to: ",
            ReportError::NoWay(..) => "--xy: ",
        };
        UsageError(format!("{option}{error}"))
    }
}

impl From<PortError> for UsageError {
    fn from(error: PortError) -> UsageError {
        match error {
            PortError::Host(error) => error.into(),
            PortError::NoPrinter(name) => UsageError(format!("--print {name}: give --{name}, too")),
            PortError::Failed(why) => UsageError(why),
        }
    }
}

impl fmt::Display for UsageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
