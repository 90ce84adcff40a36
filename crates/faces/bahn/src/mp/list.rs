//! `bahn mp list`: parameters with value, range, unit and name.

use bahn_parameters::conformance::{Kind, find};
use bahn_parameters::{Advice, Change, ControlModel, Definition, ParameterList, Reaction};
use serde::Serialize;

use super::options::ListOptions;
use super::source;
use crate::options::Format;
use crate::style::Style;
use crate::{Outcome, UsageError, console};

/// Prints the parameters that are wanted.
pub(super) fn command(options: &ListOptions) -> Result<Outcome, UsageError> {
    let (list, _) = source::shown(&options.values)?;
    let rows: Vec<Row> = Definition::all(list.model())
        .iter()
        .filter(|definition| !options.user || definition.user)
        .filter(|definition| is_wanted(definition, &options.wanted))
        .map(|definition| Row::new(definition, &list))
        .filter(|row| !options.changed || row.value != row.standard)
        .filter(|row| !options.without_effect || row.effect != "acts")
        .collect();
    if rows.is_empty() && !options.wanted.is_empty() {
        return Err(UsageError::new(format!(
            "no machine parameter of the {} fits `{}`",
            list.model(),
            options.wanted.join(" ")
        )));
    }
    match options.values.format {
        Format::Json => console::print_json(&rows)?,
        Format::Text => console::print_bytes(text(&rows, Style::of_output()).as_bytes())?,
    }
    Ok(Outcome::Fine)
}

/// Whether the number begins with one of the numbers wanted, and all words are in name, axis or group.
fn is_wanted(definition: &Definition, wanted: &[String]) -> bool {
    let digits = |text: &str| text.trim_start_matches(['M', 'P', 'm', 'p']).to_owned();
    let is_number = |text: &&String| digits(text).starts_with(|c: char| c.is_ascii_digit());
    let (numbers, words): (Vec<&String>, Vec<&String>) = wanted.iter().partition(is_number);
    let own = digits(&definition.id.to_string());
    let text = format!(
        "{} {} {}",
        definition.name,
        definition.axis,
        definition.group().unwrap_or_default()
    )
    .to_lowercase();
    (numbers.is_empty() || numbers.iter().any(|number| own.starts_with(&digits(number))))
        && words.iter().all(|word| text.contains(&word.to_lowercase()))
}

/// What a parameter is, and its value in a list.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Row {
    pub parameter: String,
    pub name: &'static str,
    pub group: Option<&'static str>,
    pub index: &'static str,
    pub value: String,
    /// As number, whatever the format.
    pub number: f64,
    pub meaning: Vec<String>,
    /// What it does here: acts, partly, none.
    pub effect: &'static str,
    /// What it does not do here; empty where it acts.
    pub missing: &'static str,
    pub unit: &'static str,
    pub min: Option<String>,
    pub max: Option<String>,
    /// Value of the list that the control makes by itself.
    pub standard: String,
    pub recommended: &'static str,
    pub choices: Vec<&'static str>,
    pub user: bool,
    pub change: &'static str,
    pub reaction: &'static str,
    pub versions: &'static str,
    pub notes: &'static str,
    pub source: &'static str,
    /// What it does, and what happens when it is too small or too large.
    pub does: &'static str,
    pub too_small: &'static str,
    pub too_large: &'static str,
    /// Numbers that belong to it.
    pub related: &'static [u16],
    #[serde(skip)]
    pub model: ControlModel,
}

impl Row {
    pub fn new(definition: &'static Definition, list: &ParameterList) -> Row {
        let id = definition.id;
        let entry = find(list.model(), Kind::MachineParameter, &id.to_string());
        let number = list.get(id.number, id.index.unwrap_or(0)).unwrap_or_default();
        let advice = Advice::of(list.model(), id.number);
        let [min, max] = definition
            .range_text()
            .map_or([None, None], |range| range.map(Some));
        Row {
            parameter: id.to_string(),
            name: definition.name,
            group: definition.group(),
            index: definition.axis,
            value: definition.format_value(number),
            number,
            meaning: definition.meaning(number),
            effect: entry.map_or("none", |entry| entry.effect.id()),
            missing: entry.map_or("", |entry| entry.missing),
            unit: definition.unit,
            min,
            max,
            standard: definition.format_value(definition.standard()),
            recommended: definition.recommended,
            choices: definition.choices().collect(),
            user: definition.user,
            change: match definition.change {
                Change::List => "list",
                Change::PlcEdit => "PLC EDIT",
                Change::PlcRun => "PLC RUN",
            },
            reaction: match definition.reaction {
                Reaction::None => "none",
                Reaction::Reset => "RESET",
                Reaction::ReferenceMarks => "REF",
            },
            versions: definition.versions,
            notes: definition.notes,
            source: definition.source,
            does: advice.map_or("", |advice| advice.does),
            too_small: advice.map_or("", |advice| advice.too_small),
            too_large: advice.map_or("", |advice| advice.too_large),
            related: advice.map_or(&[], |advice| &advice.related),
            model: list.model(),
        }
    }

    /// `no effect here (digitizing)`, `acts in part, without: ...`; empty for what acts.
    pub fn remark(&self) -> String {
        match self.effect {
            "acts" => String::new(),
            "partly" => format!("acts in part here: {}", self.missing),
            _ => format!("no effect here ({})", self.missing),
        }
    }

    /// `0.001 .. 5 m/s^2`
    pub fn range(&self) -> String {
        let range = match (&self.min, &self.max) {
            (Some(min), Some(max)) => format!("{min} .. {max}"),
            _ => "no range printed".to_owned(),
        };
        format!("{range} {}", self.unit).trim_end().to_owned()
    }

    /// Name with the axis or range of its index: `Acceleration, X axis`.
    pub fn title(&self) -> String {
        if self.index.is_empty() {
            self.name.to_owned()
        } else {
            format!("{}, {}", self.name, self.index)
        }
    }
}

fn text(rows: &[Row], style: Style) -> String {
    let width = |of: fn(&Row) -> String| {
        rows.iter()
            .map(|row| of(row).chars().count())
            .max()
            .unwrap_or_default()
    };
    let (value_width, range_width) = (width(|row| row.value.clone()), width(Row::range).min(40));
    let mut text = String::new();
    let mut group = None;
    for row in rows {
        if row.group != group {
            let blank = if text.is_empty() { "" } else { "\n" };
            text += &format!("{blank}{}\n", style.bold(row.group.unwrap_or_default()));
            group = row.group;
        }
        let range = style.faint(&format!("{:<range_width$}", row.range()));
        let remark = match row.effect {
            "acts" => "",
            "partly" => "  (acts in part here)",
            _ => "  (no effect here)",
        };
        text += &format!(
            "{:<9} {:>value_width$}  {range}  {}{}\n",
            row.parameter,
            row.value,
            row.title(),
            style.faint(remark)
        );
    }
    text
}
