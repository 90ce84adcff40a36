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

use crate::columns::TableFault;
use crate::{Outcome, UsageError};
use options::MachineCommand;

/// Reads what a control remembers and writes it again, for fuzzing: `None` when it is damaged, else whether the
/// second reading is the first.
#[doc(hidden)]
pub fn check_state(file: &[u8]) -> Option<bool> {
    let read = remembered::read(file).ok()?;
    Some(remembered::read(remembered::write(&read).as_bytes()).as_ref() == Ok(&read))
}

/// Reads a text as datum table and as pallet file, for fuzzing: the lines of the faults, 0 is the table as a whole.
#[doc(hidden)]
pub fn check_nc_tables(text: &str) -> [Result<(), Vec<u32>>; 2] {
    let lines = |faults: Vec<TableFault>| faults.iter().map(|fault| fault.line).collect();
    [
        nc_memory::datum_table(text, [false; 5]).map(drop).map_err(lines),
        nc_memory::pallet_file(text).map(drop).map_err(lines),
    ]
}

/// Executes a subcommand of `bahn machine`.
pub(crate) fn command(options: &MachineFolderOptions) -> Result<Outcome, UsageError> {
    match &options.command {
        MachineCommand::New(options) => new::command(options),
        MachineCommand::Check(options) => check::command(options),
        MachineCommand::List(options) => list::command(options),
    }
}
