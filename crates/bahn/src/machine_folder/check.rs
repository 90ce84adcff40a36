//! `bahn machine check`: everything in a folder, all faults of all files.

use std::path::Path;

use serde::Serialize;

use super::load::load;
use super::options::CheckOptions;
use crate::cli::Format;
use crate::diagnostics::{self, FileFault, Severity};
use crate::{Outcome, UsageError, console};

#[derive(Debug, Serialize)]
struct Report {
    folder: String,
    name: Option<String>,
    model: Option<&'static str>,
    ok: bool,
    faults: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Entry {
    severity: &'static str,
    file: String,
    line: u32,
    column: Option<u32>,
    message: String,
    detail: String,
}

/// Checks folders and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let mut outcome = Outcome::Fine;
    let mut reports = Vec::new();
    for folder in &options.folders {
        match check(folder, options.format) {
            Ok(report) => {
                if !report.ok && outcome == Outcome::Fine {
                    outcome = Outcome::ProgramError;
                }
                reports.push(report);
            }
            // The other folders are checked all the same.
            Err(error) => {
                diagnostics::print_usage_error(&error.to_string());
                outcome = Outcome::WrongUse;
            }
        }
    }
    if options.format == Format::Json {
        let json = serde_json::to_string_pretty(&reports)
            .map_err(|error| UsageError::new(format!("cannot write the report: {error}")))?;
        console::print(&(json + "\n"))?;
    }
    Ok(outcome)
}

fn check(folder: &Path, format: Format) -> Result<Report, UsageError> {
    let (loaded, faults) = match load(folder)? {
        Ok(machine) => {
            let faults = machine.warnings.clone();
            (Some(machine), faults)
        }
        Err(faults) => (None, faults),
    };
    let errors = faults
        .iter()
        .filter(|fault| fault.severity == Severity::Error)
        .count();
    if format == Format::Text {
        faults.iter().for_each(FileFault::print);
        let what = loaded
            .as_ref()
            .map_or("cannot be switched on".to_owned(), |machine| {
                format!("{}, {}", machine.folder.name, machine.parameters.model())
            });
        let count =
            |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
        diagnostics::print_text(&format!(
            "{}: {what}, {}, {}",
            folder.display(),
            count(errors, "error"),
            count(faults.len() - errors, "warning")
        ));
    }
    Ok(Report {
        folder: folder.display().to_string(),
        name: loaded.as_ref().map(|machine| machine.folder.name.clone()),
        model: loaded.as_ref().map(|machine| machine.parameters.model().id()),
        ok: loaded.is_some(),
        faults: faults.iter().map(Entry::new).collect(),
    })
}

impl Entry {
    fn new(fault: &FileFault) -> Entry {
        Entry {
            severity: match fault.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            file: fault.path.display().to_string(),
            line: fault.marked.line,
            column: fault.marked.columns.map(|(column, _)| column),
            message: fault.title.clone(),
            detail: fault.label.clone(),
        }
    }
}
