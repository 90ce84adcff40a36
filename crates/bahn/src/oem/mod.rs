//! `bahn oem`: cycles of the machine builder, and EPROMs with them [000:17691-17984] [000:11388-11412].
//!
//! - `options`: options and help texts;
//! - `list`, `export`, `import`: the subcommands.

mod export;
mod import;
mod list;
mod options;

pub(crate) use options::OemOptions;

use bahn_host::LoadedMachine;

use crate::{Outcome, UsageError, diagnostics};
use options::OemCommand;

/// Executes a subcommand of `bahn oem`.
pub(crate) fn command(options: &OemOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        OemCommand::List(options) => list::command(options),
        OemCommand::Export(options) => export::command(options),
        OemCommand::Import(options) => import::command(options),
    }
}

/// The machine of a folder; `None` when it has faults, which are printed.
fn machine(folder: &std::path::Path) -> Result<Option<LoadedMachine>, UsageError> {
    match LoadedMachine::load(folder)? {
        Ok(machine) => Ok(Some(machine)),
        Err(faults) => {
            diagnostics::print_faults(&faults);
            Ok(None)
        }
    }
}
