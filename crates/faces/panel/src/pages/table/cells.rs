//! What stands in cells, and lines of the file of a table.

use std::path::Path;

use bahn_host::{LineChange, TableForm, files, set_line};
use bahn_text::decode;

/// A mark: ENT sets it, NO ENT takes it away [003:1906-1911].
pub(super) fn is_mark(form: TableForm, column: &str) -> bool {
    match form {
        TableForm::Tool => matches!(column, "TL" | "ST"),
        TableForm::Pocket => matches!(column, "ST" | "F" | "L"),
        _ => false,
    }
}

/// What the control keeps of a cell: marks are 1, no tool is -1.
pub(super) fn element_value(form: TableForm, column: &str, value: &str) -> Option<f64> {
    let empty = matches!(value, "" | "-");
    match column {
        "T" | "RT" if empty || value == "0" => Some(-1.0),
        _ if is_mark(form, column) || column == "DIRECT" => {
            Some(f64::from(u8::from(!empty && !matches!(value, "0" | "N"))))
        }
        _ if empty => Some(0.0),
        "PLC" => match value.strip_prefix('%') {
            Some(bits) => u8::from_str_radix(bits, 2).ok().map(f64::from),
            None => value.parse().ok(),
        },
        _ => value.parse().ok(),
    }
}

pub(super) fn read(path: &Path) -> Result<String, String> {
    let bytes = files::read_table(path).map_err(|error| error.to_string())?;
    Ok(decode(&bytes))
}

/// The text of the table of a file with a new line.
pub(super) fn with_line(path: &Path, form: TableForm, line: &str) -> Result<String, String> {
    match set_line(&read(path)?, form, line, &[])? {
        (_, LineChange::Changed) => Err(format!("{} {line}", form.key())),
        (text, LineChange::Added) => Ok(text),
    }
}
