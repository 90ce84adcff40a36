//! What a machine parameter means, as `bahn mp explain` says it.

use bahn_parameters::conformance::{Entry as Registered, Kind, find};
use bahn_parameters::{Advice, Change, Definition, Reaction, with_chapters};

use super::ParameterText;
use crate::language::Hover;
use crate::markdown::Markdown;

pub(super) fn hover(list: &ParameterText, at: usize) -> Option<Hover> {
    let entries = list.entries();
    let entry = entries
        .iter()
        .find(|entry| entry.line.start <= at && at <= entry.value.end)?;
    Some(Hover {
        range: entry.name.start..entry.value.end,
        text: explained(list, entry.definition, Some(entry.number)),
    })
}

/// A parameter, with a value if it has one.
pub(super) fn explained(list: &ParameterText, definition: &Definition, value: Option<f64>) -> String {
    let id = definition.id;
    let advice = Advice::of(list.model, id.number);
    let title = match definition.axis {
        "" => format!("{id} {}", definition.name),
        axis => format!("{id} {}, {axis}", definition.name),
    };
    let range = definition
        .range_text()
        .map(|[min, max]| format!("{min} to {max}"));
    let meaning = value.map(|value| definition.meaning(value).join("; "));
    let registered = find(list.model, Kind::MachineParameter, &id.to_string());
    let related = advice.map(|advice| {
        advice
            .related
            .iter()
            .map(|number| format!("MP{number}"))
            .collect::<Vec<_>>()
    });
    Markdown::titled(&title)
        .paragraph(advice.map_or("", |advice| advice.does))
        .fact("This value", &meaning.unwrap_or_default())
        .fact("Unit", definition.unit)
        .fact("Range", &range.unwrap_or_default())
        .list(definition.choices().map(str::to_owned))
        .fact("Too small", advice.map_or("", |advice| advice.too_small))
        .fact("Too large", advice.map_or("", |advice| advice.too_large))
        .fact("Related", &related.unwrap_or_default().join(", "))
        .fact(
            "Of the list that the control makes",
            &definition.format_value(definition.standard()),
        )
        .fact("Change", change(definition.change))
        .fact("Needs", reaction(definition.reaction))
        .fact(
            "Here",
            &registered.and_then(Registered::remark).unwrap_or_default(),
        )
        .fact("Versions", definition.versions)
        .fact("Note", &with_chapters(definition.notes))
        .source(definition.source)
        .text()
}

fn change(change: Change) -> &'static str {
    match change {
        Change::List => "",
        Change::PlcEdit => "by the PLC, too, while no program runs",
        Change::PlcRun => "by the PLC, too, also while a program runs",
    }
}

fn reaction(reaction: Reaction) -> &'static str {
    match reaction {
        Reaction::None => "",
        Reaction::Reset => "the control to be switched on anew",
        Reaction::ReferenceMarks => "the reference marks to be passed again",
    }
}
