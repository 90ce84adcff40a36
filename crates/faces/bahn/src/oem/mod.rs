//! `bahn oem`: cycles of the machine builder, and EPROMs with them [000:17691-17984] [000:11388-11412].
//!
//! - `options`: options and help texts;
//! - `list`, `export`, `import`: the subcommands.

mod export;
mod import;
mod list;
mod machine;
mod options;

pub(crate) use options::OemOptions;

use crate::{Outcome, UsageError};
use options::OemCommand;

use machine::machine;

/// Executes a subcommand of `bahn oem`.
pub(crate) fn command(options: &OemOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        OemCommand::List(options) => list::command(options),
        OemCommand::Export(options) => export::command(options),
        OemCommand::Import(options) => import::command(options),
    }
}
