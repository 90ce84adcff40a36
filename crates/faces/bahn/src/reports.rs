//! The reports of several files, one after the other: one that cannot be read is told, has its place among the others, and
//! hides none of them.
//!
//! Decision: Of several files that a command reports as JSON one that cannot be read has its place with `file`,
//! `completed` false and `error` (also `bahn/src/refused.rs`)

use std::path::Path;

use serde::Serialize;

use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

/// What came out of a file.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum OfFile<T> {
    Report(T),
    Refused(Refused),
}

/// A file that could not be read.
#[derive(Debug, Serialize)]
pub(crate) struct Refused {
    file: String,
    /// A file that is refused completes nothing.
    completed: bool,
    /// What is wrong, in words.
    error: String,
}

impl<T> OfFile<T> {
    /// What came out; what is wrong is told.
    pub fn reported(file: &Path, result: Result<T, UsageError>) -> OfFile<T> {
        match result {
            Ok(report) => OfFile::Report(report),
            Err(error) => {
                diagnostics::print_usage_error(&error.to_string());
                OfFile::Refused(Refused {
                    file: file.display().to_string(),
                    completed: false,
                    error: error.to_string(),
                })
            }
        }
    }

    /// The report, when there is one.
    pub fn report(&self) -> Option<&T> {
        match self {
            OfFile::Report(report) => Some(report),
            OfFile::Refused(_) => None,
        }
    }
}

/// The reports of several files.
#[derive(Debug)]
pub(crate) struct Reports<T>(Vec<OfFile<T>>);

impl<T: Serialize> Reports<T> {
    /// No report yet.
    pub fn new() -> Reports<T> {
        Reports(Vec::new())
    }

    /// Takes what came out of the next file; the others are looked at all the same.
    pub fn add(&mut self, file: &Path, result: Result<T, UsageError>) {
        self.0.push(OfFile::reported(file, result));
    }

    /// The reports of those that could be read.
    pub fn readable(&self) -> impl Iterator<Item = &T> {
        self.0.iter().filter_map(OfFile::report)
    }

    /// Prints them as JSON when that is wanted, and says how the command ends.
    pub fn end(&self, format: Format, is_faulty: impl Fn(&T) -> bool) -> Result<Outcome, UsageError> {
        if format == Format::Json {
            console::print_json(&self.0)?;
        }
        let refused = self.0.iter().any(|of_file| of_file.report().is_none());
        Ok(match (refused, self.readable().any(is_faulty)) {
            (true, _) => Outcome::WrongUse,
            (false, true) => Outcome::ProgramError,
            (false, false) => Outcome::Fine,
        })
    }
}
