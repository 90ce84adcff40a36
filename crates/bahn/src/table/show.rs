//! `bahn table show`: a table in columns.

use bahn_control::Remembered;
use bahn_host::{CellContent, LoadedMachine, PlainTable, TableForm, canonical};
use bahn_parameters::tables::{POCKET_ELEMENTS, TOOL_ELEMENTS, shown_elements};
use bahn_plc::TableKind;
use serde_json::{Map, Value, json};

use super::options::{ShowFormat, ShowOptions};
use super::source::{self, Source};
use crate::{Outcome, UsageError, console};

/// Prints a table.
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
        bring_up_to_date(&mut table, &remembered);
    }
    if let Some(shown) = machine
        .and_then(|machine| shown(&machine, source.kind))
        .filter(|_| !options.all)
    {
        let key = [source.kind.key().to_owned()].into_iter();
        table.choose(&key.chain(shown).collect::<Vec<_>>());
    }
    match options.format {
        ShowFormat::Text => console::print(&columns(&table))?,
        ShowFormat::Csv => console::print(&table.separated(','))?,
        ShowFormat::Tsv => console::print(&table.separated('\t'))?,
        ShowFormat::Json => console::print_json(&report(&source, &table))?,
    }
    Ok(Outcome::Fine)
}

/// Tools have changed their pockets, their lives were counted, the PLC has written.
fn bring_up_to_date(table: &mut PlainTable, remembered: &Remembered) {
    let key = table.kind.key();
    let kind = match table.kind {
        TableForm::Tool => TableKind::Tool,
        TableForm::Pocket => TableKind::Pocket,
        _ => return,
    };
    let written = remembered.written.iter().filter(|element| element.table == kind);
    let written: Vec<(String, &str, String)> = written
        .filter_map(|element| {
            let column = kind.columns().get(element.element)?.as_ref()?;
            Some((
                element.line.to_string(),
                canonical(column.name),
                element.value.to_string(),
            ))
        })
        .collect();
    for (line, column, value) in &written {
        table.set(key, line, column, value);
    }
    let moved = remembered.pockets.iter();
    let moved: Vec<(String, Option<u16>)> = moved
        .map(|moved| (moved.tool.to_string(), moved.pocket))
        .collect();
    if table.kind == TableForm::Tool {
        for (tool, pocket) in &moved {
            table.set(
                key,
                tool,
                "P",
                &pocket.map(|pocket| pocket.to_string()).unwrap_or_default(),
            );
        }
        return;
    }
    for (tool, _) in &moved {
        table.set("T", tool, "T", "");
    }
    for (tool, pocket) in moved.iter().filter_map(|(tool, pocket)| Some((tool, (*pocket)?))) {
        table.set(key, &pocket.to_string(), "T", tool);
    }
}

/// The columns that the control shows of a table; `None` for all of them.
fn shown(machine: &LoadedMachine, kind: TableForm) -> Option<Vec<String>> {
    let tables = machine.parameters.table_parameters();
    let shown = match kind {
        TableForm::Tool => shown_elements(&tables.tool_columns, &TOOL_ELEMENTS),
        TableForm::Pocket => shown_elements(&tables.pocket_columns, &POCKET_ELEMENTS),
        _ => return None,
    };
    let shown: Vec<String> = shown.into_iter().map(str::to_owned).collect();
    (!shown.is_empty()).then_some(shown)
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
