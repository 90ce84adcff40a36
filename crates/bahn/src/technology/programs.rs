//! Programs and subroutines from files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_din::{Program, Shelf};
use bahn_technology::NcPrograms;

use crate::{UsageError, files};

/// The programs of files in turn; a file may hold several.
pub(super) fn read(paths: &[PathBuf]) -> Result<NcPrograms, UsageError> {
    let mut programs = Vec::new();
    let mut folders: Vec<PathBuf> = Vec::new();
    for path in paths {
        let bytes = files::read_program(path)?;
        let bytes = bytes.ok_or_else(|| UsageError::new(format!("{} is too large", path.display())))?;
        programs.push(Arc::new(Program::from_bytes(&file_name(path), &bytes)));
        let parent = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = parent.unwrap_or(Path::new(".")).to_owned();
        if !folders.contains(&folder) {
            folders.push(folder);
        }
    }
    NcPrograms::new(&programs, Arc::new(Folders(folders)))
        .map_err(|fault| UsageError::new(format!("{}: {}", fault.program, fault.message)))
}

/// What a picture is called.
pub(super) fn title(paths: &[PathBuf]) -> String {
    let names: Vec<String> = paths.iter().map(|path| file_name(path)).collect();
    names.join(", ")
}

/// A file as reports call it.
pub(super) fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// The folders of the programs, where their subroutines lie.
struct Folders(Vec<PathBuf>);

impl Shelf for Folders {
    fn text(&self, name: &str) -> Option<(String, Vec<u8>)> {
        let path = self.0.iter().find_map(|folder| find(folder, name))?;
        let bytes = files::read_program(&path).ok()??;
        Some((file_name(&path), bytes))
    }
}

/// The file of a name in a folder, without regard to case if there is none written so. Names lead nowhere else.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    if name.is_empty() || name.contains(['/', '\\', '\0']) || name == ".." {
        return None;
    }
    let path = folder.join(name);
    if path.is_file() {
        return Some(path);
    }
    let entries = std::fs::read_dir(folder).ok()?;
    let mut alike: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.is_file() && file_name(path).eq_ignore_ascii_case(name))
        .collect();
    alike.sort();
    alike.into_iter().next()
}
