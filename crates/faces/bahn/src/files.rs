//! Files of the command line: outputs replace no input. How files are read and written is the host's.
//!
//! Decision: An output replaces no program, list, table, description or memory, whoever reads it; one that cannot be
//! written ends a run with its report (also `bahn/src/run/mod.rs`)

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

pub(crate) use bahn_host::files::*;

use crate::{UsageError, console};

/// Endings of files that commands read and none of these options writes: programs, PLC programs, lists and
/// descriptions of machines, tables of tools, pallets, datums and compensation, memories.
const KEPT: [&str; 14] = [
    "h", "i", "nc", "900", "plc", "mp", "q", "toml", "tsv", "p", "d", "cma", "com", "mem",
];

/// Refuses outputs, given with their options, that would overwrite an input or each other, or a file of a kind
/// that the command may read under way, as a program that another one calls.
pub(crate) fn keep_inputs(inputs: &[&Path], outputs: &[(&str, &Path)]) -> Result<(), UsageError> {
    let mut taken: Vec<(PathBuf, &str)> = inputs
        .iter()
        .filter_map(|path| Some((regular(path)?, "an input")))
        .collect();
    for (option, path) in outputs {
        let Some(file) = regular(path) else { continue };
        if let Some((_, by)) = taken.iter().find(|(other, _)| *other == file) {
            return Err(UsageError::new(format!(
                "{option} {}: this file is already {by} of the command",
                path.display()
            )));
        }
        if KEPT.contains(&extension(&file).as_str()) && file.exists() {
            return Err(UsageError::new(format!(
                "{option} {}: an output does not replace a file of this kind",
                path.display()
            )));
        }
        taken.push((file, "an output"));
    }
    Ok(())
}

/// Writes a text to a file, which is replaced only with `--force`; without a file to standard output. Whether it went
/// into a file.
pub(crate) fn write_or_print(text: &str, output: Option<&Path>, force: bool) -> Result<bool, UsageError> {
    let Some(path) = output else {
        console::print_bytes(text.as_bytes())?;
        return Ok(false);
    };
    if path.is_file() && !force {
        return Err(UsageError::new(format!(
            "{} is there already; --force replaces it",
            path.display()
        )));
    }
    let mut file = NewFile::create(path)?;
    file.write_all(text.as_bytes())
        .map_err(|error| cannot("write", path, &error))?;
    file.finish()?;
    Ok(true)
}

/// What a path leads to, by its real name; `None` for what is there but no regular file, as `/dev/stdout`.
fn regular(path: &Path) -> Option<PathBuf> {
    match fs::metadata(path) {
        Ok(there) if !there.is_file() => None,
        Ok(_) => fs::canonicalize(path).ok(),
        Err(_) => {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            let folder = fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
            Some(folder.join(path.file_name()?))
        }
    }
}

/// What a name ends with after its last dot, in small letters; empty without one.
pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}
