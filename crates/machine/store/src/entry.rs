//! What is in a folder.

use std::time::SystemTime;

/// A file or folder in a list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its name; `NAME.<code>NC` is `NAME.EXT`.
    pub name: String,
    /// What there is to be said of it.
    pub attributes: Attributes,
}

/// What there is to be said of a file or folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attributes {
    /// Bytes; a folder has none.
    pub size: u64,
    /// When it was written.
    pub modified: SystemTime,
    /// It has no write permission, or its first block protects it.
    pub protected: bool,
    /// A folder, not a file.
    pub is_folder: bool,
}

/// What becomes of a file of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// It stays: the new one is refused.
    Keep,
    /// It is replaced when the new one is complete.
    Replace,
}
