//! The program memory: the part programs of the machine's folder, listed, read, written and protected.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError, RwLock};

use bahn_host::FolderPrograms;
use bahn_host::files::{self, Loaded, NewFile};
use bahn_parameters::MessageId;
use bahn_program::{Edit, Program};
use bahn_reader::{Reader, Start};
use bahn_tnc::Programs;

use crate::frames;

/// Characters of a name at most [000:6834-6905].
pub const NAME_MAX: usize = 16;

/// An entry of the directory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name with its type: `BRACKET.H`.
    pub name: String,
    /// Size of the file, bytes.
    pub size: u64,
    /// `P`: a program that is protected against erasing and editing [003:1015-1023].
    pub protected: bool,
}

/// The program memory, which the control reads and the panel writes.
pub struct ProgramMemory {
    folder: PathBuf,
    /// Anew whenever a file was written: it keeps what it has read.
    inner: RwLock<FolderPrograms>,
    /// Grows with each change that a list must show.
    version: AtomicU64,
}

/// Why the memory does not do something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Denial {
    /// A message of the control.
    Message(MessageId),
    /// In words: the medium does not do it.
    Words(String),
}

impl ProgramMemory {
    /// The programs that lie in a folder now.
    pub fn new(folder: &Path) -> ProgramMemory {
        ProgramMemory {
            folder: folder.to_owned(),
            inner: RwLock::new(FolderPrograms::of_folder(folder)),
            version: AtomicU64::new(0),
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
            let protected = is_program(&name) && files::is_protected_program(&self.folder.join(&name));
            (!name.starts_with('.')).then_some(Entry {
                name,
                size,
                protected,
            })
        };
        let mut entries: Vec<_> = entries.flatten().filter_map(entry).collect();
        entries.sort_by(|one, other| one.name.cmp(&other.name));
        entries
    }

    /// Where a file of the memory lies, or would; `None` for a name that leads out of it or to no plain file's place. In
    /// capital or small letters it is the same file, as where a program calls it: the keys have capitals alone.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        let in_folder = || files::named(&self.folder, name).unwrap_or_else(|| self.folder.join(name));
        is_name(name).then(in_folder)
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
        Some(bahn_text::decode(&bytes))
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

    /// Makes a new file: a program has its first and last block, a table its columns.
    ///
    /// # Errors
    /// When there is one of this name, or the medium does not take it.
    pub fn create(&self, name: &str, inch: bool) -> Result<(), Denial> {
        self.free(name)?;
        let text = frames::new_file(name, inch);
        self.write(name, text.as_bytes()).map_err(Denial::Words)
    }

    /// Erases a file.
    ///
    /// # Errors
    /// When it is protected, or the medium does not do it.
    pub fn erase(&self, name: &str) -> Result<(), Denial> {
        let path = self.own(name)?;
        if is_program(name) && files::is_protected_program(&path) {
            return Err(Denial::Message(MessageId::ProtectedPgm));
        }
        fs::remove_file(&path).map_err(|error| Denial::Words(format!("{name}: {error}")))?;
        files::sync_folder(&path);
        self.changed();
        Ok(())
    }

    /// Copies a file; a program has the new name in its first and last block.
    ///
    /// # Errors
    /// When there is a file of the new name, or the medium does not take it.
    pub fn copy(&self, old: &str, new: &str) -> Result<(), Denial> {
        let from = self.own(old)?;
        self.free(new)?;
        let text = fs::read(&from).map_err(|error| Denial::Words(format!("{old}: {error}")))?;
        let text = match is_program(new) {
            true => frames::renamed(&text, new),
            false => text,
        };
        self.write(new, &text).map_err(Denial::Words)
    }

    /// Renames a file, a program in its first and last block, too. Whenever it is cut short one of both is there, whole.
    ///
    /// # Errors
    /// When it is protected, there is a file of the new name, or the medium does not do it.
    pub fn rename(&self, old: &str, new: &str) -> Result<(), Denial> {
        let from = self.own(old)?;
        if is_program(old) && files::is_protected_program(&from) {
            return Err(Denial::Message(MessageId::ProtectedPgm));
        }
        self.copy(old, new)?;
        self.erase(old)
    }

    /// Protects a program, or takes its protection away.
    ///
    /// # Errors
    /// When it is no program, or the medium does not take it.
    pub fn protect(&self, name: &str, on: bool) -> Result<(), Denial> {
        let incorrect = Denial::Message(MessageId::EntryValueIncorrect);
        let program = self.read(name).filter(|_| is_program(name)).ok_or(incorrect)?;
        let edit = if on { Edit::Protect } else { Edit::Unprotect };
        match program.edit(&edit) {
            Ok(program) => self.write(name, &program.to_bytes()).map_err(Denial::Words),
            Err(error) => Err(Denial::Message(error.message())),
        }
    }

    /// Counts the changes of the memory.
    pub fn version(&self) -> u64 {
        self.version.load(Ordering::Relaxed)
    }

    /// A file that is there.
    fn own(&self, name: &str) -> Result<PathBuf, Denial> {
        let path = self.path(name).filter(|path| path.is_file());
        path.ok_or(Denial::Message(MessageId::ProgramNotFound))
    }

    /// Refuses a name that a file has already, or that none can have.
    fn free(&self, name: &str) -> Result<(), Denial> {
        match self.path(name) {
            Some(path) if !path.exists() => Ok(()),
            _ => Err(Denial::Message(MessageId::EntryValueIncorrect)),
        }
    }

    /// Something of the machine's files was written beside: who shows them looks at them again.
    pub fn was_written(&self) {
        self.changed();
    }

    fn changed(&self) {
        self.version.fetch_add(1, Ordering::Relaxed);
        let mut inner = self.inner.write().unwrap_or_else(PoisonError::into_inner);
        *inner = FolderPrograms::of_folder(&self.folder);
    }
}

/// A part program, by its name.
pub fn is_program(name: &str) -> bool {
    bahn_program::FILE_TYPES.iter().any(|kind| {
        name.rsplit_once('.')
            .is_some_and(|(_, ending)| ending.eq_ignore_ascii_case(kind.extension))
    })
}

/// What can be run and tested, by its name: part programs, and those of DIN 66025.
pub fn is_executed(name: &str) -> bool {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    is_program(name) || ending.is_some_and(|ending| ending.eq_ignore_ascii_case("nc"))
}

/// A file name of the memory: letters, digits and what serial interfaces know, one point, nothing hidden.
pub fn is_name(name: &str) -> bool {
    let fits = |character: char| character.is_ascii_alphanumeric() || "$_#-.%+".contains(character);
    !name.is_empty() && name.len() <= 64 && !name.starts_with('.') && name.chars().all(fits)
}

impl Programs for ProgramMemory {
    fn open(&self, name: &str, caller: &str) -> Result<Option<Arc<Program>>, String> {
        let inner = self.inner.read().unwrap_or_else(PoisonError::into_inner);
        inner.open(name, caller)
    }

    fn reader(&self, name: &str, start: &Start) -> Result<Option<Box<dyn Reader>>, String> {
        let inner = self.inner.read().unwrap_or_else(PoisonError::into_inner);
        inner.reader(name, start)
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
        let version = memory.version();
        memory.protect("2.H", true).unwrap();
        assert!(memory.version() > version && memory.list()[0].protected);
        let denied = Err(Denial::Message(MessageId::ProtectedPgm));
        assert_eq!(
            (memory.erase("2.H"), memory.rename("2.H", "3.H")),
            (denied.clone(), denied)
        );
        memory.copy("2.H", "3.H").unwrap();
        assert_eq!(memory.text("3.H").unwrap(), "BEGIN PGM 3 MM P\nEND PGM 3 MM P\n");
        memory.protect("3.H", false).unwrap();
        memory.erase("3.H").unwrap();
        memory.protect("2.H", false).unwrap();
        assert!(memory.write("../2.H", b"").is_err());
        memory.erase("2.H").unwrap();
        assert!(memory.list().is_empty());
        fs::remove_dir_all(&folder).unwrap();
    }
}
