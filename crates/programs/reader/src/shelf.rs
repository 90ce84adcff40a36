//! Programs that lie in folders: which file a name means.
//!
//! Decision: A name in CALL PGM means a file beside the caller: as it is written, then with `.H`, `.I` and the ending of the
//! caller; one that is written so goes before one in another case. Later controls write folders (`TNC:\PARTS\7.H`): only
//! the name counts. Cycles in the EPROM of the PLC lie in the folder `eprom` beside the programs

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bahn_program::{FILE_TYPES, Program};
use bahn_text::{meant, name_alone};

use crate::programs::Programs;

/// The folder beside the programs with what is in the EPROM of the PLC.
pub const EPROM: &str = "eprom";

/// Folders with programs: on a disk, or as an editor shows them.
pub trait Folders: Send + Sync {
    /// The names of what lies in a folder.
    fn names(&self, folder: &Path) -> Vec<String>;

    /// Whether there is a file.
    fn has(&self, path: &Path) -> bool;

    /// The program of a file; its name is what others find those beside it by.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn load(&self, path: &Path) -> Result<Arc<Program>, String>;
}

/// The file of a folder that a name in the program `caller` means.
pub fn called(
    folders: &(impl Folders + ?Sized),
    folder: &Path,
    name: &str,
    caller: &Path,
) -> Option<PathBuf> {
    let ending = caller.extension().and_then(|ending| ending.to_str());
    let wanted = spellings(name, ending.unwrap_or_default());
    let has = |name: &str| folders.has(&folder.join(name));
    meant(&wanted, has, || folders.names(folder)).map(|name| folder.join(name))
}

/// File names of a called program.
fn spellings(name: &str, callers_ending: &str) -> Vec<String> {
    let Some(name) = name_alone(name.trim()) else {
        return Vec::new();
    };
    let mut names = vec![name.to_owned()];
    names.extend(FILE_TYPES.iter().map(|of| format!("{name}.{}", of.extension)));
    if !callers_ending.is_empty() {
        names.push(format!("{name}.{callers_ending}"));
    }
    names
}

/// The programs of folders, beside those that call them; each is read once.
///
/// ```
/// use std::path::Path;
/// use std::sync::Arc;
/// use bahn_program::Program;
/// use bahn_reader::{Folders, Programs, Shelf};
///
/// /// One folder with one file.
/// struct One;
///
/// impl Folders for One {
///     fn names(&self, _: &Path) -> Vec<String> {
///         vec!["7.H".to_owned()]
///     }
///     fn has(&self, path: &Path) -> bool {
///         path == Path::new("parts/7.H")
///     }
///     fn load(&self, path: &Path) -> Result<Arc<Program>, String> {
///         let name = path.to_string_lossy().into_owned();
///         Ok(Arc::new(Program::from_bytes(name, b"BEGIN PGM 7 MM\nEND PGM 7 MM\n".to_vec())))
///     }
/// }
///
/// let shelf = Shelf::new(One);
/// for name in ["7", "7.h", "TNC:\\7.H"] {
///     let found = shelf.open(name, "parts/1.H")?;
///     assert_eq!(found.map(|program| program.name().to_owned()).as_deref(), Some("parts/7.H"));
/// }
/// assert!(shelf.open("8", "parts/1.H")?.is_none());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Default)]
pub struct Shelf<F> {
    folders: F,
    known: Mutex<Known>,
}

/// What was read and found before.
#[derive(Debug, Default)]
struct Known {
    /// By path, so that one file is one program whatever its name was written like.
    programs: HashMap<PathBuf, Arc<Program>>,
    /// What a name in a folder, in a caller, led to.
    found: HashMap<(PathBuf, String), Arc<Program>>,
}

impl<F: Folders> Shelf<F> {
    /// The programs of folders.
    pub fn new(folders: F) -> Shelf<F> {
        Shelf {
            folders,
            known: Mutex::default(),
        }
    }

    /// The same, with a main program that was read already.
    pub fn with_main(folders: F, main: &Arc<Program>) -> Shelf<F> {
        let shelf = Shelf::new(folders);
        let path = PathBuf::from(main.name());
        shelf.known().programs.insert(path, Arc::clone(main));
        shelf
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn find(&self, folder: &Path, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let key = (folder.join(name), caller.to_owned());
        let mut known = self.known();
        if let Some(program) = known.found.get(&key) {
            return Ok(Some(Arc::clone(program)));
        }
        let Some(path) = called(&self.folders, folder, name, Path::new(caller)) else {
            return Ok(None);
        };
        let program = match known.programs.get(&path) {
            Some(program) => Arc::clone(program),
            None => self.folders.load(&path)?,
        };
        known.programs.insert(path, Arc::clone(&program));
        known.found.insert(key, Arc::clone(&program));
        Ok(Some(program))
    }
}

impl<F: Folders> Programs for Shelf<F> {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.find(memory_of(caller), name, caller)
    }

    fn open_in_eprom(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        self.find(&memory_of(caller).join(EPROM), name, caller)
    }
}

/// The folder of the programs beside a caller, which may itself be in the EPROM.
fn memory_of(caller: &str) -> &Path {
    let folder = Path::new(caller).parent().unwrap_or(Path::new(""));
    match folder.file_name().is_some_and(|name| name == EPROM) {
        true => folder.parent().unwrap_or(Path::new("")),
        false => folder,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn called_names_get_endings_and_lose_folders() {
        assert_eq!(spellings("7", ""), ["7", "7.H", "7.I"]);
        assert_eq!(spellings("7", "nc"), ["7", "7.H", "7.I", "7.nc"]);
        assert_eq!(spellings(r"TNC:\PARTS\7.H", ""), ["7.H", "7.H.H", "7.H.I"]);
        assert!(spellings("..", "H").is_empty() && spellings("/", "").is_empty());
    }
}
