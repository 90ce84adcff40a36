//! `bahn mp check`: all faults of lists.

use std::path::{Path, PathBuf};

use bahn_parameters::conformance::{Effect, Kind, find};
use bahn_parameters::{Inconsistency, ListError, ListText, ParameterError, ParameterId};
use bahn_text::Diagnostic;
use serde::Serialize;

use super::options::CheckOptions;
use super::source;
use crate::diagnostics;
use crate::options::Format;
use crate::reports::Reports;
use crate::{Outcome, UsageError, files};
use bahn_report::count;

/// Checks lists and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let mut reports = Reports::new();
    for path in &options.files {
        match lists(path) {
            Ok(lists) => lists
                .iter()
                .for_each(|list| reports.add(list, check(list, options))),
            Err(error) => reports.add(path, Err(error)),
        }
    }
    reports.end(options.format, |report| !report.errors.is_empty())
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
    /// How many more errors there are.
    not_listed: usize,
    warnings: Vec<Item>,
}

#[derive(Debug, Serialize)]
struct Item {
    /// Number of the control's editor; none for what does not go together.
    number: Option<u8>,
    text: String,
    parameter: Option<String>,
    line: u32,
    column: u32,
    length: u32,
    detail: String,
}

fn check(path: &Path, options: &CheckOptions) -> Result<Report, UsageError> {
    let text = source::read(path, options.model)?;
    let of_machine = source::of_machine(path, &text);
    let faults = match options.partial || of_machine.is_some() {
        true => text.faults().to_vec(),
        false => text.all_faults(),
    };
    let inconsistent = match &of_machine {
        _ if !faults.is_empty() => Vec::new(),
        Some(list) => list.inconsistencies(),
        None if options.partial => Vec::new(),
        None => text.inconsistencies(),
    };
    let lacking = of_machine.map_or_else(Vec::new, |list| text.lacking(&list, path));
    let (impossible, doubtful): (Vec<Inconsistency>, Vec<_>) =
        inconsistent.into_iter().partition(|found| found.impossible);
    let marked = |found: &Inconsistency| found.diagnostic(&text, path);
    let (impossible_at, warnings): (Vec<Diagnostic>, Vec<Diagnostic>) = (
        impossible.iter().map(marked).collect(),
        doubtful.iter().map(marked).collect(),
    );
    let items = |found: &[Inconsistency], at: &[Diagnostic]| -> Vec<Item> {
        found
            .iter()
            .zip(at)
            .map(|(found, fault)| inconsistent_item(found, fault))
            .collect()
    };
    let report = Report {
        file: path.display().to_string(),
        model: text.model().id(),
        entries: text.entries().len(),
        without_effect: entries_with(&text, Effect::None),
        acting_partly: entries_with(&text, Effect::Partly),
        errors: faults
            .iter()
            .map(error_item)
            .chain(items(&impossible, &impossible_at))
            .chain(lacking.iter().map(lacking_item))
            .collect(),
        not_listed: text.not_listed(),
        warnings: items(&doubtful, &warnings),
    };
    if options.format == Format::Text {
        let unreadable: Vec<Diagnostic> = faults
            .iter()
            .filter(|fault| !is_missing(fault))
            .map(|fault| fault.diagnostic(&text, path))
            .collect();
        diagnostics::print_faults(&unreadable);
        let missing: Vec<&ListError> = faults.iter().filter(|fault| is_missing(fault)).collect();
        if let Some(first) = missing.first() {
            print_missing(&missing, first);
        }
        impossible_at
            .iter()
            .chain(&lacking)
            .chain(&warnings)
            .for_each(diagnostics::print_fault);
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
        line: fault.span.line,
        column: fault.span.column,
        length: fault.span.length,
        detail: fault.error.to_string(),
    }
}

fn inconsistent_item(found: &Inconsistency, fault: &Diagnostic) -> Item {
    Item {
        number: None,
        text: fault.message.clone(),
        parameter: Some(found.id.to_string()),
        line: fault.span.line,
        column: fault.span.column.max(1),
        length: fault.span.length,
        detail: fault.detail.clone(),
    }
}

/// What the control of the machine has not: an option, or a later software.
fn lacking_item(fault: &Diagnostic) -> Item {
    Item {
        number: None,
        text: fault.message.clone(),
        parameter: Some(fault.code.clone()),
        line: fault.span.line,
        column: fault.span.column.max(1),
        length: fault.span.length,
        detail: fault.detail.clone(),
    }
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
