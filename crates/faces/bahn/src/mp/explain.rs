//! `bahn mp explain`: what a parameter means.

use bahn_parameters::{Definition, chapters, with_chapters};
use bahn_report::paragraph::{labelled, labelled_lines};

use super::list::Row;
use super::options::ExplainOptions;
use super::source;
use crate::options::Format;
use crate::style::Style;
use crate::{Outcome, UsageError, console};

/// Explains one parameter, or all indices of a number.
pub(super) fn command(options: &ExplainOptions) -> Result<Outcome, UsageError> {
    let (list, name) = source::shown(&options.values)?;
    let written = options
        .number
        .trim()
        .trim_start_matches(['M', 'P', 'm', 'p'])
        .trim_start();
    let is_meant = |definition: &&Definition| {
        let id = definition.id.to_string();
        let own = id.trim_start_matches("MP");
        let without_index = own.split('.').next();
        // One value only may be named with index 0.
        own == written || without_index == Some(written) || format!("{own}.0") == written
    };
    let rows: Vec<Row> = Definition::all(list.model())
        .iter()
        .filter(is_meant)
        .map(|definition| Row::new(definition, &list))
        .collect();
    let Some(first) = rows.first() else {
        return Err(UsageError::new(format!(
            "the {} has no machine parameter `{}`; `bahn mp list` lists all",
            list.model(),
            options.number
        )));
    };
    match options.values.format {
        Format::Json => console::print_json(&rows)?,
        Format::Text => console::print_bytes(text(first, &rows, &name, Style::of_output()).as_bytes())?,
    }
    Ok(Outcome::Fine)
}

fn text(first: &Row, rows: &[Row], list: &str, style: Style) -> String {
    let number = first.parameter.split('.').next().unwrap_or_default();
    let title = match rows {
        [one] => format!("{}  {}", one.parameter, one.title()),
        _ => format!("{number}  {}", first.name),
    };
    let mut text = format!("{}\n", style.bold(&title));
    let mut line = |label: &str, content: &str| text += &labelled(label, content);
    line("does:", first.does);
    line("too small:", first.too_small);
    line("too large:", first.too_large);
    line("related:", &related(first));
    line("group:", first.group.unwrap_or_default());
    line("range:", &first.range());
    for (at, choice) in first.choices.iter().enumerate() {
        line(if at == 0 { "values:" } else { "" }, choice);
    }
    line("default:", &standard(rows));
    line("recommended:", &recommended(first.recommended));
    line("change:", change(first));
    line(
        "operator:",
        if first.user {
            "may change it with code number 123"
        } else {
            ""
        },
    );
    line("needs:", reaction(first.reaction));
    for remark in remarks(rows) {
        line("effect:", &remark);
    }
    line("versions:", first.versions);
    line("note:", &with_chapters(first.notes));
    text += &labelled_lines("source:", &chapters(first.source));
    text += &format!("  in the {list}:\n");
    let index_width = rows
        .iter()
        .map(|row| row.parameter.len())
        .max()
        .unwrap_or_default();
    for row in rows {
        let index = if row.index.is_empty() {
            String::new()
        } else {
            format!("  {}", row.index)
        };
        let meaning = if row.meaning.is_empty() {
            String::new()
        } else {
            format!("  = {}", row.meaning.join("; "))
        };
        let value = format!("{} {}", row.value, row.unit);
        text += &format!(
            "    {:<index_width$}  {}{index}{meaning}\n",
            row.parameter,
            style.added(value.trim_end())
        );
    }
    text
}

/// What has no effect here, or only part of it: said once when it is the same for all indices.
fn remarks(rows: &[Row]) -> Vec<String> {
    let runs = rows.chunk_by(|a, b| a.remark() == b.remark());
    let runs = runs.filter_map(|run| Some((run.first()?, run.last()?)));
    let said = runs.map(|(first, last)| match first.remark() {
        remark if remark.is_empty() => remark,
        remark if rows.len() == 1 || rows.iter().all(|row| row.remark() == remark) => remark,
        remark if first.parameter == last.parameter => format!("{}: {remark}", first.parameter),
        remark => format!("{} to {}: {remark}", first.parameter, last.parameter),
    });
    said.collect()
}

/// The related parameters with their names: `MP1070 Radial acceleration, MP1010 Rapid traverse`.
fn related(row: &Row) -> String {
    let all = Definition::all(row.model);
    let named = row.related.iter().filter_map(|number| {
        let definition = all.iter().find(|definition| definition.id.number == *number)?;
        Some(format!("MP{number} {}", definition.name))
    });
    named.collect::<Vec<_>>().join("; ")
}

/// The values of the list that the control makes by itself.
fn standard(rows: &[Row]) -> String {
    let mut values: Vec<&str> = rows.iter().map(|row| row.standard.as_str()).collect();
    values.dedup();
    format!(
        "{} (the list that the control makes by itself)",
        values.join(", ")
    )
}

/// The manual's advice: `rec` recommended, `comm` provisional for commissioning, `std` standard colour.
fn recommended(text: &str) -> String {
    match text.split_once(' ') {
        Some(("rec", value)) => value.to_owned(),
        Some(("comm", value)) => format!("{value} (for commissioning)"),
        Some(("std", value)) => format!("{value} (standard colour)"),
        _ => text.to_owned(),
    }
}

fn change(row: &Row) -> &'static str {
    match row.change {
        "PLC EDIT" => "by the PLC too while no program runs (PLC EDIT)",
        "PLC RUN" => "by the PLC too, also while a program runs (PLC RUN)",
        _ => "in the list, code number 95148",
    }
}

/// What the operator has to do after a change.
pub(super) fn reaction(reaction: &str) -> &'static str {
    match reaction {
        "RESET" => "a restart of the control (RESET)",
        "REF" => "a reference run (REF)",
        _ => "",
    }
}
