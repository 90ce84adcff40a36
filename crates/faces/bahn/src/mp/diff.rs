//! `bahn mp diff`: in which parameters two lists differ.

use bahn_parameters::{Definition, ParameterList};
use serde::Serialize;

use super::list::Row;
use super::options::DiffOptions;
use super::{explain, source};
use crate::options::Format;
use crate::style::Style;
use crate::{Outcome, UsageError, console};
use bahn_report::count;

/// Compares two lists, parameter by parameter.
pub(super) fn command(options: &DiffOptions) -> Result<Outcome, UsageError> {
    let first = source::read(&options.a, options.model)?;
    let model = first.model();
    let a = source::values(&options.a, &first)?;
    let (a, b) = match &options.b {
        Some(path) => (a, source::values(path, &source::read(path, Some(model))?)?),
        None => (ParameterList::reference(model), a),
    };
    let differences: Vec<Difference> = a
        .differences(&b)
        .into_iter()
        .filter_map(|name| Definition::named(model, name).ok())
        .map(|definition| Difference::new((Row::new(definition, &a), Row::new(definition, &b))))
        .collect();
    match options.format {
        Format::Json => console::print_json(&differences)?,
        Format::Text => console::print_bytes(text(&differences, Style::of_output()).as_bytes())?,
    }
    Ok(if differences.is_empty() {
        Outcome::Fine
    } else {
        Outcome::ProgramError
    })
}

/// A parameter that is not the same in both lists.
#[derive(Debug, Serialize)]
struct Difference {
    parameter: String,
    name: String,
    unit: &'static str,
    a: Value,
    b: Value,
    /// What the parameter does here: acts, partly, none.
    effect: &'static str,
    /// The same in words; empty for what acts.
    remark: String,
    /// What the change needs: none, RESET or REF.
    reaction: &'static str,
}

#[derive(Debug, Serialize)]
struct Value {
    value: String,
    number: f64,
    meaning: Vec<String>,
}

impl Difference {
    fn new((a, b): (Row, Row)) -> Difference {
        // Bits that are the same in both say nothing.
        let said = |own: &[String], other: &[String]| -> Vec<String> {
            own.iter().filter(|item| !other.contains(item)).cloned().collect()
        };
        let (a_said, b_said) = (said(&a.meaning, &b.meaning), said(&b.meaning, &a.meaning));
        Difference {
            parameter: a.parameter.clone(),
            name: a.title(),
            unit: a.unit,
            reaction: a.reaction,
            effect: a.effect,
            remark: a.remark(),
            a: Value {
                value: a.value,
                number: a.number,
                meaning: a_said,
            },
            b: Value {
                value: b.value,
                number: b.number,
                meaning: b_said,
            },
        }
    }
}

fn text(differences: &[Difference], style: Style) -> String {
    let value = |value: &Value, unit: &str| {
        let meaning = if value.meaning.is_empty() {
            String::new()
        } else {
            format!("  {}", value.meaning.join("; "))
        };
        format!("{} {unit}", value.value).trim_end().to_owned() + &meaning
    };
    let mut text = String::new();
    for difference in differences {
        let needs = explain::reaction(difference.reaction);
        let needs = if needs.is_empty() {
            String::new()
        } else {
            style.warning(&format!("  needs {needs}"))
        };
        let title = style.bold(&format!("{}  {}", difference.parameter, difference.name));
        text += &format!("{title}{needs}\n");
        if !difference.remark.is_empty() {
            text += &format!("  {}\n", style.faint(&difference.remark));
        }
        text += &format!(
            "  {}\n",
            style.removed(&format!("- {}", value(&difference.a, difference.unit)))
        );
        text += &format!(
            "  {}\n",
            style.added(&format!("+ {}", value(&difference.b, difference.unit)))
        );
    }
    text += &format!("{}\n", summary(differences));
    text
}

/// How many, and what all changes together need.
fn summary(differences: &[Difference]) -> String {
    let has = |reaction: &str| {
        differences
            .iter()
            .any(|difference| difference.reaction == reaction)
    };
    let needs: Vec<&str> = ["RESET", "REF"]
        .into_iter()
        .filter(|name| has(name))
        .map(explain::reaction)
        .collect();
    match (differences.len(), needs.as_slice()) {
        (0, _) => "no difference".to_owned(),
        (number, []) => count(number, "difference"),
        (number, needs) => format!(
            "{}; the change needs {}",
            count(number, "difference"),
            needs.join(" and ")
        ),
    }
}
