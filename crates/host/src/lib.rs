//! The host: a machine from its folder, and what it keeps on the medium.
//!
//! - [`LoadedMachine`] is everything in the folder of a machine, with all faults of all files at once
//!   ([`FileFault`]);
//! - [`State`] is what survives power-off: it is on the medium before the control goes on;
//! - [`FolderPrograms`] are the part programs of a machine;
//! - [`files`] reads programs and tables and writes files that are whole or not there; [`lists`] and
//!   [`PlcSource`] say where in a file of machine parameters or of a PLC program a fault is.
//!
//! Nothing is printed here: what there is to be said is data, its words are the caller's.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]

mod called;
mod columns;
mod error;
mod fault;
pub mod files;
mod kept;
pub mod lists;
mod machine_folder;
mod plc_source;
mod retained;
pub mod tool_table;

pub use columns::TableFault;
pub use error::HostError;
pub use fault::{FileFault, Marked, Severity};
pub use machine_folder::{FolderPrograms, Found, LoadedMachine, State, decode};
/// Reads a tool table, for fuzzing; errors name their lines, 0 is the table as a whole.
#[doc(hidden)]
pub fn check_tool_table(text: &str) -> Result<(), Vec<u32>> {
    let faults = |faults: Vec<TableFault>| faults.iter().map(|fault| fault.line).collect();
    tool_table::parse(text).map(drop).map_err(faults)
}

#[doc(hidden)]
pub use machine_folder::{check_nc_tables, check_state};
pub use plc_source::PlcSource;
pub use retained::Retained;
