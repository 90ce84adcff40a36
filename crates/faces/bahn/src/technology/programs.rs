//! Programs and subroutines from files.
//!
//! Decision: Subroutines of the `.nc` programs of a run lie in the folder of any of them, or below

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use bahn_din::Program;
use bahn_technology::NcPrograms;
use bahn_text::{Files, NamedFile};

use crate::files::NcFolder;
use crate::{UsageError, files};

/// The programs of a run, and the files that they stand in.
pub(super) struct Sources {
    pub programs: NcPrograms,
    pub files: Vec<(PathBuf, Arc<Program>)>,
}

/// The programs of files in turn; a file may hold several.
pub(super) fn read(paths: &[PathBuf]) -> Result<Sources, UsageError> {
    let mut programs = Vec::new();
    for path in paths {
        let bytes = files::read_program(path)?;
        let bytes = bytes.ok_or_else(|| UsageError::new(format!("{} is too large", path.display())))?;
        programs.push(Arc::new(Program::from_bytes(&file_name(path), &bytes)));
    }
    let files = paths.iter().cloned().zip(programs.iter().cloned()).collect();
    let programs = NcPrograms::new(&programs, Arc::new(Folders::of(paths.iter())))
        .map_err(|fault| UsageError::new(format!("{}: {}", fault.program, fault.message)))?;
    Ok(Sources { programs, files })
}

impl Sources {
    /// Functions that the programs give types: `M5` for `V.G.M_FCT[5].SYNCH`.
    pub fn typed(&self) -> BTreeSet<String> {
        let beside: Arc<dyn Files> = Arc::new(Folders::of(self.files.iter().map(|(path, _)| path)));
        let values = self.files.iter().flat_map(|(_, program)| {
            let examined = bahn_din::examine(program, &beside, &AtomicBool::new(false));
            examined.values.into_keys()
        });
        let of = |name: String| {
            let (letter, rest) = name.strip_prefix("V.G.")?.split_once("_FCT[")?;
            let number = rest.strip_suffix("].SYNCH")?;
            Some(format!("{letter}{number}"))
        };
        values.filter_map(of).collect()
    }

    /// The file that reports call so: one of the run, or a subroutine beside one.
    pub fn file(&self, name: &str) -> Option<(PathBuf, Arc<Program>)> {
        let mut files = self.files.iter();
        if let Some((path, program)) = files.find(|(_, program)| &**program.name() == name) {
            return Some((path.clone(), program.clone()));
        }
        let mut folders = self.files.iter().filter_map(|(path, _)| path.parent());
        let path = folders.find_map(|folder| Some(folder.join(files::below(folder, name)?)))?;
        let bytes = files::read_program(&path).ok()??;
        let program = Arc::new(Program::from_bytes(name, &bytes));
        Some((path, program))
    }
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
struct Folders(Vec<NcFolder>);

impl Folders {
    fn of<'a>(programs: impl Iterator<Item = &'a PathBuf>) -> Folders {
        Folders(programs.map(|path| NcFolder::of(path)).collect())
    }
}

impl Files for Folders {
    fn read(&self, name: &str) -> Option<NamedFile> {
        self.0.iter().find_map(|folder| folder.read(name))
    }
}
