//! The FLASH of a System 900 in the folder of its state, and its functions on parameters and on the programs of the folder
//! [002:403-534].
//!
//! Decision: The FLASH is a file of its own in the state folder, written whole after each function that changes it; a
//! control that keeps nothing has an empty one. A function that is refused is a message that is shown

use std::fs;
use std::path::{Path, PathBuf};

use bahn_control900::Control900;
use bahn_system900::{Flash, ProgramName, Programs};

use super::programs::Programs900;
use crate::error::HostError;
use crate::files;

/// Its file in the state folder.
const FILE: &str = "flash";

/// The FLASH, and where it is kept.
#[derive(Debug, Default)]
pub struct Flash900 {
    flash: Flash,
    /// `None` keeps it as long as the control is on.
    path: Option<PathBuf>,
}

impl Flash900 {
    /// That of a state folder; an empty one where there is none.
    ///
    /// # Errors
    /// When its file cannot be read, or is damaged: nothing of it is lost by going on without it.
    pub fn open(folder: &Path) -> Result<Flash900, HostError> {
        let path = folder.join(FILE);
        let flash = match path.exists() {
            true => Flash::read(&files::read_table(&path)?).map_err(|error| {
                HostError::new(format!(
                    "{}: {error}; put the file away, and the FLASH is empty",
                    path.display()
                ))
            })?,
            false => Flash::default(),
        };
        Ok(Flash900 {
            flash,
            path: Some(path),
        })
    }

    /// Executes a function of q10 on a control and the programs of its folder; whether it brought programs.
    ///
    /// # Errors
    /// When a file cannot be read or written; what the control refuses, it says itself.
    pub fn run(
        &mut self,
        number: i64,
        control: &mut Control900,
        of: &Programs900,
    ) -> Result<bool, HostError> {
        let before = programs(of.folder())?;
        let mut programs = before.clone();
        if control.execute(number, &mut self.flash, &mut programs).is_err() {
            return Ok(false);
        }
        for (name, bytes) in programs.iter() {
            if before.get(name) != Some(bytes) {
                files::write_whole(&of.folder().join(format!("{name}.900")), bytes)?;
            }
        }
        if let Some(path) = &self.path {
            files::write_whole(path, &self.flash.bytes())?;
        }
        Ok(programs != before)
    }
}

/// The NC memory: programs and cycles of a folder.
fn programs(folder: &Path) -> Result<Programs, HostError> {
    let mut programs = Programs::default();
    // Without a folder there are no programs.
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        let is_program = path.extension().is_some_and(|extension| extension == "900");
        let name = path.file_name().map(|name| name.to_string_lossy());
        let name = name.as_deref().and_then(ProgramName::of_file);
        if let (Some(name), Some(bytes)) = (name.filter(|_| is_program), files::read_program(&path)?) {
            programs.insert(name, bytes);
        }
    }
    Ok(programs)
}
