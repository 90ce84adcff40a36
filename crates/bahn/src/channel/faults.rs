//! What is wrong with a list, for people and for programs.

use std::path::Path;

use bahn_host::{FileFault, Marked, Severity};
use bahn_technology::{ChannelList, ListFault};
use serde::Serialize;

/// What is wrong with a list, for programs.
#[derive(Debug, Serialize)]
pub(super) struct Report<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    ok: bool,
    errors: Vec<Item<'a>>,
    warnings: Vec<Item<'a>>,
}

/// A fault at its place, from 1 on.
#[derive(Debug, Serialize)]
struct Item<'a> {
    line: usize,
    column: usize,
    length: usize,
    message: &'a str,
    help: &'a str,
}

impl<'a> Report<'a> {
    pub fn new(list: &'a ChannelList) -> Report<'a> {
        let item = |fault: &'a ListFault| Item {
            line: fault.line,
            column: fault.column,
            length: fault.length,
            message: &fault.message,
            help: fault.help.as_deref().unwrap_or_default(),
        };
        Report {
            file: None,
            ok: list.errors().is_empty(),
            errors: list.errors().iter().map(item).collect(),
            warnings: list.warnings().iter().map(item).collect(),
        }
    }

    /// One of several lists has its name.
    pub fn of_file(self, name: String) -> Report<'a> {
        Report {
            file: Some(name),
            ..self
        }
    }
}

/// Errors, then warnings, each with its line.
pub(crate) fn faults(list: &ChannelList, path: &Path) -> Vec<FileFault> {
    let errors = list.errors().iter().map(|fault| (Severity::Error, fault));
    let warnings = list.warnings().iter().map(|fault| (Severity::Warning, fault));
    let at_its_place = |(severity, fault): (Severity, &ListFault)| FileFault {
        severity,
        title: fault.message.clone(),
        path: path.to_owned(),
        marked: Marked {
            line: u32::try_from(fault.line).unwrap_or(u32::MAX),
            text: list.line(fault.line).to_owned(),
            columns: Some((
                u32::try_from(fault.column).unwrap_or(u32::MAX),
                u32::try_from(fault.length).unwrap_or(u32::MAX),
            )),
        },
        label: String::new(),
        help: fault.help.clone(),
        opened: None,
    };
    errors.chain(warnings).map(at_its_place).collect()
}
