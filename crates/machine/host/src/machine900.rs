//! Everything that belongs to a machine with a System 900, from its folder; all faults of all files at once.

use std::path::{Path, PathBuf};

use bahn_machine::Folder900;
use bahn_system900::{Checked, DataFile, check};
use bahn_text::{Diagnostic, Severity, Span, decode};

use crate::{HostError, files};

/// A machine with a System 900.
pub struct Machine900 {
    /// The folder.
    pub root: PathBuf,
    /// What `machine.toml` says.
    pub folder: Folder900,
    /// Its parameters.
    pub parameters: DataFile,
    /// The channels with their axes, and what of the parameters looks wrong.
    pub checked: Checked,
}

impl Machine900 {
    /// Whether a folder describes a machine of this family.
    pub fn is_meant(root: &Path) -> bool {
        let bytes = files::read_description(&root.join(Folder900::FILE));
        bytes.is_ok_and(|bytes| Folder900::named_at(&decode(&bytes)).is_some())
    }

    /// Loads the machine of a folder; the inner `Err` holds every fault of every file.
    ///
    /// # Errors
    /// When there is no such folder or no `machine.toml` in it.
    pub fn load(root: &Path) -> Result<Result<Machine900, Vec<Diagnostic>>, HostError> {
        let file = root.join(Folder900::FILE);
        let text = decode(&files::read_description(&file)?);
        let (folder, faults) = Folder900::read(&text);
        let mut faults: Vec<Diagnostic> = faults
            .into_iter()
            .map(|fault| fault.in_text(&file, &text))
            .collect();
        if folder.parameters.is_empty() {
            return Ok(Err(faults));
        }
        let data = root.join(&folder.parameters);
        let parameters = match files::read_table(&data) {
            Ok(bytes) => DataFile::read(&bytes),
            Err(error) => {
                faults.push(Diagnostic::error(Span::default(), error.to_string()).at(&data, ""));
                return Ok(Err(faults));
            }
        };
        let checked = check(&parameters);
        let errors = checked.errors().cloned();
        faults.extend(errors.map(|fault| fault.in_text(&data, parameters.text())));
        match faults.is_empty() {
            true => Ok(Ok(Machine900 {
                root: root.to_owned(),
                folder,
                parameters,
                checked,
            })),
            false => Ok(Err(faults)),
        }
    }

    /// The folder of its part programs and cycles.
    pub fn programs(&self) -> PathBuf {
        self.root.join(&self.folder.programs)
    }

    /// What is accepted, but looks wrong.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        let data = self.root.join(&self.folder.parameters);
        let all = self.checked.faults.iter();
        let warnings = all.filter(|fault| fault.severity != Severity::Error).cloned();
        let text = self.parameters.text();
        warnings.map(|fault| fault.in_text(&data, text)).collect()
    }
}
