//! What is wrong with a list, for people and for programs.

use std::path::Path;

use bahn_technology::ChannelList;
use bahn_text::{Diagnostic, Severity};
use serde::Serialize;

use crate::diagnostics::Item;

/// What is wrong with a list, for programs.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    ok: bool,
    errors: Vec<Item>,
    warnings: Vec<Item>,
}

impl Report {
    /// Of the faults of a list.
    pub fn new(faults: &[Diagnostic]) -> Report {
        let of = |severity| faults.iter().filter(move |fault| fault.severity == severity);
        let errors: Vec<Item> = of(Severity::Error).map(Item::from).collect();
        Report {
            file: None,
            ok: errors.is_empty(),
            errors,
            warnings: of(Severity::Warning).map(Item::from).collect(),
        }
    }

    /// One of several lists has its name.
    pub fn of_file(self, name: String) -> Report {
        Report {
            file: Some(name),
            ..self
        }
    }
}

/// Errors, then warnings, each with its line.
pub(crate) fn faults(list: &ChannelList, path: &Path) -> Vec<Diagnostic> {
    let all = list.errors().iter().chain(list.warnings());
    let in_file = all.map(|fault| {
        let line = list.line(fault.span.line as usize);
        fault.clone().at(path, line)
    });
    in_file.collect()
}
