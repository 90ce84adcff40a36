//! `bahn mp`: machine parameters.
//!
//! - `options`: options and help texts;
//! - `source`: lists from files, and for which control they are;
//! - `check`, `list`, `explain`, `diff`, `new`: the subcommands.

mod check;
mod diff;
mod explain;
mod list;
mod new;
mod options;
mod source;

pub(crate) use options::MpOptions;

use crate::{Outcome, UsageError};
use options::MpCommand;

/// Executes a subcommand of `bahn mp`.
pub(crate) fn command(options: &MpOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        MpCommand::Check(options) => check::command(options),
        MpCommand::List(options) => list::command(options),
        MpCommand::Explain(options) => explain::command(options),
        MpCommand::Diff(options) => diff::command(options),
        MpCommand::New(options) => new::command(options),
    }
}
