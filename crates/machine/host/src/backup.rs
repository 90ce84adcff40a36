//! BACKUP and RESTORE: everything in the folder of a machine as one text, which any line carries.
//!
//! The original sends all parameters and all files as one file `$BACKUP.ANC`; what stands in it no manual says. Here it is
//! lines of printable characters, so that seven data bits are enough *(inferred)*:
//!
//! ```text
//! BEGIN BACKUP 1 mill
//! FILE 30 8AC76F6B programs/15.H
//! BEGIN PGM 15 MM\n
//! END PGM 15 MM\n
//! END BACKUP 1
//! ```
//!
//! After `FILE` stand bytes, check sum (CRC-32) and path. An end of line is only where `\n` says so; lines may be cut
//! anywhere else.
//!
//! Decision: `$BACKUP` is text of printable characters with sizes and check sums, so that seven data bits carry it;
//! it is restored as a whole or not at all, through no symbolic link, and what it does not have stays; a file that it
//! cannot carry is named, and there is no backup: one that lacks something is found out too late

use std::fs;
use std::io::{self, BufRead, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};

use bahn_text::unescaped;
use thiserror::Error;

use crate::HostError;
use crate::files::{self, NewFile, WrittenFile, cannot};

/// Name under which it is sent [000:465-467].
pub const BACKUP_NAME: &str = "$BACKUP";
/// Characters of a line at most.
const LINE: usize = 100;
/// Bytes of a line that are read at most: a path of eight names of 255, and what stands before it.
const READ: u64 = 4096;
/// Bytes of a file at most: nothing that a machine keeps is longer.
const FILE_MAX: u64 = 1 << 30;
/// Names of a path at most, with that of the file.
const DEPTH_MAX: usize = 8;
/// The file that says who has switched the machine on.
const LOCK: &str = "lock";

/// Why there is no backup, or why it is not restored.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BackupError {
    /// A file cannot be read or written.
    #[error(transparent)]
    Host(#[from] HostError),
    /// A line of the backup is not what it should be.
    #[error("line {line} of the backup: {what}")]
    Damaged {
        /// The line, from 1.
        line: u64,
        /// What is wrong in it, in words.
        what: &'static str,
    },
    /// A file that no backup carries.
    #[error("cannot back up {path}: {why}")]
    NotCarried {
        /// Path of the file in the machine's folder.
        path: String,
        /// What it has that cannot be carried.
        why: &'static str,
    },
    /// It ends before its END.
    #[error("the backup ends in the middle")]
    Incomplete,
}

/// The lines of a backup of a folder, one after the other.
///
/// Hidden files, other backups, the file `lock` of whoever has the machine, and what is neither file nor folder, such as a
/// symbolic link, are left out.
///
/// # Errors
/// [`BackupError::NotCarried`], when a file cannot be read, or the lines cannot be taken.
pub fn back_up(
    folder: &Path,
    name: &str,
    mut take: impl FnMut(&str) -> Result<(), HostError>,
) -> Result<u64, BackupError> {
    let mut paths = Vec::new();
    collect(folder, Path::new(""), &mut paths)?;
    take(&format!("BEGIN BACKUP 1 {}", escaped(name.as_bytes())))?;
    for path in &paths {
        let whole = folder.join(path);
        let length = fs::metadata(&whole)
            .map_err(|error| cannot("read", &whole, &error))?
            .len();
        if length > FILE_MAX {
            return Err(not_carried(path, "it is longer than 1 GiB"));
        }
        let bytes = fs::read(&whole).map_err(|error| cannot("read", &whole, &error))?;
        let head = format!(
            "FILE {} {:08X} {}",
            bytes.len(),
            crc32fast::hash(&bytes),
            shown(path)
        );
        take(&head)?;
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            for piece in pieces(line) {
                take(&escaped(piece))?;
            }
        }
    }
    take(&format!("END BACKUP {}", paths.len()))?;
    Ok(paths.len() as u64)
}

/// The files of a folder in the order of their paths.
fn collect(folder: &Path, below: &Path, paths: &mut Vec<PathBuf>) -> Result<(), BackupError> {
    let here = folder.join(below);
    let failed = |error: io::Error| cannot("read", &here, &error);
    let mut names: Vec<_> = Vec::new();
    for entry in fs::read_dir(&here).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        names.push((entry.file_name(), entry.file_type().map_err(failed)?));
    }
    names.sort_by(|one, other| one.0.cmp(&other.0));
    for (name, kind) in names {
        let path = below.join(&name);
        let name = name.to_string_lossy();
        // A backup that is on its way holds no other.
        if name.starts_with('.') || name.starts_with(BACKUP_NAME) {
            continue;
        }
        if kind.is_dir() {
            if path.components().count() == DEPTH_MAX {
                return Err(not_carried(&path, "no folder may be in seven others"));
            }
            collect(folder, &path, paths)?;
        } else if kind.is_file() && name != LOCK {
            if relative(&path.to_string_lossy()).is_none() {
                return Err(not_carried(
                    &path,
                    "its name has other characters than A to Z, digits, blanks inside and ._$#-+%(), or is lock",
                ));
            }
            paths.push(path);
        }
    }
    Ok(())
}

fn not_carried(path: &Path, why: &'static str) -> BackupError {
    let path = shown(path);
    BackupError::NotCarried { path, why }
}

/// A path as it is written in a backup.
fn shown(path: &Path) -> String {
    let names = path.iter().map(|name| name.to_string_lossy());
    names.collect::<Vec<_>>().join("/")
}

/// A path that leads nowhere else, and to nothing hidden.
fn relative(path: &str) -> Option<PathBuf> {
    let path = Path::new(path);
    let mut count = 0;
    for component in path.components() {
        let Component::Normal(name) = component else {
            return None;
        };
        let name = name.to_str()?;
        let fits = |c: char| c.is_ascii_alphanumeric() || "._$#-+% ()".contains(c);
        // A blank at the end of a line would be lost on its way.
        if name.starts_with('.') || name == LOCK || name.ends_with(' ') || !name.chars().all(fits) {
            return None;
        }
        count += 1;
    }
    (1..=DEPTH_MAX).contains(&count).then(|| path.to_owned())
}

/// Printable characters; a blank at the end of a line would be lost on its way.
fn escaped(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    for byte in bytes {
        match byte {
            b'\n' => text.push_str("\\n"),
            b'\\' => text.push_str("\\\\"),
            b' '..=b'~' => text.push(char::from(*byte)),
            _ => text.push_str(&format!("\\x{byte:02X}")),
        }
    }
    if text.ends_with(' ') {
        text.truncate(text.len() - 1);
        text.push_str("\\x20");
    }
    text
}

/// A line of a file in pieces that are short enough when they are escaped.
fn pieces(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = line;
    std::iter::from_fn(move || {
        let mut length = 0;
        let fits = |byte: &&u8| {
            length += match byte {
                b'\\' | b'\n' => 2,
                b' '..=b'~' => 1,
                _ => 4,
            };
            // A blank at the end takes three more.
            length + 3 <= LINE
        };
        let count = rest.iter().take_while(fits).count();
        let (piece, after) = rest.split_at_checked(count)?;
        rest = after;
        (count > 0).then_some(piece)
    })
}

/// Takes a backup line by line. Nothing in the folder changes before [`Restore::commit`].
#[derive(Debug)]
pub struct Restore {
    folder: PathBuf,
    line: u64,
    state: State,
    /// Files that are complete and have not their names yet.
    files: Vec<WrittenFile>,
    /// Folders that were not there.
    made: Vec<PathBuf>,
}

#[derive(Debug)]
enum State {
    Begin,
    Files,
    /// A file that is coming: its bytes and what they must come to.
    Inside {
        path: PathBuf,
        bytes: Vec<u8>,
        length: usize,
        sum: u32,
    },
    End,
}

impl Restore {
    /// A backup comes for a folder.
    pub fn new(folder: &Path) -> Restore {
        Restore {
            folder: folder.to_owned(),
            line: 0,
            state: State::Begin,
            files: Vec::new(),
            made: Vec::new(),
        }
    }

    /// Takes all lines of a backup, however long it is.
    ///
    /// # Errors
    /// When it cannot be read, or is not what it should be; nothing is restored then.
    pub fn read(folder: &Path, mut text: impl BufRead) -> Result<Restore, BackupError> {
        let mut restore = Restore::new(folder);
        let mut line = Vec::new();
        loop {
            line.clear();
            let read = text.by_ref().take(READ).read_until(b'\n', &mut line);
            if read.map_err(|error| HostError::new(format!("cannot read the backup: {error}")))? == 0 {
                return Ok(restore);
            }
            let line = line.strip_suffix(b"\n").unwrap_or(&line);
            let line = line.strip_suffix(b"\r").unwrap_or(line);
            restore.line(&String::from_utf8_lossy(line))?;
        }
    }

    /// Takes a line, without its end.
    ///
    /// # Errors
    /// When it is not what it should be; nothing is restored then.
    pub fn line(&mut self, line: &str) -> Result<(), BackupError> {
        self.line += 1;
        let at = self.line;
        let damaged = |what| BackupError::Damaged { line: at, what };
        match &mut self.state {
            State::Begin if line.starts_with("BEGIN BACKUP 1") => self.state = State::Files,
            State::Begin => return Err(damaged("it does not begin with BEGIN BACKUP 1")),
            State::Files => match line.strip_prefix("END BACKUP ") {
                Some(count) if count.trim().parse() == Ok(self.files.len()) => self.state = State::End,
                Some(_) => return Err(damaged("files are missing")),
                None => self.head(line)?,
            },
            State::Inside { bytes, length, .. } => {
                bytes.extend(unescaped(line).ok_or_else(|| damaged("an escape that there is not"))?);
                if bytes.len() > *length {
                    return Err(damaged("the file is longer than its head says"));
                }
                self.take_whole()?;
            }
            State::End if line.trim().is_empty() => {}
            State::End => return Err(damaged("something stands after END BACKUP")),
        }
        Ok(())
    }

    fn head(&mut self, line: &str) -> Result<(), BackupError> {
        let damaged = |what| BackupError::Damaged {
            line: self.line,
            what,
        };
        let no_head = || damaged("FILE with bytes, check sum and path is expected");
        let mut words = line.strip_prefix("FILE ").ok_or_else(no_head)?.splitn(3, ' ');
        let length: u64 = words
            .next()
            .and_then(|word| word.parse().ok())
            .ok_or_else(no_head)?;
        let sum = words.next().and_then(|word| u32::from_str_radix(word, 16).ok());
        let path = words.next().ok_or_else(no_head)?;
        let path = relative(path).ok_or_else(|| damaged("no path of a machine"))?;
        let length = usize::try_from(length.min(FILE_MAX + 1)).unwrap_or(usize::MAX);
        if length as u64 > FILE_MAX {
            return Err(damaged("the file is too long"));
        }
        self.state = State::Inside {
            path,
            bytes: Vec::new(),
            length,
            sum: sum.ok_or_else(no_head)?,
        };
        self.take_whole()
    }

    /// Writes a file beside its place when all of it has come.
    fn take_whole(&mut self) -> Result<(), BackupError> {
        let (path, bytes, sum) = match std::mem::replace(&mut self.state, State::Files) {
            State::Inside {
                path,
                bytes,
                length,
                sum,
            } if bytes.len() == length => (path, bytes, sum),
            other => {
                self.state = other;
                return Ok(());
            }
        };
        if crc32fast::hash(&bytes) != sum {
            return Err(BackupError::Damaged {
                line: self.line,
                what: "the check sum of the file is another one",
            });
        }
        let whole = self.folder.join(&path);
        self.make_folders(&path)?;
        // Nor through a symbolic link, and not into a device at once.
        if fs::symlink_metadata(&whole).is_ok_and(|found| !found.is_file()) {
            return Err(BackupError::Damaged {
                line: self.line,
                what: "something that is no file stands in its place",
            });
        }
        let mut file = NewFile::create(&whole)?;
        file.write_all(&bytes)
            .map_err(|error| cannot("write", &whole, &error))?;
        self.files.push(file.complete()?);
        Ok(())
    }

    /// The folders of a path, none of them a symbolic link that leads out.
    fn make_folders(&mut self, path: &Path) -> Result<(), BackupError> {
        let mut folder = self.folder.clone();
        for component in path.parent().into_iter().flat_map(Path::components) {
            folder.push(component);
            match fs::symlink_metadata(&folder) {
                Ok(found) if found.is_dir() => {}
                Ok(_) => {
                    return Err(BackupError::Damaged {
                        line: self.line,
                        what: "its path leads through something that is no folder",
                    });
                }
                Err(_) => {
                    fs::create_dir(&folder).map_err(|error| cannot("make", &folder, &error))?;
                    self.made.push(folder.clone());
                }
            }
        }
        Ok(())
    }

    /// Whether END BACKUP has come.
    pub fn is_complete(&self) -> bool {
        matches!(self.state, State::End)
    }

    /// Puts all files in their places; how many there are. Files that the backup has not stay as they are.
    ///
    /// # Errors
    /// [`BackupError::Incomplete`], or when the medium does not take them.
    pub fn commit(mut self) -> Result<u64, BackupError> {
        if !self.is_complete() {
            return Err(BackupError::Incomplete);
        }
        let files = std::mem::take(&mut self.files);
        let count = files.len() as u64;
        for file in files {
            file.put()?;
        }
        for folder in std::iter::once(&self.folder).chain(&self.made) {
            files::sync_folder(folder);
        }
        self.made.clear();
        Ok(count)
    }
}

impl Drop for Restore {
    fn drop(&mut self) {
        self.files.clear();
        // Folders that nobody needs; those that hold something stay.
        for folder in self.made.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests;
