//! `bahn machine`: the folder of a machine.
//!
//! - `load`: everything in it, all faults at once; `nc_memory`: its tables; `programs`: its part programs; `state`: what survives
//!   power-off, `remembered` as a file;
//! - `options`, `new`, `check`, `list`: the subcommands.

mod check;
mod list;
mod load;
mod nc_memory;
mod new;
mod options;
mod programs;
mod remembered;
mod state;

pub(crate) use load::{LoadedMachine, decode, load};
pub(crate) use options::MachineFolderOptions;
pub(crate) use programs::FolderPrograms;
pub(crate) use state::State;

use crate::{Outcome, UsageError};
use options::MachineCommand;

/// Reads what a control remembers and writes it again, for fuzzing: `None` when it is damaged, else whether the
/// second reading is the first.
#[doc(hidden)]
pub fn check_state(file: &[u8]) -> Option<bool> {
    let read = remembered::read(file).ok()?;
    Some(remembered::read(remembered::write(&read).as_bytes()).as_ref() == Ok(&read))
}

/// Executes a subcommand of `bahn machine`.
pub(crate) fn command(options: &MachineFolderOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        MachineCommand::New(options) => new::command(options),
        MachineCommand::Check(options) => check::command(options),
        MachineCommand::List(options) => list::command(options),
    }
}
