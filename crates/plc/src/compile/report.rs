//! What a compilation has to say.

use crate::{Diagnostic, PlcError};

/// Errors that are listed at most, and warnings: a file that is no PLC program has one in each of a million
/// lines.
pub(super) const LISTED_MAX: usize = 1000;

/// Errors and warnings while they are collected.
#[derive(Debug, Default)]
pub(super) struct Reports {
    pub(super) errors: Vec<(usize, Diagnostic)>,
    pub(super) warnings: Vec<(usize, Diagnostic)>,
    /// How many reports there are beyond [`LISTED_MAX`].
    pub(super) not_listed: usize,
    /// The error that came last is listed.
    pub(super) last_is_listed: bool,
}

/// Where a report belongs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub(super) line: u32,
    pub(super) column: u32,
}

impl Reports {
    pub(super) fn error(&mut self, file: (usize, &str), place: Place, error: PlcError, detail: &str) {
        self.last_is_listed = self.errors.len() < LISTED_MAX;
        if self.last_is_listed {
            self.errors
                .push((file.0, diagnostic(file.1, place, error, detail)));
        } else {
            self.not_listed += 1;
        }
    }

    /// The last error comes from what was opened at a place.
    pub(super) fn opened_at(&mut self, place: Place) {
        if let Some((_, error)) = self.errors.last_mut().filter(|_| self.last_is_listed) {
            error.opened = Some((place.line, place.column));
        }
    }

    pub(super) fn warning(&mut self, file: (usize, &str), place: Place, error: PlcError, detail: &str) {
        if self.warnings.len() < LISTED_MAX {
            self.warnings
                .push((file.0, diagnostic(file.1, place, error, detail)));
        } else {
            self.not_listed += 1;
        }
    }

    /// By file in the order of linking, then by line and column.
    pub(super) fn sorted(mut reports: Vec<(usize, Diagnostic)>) -> Vec<Diagnostic> {
        reports.sort_by_key(|(file, report)| (*file, report.line, report.column));
        reports.into_iter().map(|(_, report)| report).collect()
    }
}

pub(super) fn diagnostic(file: &str, place: Place, error: PlcError, detail: &str) -> Diagnostic {
    let message = if detail.is_empty() {
        error.text().to_owned()
    } else {
        format!("{}: {detail}", error.text())
    };
    Diagnostic {
        error,
        file: file.to_owned(),
        line: place.line,
        column: place.column,
        message,
        opened: None,
    }
}
