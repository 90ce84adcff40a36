//! What is wrong, on standard error for people, and for programs.

use std::io::{self, IsTerminal, Write};

use bahn_text::{Diagnostic, Severity, printable, printable_lines, render};
use serde::Serialize;

use crate::refused;

/// Faults of a file that are printed; the others are counted.
pub(crate) const PRINTED_MAX: usize = 100;

/// Prints a fault as rustc does, with an empty line after it.
pub(crate) fn print_fault(fault: &Diagnostic) {
    if fault.severity == Severity::Error {
        refused::fault(fault, PRINTED_MAX);
    }
    print_styled(&render(fault, is_styled()));
    print_line("");
}

/// A fault as reports for programs have it. A line as a whole is all of its characters.
#[derive(Debug, Serialize)]
pub(crate) struct Item {
    severity: &'static str,
    file: String,
    line: u32,
    column: u32,
    length: u32,
    message: String,
    detail: String,
    help: String,
}

impl From<&Diagnostic> for Item {
    fn from(fault: &Diagnostic) -> Item {
        let whole = || (1, u32::try_from(fault.source.chars().count()).unwrap_or(u32::MAX));
        let (column, length) = fault.span.columns().unwrap_or_else(whole);
        Item {
            severity: fault.severity.name(),
            file: fault.file.display().to_string(),
            line: fault.span.line,
            column,
            length,
            message: fault.message.clone(),
            detail: fault.detail.clone(),
            help: fault.help.clone().unwrap_or_default(),
        }
    }
}

/// Prints the first [`PRINTED_MAX`] faults, and how many there are besides.
pub(crate) fn print_faults(faults: &[Diagnostic]) {
    faults.iter().take(PRINTED_MAX).for_each(print_fault);
    print_rest(faults.len().saturating_sub(PRINTED_MAX));
}

/// Says how many faults are not shown.
pub(crate) fn print_rest(count: usize) {
    if count > 0 {
        print_line(&format!("{count} more not shown\n"));
    }
}

/// Prints what is wrong with the use of the command.
pub(crate) fn print_usage_error(text: &str) {
    let level = if is_styled() {
        "\x1b[1m\x1b[91merror\x1b[0m"
    } else {
        "error"
    };
    refused::error(text);
    let text: Vec<String> = text.lines().map(printable).collect();
    print_styled(&format!("{level}: {}", text.join("\n  ")));
}

/// Prints a line to standard error, with nothing in it that would steer the terminal.
pub(crate) fn print_text(text: &str) {
    print_line(&printable(text));
}

/// Prints what was lost at power-on, or is otherwise than it seems.
pub(crate) fn print_warnings(texts: &[String]) {
    for text in texts {
        print_line(&format!("warning: {text}"));
    }
}

/// Prints lines to standard error, with nothing in them that would steer the terminal.
pub(crate) fn print_line(text: &str) {
    if text.starts_with("error: ") {
        refused::error(text);
    }
    print_styled(&printable_lines(text));
}

/// Prints what has colours of ours; nobody can be told when that fails.
fn print_styled(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Whether standard error shows colours.
pub(crate) fn is_styled() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
