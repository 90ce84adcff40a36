//! The folder of a machine.
//!
//! `load`: everything in it, all faults at once, with its `channels`; `compensation`: the tables of axis errors; `equipment`: boards,
//! options, software; `nc_memory` and `tool_files`: its tables; `plc_program`: which one it runs; `programs`: its part programs; `state`:
//! what survives power-off, `remembered` and `mechanics` as files.

mod channel;
mod channels;
mod compensation;
mod equipment;
mod functions;
mod load;
mod macros;
mod mechanics;
mod nc_memory;
mod plc_program;
mod programs;
mod remembered;
mod state;
mod tool_files;

pub use channel::LoadedChannel;
pub use load::LoadedMachine;
pub use programs::FolderPrograms;
pub use remembered::{read as read_remembered, write as write_remembered};
pub use state::{Found, FoundMechanics, State};
pub use tool_files::tools_fit;

use bahn_text::Diagnostic;

/// Reads what a control remembers and writes it again, for fuzzing: `None` when it is damaged, else whether the
/// second reading is the first.
#[doc(hidden)]
pub fn check_state(file: &[u8]) -> Option<bool> {
    let read = remembered::read(file).ok()?;
    Some(remembered::read(remembered::write(&read).as_bytes()).as_ref() == Ok(&read))
}

/// The faults of a datum table whose axes 4 and 5 turn.
pub(crate) fn check_datum_table(text: &str) -> Result<(), Vec<Diagnostic>> {
    let axes = nc_memory::DatumAxes::turning();
    nc_memory::datum_table(text, &axes, nc_memory::LINES_MAX).map(drop)
}

/// The faults of a pallet file.
pub(crate) fn check_pallet_file(text: &str) -> Result<(), Vec<Diagnostic>> {
    nc_memory::pallet_file(text, nc_memory::LINES_MAX).map(drop)
}

/// Reads a text as datum table and as pallet file, for fuzzing: the lines of the faults, 0 is the table as a whole.
#[doc(hidden)]
pub fn check_nc_tables(text: &str) -> [Result<(), Vec<u32>>; 2] {
    let lines = |faults: Vec<Diagnostic>| faults.iter().map(|fault| fault.span.line).collect();
    [
        nc_memory::datum_table(text, &nc_memory::DatumAxes::default(), nc_memory::LINES_MAX)
            .map(drop)
            .map_err(lines),
        nc_memory::pallet_file(text, nc_memory::LINES_MAX)
            .map(drop)
            .map_err(lines),
    ]
}
