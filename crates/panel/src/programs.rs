//! The program memory: the part programs of the machine's folder, listed, read, written and protected.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError, RwLock};

use bahn_control::Programs;
use bahn_host::FolderPrograms;
use bahn_host::files::{self, Loaded, NewFile};
use bahn_program::Program;

/// Characters of a name at most [000:6834-6905].
pub(crate) const NAME_MAX: usize = 16;

/// An entry of the directory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    /// Name with its type: `BRACKET.H`.
    pub name: String,
    /// Bytes.
    pub size: u64,
}

/// The program memory, which the control reads and the panel writes.
pub(crate) struct ProgramMemory {
    folder: PathBuf,
    /// Anew whenever a file was written: it keeps what it has read.
    inner: RwLock<FolderPrograms>,
}

impl ProgramMemory {
    /// The programs of a folder.
    pub fn new(folder: &Path) -> ProgramMemory {
        ProgramMemory {
            folder: folder.to_owned(),
            inner: RwLock::new(FolderPrograms::of_folder(folder)),
        }
    }

    /// The files of the memory by name; those that are hidden are not its own.
    pub fn list(&self) -> Vec<Entry> {
        let Ok(entries) = fs::read_dir(&self.folder) else {
            return Vec::new();
        };
        let entry = |entry: fs::DirEntry| {
            let size = entry.metadata().ok().filter(fs::Metadata::is_file)?.len();
            let name = entry.file_name().into_string().ok()?;
            (!name.starts_with('.')).then_some(Entry { name, size })
        };
        let mut entries: Vec<_> = entries.flatten().filter_map(entry).collect();
        entries.sort_by(|one, other| one.name.cmp(&other.name));
        entries
    }

    /// Where a file of the memory lies; `None` for a name that leads out of it or to no plain file's place.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        is_name(name).then(|| self.folder.join(name))
    }

    /// There is a file of this name.
    pub fn has(&self, name: &str) -> bool {
        self.path(name).is_some_and(|path| path.is_file())
    }

    /// A program by its name.
    pub fn read(&self, name: &str) -> Option<Arc<Program>> {
        match files::load_program(&self.path(name)?).ok()? {
            Loaded::Program(program) | Loaded::Empty(program) => Some(program),
            Loaded::TooLarge => None,
        }
    }

    /// The text of any file.
    pub fn text(&self, name: &str) -> Option<String> {
        let bytes = files::read_table(&self.path(name)?).ok()?;
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Writes a file, whole or not at all; the control reads it from now on.
    ///
    /// # Errors
    /// In words.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let path = self.path(name).ok_or_else(|| format!("{name} is no name"))?;
        let write = || {
            let mut file = NewFile::create(&path)?;
            file.write_all(bytes)
                .map_err(|error| files::cannot("write", &path, &error))?;
            file.finish()
        };
        write().map_err(|error| error.to_string())?;
        self.changed();
        Ok(())
    }

    /// Erases a file.
    ///
    /// # Errors
    /// In words.
    pub fn erase(&self, name: &str) -> Result<(), String> {
        let path = self.path(name).ok_or_else(|| format!("{name} is no name"))?;
        fs::remove_file(&path).map_err(|error| format!("{name}: {error}"))?;
        files::sync_folder(&path);
        self.changed();
        Ok(())
    }

    /// Renames a file; what has the new name stays.
    ///
    /// # Errors
    /// In words.
    pub fn rename(&self, old: &str, new: &str) -> Result<(), String> {
        let (Some(from), Some(to)) = (self.path(old), self.path(new)) else {
            return Err(format!("{new} is no name"));
        };
        if to.exists() {
            return Err(format!("{new} is there already"));
        }
        fs::rename(&from, &to).map_err(|error| format!("{old}: {error}"))?;
        files::sync_folder(&to);
        self.changed();
        Ok(())
    }

    fn changed(&self) {
        let mut inner = self.inner.write().unwrap_or_else(PoisonError::into_inner);
        *inner = FolderPrograms::of_folder(&self.folder);
    }
}

/// A file name of the memory: letters, digits and what serial interfaces know, one point, nothing hidden.
pub(crate) fn is_name(name: &str) -> bool {
    let fits = |character: char| character.is_ascii_alphanumeric() || "$_#-.%+".contains(character);
    !name.is_empty() && name.len() <= 64 && !name.starts_with('.') && name.chars().all(fits)
}

impl Programs for ProgramMemory {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let inner = self.inner.read().unwrap_or_else(PoisonError::into_inner);
        inner.open(name, caller)
    }

    fn open_in_eprom(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let inner = self.inner.read().unwrap_or_else(PoisonError::into_inner);
        inner.open_in_eprom(name, caller)
    }

    fn store(&self, name: &str, pieces: &[Arc<[u8]>]) -> Result<(), String> {
        let stored = {
            let inner = self.inner.read().unwrap_or_else(PoisonError::into_inner);
            inner.store(name, pieces)
        };
        self.changed();
        stored
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_nowhere_else() {
        for name in ["1.H", "BRACKET.H", "T_1-A.TCH", "$MDI.H"] {
            assert!(is_name(name), "{name}");
        }
        for name in [
            "", ".H", "..", "../1.H", "a/b.H", "C:1.H", "a\\b", "a b.H", "ä.H", "1.H\0",
        ] {
            assert!(!is_name(name), "{name}");
        }
    }

    #[test]
    fn what_was_written_is_what_the_control_reads() {
        let folder = std::env::temp_dir().join(format!("bahn-panel-memory-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let memory = ProgramMemory::new(&folder);
        let blocks = |memory: &ProgramMemory| {
            let program = memory.open("1", "").unwrap();
            program.map(|program| program.block_count())
        };
        assert_eq!(blocks(&memory), None);
        memory
            .write("1.H", b"BEGIN PGM 1 MM\nSTOP\nEND PGM 1 MM\n")
            .unwrap();
        assert_eq!(blocks(&memory), Some(3));
        memory.write("1.H", b"BEGIN PGM 1 MM\nEND PGM 1 MM\n").unwrap();
        assert_eq!(blocks(&memory), Some(2));
        memory.rename("1.H", "2.H").unwrap();
        assert_eq!((memory.has("1.H"), memory.has("2.H")), (false, true));
        assert!(memory.write("../2.H", b"").is_err());
        memory.erase("2.H").unwrap();
        assert!(memory.list().is_empty());
        fs::remove_dir_all(&folder).unwrap();
    }
}
