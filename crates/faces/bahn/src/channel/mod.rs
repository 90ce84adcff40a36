//! `bahn channel`: channel parameter lists.
//!
//! - `options`: options and help texts;
//! - `faults`: what is wrong with a list, for people and for programs;
//! - `check`, `explain`, `new`: the subcommands.

mod check;
mod explain;
mod faults;
mod new;
mod options;

pub(crate) use faults::{Report, faults};
pub(crate) use options::ChannelOptions;

use crate::{Outcome, UsageError};
use options::ChannelCommand;

/// Executes a subcommand of `bahn channel`.
pub(crate) fn command(options: &ChannelOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        ChannelCommand::Check(options) => check::command(options),
        ChannelCommand::Explain(options) => explain::command(options),
        ChannelCommand::New(options) => new::command(options),
    }
}
