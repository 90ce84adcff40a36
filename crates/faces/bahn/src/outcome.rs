//! How a command ended, and what was wrong with its use.

use std::fmt;
use std::path::Path;

use bahn_host::HostError;
use bahn_ports::PortError;
use bahn_report::ReportError;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Everything was done, and nothing is wrong.
    Fine,
    /// A program has an error.
    ProgramError,
    /// An option or a file is wrong.
    WrongUse,
    /// Ctrl-C ended it.
    Interrupted,
}

impl Outcome {
    /// Exit code of the process.
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

    /// Options that mean something to a TNC alone are refused where a folder has a System 900.
    pub(super) fn unless_of_a_tnc(given: &[(&str, bool)], folder: &Path) -> Result<(), UsageError> {
        let given = given.iter().find(|(_, given)| *given);
        given.map_or(Ok(()), |(option, _)| {
            let folder = folder.display();
            Err(UsageError(format!(
                "{option} is for a TNC, and {folder} has a System 900"
            )))
        })
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
            PortError::Service(error) => UsageError(error.to_string()),
            PortError::Failed(why) => UsageError(why),
        }
    }
}

impl fmt::Display for UsageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use bahn_workpiece::WorkpieceError;

    use super::*;

    /// The rooms below know no options; whoever has typed one reads which it was.
    #[test]
    fn what_does_not_fit_is_named_with_its_option() {
        let said = |error: ReportError| UsageError::from(error).to_string();
        assert_eq!(
            said(ReportError::NoSignal(
                "X.speed".to_owned(),
                "X.lag, M2045".to_owned()
            )),
            "--signals X.speed: the recording has no such signal; there are X.lag, M2045"
        );
        assert_eq!(
            said(ReportError::OutOfTime(0.5, 2.25)),
            "--from, --to: the recording runs from 0.5 to 2.25 s"
        );
        assert_eq!(
            said(ReportError::NoWay("X".to_owned(), "2:Y".to_owned())),
            "--xy: the recording has no X.actual and 2:Y.actual"
        );
        let resolution = WorkpieceError::TooFine { finest_mm: 0.01 };
        assert_eq!(
            said(resolution.into()),
            "--resolution: the resolution is too fine for the blank, the finest is 0.0100 mm"
        );
        let taken = HostError::SwitchedOn("mill".to_owned());
        let fresh = "mill: the machine is switched on already; --fresh runs beside it without its state";
        assert_eq!(said(taken.clone().into()), fresh);
        assert_eq!(UsageError::from(PortError::Host(taken)).to_string(), fresh);
        assert_eq!(
            UsageError::from(PortError::NoPrinter("rs422")).to_string(),
            "--print rs422: give --rs422, too"
        );
    }
}
