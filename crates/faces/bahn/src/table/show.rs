//! `bahn table show`: a table in columns.

use bahn_host::{CellContent, LoadedMachine, PlainTable, TableForm};
use serde_json::{Map, Value, json};

use super::options::{ShowFormat, ShowOptions};
use super::source::{self, Source};
use crate::{Outcome, UsageError, console};
use bahn_text::printable_lines;

pub(super) fn command(options: &ShowOptions) -> Result<Outcome, UsageError> {
    let machine = source::machine(&options.table)?;
    let path = match &machine {
        Some(machine) => {
            let kind = options.kind.map_or(TableForm::Tool, TableForm::from);
            source::of_machine(machine, kind)?
        }
        None => options.table.clone(),
    };
    let kind = match &machine {
        Some(_) => options.kind.or(Some(super::options::KindOption::Tool)),
        None => options.kind,
    };
    let source = source::read(&path, kind)?;
    if let Err(faults) = source.kind.check(&source.text) {
        source.print(&faults);
        return Ok(Outcome::ProgramError);
    }
    let mut table = PlainTable::new(source.kind, &source.table);
    if let Some(remembered) = machine.as_ref().and_then(LoadedMachine::remembered) {
        table.bring_up_to_date(&remembered);
    }
    if let Some(shown) = machine
        .and_then(|machine| source.kind.shown(&machine.parameters))
        .filter(|_| !options.all)
    {
        let key = [source.kind.key().to_owned()].into_iter();
        table.choose(&key.chain(shown).collect::<Vec<_>>());
    }
    match options.format {
        ShowFormat::Text => console::print(&columns(&table))?,
        ShowFormat::Csv => console::print_bytes(data(&table, ',').as_bytes())?,
        ShowFormat::Tsv => console::print_bytes(data(&table, '\t').as_bytes())?,
        ShowFormat::Json => console::print_json(&report(&source, &table))?,
    }
    Ok(Outcome::Fine)
}

/// For other programs, which need the tabs; nothing else in it steers a terminal.
fn data(table: &PlainTable, separator: char) -> String {
    let text = table.separated(separator);
    let parts = text.split('\t').map(printable_lines);
    parts.collect::<Vec<_>>().join("\t")
}

/// Numbers to the right, text to the left.
fn columns(table: &PlainTable) -> String {
    let width = |at: usize| {
        let fields = table
            .rows
            .iter()
            .filter_map(|row| row.get(at))
            .chain(table.names.get(at));
        fields
            .map(|field| field.chars().count())
            .max()
            .unwrap_or_default()
    };
    let widths: Vec<(usize, bool)> = (0..)
        .zip(&table.names)
        .map(|(at, name)| (width(at), table.kind.content(name) == CellContent::Text))
        .collect();
    let line = |fields: &Vec<String>| {
        let padded = fields
            .iter()
            .zip(&widths)
            .map(|(field, (width, left))| match left {
                true => format!("{field:<width$}"),
                false => format!("{field:>width$}"),
            });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    [&table.names].into_iter().chain(&table.rows).map(line).collect()
}

/// A table as JSON: numbers are numbers, empty fields are left out.
fn report(source: &Source, table: &PlainTable) -> Value {
    let value = |name: &str, field: &str| match table.kind.content(name) {
        CellContent::Text => json!(field),
        CellContent::Length | CellContent::Number => {
            let number = field.replace(',', ".").parse::<f64>();
            number.map_or_else(|_| json!(field), |number| json!(number))
        }
    };
    let row = |(row, at): (&Vec<String>, u32)| {
        let fields = table.names.iter().zip(row).filter(|(_, field)| !field.is_empty());
        let mut object: Map<String, Value> = fields
            .map(|(name, field)| (name.clone(), value(name, field)))
            .collect();
        object.insert("line".to_owned(), json!(at));
        Value::Object(object)
    };
    let lines = source.table.rows.iter().map(|row| row.line);
    json!({
        "file": source.path.display().to_string(),
        "kind": table.kind.name(),
        "unit": "mm",
        "rows": table.rows.iter().zip(lines).map(row).collect::<Vec<_>>(),
    })
}
