//! `bahn plc check`: compile and say what is wrong.

use bahn_report::plc::Entry;

use super::options::CheckOptions;
use super::source::Source;
use crate::diagnostics::Item;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};
use bahn_report::count;

/// Compiles a program and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let compilation = &source.compilation;
    let report = Report {
        ok: compilation.program.is_some() && source.of_machine.is_empty(),
        errors: compilation.errors.iter().map(Entry::new).collect(),
        machine: source.of_machine.iter().map(Item::from).collect(),
        warnings: compilation.warnings.iter().map(Entry::new).collect(),
        not_listed: compilation.not_listed,
        size_bytes: compilation.size_bytes,
        nominal_percent: compilation.nominal_percent(),
        load: compilation.load(),
    };
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => {
            source.print_faults();
            for what in &report.load {
                diagnostics::print_text(&format!("warning: {what}"));
            }
            diagnostics::print_text(&format!(
                "{}: {}, {}{}, {} bytes, nominal cycle time {:.2} %",
                options.program.file.display(),
                count(report.errors.len() + report.machine.len(), "error"),
                count(report.warnings.len(), "warning"),
                more(report.not_listed),
                report.size_bytes,
                report.nominal_percent,
            ));
        }
    }
    Ok(if report.ok {
        Outcome::Fine
    } else {
        Outcome::ProgramError
    })
}

/// How many errors and warnings there are besides.
fn more(not_listed: usize) -> String {
    match not_listed {
        0 => String::new(),
        count => format!(", {count} more of both"),
    }
}

#[derive(Debug, serde::Serialize)]
struct Report {
    ok: bool,
    errors: Vec<Entry>,
    /// What of the folder of a machine does not go together with it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    machine: Vec<Item>,
    warnings: Vec<Entry>,
    #[serde(skip_serializing_if = "is_zero")]
    not_listed: usize,
    size_bytes: u32,
    nominal_percent: f64,
    /// What is too much for the control.
    load: Vec<String>,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}
