//! What rows of the lists of parameters and of types of synchronisation say, for people and for programs.

use bahn_parameters::chapters;
use bahn_technology::list::{Definition, Owner, SynchRow};
use serde::Serialize;

use crate::paragraph::{labelled, labelled_lines};

/// The rows for programs.
pub fn items(parameters: &[&'static Definition], types: &[&'static SynchRow]) -> Vec<Item> {
    let parameters = parameters.iter().map(|row| Item::Parameter(row.into()));
    let types = types.iter().map(|row| Item::Type(TypeItem::from(*row)));
    parameters.chain(types).collect()
}

/// The rows for people, each under its heading.
pub fn text(
    parameters: &[&'static Definition],
    types: &[&'static SynchRow],
    heading: impl Fn(&str) -> String,
) -> String {
    let parameters = parameters.iter().map(|row| parameter(row, &heading));
    let types = types.iter().map(|row| synch(row, &heading));
    parameters.chain(types).collect::<Vec<_>>().join("\n")
}

fn parameter(row: &Definition, heading: &impl Fn(&str) -> String) -> String {
    let mut text = format!("{}\n", heading(&format!("{}  {}", row.id, row.name)));
    let mut line = |label: &str, content: &str| text += &labelled(label, content);
    line("does:", row.meaning);
    line("also:", &row.variants.join(", "));
    line("values:", &row.kind.range());
    line("unit:", row.unit);
    line("default:", row.default);
    line("index:", &indices(row).unwrap_or_default());
    if !row.without_effect.is_empty() {
        line("effect:", &format!("none here: {}", row.without_effect));
    }
    text + &source(row.source)
}

fn indices(row: &Definition) -> Option<String> {
    let ranges: Vec<String> = row
        .indices
        .iter()
        .map(|(first, last)| format!("{first} to {last}"))
        .collect();
    (!ranges.is_empty()).then(|| ranges.join(", "))
}

/// Manual and chapter; what is said of them after.
fn source(source: &str) -> String {
    let (cited, remark) = match source.split_once('(') {
        Some((cited, remark)) => (cited.trim(), remark.trim_end_matches(')')),
        None => (source, ""),
    };
    let said = match remark.split_once(": ") {
        Some(("public", what)) => format!("public documentation of the manufacturer: {what}"),
        Some((mark, what)) => format!("{mark}: {what}"),
        None if remark == "public" => "public documentation of the manufacturer".to_owned(),
        None => remark.to_owned(),
    };
    let mut lines = chapters(cited);
    lines.extend((!said.is_empty()).then_some(said));
    labelled_lines("source:", &lines)
}

fn synch(row: &SynchRow, heading: &impl Fn(&str) -> String) -> String {
    let mut text = format!("{}\n", heading(&format!("{}  0x{:08X}", row.name, row.bits)));
    let mut line = |label: &str, content: &str| text += &labelled(label, content);
    line("does:", row.meaning);
    line("output:", row.output);
    line("waits:", row.wait);
    line("for:", &owners(row).join(", "));
    if row.is_bit {
        line("use:", "joined to a type by |");
    }
    text + &source(row.source)
}

/// Whose functions may have it.
fn owners(row: &SynchRow) -> Vec<&'static str> {
    let all = [
        (Owner::M, "M functions"),
        (Owner::H, "H functions"),
        (Owner::Spindle, "spindles"),
    ];
    all.into_iter()
        .filter_map(|(owner, name)| row.is_for(owner).then_some(name))
        .collect()
}

/// A line for each parameter and type.
pub fn overview(parameters: &[&Definition], types: &[&SynchRow]) -> String {
    let mut text = String::new();
    let width = parameters
        .iter()
        .map(|row| row.name.len())
        .max()
        .unwrap_or_default();
    for row in parameters {
        let effect = if row.without_effect.is_empty() {
            ""
        } else {
            "  (no effect here)"
        };
        text += &format!("{:<14}{:<width$}  {}{effect}\n", row.id, row.name, row.default);
    }
    text.push('\n');
    for row in types {
        let when = match row.is_bit {
            true => "joined to a type by |".to_owned(),
            false => format!("output {}, waited for {}", row.output, row.wait),
        };
        text += &format!("0x{:08X}    {:<10} {when}\n", row.bits, row.name);
    }
    text
}

/// A row for programs.
#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Item {
    /// A parameter.
    Parameter(ParameterItem),
    /// A type of synchronisation, or a bit of one.
    Type(TypeItem),
}

/// A parameter as JSON has it.
#[derive(Debug, Serialize)]
pub struct ParameterItem {
    id: &'static str,
    name: &'static str,
    variants: Vec<&'static str>,
    values: String,
    unit: &'static str,
    default: &'static str,
    index: Option<String>,
    meaning: &'static str,
    without_effect: &'static str,
    source: &'static str,
}

impl From<&&'static Definition> for ParameterItem {
    fn from(row: &&'static Definition) -> ParameterItem {
        ParameterItem {
            id: row.id,
            name: row.name,
            variants: row.variants.clone(),
            values: row.kind.range(),
            unit: row.unit,
            default: row.default,
            index: indices(row),
            meaning: row.meaning,
            without_effect: row.without_effect,
            source: row.source,
        }
    }
}

/// A type as JSON has it.
#[derive(Debug, Serialize)]
pub struct TypeItem {
    name: &'static str,
    value: String,
    bit: bool,
    output: &'static str,
    waits: &'static str,
    functions: Vec<&'static str>,
    meaning: &'static str,
    source: &'static str,
}

impl From<&'static SynchRow> for TypeItem {
    fn from(row: &'static SynchRow) -> TypeItem {
        TypeItem {
            name: row.name,
            value: format!("0x{:08X}", row.bits),
            bit: row.is_bit,
            output: row.output,
            waits: row.wait,
            functions: owners(row),
            meaning: row.meaning,
            source: row.source,
        }
    }
}
