//! `bahn machine`: the folder of a machine.
//!
//! `options`, `new`, `check`, `io`, `list`: the subcommands.

mod check;
mod io;
mod list;
mod load;
mod new;
mod options;

pub(crate) use options::MachineFolderOptions;

use crate::{Outcome, UsageError};
use options::MachineCommand;

pub(crate) use load::{load, load_to_enter, load_with_tools};

/// Executes a subcommand of `bahn machine`.
pub(crate) fn command(options: &MachineFolderOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        MachineCommand::New(options) => new::command(options),
        MachineCommand::Check(options) => check::command(options),
        MachineCommand::Io(options) => io::command(options),
        MachineCommand::List(options) => list::command(options),
    }
}
