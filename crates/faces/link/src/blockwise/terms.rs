//! What a device lets the other side do, and in which terms: names, types and errors.

use crate::FileType;
use bahn_store::StoreError;

/// What the other side may do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rights {
    /// Files may be asked for.
    pub gives: bool,
    /// The device stores files that are sent to it.
    pub takes: bool,
    /// Only these, when there are any.
    pub only: Vec<String>,
    /// A file that is there is replaced after a question only.
    pub asks: bool,
}

impl Rights {
    /// The rights of a disk unit: everything.
    pub const ALL: Rights = Rights {
        gives: true,
        takes: true,
        only: Vec::new(),
        asks: false,
    };

    pub(super) fn allow(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|only| only.eq_ignore_ascii_case(name))
    }
}

/// What a FE says [000:17603-17625].
pub(super) fn code(error: &StoreError) -> u16 {
    match error {
        StoreError::BadName(_) | StoreError::NoFolder(_) | StoreError::NotEmpty(_) => 2,
        StoreError::NoFile(_) => 10,
        StoreError::Protected(_) | StoreError::Exists(_) => 11,
        StoreError::Busy(_) | StoreError::InUse(_) => 12,
        StoreError::DirectoryFull => 13,
        StoreError::DiskFull => 14,
        StoreError::Medium(_) => 104,
    }
}

/// Names that a file of this code may have; who sends no code that is known means a program.
pub(super) fn candidates(stem: &str, code: Option<u8>) -> Vec<String> {
    let known = code
        .map(char::from)
        .filter(|code| FileType::of_code(*code).is_some());
    let kinds = FileType::all().filter(|kind| match known {
        Some(code) => kind.code() == code.to_ascii_uppercase(),
        None => kind.is_program(),
    });
    kinds.map(|kind| format!("{stem}.{}", kind.extension())).collect()
}
