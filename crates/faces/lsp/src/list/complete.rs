//! Numbers of parameters with their names, and values with their meaning.

use bahn_parameters::Definition;

use super::ParameterText;
use super::hover::explained;
use crate::language::{Completion, CompletionKind};

pub(super) fn completions(list: &ParameterText, at: usize) -> Vec<Completion> {
    let line = list.text.line_at(at);
    let before = list.text.get(line.start..at);
    if before.contains(';') {
        return Vec::new();
    }
    match before.split_once([':', '=']) {
        Some((name, value)) => {
            let start = at - value.trim_start().len();
            values(list, name.trim(), start..at)
        }
        None => {
            let start = line.start + before.len() - before.trim_start().len();
            let all = Definition::all(list.model).iter();
            all.map(|definition| Completion {
                label: definition.id.to_string(),
                detail: named(definition),
                documentation: explained(list, definition, None),
                kind: CompletionKind::Parameter,
                range: start..at,
                snippet: format!(
                    "{:<9}: ${{1:{}}} ;{}",
                    definition.id.to_string(),
                    definition.format_value(definition.standard()),
                    named(definition).replace('$', "\\$").replace('}', "\\}")
                ),
            })
            .collect()
        }
    }
}

fn named(definition: &Definition) -> String {
    match definition.axis {
        "" => definition.name.to_owned(),
        axis => format!("{}, {axis}", definition.name),
    }
}

/// Values that mean something.
fn values(list: &ParameterText, name: &str, range: std::ops::Range<usize>) -> Vec<Completion> {
    let all = Definition::all(list.model).iter();
    let own = name.trim_start_matches(['M', 'P', 'm', 'p']).trim();
    let named = |definition: &&Definition| definition.id.to_string().trim_start_matches("MP") == own;
    let Some(definition) = all.into_iter().find(named) else {
        return Vec::new();
    };
    let choices = definition.choices().filter_map(|choice| {
        let (value, text) = choice.split_once('=')?;
        let value: f64 = value.trim().parse().ok()?;
        Some((definition.format_value(value), text.trim().to_owned()))
    });
    choices
        .map(|(value, text)| Completion {
            label: value.clone(),
            detail: text,
            documentation: String::new(),
            kind: CompletionKind::Value,
            range: range.clone(),
            snippet: value,
        })
        .collect()
}
