//! Instructions, labels, modules and operands with a name.

use std::collections::BTreeSet;
use std::ops::Range;

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
    let range = match word_at(&source.text.text, at, "") {
        Some(word) if word.start >= line.start => word.start..word.end.min(line.end).max(at),
        _ => at..at,
    };
    let front = before.trim_start().split_once(char::is_whitespace);
    let command = front.map(|(command, _)| command.to_ascii_uppercase());
    match command.as_deref() {
        None => commands(&range),
        Some("USES") => files(source, world, &range),
        Some(command) if GOING.contains(&command) => places(source, command, &range),
        Some(_) => operands(&range),
    }
}

fn item(range: &Range<usize>, kind: CompletionKind, label: &str, detail: &str) -> Completion {
    Completion {
        label: label.to_owned(),
        detail: detail.to_owned(),
        documentation: String::new(),
        kind,
        range: range.clone(),
        snippet: label.to_owned(),
    }
}

/// All instructions, each with what its first form does.
fn commands(range: &Range<usize>) -> Vec<Completion> {
    let mut names = BTreeSet::new();
    let forms = instructions().filter(|form| names.insert(form.instruction));
    forms
        .map(|form| Completion {
            documentation: instruction(form.instruction),
            ..item(range, CompletionKind::Word, form.instruction, form.does)
        })
        .collect()
}

/// Source files of the folder.
fn files(source: &PlcSource, world: &World, range: &Range<usize>) -> Vec<Completion> {
    let folder = source.path.parent();
    let names = folder.map(|folder| world.files.names(folder)).unwrap_or_default();
    let sources = names
        .iter()
        .filter(|name| name.to_ascii_lowercase().ends_with(".plc"));
    sources
        .map(|name| item(range, CompletionKind::File, name, ""))
        .collect()
}

/// Labels of the file, and after CM the modules of the control.
fn places(source: &PlcSource, command: &str, range: &Range<usize>) -> Vec<Completion> {
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
    let labels = labels
        .into_iter()
        .map(|name| item(range, CompletionKind::Label, name, "label"));
    let internal = modules().iter().filter(|_| command.starts_with("CM"));
    let internal = internal.map(|module| {
        item(
            range,
            CompletionKind::Function,
            &module.number.to_string(),
            module.name,
        )
    });
    labels.chain(internal).collect()
}

/// Operands with a fixed meaning, to be found by number or name.
fn operands(range: &Range<usize>) -> Vec<Completion> {
    let signals = signal::all().iter().filter(|signal| signal.has_function());
    let named = signals.filter_map(|signal| {
        let operand = match signal.operand {
            SignalOperand::Bit(bit) => bit.to_string(),
            SignalOperand::Number(number) => number.to_string(),
            SignalOperand::Bits(_) | SignalOperand::Bytes(_) => return None,
        };
        let label = format!("{operand} {}", signal.name);
        Some(Completion {
            snippet: operand,
            ..item(range, CompletionKind::Parameter, &label, signal.function)
        })
    });
    named.collect()
}
