//! What is wrong with a list of machine parameters, at its place.

use std::path::Path;

use bahn_parameters::{Definition, Inconsistency, ListError, ListText, ParameterList, chapters};

use crate::fault::{FileFault, Marked, Severity};

/// All faults of the list of a machine, then what does not go together in it. What the list does not name
/// keeps its value of the reference list.
pub(crate) fn machine_list(text: &ListText, list: &ParameterList, path: &Path) -> Vec<FileFault> {
    let faults = text.faults();
    if !faults.is_empty() {
        return faults.iter().map(|found| fault(found, text, path)).collect();
    }
    let found = list.inconsistencies();
    found
        .iter()
        .map(|found| inconsistency(found, text, path))
        .collect()
}

/// A fault of a list at its place.
pub fn fault(fault: &ListError, text: &ListText, path: &Path) -> FileFault {
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

/// What does not go together, at the first parameter of it that the list names: an error where no machine can be so.
pub fn inconsistency(found: &Inconsistency, text: &ListText, path: &Path) -> FileFault {
    let line = line_of(found, text);
    FileFault {
        severity: match found.impossible {
            true => Severity::Error,
            false => Severity::Warning,
        },
        title: found.rule.to_owned(),
        path: path.to_owned(),
        marked: Marked {
            line: line as u32,
            text: text.line(line),
            columns: None,
        },
        label: format!("{} ({})", found.detail, chapters(found.source).join("; ")),
        help: None,
        opened: None,
    }
}

/// The line that sets the parameter, from 1; the first where none does.
fn line_of(found: &Inconsistency, text: &ListText) -> usize {
    let mut entries = text.entries().iter();
    entries
        .find(|entry| entry.id == found.id)
        .map_or(1, |entry| entry.line)
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
