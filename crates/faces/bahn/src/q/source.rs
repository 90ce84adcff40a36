//! Data files, alone or of a machine.

use std::path::{Path, PathBuf};

use bahn_system900::DataFile;
use bahn_text::{Diagnostic, Severity, decode, path_below};

use crate::{UsageError, diagnostics, files};

/// A data file and where it is.
pub(super) fn read(path: &Path) -> Result<(DataFile, PathBuf), UsageError> {
    let path = match path.is_dir() {
        true => of_machine(path)?,
        false => path.to_owned(),
    };
    Ok((DataFile::read(&files::read_table(&path)?), path))
}

/// The data file that the description of a machine names.
fn of_machine(folder: &Path) -> Result<PathBuf, UsageError> {
    let description = folder.join("machine.toml");
    let refused = |why: &str| UsageError::new(format!("{}: {why}", description.display()));
    let table: toml::Table = decode(&files::read_description(&description)?)
        .parse()
        .map_err(|error: toml::de::Error| refused(error.message()))?;
    let word = |key: &str| table.get(key).and_then(toml::Value::as_str);
    if word("control") != Some("system900") {
        return Err(refused(
            "it is no machine of a System 900: `control` is not \"system900\"",
        ));
    }
    let file = word("parameters").and_then(path_below);
    let file = file.ok_or_else(|| refused("`parameters` names no data file of the folder"))?;
    Ok(folder.join(file))
}

/// A data file all of whose lines can be read; `None` when its faults have been shown instead.
pub(super) fn readable(path: &Path) -> Result<Option<DataFile>, UsageError> {
    let (file, path) = read(path)?;
    if file.is_readable() {
        return Ok(Some(file));
    }
    let faults = file.faults().iter();
    show(
        faults.filter(|fault| fault.severity == Severity::Error),
        &file,
        &path,
    );
    Ok(None)
}

/// Shows faults with their lines.
pub(super) fn show<'a>(faults: impl Iterator<Item = &'a Diagnostic>, file: &DataFile, path: &Path) {
    let all: Vec<&Diagnostic> = faults.collect();
    let shown = all.iter().take(diagnostics::PRINTED_MAX);
    for fault in shown {
        diagnostics::print_fault(&(*fault).clone().in_text(path, file.text()));
    }
    diagnostics::print_rest(all.len().saturating_sub(diagnostics::PRINTED_MAX));
}
