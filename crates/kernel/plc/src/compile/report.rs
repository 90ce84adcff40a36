//! What a compilation has to say.

use bahn_text::Span;

use crate::program::SourceText;
use crate::{Fault, PlcError};

/// Errors that are listed at most, and warnings: a file that is no PLC program has one in each of a million
/// lines.
pub(super) const LISTED_MAX: usize = 1000;

/// Errors and warnings while they are collected.
#[derive(Debug, Default)]
pub(super) struct Reports {
    pub(super) errors: Vec<(usize, Fault)>,
    pub(super) warnings: Vec<(usize, Fault)>,
    /// Those beyond [`LISTED_MAX`].
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

impl Place {
    fn span(self) -> Span {
        Span {
            line: self.line,
            column: self.column,
            length: 1,
        }
    }
}

impl Reports {
    pub(super) fn error(&mut self, file: (usize, &str), place: Place, error: PlcError, detail: &str) {
        self.last_is_listed = self.errors.len() < LISTED_MAX;
        if self.last_is_listed {
            self.errors.push((file.0, fault(file.1, place, error, detail)));
        } else {
            self.not_listed += 1;
        }
    }

    /// The last error comes from what was opened at a place.
    pub(super) fn opened_at(&mut self, place: Place) {
        if let Some((_, error)) = self.errors.last_mut().filter(|_| self.last_is_listed) {
            error.opened = Some(place.span());
        }
    }

    pub(super) fn warning(&mut self, file: (usize, &str), place: Place, error: PlcError, detail: &str) {
        if self.warnings.len() < LISTED_MAX {
            self.warnings.push((file.0, fault(file.1, place, error, detail)));
        } else {
            self.not_listed += 1;
        }
    }

    /// By file in the order of linking, then by place; each covers the word that it begins.
    pub(super) fn sorted(mut reports: Vec<(usize, Fault)>, files: &[SourceText]) -> Vec<Fault> {
        reports.sort_by_key(|(file, report)| (*file, report.span));
        let whole = |(_, report): (usize, Fault)| {
            let file = files.iter().find(|own| own.name == report.file);
            let word = |span: Span| {
                let (line, column) = (span.line as usize, span.column as usize);
                let text = file.and_then(|file| file.lines.get(line.saturating_sub(1)));
                Span::word(line, column, text.map_or("", String::as_str))
            };
            Fault {
                span: word(report.span),
                opened: report.opened.map(word),
                ..report
            }
        };
        reports.into_iter().map(whole).collect()
    }
}

/// A fault whose words have no length yet.
pub(super) fn fault(file: &str, place: Place, error: PlcError, detail: &str) -> Fault {
    Fault {
        error,
        file: file.to_owned(),
        span: place.span(),
        detail: detail.to_owned(),
        opened: None,
    }
}
