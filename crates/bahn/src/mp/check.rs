//! `bahn mp check`: all faults of lists.

use std::path::{Path, PathBuf};

use bahn_parameters::conformance::{Effect, Kind, find};
use bahn_parameters::{
    Definition, Inconsistency, ListError, ListText, ParameterError, ParameterId, ParameterList, chapters,
};
use serde::Serialize;

use super::options::CheckOptions;
use super::{count, print_json, source};
use crate::cli::Format;
use crate::diagnostics::{self, FileFault, Marked, Severity};
use crate::{Outcome, UsageError, files};

/// Checks lists and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let mut outcome = Outcome::Fine;
    let mut reports = Vec::new();
    for path in &options.files {
        let lists = lists(path);
        let checked = lists.and_then(|paths| paths.iter().map(|path| check(path, options)).collect());
        match checked {
            Ok::<Vec<Report>, UsageError>(found) => reports.extend(found),
            // The other files are checked all the same.
            Err(error) => {
                diagnostics::print_usage_error(&error.to_string());
                outcome = Outcome::WrongUse;
            }
        }
    }
    if options.format == Format::Json {
        print_json(&reports)?;
    }
    let has_errors = reports.iter().any(|report| !report.errors.is_empty());
    Ok(if outcome == Outcome::Fine && has_errors {
        Outcome::ProgramError
    } else {
        outcome
    })
}

/// The list, or those of a folder in the order of their names.
fn lists(path: &Path) -> Result<Vec<PathBuf>, UsageError> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let cannot = |error| files::cannot("read", path, &error);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(path).map_err(cannot)? {
        let file = entry.map_err(cannot)?.path();
        let is_list = file
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("mp"));
        if is_list && file.is_file() {
            found.push(file);
        }
    }
    found.sort();
    if found.is_empty() {
        return Err(UsageError::new(format!(
            "{} holds no list of machine parameters (*.mp)",
            path.display()
        )));
    }
    Ok(found)
}

/// What is wrong with one list.
#[derive(Debug, Serialize)]
struct Report {
    file: String,
    model: &'static str,
    entries: usize,
    /// Entries that have no effect here.
    without_effect: usize,
    /// Entries that act in part here.
    acting_partly: usize,
    errors: Vec<Item>,
    /// Errors beyond those.
    not_listed: usize,
    warnings: Vec<Item>,
}

#[derive(Debug, Serialize)]
struct Item {
    /// Number of the control's editor; none for a warning.
    number: Option<u8>,
    text: String,
    parameter: Option<String>,
    line: usize,
    column: usize,
    length: usize,
    detail: String,
}

fn check(path: &Path, options: &CheckOptions) -> Result<Report, UsageError> {
    let text = source::read(path, options.model)?;
    let faults = if options.partial {
        text.faults().to_vec()
    } else {
        text.all_faults()
    };
    let report = Report {
        file: path.display().to_string(),
        model: text.model().id(),
        entries: text.entries().len(),
        without_effect: entries_with(&text, Effect::None),
        acting_partly: entries_with(&text, Effect::Partly),
        errors: faults.iter().map(error_item).collect(),
        not_listed: text.not_listed(),
        warnings: warnings(&text, options.partial || !faults.is_empty()),
    };
    if options.format == Format::Text {
        let unreadable: Vec<FileFault> = faults
            .iter()
            .filter(|fault| !is_missing(fault))
            .map(|fault| file_fault(fault, &text, path))
            .collect();
        diagnostics::print_faults(&unreadable);
        let missing: Vec<&ListError> = faults.iter().filter(|fault| is_missing(fault)).collect();
        if let Some(first) = missing.first() {
            print_missing(&missing, first);
        }
        for warning in &report.warnings {
            file_warning(warning, &text, path).print();
        }
        diagnostics::print_line(&format!(
            "{}: {}, {} ({} without effect here, {} in part), {}{}, {}",
            report.file,
            report.model,
            count(report.entries, "parameter"),
            report.without_effect,
            report.acting_partly,
            count(report.errors.len(), "error"),
            match report.not_listed {
                0 => String::new(),
                more => format!(" and {more} more"),
            },
            count(report.warnings.len(), "warning"),
        ));
    }
    Ok(report)
}

/// How many entries of a list have an effect of a kind here.
fn entries_with(text: &ListText, effect: Effect) -> usize {
    let found = |id: ParameterId| find(text.model(), Kind::MachineParameter, &id.to_string());
    let entries = text.entries().iter();
    entries
        .filter(|entry| found(entry.id).is_some_and(|row| row.effect == effect))
        .count()
}

fn is_missing(fault: &ListError) -> bool {
    matches!(fault.error, ParameterError::NotDefined(_))
}

fn error_item(fault: &ListError) -> Item {
    Item {
        number: Some(fault.error.number()),
        text: fault.error.control_text().to_owned(),
        parameter: fault.error.id().map(|id| id.to_string()),
        line: fault.line,
        column: fault.column,
        length: fault.length,
        detail: fault.error.to_string(),
    }
}

/// What does not go together in a list that can be read as a whole.
fn warnings(text: &ListText, is_part: bool) -> Vec<Item> {
    if is_part || text.entries().is_empty() {
        return Vec::new();
    }
    let mut list = ParameterList::smallest(text.model());
    list.take(text);
    warnings_of(text, &list)
}

fn warnings_of(text: &ListText, list: &ParameterList) -> Vec<Item> {
    let line_of = |id| {
        text.entries()
            .iter()
            .find(|entry| entry.id == id)
            .map_or(1, |entry| entry.line)
    };
    let item = |found: Inconsistency| Item {
        number: None,
        text: found.rule.to_owned(),
        parameter: Some(found.id.to_string()),
        line: line_of(found.id),
        column: 1,
        length: 0,
        detail: format!("{} ({})", found.detail, chapters(found.source).join("; ")),
    };
    list.inconsistencies().into_iter().map(item).collect()
}

/// A fault of a list at its place.
fn file_fault(fault: &ListError, text: &ListText, path: &Path) -> FileFault {
    FileFault {
        severity: Severity::Error,
        title: format!("{} {}", fault.error.number(), fault.error.control_text()),
        path: path.to_owned(),
        marked: Marked {
            line: fault.line as u32,
            text: text.line(fault.line),
            columns: Some((fault.column as u32, fault.length as u32)),
        },
        label: fault.error.to_string(),
        help: help(fault, text),
        opened: None,
    }
}

/// All faults of the list of a machine, then what does not go together in it. What the list does not name
/// keeps its value of the reference list.
pub(crate) fn machine_list(text: &ListText, list: &ParameterList, path: &Path) -> Vec<FileFault> {
    let faults = text.faults();
    if !faults.is_empty() {
        return faults.iter().map(|fault| file_fault(fault, text, path)).collect();
    }
    warnings_of(text, list)
        .iter()
        .map(|warning| file_warning(warning, text, path))
        .collect()
}

/// What the parameter is, for someone who has to enter another value.
fn help(fault: &ListError, text: &ListText) -> Option<String> {
    let id = fault.error.id()?;
    let definition = Definition::named(text.model(), id).ok()?;
    let choices: Vec<&str> = definition.choices().take(6).collect();
    let unit = if definition.unit.is_empty() {
        String::new()
    } else {
        format!(" {}", definition.unit)
    };
    let range = definition
        .range_text()
        .map(|[min, max]| format!(", {min} to {max}{unit}"));
    let mut help = format!("{id} is {}{}", definition.name, range.unwrap_or_default());
    if !choices.is_empty() {
        help += &format!(" ({})", choices.join("; "));
    }
    Some(help)
}

/// Columns of the text in which missing parameters are named.
const COLUMNS: usize = 100;

fn print_missing(missing: &[&ListError], first: &ListError) {
    let ids: Vec<ParameterId> = missing.iter().filter_map(|fault| fault.error.id()).collect();
    let mut lines = vec![String::new()];
    for name in ids.chunk_by(follows).filter_map(run_name) {
        match lines.last_mut() {
            Some(line) if line.len() + name.len() + 1 < COLUMNS => *line += &format!(" {name}"),
            _ => lines.push(format!(" {name}")),
        }
    }
    diagnostics::print_usage_error(&format!(
        "{} {}: {}\n{}\n`bahn mp new --from` completes a list; --partial checks one that holds changes only",
        first.error.number(),
        first.error.control_text(),
        count(missing.len(), "parameter"),
        lines.join("\n"),
    ));
    diagnostics::print_line("");
}

/// Whether the second is the next index of the same number.
fn follows(a: &ParameterId, b: &ParameterId) -> bool {
    a.number == b.number && a.index.zip(b.index).is_some_and(|(a, b)| b == a + 1)
}

/// `MP1060.0-4` for all indices in a row.
fn run_name(run: &[ParameterId]) -> Option<String> {
    let (first, last) = (run.first()?, run.last()?);
    Some(match last.index {
        Some(last) if run.len() > 1 => format!("{first}-{last}"),
        _ => first.to_string(),
    })
}

fn file_warning(warning: &Item, text: &ListText, path: &Path) -> FileFault {
    FileFault {
        severity: Severity::Warning,
        title: warning.text.clone(),
        path: path.to_owned(),
        marked: Marked {
            line: warning.line as u32,
            text: text.line(warning.line),
            columns: None,
        },
        label: warning.detail.clone(),
        help: None,
        opened: None,
    }
}
