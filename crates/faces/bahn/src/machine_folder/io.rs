//! `bahn machine io`: the terminals of a control and its boards, and what is wired to them.

use std::collections::BTreeMap;

use serde::Serialize;

use bahn_host::{LoadedMachine, Operable};
use bahn_parameters::terminals::{Terminal, TerminalKind, terminals};
use bahn_screen::texts::Language;
use bahn_why::wiring;

use super::load;
use super::options::IoOptions;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics};

/// A terminal.
#[derive(Debug, Serialize)]
struct Row {
    terminal: String,
    operand: Option<String>,
    /// What is wired to it, or what it is for on every machine.
    name: Option<String>,
    kind: &'static str,
}

/// Prints the terminals of a machine.
pub(super) fn command(options: &IoOptions) -> Result<Outcome, UsageError> {
    let machine = match load(&options.folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let rows = rows(&machine);
    match options.format {
        Format::Json => console::print_json(&rows)?,
        Format::Text => console::print(&text(&machine, &rows))?,
    }
    Ok(Outcome::Fine)
}

fn rows(machine: &LoadedMachine) -> Vec<Row> {
    let names = machine.plant.as_ref().map(names).unwrap_or_default();
    let all = terminals(machine.parameters.model(), &machine.boards);
    let pinned = all.filter(|terminal| terminal.kind != TerminalKind::Handwheel);
    let row = |terminal: Terminal| {
        let operand = terminal.operand.map(|operand| operand.to_string());
        let wired = operand.as_ref().and_then(|operand| names.get(operand)).cloned();
        let fixed = Some(terminal.name.to_owned()).filter(|name| !name.is_empty());
        Row {
            terminal: terminal.to_string(),
            operand,
            name: wired.or(fixed),
            kind: terminal.kind.id(),
        }
    };
    pinned.map(row).collect()
}

/// What is wired to each operand, in words.
fn names(plant: &impl Operable) -> BTreeMap<String, String> {
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for wired in plant.wires() {
        let words = wiring::in_words(&wired, plant, Language::English);
        let name = names.entry(wired.operand).or_default();
        // A drive of each axis may have the same enable.
        if !name.is_empty() {
            name.push_str(", ");
        }
        name.push_str(&words);
    }
    names
}

fn text(machine: &LoadedMachine, rows: &[Row]) -> String {
    let boards = machine.boards.iter().map(|fitted| fitted.board.name);
    let boards = boards.collect::<Vec<_>>().join(", ");
    let equipment = match boards.is_empty() {
        true => "no boards".to_owned(),
        false => boards,
    };
    let head = format!("{}, {equipment}\n\n", machine.parameters.model().name());
    let width = rows
        .iter()
        .map(|row| row.terminal.len())
        .max()
        .unwrap_or_default();
    let lines = rows.iter().map(|row| {
        let operand = row.operand.as_deref().unwrap_or("-");
        let name = row.name.as_deref().map(bahn_text::printable).unwrap_or_default();
        let line = format!("{:width$}  {operand:<5} {:<9} {name}", row.terminal, row.kind);
        format!("{}\n", line.trim_end())
    });
    head + &lines.collect::<String>()
}
