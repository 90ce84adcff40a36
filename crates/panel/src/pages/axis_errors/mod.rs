//! The files of non-linear axis errors: compensation tables (.COM), their assignment (.CMA), and the correction tables of
//! code number 105 296 [000:3768-3896]. What is entered is checked, on the medium at once, and acts at once as far as the
//! file is in use.

mod assignment;
mod corrections;
mod head;
mod table;

use std::path::Path;

use bahn_control::{CompensationFiles, Renewed};
use bahn_host::{LoadedMachine, decode, files};

use crate::page::Turn;
use crate::pages::description;
use crate::site::Site;

pub(crate) use corrections::open as corrections;

/// The axes of the tables.
const AXES: [&str; 5] = ["X", "Y", "Z", "4", "5"];
/// DATUM and DIST of a new table (inferred).
const NEW_HEAD: &str = "MM DATUM 0 DIST 16";

/// The editor of a file of the PLC's folder, where its type has one.
pub(crate) fn editor(name: &str, path: &Path) -> Option<Result<Turn, String>> {
    let (_, ending) = name.rsplit_once('.')?;
    match ending.to_uppercase().as_str() {
        "COM" => Some(table::open(name, path)),
        "CMA" => Some(assignment::open(name, path)),
        _ => None,
    }
}

/// What a new file of a type begins with.
pub(crate) fn new_file(name: &str) -> String {
    match name.rsplit_once('.') {
        Some((stem, ending)) if ending.eq_ignore_ascii_case("COM") => format!("{stem} {NEW_HEAD}\n"),
        Some((_, ending)) if ending.eq_ignore_ascii_case("CMA") => "0\n".to_owned(),
        _ => String::new(),
    }
}

fn read(path: &Path) -> Result<String, String> {
    let bytes = files::read_table(path).map_err(|error| error.to_string())?;
    Ok(decode(&bytes))
}

/// Writes a text, and lets it act. One with which the machine could not be switched on again is refused.
fn store(path: &Path, text: &str, site: &mut Site) -> Result<(), String> {
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
fn act(machine: LoadedMachine, site: &mut Site) {
    let files = CompensationFiles {
        assignment: machine.files.compensation,
        tables: machine.files.compensation_tables,
        correction_tables: machine.files.correction_tables,
    };
    site.host.renew(Renewed::Compensation(Box::new(files)));
}

/// The lines of a text without empty ones, and a text of lines.
fn lines(text: &str) -> Vec<String> {
    let lines = text.lines().map(str::trim_end);
    lines.filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

fn text_of(lines: &[String]) -> String {
    lines.iter().map(|line| format!("{line}\n")).collect()
}
