//! `bahn plc check`: compile and say what is wrong.

use bahn_plc::Diagnostic as Fault;

use super::options::CheckOptions;
use super::source::Source;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

/// Logic commands for which a PLC run has time [000:11185].
const COMMANDS_MAX: usize = 8000;
/// Load up to which the control keeps its block processing speed, % [000:12038].
const KEPT_PERCENT: f64 = 100.0;
/// Load that should not occur [000:12038], and that which stops the control: 10 ms [000:11245], %.
const RESERVE_PERCENT: f64 = 150.0;
const TIME_OUT_PERCENT: f64 = 200.0;

/// Compiles a program and prints what is wrong.
pub(super) fn command(options: &CheckOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let compilation = &source.compilation;
    let report = Report {
        ok: compilation.program.is_some(),
        errors: compilation.errors.iter().map(Entry::new).collect(),
        warnings: compilation.warnings.iter().map(Entry::new).collect(),
        not_listed: compilation.not_listed,
        size_bytes: compilation.size_bytes,
        nominal_percent: compilation.nominal_percent(),
        load: load(
            compilation
                .program
                .as_ref()
                .map_or(0, |program| program.code.len()),
            compilation.nominal_percent(),
        ),
    };
    match options.format {
        Format::Json => console::print_json(&report)?,
        Format::Text => {
            source.print_faults();
            for what in &report.load {
                diagnostics::print_text(&format!("warning: {what}"));
            }
            let count = |number: usize, what: &str| match number {
                1 => format!("1 {what}"),
                _ => format!("{number} {what}s"),
            };
            diagnostics::print_text(&format!(
                "{}: {}, {}{}, {} bytes, nominal cycle time {:.2} %",
                options.program.file.display(),
                count(report.errors.len(), "error"),
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

/// What is too much for the control, though it can be compiled.
fn load(commands: usize, percent: f64) -> Vec<String> {
    let mut found = Vec::new();
    if commands > COMMANDS_MAX {
        found.push(format!(
            "{commands} commands: a PLC run has time for {COMMANDS_MAX} of them"
        ));
    }
    let means = match percent {
        _ if percent > TIME_OUT_PERCENT => "more than 10 ms: PLC-program error 53 stops the control",
        _ if percent > RESERVE_PERCENT => {
            "above 150 % no reserve is left for data transfer and handwheel: error 53 may come"
        }
        _ if percent > KEPT_PERCENT => "above 100 % the control does not keep its block processing speed",
        _ => return found,
    };
    found.push(format!("nominal cycle time {percent:.2} %: {means}"));
    found
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

/// An error or a warning.
#[derive(Debug, serde::Serialize)]
pub(super) struct Entry {
    pub number: u8,
    file: String,
    line: u32,
    column: u32,
    pub message: String,
}

impl Entry {
    pub fn new(fault: &Fault) -> Entry {
        Entry {
            number: fault.error.number(),
            file: fault.file.clone(),
            line: fault.line,
            column: fault.column,
            message: fault.message.clone(),
        }
    }
}
