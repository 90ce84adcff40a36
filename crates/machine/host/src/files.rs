//! Files: reading programs, finding called ones, writing without leaving half-written files.

mod nc;
mod neighbours;

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use bahn_program::Program;
use bahn_reader::{Folders, Shelf};
use bahn_text::Encoding;

use crate::{HostError, called};

pub use crate::called::{below, named};
pub use bahn_reader::EPROM;

pub use nc::{NcFolder, dialect, nc_reader};

/// Largest program file, 1 GiB. A larger one is FURTHER PROGRAM ENTRY IMPOSSIBLE: the run holds the file in
/// memory.
pub const MAX_PROGRAM_BYTES: u64 = 1 << 30;

/// Largest tool table or list of machine parameters, 16 MiB: many times what any control holds.
const MAX_TABLE_BYTES: u64 = 16 << 20;

/// Largest description of a machine, 1 MiB: the tree that is made of it takes many times as much.
const MAX_DESCRIPTION_BYTES: u64 = 1 << 20;

/// The first block of a program ends within so much of its file.
const FIRST_BLOCK_BYTES: u64 = 1024;

/// What became of reading a program.
pub enum Loaded {
    /// A program with at least one block.
    Program(Arc<Program>),
    /// The file holds no block at all: nothing, or blanks and NULs only.
    Empty(Arc<Program>),
    /// The file is larger than [`MAX_PROGRAM_BYTES`].
    TooLarge,
}

/// Why an empty file is an error.
pub const EMPTY: &str = "the file holds no program";
/// Why a file is an error that is too large.
pub const TOO_LARGE: &str = "the file is larger than 1 GiB";

/// Reads a program file.
///
/// # Errors
/// When it cannot be read.
pub fn load_program(path: &Path) -> Result<Loaded, HostError> {
    Ok(as_program(path, read_program(path)?))
}

/// The program of a file that was read; `None` is one that is too large.
pub fn as_program(path: &Path, bytes: Option<Vec<u8>>) -> Loaded {
    let Some(bytes) = bytes else {
        return Loaded::TooLarge;
    };
    let program = Arc::new(Program::from_bytes(program_name(path), bytes));
    if is_empty(&program) {
        Loaded::Empty(program)
    } else {
        Loaded::Program(program)
    }
}

fn is_empty(program: &Program) -> bool {
    // Two blocks are the implied BEGIN and END.
    program.begin().is_none() && program.end().is_none() && program.block_count() <= 2
}

/// The bytes of a program file; `None` when it is larger than [`MAX_PROGRAM_BYTES`].
///
/// # Errors
/// When it cannot be read.
pub fn read_program(path: &Path) -> Result<Option<Vec<u8>>, HostError> {
    read(path, MAX_PROGRAM_BYTES).map_err(|error| cannot("read", path, &error))
}

/// Reads a tool table or parameter list.
///
/// # Errors
/// When it cannot be read, or is too large.
pub fn read_table(path: &Path) -> Result<Vec<u8>, HostError> {
    read_up_to(path, MAX_TABLE_BYTES)
}

/// Whether the first block of a program says that it is protected [003:1015-1023]; of a file that is no program, or cannot
/// be read, nothing does.
pub fn is_protected_program(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(FIRST_BLOCK_BYTES).read_to_end(&mut head));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    read.is_ok() && Program::from_bytes(&*name, head).is_protected()
}

/// Reads the description of a machine.
///
/// # Errors
/// When it cannot be read, or is too large.
pub fn read_description(path: &Path) -> Result<Vec<u8>, HostError> {
    read_up_to(path, MAX_DESCRIPTION_BYTES)
}

fn read_up_to(path: &Path, limit: u64) -> Result<Vec<u8>, HostError> {
    match read(path, limit) {
        Ok(Some(bytes)) => Ok(bytes),
        Ok(None) => Err(HostError::new(format!("{} is too large", path.display()))),
        Err(error) => Err(cannot("read", path, &error)),
    }
}

/// A file that cannot be read or written. Of one that is not there its folder says what is.
pub fn cannot(verb: &str, path: &Path, error: &io::Error) -> HostError {
    let mut text = format!("cannot {verb} {}: {error}", path.display());
    if verb == "read" && error.kind() == io::ErrorKind::NotFound {
        text += &neighbours::of(path).unwrap_or_default();
    }
    HostError::new(text)
}

/// The name that a program of this path is opened by: its absolute path, so that no two programs share one
/// and called programs are found beside it.
fn program_name(path: &Path) -> String {
    std::path::absolute(path)
        .unwrap_or_else(|_| path.to_owned())
        .to_string_lossy()
        .into_owned()
}

/// The name of a program in reports: that of its file, without folders.
pub fn short_name(program: &Program) -> &str {
    let name = program.name();
    name.rsplit(std::path::MAIN_SEPARATOR).next().unwrap_or(name)
}

/// All bytes of a file, or `None` when there are more than `limit`.
fn read(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > limit {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    // One more byte shows the end, so that reading needs no second buffer.
    bytes.try_reserve_exact(usize::try_from(length).unwrap_or(usize::MAX).saturating_add(1))?;
    // Devices have no length but may have no end.
    file.take(limit + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}

/// The files of the disk.
#[derive(Clone, Copy, Debug, Default)]
pub struct OnDisk;

/// The programs of folders on the disk.
pub type FileLibrary = Shelf<OnDisk>;

/// The programs beside a main program that was read, which is one of them.
pub fn beside(main: &Arc<Program>) -> FileLibrary {
    Shelf::with_main(OnDisk, main)
}

/// The file that a call of a program means, beside the calling one.
pub fn called_program(name: &str, caller: &Path) -> Option<PathBuf> {
    let folder = caller.parent().unwrap_or(Path::new(""));
    bahn_reader::called(&OnDisk, folder, name, caller)
}

impl Folders for OnDisk {
    fn names(&self, folder: &Path) -> Vec<String> {
        called::names_in(folder)
    }

    fn has(&self, path: &Path) -> bool {
        path.is_file()
    }

    fn load(&self, path: &Path) -> Result<Arc<Program>, String> {
        match load_program(path) {
            Ok(Loaded::Program(program)) => Ok(program),
            Ok(Loaded::Empty(_)) => Err(EMPTY.to_owned()),
            Ok(Loaded::TooLarge) => Err(TOO_LARGE.to_owned()),
            Err(error) => Err(error.to_string()),
        }
    }
}

/// The files that are being written and have not their names yet.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Counts the files that are begun.
static COUNT: AtomicU64 = AtomicU64::new(0);

fn temporaries() -> std::sync::MutexGuard<'static, Vec<PathBuf>> {
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what is half written: the process ends.
pub fn remove_temporaries() {
    for temporary in temporaries().drain(..) {
        // It is of no use to anybody.
        let _ = fs::remove_file(temporary);
    }
}

/// Removes what writers left half written in a folder that were killed; what somebody still writes stays.
pub fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let known = temporaries().iter().any(|known| known.file_name() == Some(&name));
        let is_ours = !known && name.to_str().is_some_and(is_temporary);
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_ours && is_file && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            // If it cannot be removed it stays hidden.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// A name that [`NewFile`] gives: `.NAME.PROCESS-NUMBER.tmp`, or without a number as it once was.
fn is_temporary(name: &str) -> bool {
    let Some(name) = name.strip_prefix('.').and_then(|name| name.strip_suffix(".tmp")) else {
        return false;
    };
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    name.rsplit_once('.')
        .is_some_and(|(name, process)| !name.is_empty() && process.split('-').all(digits))
}

/// A file being written: it appears under its name when it is complete, in one step. Until then, and for
/// good when it is dropped before, whatever was there stays there.
#[derive(Debug)]
pub struct NewFile {
    written: WrittenFile,
    writer: BufWriter<Medium>,
}

/// A file that is complete, safe on the medium and no longer open, and has not its name yet. Dropped, it is as if it had never
/// been begun.
#[derive(Debug)]
pub struct WrittenFile {
    path: PathBuf,
    /// Beside the path; `None` when the path is no regular file (`/dev/stdout`) and is written to directly.
    temporary: Option<PathBuf>,
}

/// What a file is written on. In tests its room ends where they say.
#[derive(Debug)]
struct Medium {
    file: File,
    #[cfg(test)]
    room: Option<usize>,
}

impl Medium {
    fn new(file: File) -> Medium {
        Medium {
            file,
            #[cfg(test)]
            room: tests::ROOM.get(),
        }
    }

    /// Everything is on the medium.
    fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }
}

impl Write for Medium {
    #[cfg(not(test))]
    #[inline]
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    #[cfg(test)]
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let Some(room) = &mut self.room else {
            return self.file.write(bytes);
        };
        if *room == 0 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let fits = bytes.get(..(*room).min(bytes.len())).unwrap_or(bytes);
        let written = self.file.write(fits)?;
        *room -= written;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl NewFile {
    /// Begins a file.
    ///
    /// # Errors
    /// When its folder cannot be written.
    pub fn create(path: &Path) -> Result<NewFile, HostError> {
        NewFile::try_create(path).map_err(|error| cannot("write", path, &error))
    }

    fn try_create(path: &Path) -> io::Result<NewFile> {
        // Through symbolic links, so that the link stays and what it names is replaced.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let old = fs::metadata(&path).ok();
        if old.as_ref().is_some_and(|old| !old.is_file()) {
            let file = OpenOptions::new().write(true).open(&path)?;
            let written = WrittenFile {
                path,
                temporary: None,
            };
            return Ok(NewFile::on(file, written));
        }
        let name = path
            .file_name()
            .ok_or(io::ErrorKind::InvalidInput)?
            .to_string_lossy()
            .into_owned();
        // Each has a name of its own: two of one process may write the same file.
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let temporary = path.with_file_name(format!(".{name}.{}-{number}.tmp", std::process::id()));
        temporaries().push(temporary.clone());
        let written = WrittenFile {
            path,
            temporary: Some(temporary.clone()),
        };
        let create = || OpenOptions::new().write(true).create_new(true).open(&temporary);
        // What is there is what a killed process of the same number left, or a link that leads elsewhere.
        let file = create().or_else(|_| fs::remove_file(&temporary).and_then(|()| create()))?;
        // Who sweeps sees that somebody still writes; where files cannot be locked nothing is swept.
        let _ = file.try_lock();
        if let Some(old) = old {
            file.set_permissions(old.permissions())?;
        }
        Ok(NewFile::on(file, written))
    }

    fn on(file: File, written: WrittenFile) -> NewFile {
        NewFile {
            written,
            writer: BufWriter::with_capacity(1 << 16, Medium::new(file)),
        }
    }

    /// Puts the complete file in its place.
    ///
    /// # Errors
    /// When it cannot be written; what was there stays.
    pub fn finish(self) -> Result<(), HostError> {
        self.complete()?.put()
    }

    /// Closes the complete file, so that many can wait for their names and none is held open.
    ///
    /// # Errors
    /// When it cannot be written; what was there stays.
    pub fn complete(mut self) -> Result<WrittenFile, HostError> {
        self.save()
            .map_err(|error| cannot("write", &self.written.path, &error))?;
        Ok(self.written)
    }

    fn save(&mut self) -> io::Result<()> {
        self.writer.flush()?;
        match self.written.temporary {
            Some(_) => self.writer.get_ref().sync(),
            None => Ok(()),
        }
    }
}

impl WrittenFile {
    /// Puts the file in its place.
    ///
    /// # Errors
    /// When it cannot take it; what was there stays.
    pub fn put(mut self) -> Result<(), HostError> {
        let Some(temporary) = &self.temporary else {
            return Ok(());
        };
        fs::rename(temporary, &self.path).map_err(|error| cannot("write", &self.path, &error))?;
        temporaries().retain(|known| known != temporary);
        self.temporary = None;
        sync_folder(&self.path);
        Ok(())
    }
}

impl Write for NewFile {
    #[inline]
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl Drop for WrittenFile {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // It is of no use to anybody.
            let _ = fs::remove_file(temporary);
            temporaries().retain(|known| known != temporary);
        }
    }
}

/// Writes a file, whole or not at all.
///
/// # Errors
/// When the medium does not take it; the file is what it was before.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), HostError> {
    let mut file = NewFile::create(path)?;
    file.write_all(bytes)
        .map_err(|error| cannot("write", path, &error))?;
    file.finish()
}

/// Writes a text anew as its file is written: in its alphabet, with its byte order mark; a new file in UTF-8.
///
/// # Errors
/// As [`write_whole`].
pub fn write_text(path: &Path, text: &str) -> Result<(), HostError> {
    match fs::read(path) {
        Ok(before) => write_whole(path, &Encoding::read(&before).1.write(text)),
        Err(_) => write_whole(path, text.as_bytes()),
    }
}

/// The new name is safe when its folder is; where a folder cannot be synchronised nothing can be done.
pub fn sync_folder(path: &Path) {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use std::cell::Cell;

    thread_local! {
        /// So many bytes find room in each file that is begun on this thread.
        pub(crate) static ROOM: Cell<Option<usize>> = const { Cell::new(None) };
    }

    /// Two that write one file do not meet, and the last one that ends is what stays; what a killed process left is swept,
    /// what is being written is not.
    #[test]
    fn writers_do_not_meet_and_leftovers_are_swept() {
        let folder = std::env::temp_dir().join(format!("bahn-sweep-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("1.H");
        for left in [".1.H.4711.tmp", ".1.H.4711-3.tmp"] {
            fs::write(folder.join(left), "half").unwrap();
        }
        fs::write(folder.join(".hidden.tmp"), "kept").unwrap();
        let mut one = NewFile::create(&path).unwrap();
        let mut other = NewFile::create(&path).unwrap();
        one.write_all(b"one").unwrap();
        other.write_all(b"other").unwrap();
        sweep(&folder);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 3);
        other.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"other");
        one.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"one");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(&folder).unwrap();
    }

    /// A file that cannot be begun is not remembered as one that is being written.
    #[test]
    fn what_cannot_be_begun_is_forgotten() {
        let name = format!("bahn-missing-{}", std::process::id());
        let path = std::env::temp_dir().join(&name).join("1.H");
        assert!(NewFile::create(&path).is_err());
        let known = temporaries().iter().any(|known| known.parent() == path.parent());
        assert!(!known);
    }

    /// The medium is full after any byte: what was there stays, nothing half written is left, and the next try with
    /// room writes it.
    #[test]
    fn a_full_medium_leaves_what_was_there() {
        let folder = std::env::temp_dir().join(format!("bahn-full-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("control.toml");
        fs::write(&path, "before").unwrap();
        let text = vec![b'x'; 300];
        let put = || {
            let mut file = NewFile::create(&path)?;
            file.write_all(&text)
                .map_err(|error| cannot("write", &path, &error))?;
            file.finish()
        };
        for room in 0..text.len() {
            ROOM.set(Some(room));
            assert!(put().is_err(), "{room}");
            assert_eq!(fs::read(&path).unwrap(), b"before", "{room}");
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "{room}");
        }
        ROOM.set(Some(text.len()));
        put().unwrap();
        ROOM.set(None);
        assert_eq!(fs::read(&path).unwrap(), text);
        fs::remove_dir_all(&folder).unwrap();
    }
}
