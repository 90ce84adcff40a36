//! `bahn table`: tool, pocket, datum, pallet and point tables.
//!
//! - `options`: options and help texts;
//! - `source`: tables from files, and what kind they are;
//! - `show`, `check`, `set`, `convert`: the subcommands.

mod check;
mod convert;
mod options;
mod set;
mod show;
mod source;

pub(crate) use options::TableOptions;

use crate::{Outcome, UsageError};
use options::TableCommand;

/// Executes a subcommand of `bahn table`.
pub(crate) fn command(options: &TableOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        TableCommand::Show(options) => show::command(options),
        TableCommand::Check(options) => check::command(options),
        TableCommand::Set(options) => set::command(options),
        TableCommand::Convert(options) => convert::command(options),
    }
}
