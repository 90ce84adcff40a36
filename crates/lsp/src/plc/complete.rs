//! Instructions, labels, modules and operands with a name.

use std::collections::BTreeSet;

use bahn_exchange::signal::{self, SignalOperand};
use bahn_plc::{instructions, modules};

use super::PlcSource;
use super::hover::instruction;
use crate::language::{Analysis, Completion, CompletionKind, Role, Thing};
use crate::text::word_at;
use crate::world::World;

/// Instructions that go to a label or call a module.
const GOING: [&str; 8] = ["JP", "JPT", "JPF", "CM", "CMT", "CMF", "SUBM", "GLOBAL"];

pub(super) fn completions(source: &PlcSource, at: usize, world: &World) -> Vec<Completion> {
    let line = source.text.line_at(at);
    let before = source.text.get(line.start..at);
    if before.contains(';') {
        return Vec::new();
    }
    let front = before.trim_start();
    let range = match word_at(&source.text.text, at, "") {
        Some(word) if word.start >= line.start => word.start..word.end.min(line.end).max(at),
        _ => at..at,
    };
    let item = |label: String, detail: String, kind: CompletionKind, snippet: String| Completion {
        label,
        detail,
        documentation: String::new(),
        kind,
        range: range.clone(),
        snippet,
    };
    let Some((command, _)) = front.split_once(char::is_whitespace) else {
        let mut names = BTreeSet::new();
        let forms = instructions().filter(|form| names.insert(form.instruction));
        return forms
            .map(|form| Completion {
                documentation: instruction(form.instruction),
                ..item(
                    form.instruction.to_owned(),
                    form.does.to_owned(),
                    CompletionKind::Word,
                    form.instruction.into(),
                )
            })
            .collect();
    };
    let command = command.to_ascii_uppercase();
    if command == "USES" {
        let names = source
            .path
            .parent()
            .map(|folder| world.files.names(folder))
            .unwrap_or_default();
        let sources = names
            .into_iter()
            .filter(|name| name.to_ascii_lowercase().ends_with(".plc"));
        return sources
            .map(|name| item(name.clone(), String::new(), CompletionKind::File, name))
            .collect();
    }
    if GOING.contains(&command.as_str()) {
        let set = source
            .mentions()
            .iter()
            .filter(|mention| mention.role == Role::Sets);
        let labels: BTreeSet<&str> = set
            .filter_map(|mention| match &mention.thing {
                Thing::PlcLabel(name) => Some(name.as_str()),
                _ => None,
            })
            .collect();
        let labels = labels.into_iter();
        let labels = labels.map(|name| item(name.into(), "label".into(), CompletionKind::Label, name.into()));
        let internal = modules()
            .iter()
            .filter(|_| command.starts_with("CM"))
            .map(|module| {
                let number = module.number.to_string();
                item(
                    number.clone(),
                    module.name.to_owned(),
                    CompletionKind::Function,
                    number,
                )
            });
        return labels.chain(internal).collect();
    }
    let signals = signal::all().iter().filter(|signal| signal.has_function());
    let named = signals.filter_map(|signal| {
        let operand = match signal.operand {
            SignalOperand::Bit(bit) => bit.to_string(),
            SignalOperand::Number(number) => number.to_string(),
            SignalOperand::Bits(_) | SignalOperand::Bytes(_) => return None,
        };
        let label = format!("{operand} {}", signal.name);
        Some(item(
            label,
            signal.function.to_owned(),
            CompletionKind::Parameter,
            operand,
        ))
    });
    named.collect()
}
