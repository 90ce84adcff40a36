//! `bahn channel explain`: what a parameter, a type or a value means.

use bahn_parameters::chapters;
use bahn_report::paragraph::{labelled, labelled_lines};
use bahn_technology::Synch;
use bahn_technology::list::{Definition, Owner, SynchRow};
use serde::Serialize;

use super::options::ExplainOptions;
use crate::options::Format;
use crate::style::Style;
use crate::{Outcome, UsageError, console};

/// Explains what is wanted, or lists everything.
pub(super) fn command(options: &ExplainOptions) -> Result<Outcome, UsageError> {
    let (parameters, types) = match &options.wanted {
        None => (
            Definition::all().iter().collect(),
            SynchRow::all().iter().collect(),
        ),
        Some(wanted) => found(wanted.trim())?,
    };
    match options.format {
        Format::Json => {
            let parameters = parameters.iter().map(|row| Item::Parameter(row.into()));
            let types = types.iter().map(|row| Item::Type(TypeItem::from(*row)));
            console::print_json(&parameters.chain(types).collect::<Vec<_>>())?;
        }
        Format::Text if options.wanted.is_none() => console::print(&overview(&parameters, &types))?,
        Format::Text => {
            let style = Style::of_output();
            let parameters = parameters.iter().map(|row| parameter(row, style));
            let types = types.iter().map(|row| synch(row, style));
            let text = parameters.chain(types).collect::<Vec<_>>().join("\n");
            console::print_bytes(text.as_bytes())?;
        }
    }
    Ok(Outcome::Fine)
}

/// What a word means: a parameter by name or number, a type or bit by name, or a value with all its bits.
type Found = (Vec<&'static Definition>, Vec<&'static SynchRow>);

fn found(wanted: &str) -> Result<Found, UsageError> {
    if let Some(parts) = parts(wanted) {
        return Ok((Vec::new(), parts));
    }
    if let Some(row) = Definition::named(wanted) {
        return Ok((vec![row], Vec::new()));
    }
    let bare = without_indices(wanted);
    let digits = wanted.trim_start_matches(|c: char| !c.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| is_number(wanted));
    let is_meant = |row: &&Definition| {
        let of_id = row.id.rsplit('-').next().and_then(|id| id.parse::<u32>().ok());
        let names = |name: &str| {
            let known = without_indices(name);
            known == bare || known.rsplit('.').next() == Some(bare.as_str())
        };
        (number.is_some() && number == of_id && is_kind(row.id, wanted))
            || row
                .meaning
                .split([' ', '.'])
                .any(|word| word.eq_ignore_ascii_case(wanted) && word.starts_with("P-STUP-"))
            || row.names().any(names)
            || row.default == wanted
    };
    let rows: Vec<&Definition> = Definition::all().iter().filter(is_meant).collect();
    if rows.is_empty() {
        return Err(UsageError::new(format!(
            "nothing here is called `{wanted}`; `bahn channel explain` lists all parameters and types"
        )));
    }
    Ok((rows, Vec::new()))
}

/// The type and the bits that a value or an expression of constants is made of.
fn parts(wanted: &str) -> Option<Vec<&'static SynchRow>> {
    let value = |text: &str| {
        let hexadecimal = text.strip_prefix("0x").or(text.strip_prefix("0X"));
        let number = match hexadecimal {
            Some(digits) => u32::from_str_radix(digits, 16).ok(),
            None => text.parse().ok(),
        };
        number.or_else(|| Synch::constant(text))
    };
    let mut terms = wanted.split('|').map(|term| value(term.trim()));
    let bits = terms.try_fold(0_u32, |sum, term| Some(sum | term?))?;
    let synch = Synch::from_bits(bits).ok()?;
    // A bit alone is explained alone.
    let is_bit_alone = SynchRow::all().iter().any(|row| row.is_bit && row.bits == bits);
    let kind = SynchRow::find(synch.kind.name()).filter(|_| !is_bit_alone);
    let flags = SynchRow::all()
        .iter()
        .filter(|row| row.is_bit && bits & row.bits != 0);
    Some(kind.into_iter().chain(flags).collect())
}

/// `41`, `00041`, `P-CHAN-00041`, `chan-41`.
fn is_number(wanted: &str) -> bool {
    let letters = wanted.trim_end_matches(|c: char| c.is_ascii_digit());
    let letters = letters.trim_matches('-').to_ascii_uppercase();
    ["", "P", "CHAN", "P-CHAN", "AXIS", "P-AXIS"].contains(&letters.as_str())
}

/// Whether the number is one of the list that the word names, if it names one.
fn is_kind(id: &str, wanted: &str) -> bool {
    let wanted = wanted.to_ascii_uppercase();
    ["CHAN", "AXIS"]
        .iter()
        .all(|kind| !wanted.contains(kind) || id.contains(kind))
}

/// A name in small letters without what stands in brackets.
fn without_indices(name: &str) -> String {
    let parts = name.split('[').enumerate();
    let kept = parts.map(|(at, part)| match at {
        0 => part,
        _ => part.split_once(']').map_or("", |(_, rest)| rest),
    });
    kept.collect::<String>().to_ascii_lowercase()
}

fn parameter(row: &Definition, style: Style) -> String {
    let mut text = format!("{}\n", style.bold(&format!("{}  {}", row.id, row.name)));
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

fn synch(row: &SynchRow, style: Style) -> String {
    let mut text = format!("{}\n", style.bold(&format!("{}  0x{:08X}", row.name, row.bits)));
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
fn overview(parameters: &[&Definition], types: &[&SynchRow]) -> String {
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
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Item {
    Parameter(ParameterItem),
    Type(TypeItem),
}

#[derive(Serialize)]
struct ParameterItem {
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

#[derive(Serialize)]
struct TypeItem {
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
