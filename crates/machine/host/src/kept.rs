//! Files that survive power-off: who may write them, and what becomes of damaged ones.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::HostError;
use crate::files;

/// Copies of damaged files of one name that are kept at most.
const ASIDE_MAX: usize = 99;

/// Opens a file to read and write, without changing it; `None` when there is none.
///
/// # Errors
/// When it cannot be opened, or is no regular file: devices have no end.
pub(crate) fn open(path: &Path) -> Result<Option<File>, HostError> {
    match fs::metadata(path) {
        Ok(there) if !there.is_file() => {
            Err(HostError::new(format!("{} is no regular file", path.display())))
        }
        Ok(_) => OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .map(Some)
            .map_err(|error| files::cannot("open", path, &error)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(files::cannot("open", path, &error)),
    }
}

/// Makes a file that is not there yet.
///
/// # Errors
/// When it is there, or cannot be made.
pub(crate) fn make(path: &Path) -> Result<File, HostError> {
    OpenOptions::new()
        .read(true)
        .write(true)
        .create_new(true)
        .open(path)
        .map_err(|error| files::cannot("make", path, &error))
}

/// Takes a file for this process alone, until it is closed. `false` when another one has it.
///
/// # Errors
/// When the file system knows no locks.
pub(crate) fn lock(file: &File, path: &Path) -> Result<bool, HostError> {
    match file.try_lock() {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => Err(files::cannot("lock", path, &error)),
    }
}

/// The file itself is kept here, not a link to one elsewhere.
///
/// # Errors
/// When it is a link.
pub(crate) fn refuse_link(path: &Path) -> Result<(), HostError> {
    match fs::symlink_metadata(path) {
        Ok(there) if there.is_symlink() => Err(HostError::new(format!(
            "{} is a link; what survives power-off is kept in the folder itself",
            path.display()
        ))),
        _ => Ok(()),
    }
}

/// The names under which damaged files are kept: `NAME.damaged`, `NAME.damaged-2` and so on.
fn names_aside(path: &Path) -> impl Iterator<Item = PathBuf> {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    (1..=ASIDE_MAX).map(move |count| {
        let number = if count == 1 {
            String::new()
        } else {
            format!("-{count}")
        };
        path.with_file_name(format!("{name}.damaged{number}"))
    })
}

/// A damaged file that was kept and is still there.
pub(crate) fn found_aside(path: &Path) -> Option<PathBuf> {
    names_aside(path).find(|aside| fs::symlink_metadata(aside).is_ok())
}

/// Keeps a copy of a damaged file beside it; where it is now.
///
/// # Errors
/// When it cannot be written, or too many are kept already.
pub(crate) fn set_aside(path: &Path, content: &[u8]) -> io::Result<PathBuf> {
    for aside in names_aside(path) {
        let mut file = match OpenOptions::new().write(true).create_new(true).open(&aside) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
            Err(error) => return Err(error),
        };
        file.write_all(content)?;
        file.sync_all()?;
        files::sync_folder(&aside);
        return Ok(aside);
    }
    Err(io::Error::other(format!(
        "there are {ASIDE_MAX} damaged files {}.damaged already",
        path.display()
    )))
}
