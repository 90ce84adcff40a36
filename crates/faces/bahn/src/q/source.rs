//! Data files, alone or of a machine.

use std::path::{Path, PathBuf};

use bahn_machine::Folder900;
use bahn_system900::DataFile;
use bahn_text::{Diagnostic, Severity, decode};

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
    let description = folder.join(Folder900::FILE);
    let refused = |why: &str| UsageError::new(format!("{}: {why}", description.display()));
    let text = decode(&files::read_description(&description)?);
    if Folder900::named_at(&text).is_none() {
        return Err(refused(
            "it is no machine of a System 900: `control` is not \"system900\"",
        ));
    }
    // What else is wrong with it says `bahn machine check`.
    let (described, _) = Folder900::read(&text);
    match described.parameters.is_empty() {
        true => Err(refused("`parameters` names no data file of the folder")),
        false => Ok(folder.join(described.parameters)),
    }
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
