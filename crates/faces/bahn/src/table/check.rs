//! `bahn table check`: all faults of tables.

use std::path::Path;

use bahn_host::LoadedMachine;
use bahn_text::Diagnostic;
use serde::Serialize;

use super::options::CheckOptions;
use super::source;
use crate::options::Format;
use crate::reports::Reports;
use crate::{Outcome, UsageError, console, diagnostics};

/// Checks tables and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let mut reports = Reports::new();
    for path in &options.tables {
        let checked = if path.is_dir() {
            of_machine(path, options)
        } else {
            of_file(path, options)
        };
        reports.add(path, checked);
    }
    if options.format == Format::Text {
        for report in reports.readable().filter(|report| report.faults.is_empty()) {
            let (file, kind, rows) = (&report.file, report.kind, report.rows);
            console::print(&format!("{file}: {kind}, {rows} lines, no fault\n"))?;
        }
    }
    reports.end(options.format, |report: &Report| !report.faults.is_empty())
}

#[derive(Debug, Serialize)]
struct Report {
    file: String,
    kind: &'static str,
    rows: usize,
    faults: Vec<Item>,
}

#[derive(Debug, Serialize)]
struct Item {
    file: String,
    line: u32,
    column: u32,
    message: String,
}

impl Item {
    /// What exactly is wrong: a machine has a headline over it.
    fn new(file: String, fault: &Diagnostic) -> Item {
        let message = match fault.detail.as_str() {
            "" => &fault.message,
            detail => detail,
        };
        Item {
            file,
            line: fault.span.line,
            column: fault.span.column,
            message: message.to_owned(),
        }
    }
}

fn of_file(path: &Path, options: &CheckOptions) -> Result<Report, UsageError> {
    let source = source::read(path, options.kind)?;
    let faults = source.kind.check(&source.text).err().unwrap_or_default();
    if options.format == Format::Text {
        source.print(&faults);
    }
    let file = path.display().to_string();
    let item = |fault: Diagnostic| Item::new(file.clone(), &fault);
    Ok(Report {
        kind: source.kind.name(),
        rows: source.table.rows.len(),
        faults: faults.into_iter().map(item).collect(),
        file: file.clone(),
    })
}

/// All tables of a machine; other faults of its files are not looked at.
fn of_machine(path: &Path, options: &CheckOptions) -> Result<Report, UsageError> {
    let (rows, faults) = match LoadedMachine::load(path)? {
        Ok(machine) => (
            machine.tables.len() + usize::from(machine.tools.is_some()),
            machine.refused,
        ),
        Err(faults) => (0, faults),
    };
    if options.format == Format::Text {
        diagnostics::print_faults(&faults);
    }
    let item = |fault: Diagnostic| Item::new(fault.file.display().to_string(), &fault);
    Ok(Report {
        file: path.display().to_string(),
        kind: "machine",
        rows,
        faults: faults.into_iter().map(item).collect(),
    })
}
