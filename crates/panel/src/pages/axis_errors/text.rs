//! The text of such a file: read, written and put into force.

use std::path::Path;

use bahn_control::{CompensationFiles, Renewed};
use bahn_host::{LoadedMachine, decode, files};

use crate::pages::description;
use crate::site::Site;

/// The axes of the tables.
pub(super) const AXES: [&str; 5] = ["X", "Y", "Z", "4", "5"];
/// DATUM and DIST of a new table (inferred).
pub(super) const NEW_HEAD: &str = "MM DATUM 0 DIST 16";

pub(super) fn read(path: &Path) -> Result<String, String> {
    let bytes = files::read_table(path).map_err(|error| error.to_string())?;
    Ok(decode(&bytes))
}

/// Writes a text, and lets it act. One with which the machine could not be switched on again is refused.
pub(super) fn store(path: &Path, text: &str, site: &mut Site) -> Result<(), String> {
    let before = files::read_table(path).map_err(|error| error.to_string())?;
    files::write_whole(path, text.as_bytes()).map_err(|error| error.to_string())?;
    match description::loaded(site) {
        Ok(machine) => {
            act(machine, site);
            Ok(())
        }
        Err(why) => {
            files::write_whole(path, &before).map_err(|error| error.to_string())?;
            Err(why)
        }
    }
}

/// The tables of a machine act from now on.
pub(super) fn act(machine: LoadedMachine, site: &mut Site) {
    let files = CompensationFiles {
        assignment: machine.files.compensation,
        tables: machine.files.compensation_tables,
        correction_tables: machine.files.correction_tables,
    };
    site.host.renew(Renewed::Compensation(Box::new(files)));
}

/// The lines of a text without empty ones, and a text of lines.
pub(super) fn lines(text: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim_end);
    lines.filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

pub(super) fn text_of(lines: &[String]) -> String {
    lines.iter().map(|line| format!("{line}\n")).collect()
}
