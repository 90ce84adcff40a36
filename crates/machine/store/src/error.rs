//! Why the file service does not do something.

use std::io;

/// Why the file service does not do something. Each protocol has its own words or numbers for it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StoreError {
    /// No name of a file or folder, or a path that leads out of the store.
    #[error("{0:?} is no name of a file")]
    BadName(String),
    /// There is no file of this name.
    #[error("there is no file {0}")]
    NoFile(String),
    /// There is no folder of this name.
    #[error("there is no folder {0}")]
    NoFolder(String),
    /// There is a file or folder of this name.
    #[error("there is a file {0}")]
    Exists(String),
    /// The file has no write permission, or its first block protects it.
    #[error("{0} is protected")]
    Protected(String),
    /// The file is being written.
    #[error("{0} is being stored")]
    Busy(String),
    /// The machine has the file in use.
    #[error("{0} is in use")]
    InUse(String),
    /// The folder is not empty.
    #[error("the folder {0} is not empty")]
    NotEmpty(String),
    /// The disk has as many files as it may have.
    #[error("the directory is full")]
    DirectoryFull,
    /// There is no room, or the file is larger than any may be.
    #[error("the disk is full")]
    DiskFull,
    /// The medium does not do it.
    #[error("{0}")]
    Medium(String),
}

impl StoreError {
    /// What the operating system says of a file; `name` is how the client calls it.
    pub(super) fn of_system(error: &io::Error, name: &str) -> StoreError {
        use io::ErrorKind;
        match error.kind() {
            ErrorKind::NotFound => StoreError::NoFile(name.to_owned()),
            ErrorKind::AlreadyExists => StoreError::Exists(name.to_owned()),
            ErrorKind::DirectoryNotEmpty => StoreError::NotEmpty(name.to_owned()),
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
                StoreError::Protected(name.to_owned())
            }
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
                StoreError::DiskFull
            }
            _ => StoreError::Medium(format!("{name}: {error}")),
        }
    }
}
