//! A tool table for a machine that should have one, but has no file of it.
//!
//! Decision: Where MP7260 is not 0 and machine.toml names no tool table, TOOL TABLE makes TOOL.T with the tools 0 to
//! MP7260 without sizes; it counts from the next power-on

use bahn_host::files;

use super::place::TOOLS;
use crate::pages::description;
use crate::site::Site;

/// The name of its file in the machine's folder (inferred).
const NEW: &str = "TOOL.T";

/// The tools 0 to MP7260 without sizes [000:9103]. They can be called from the next power-on: until then tools come from TOOL
/// DEF (inferred).
///
/// # Errors
/// In words: the medium or `machine.toml` does not take it.
pub(super) fn make(site: &mut Site) -> Result<(), String> {
    let path = site.machine.root.join(NEW);
    if !path.exists() {
        let most = site.parameters().operation_parameters().tools.table_size;
        let lines: String = (0..=most).map(|tool| format!("{tool}\t0\t0\n")).collect();
        files::write_whole(&path, format!("T\tL\tR\n{lines}").as_bytes())
            .map_err(|error| error.to_string())?;
    }
    description::set(TOOLS, NEW, site)?;
    site.programs.was_written();
    Ok(())
}
