//! `bahn plc signals`: the fixed markers and words.

use bahn_exchange::signal::{self, Signal, SignalOperand};

use super::options::SignalsOptions;
use crate::options::Format;
use crate::{Outcome, UsageError, console};
use bahn_host::Operand;

/// Prints the signals that have all words of the filter.
pub(super) fn command(options: &SignalsOptions) -> Result<Outcome, UsageError> {
    let words: Vec<String> = options.filter.iter().map(|word| word.to_lowercase()).collect();
    let chosen: Vec<&Signal> = signal::all()
        .iter()
        .filter(|signal| words.iter().all(|word| matches(signal, word)))
        .collect();
    match options.format {
        Format::Json => {
            console::print_json(&chosen.iter().map(|signal| Entry::new(signal)).collect::<Vec<_>>())?
        }
        Format::Text => console::print(&text(&chosen))?,
    }
    Ok(Outcome::Fine)
}

/// An operand is meant as a whole, other words as parts of the texts.
fn matches(signal: &Signal, word: &str) -> bool {
    match word.parse::<Operand>() {
        Ok(operand) => occupies(signal.operand, operand),
        Err(_) => [signal.name, signal.function, signal.role, signal.values]
            .iter()
            .any(|text| text.to_lowercase().contains(word)),
    }
}

fn occupies(signal: SignalOperand, operand: Operand) -> bool {
    match (signal, operand) {
        (SignalOperand::Bit(a), Operand::Bit(b)) => a == b,
        (SignalOperand::Bits(range), Operand::Bit(b)) => range.iter().any(|a| a == b),
        (SignalOperand::Number(a), Operand::Number(b)) => a == b,
        (SignalOperand::Bytes(range), Operand::Number(b)) => {
            (0..range.count()).any(|index| range.get(index) == Some(b))
        }
        _ => false,
    }
}

fn text(signals: &[&Signal]) -> String {
    let mut text = format!(
        "{:<12} {:<38} {:<8} {:<8} {}\n",
        "OPERAND", "NAME", "SET BY", "RESET BY", "MEANING"
    );
    for signal in signals {
        text += &format!(
            "{:<12} {:<38} {:<8} {:<8} {}{}\n",
            signal.operand.to_string(),
            signal.name,
            signal.set_by,
            signal.reset_by,
            signal.function,
            aside(signal)
        );
    }
    text
}

/// What has to be known of a marker of the TNC 355: its other form, or that there is none.
fn aside(signal: &Signal) -> String {
    if !signal.has_function() {
        return " (TNC 355 only, no function)".to_owned();
    }
    if signal.tnc355 && !signal.replaced_by.is_empty() {
        return format!(" (in words: {})", signal.replaced_by);
    }
    String::new()
}

#[derive(Debug, serde::Serialize)]
struct Entry {
    operand: String,
    name: &'static str,
    function: &'static str,
    set_by: &'static str,
    reset_by: &'static str,
    role: &'static str,
    values: &'static str,
    tnc355: bool,
    notes: &'static str,
    source: &'static str,
}

impl Entry {
    fn new(signal: &Signal) -> Entry {
        Entry {
            operand: signal.operand.to_string(),
            name: signal.name,
            function: signal.function,
            set_by: signal.set_by,
            reset_by: signal.reset_by,
            role: signal.role,
            values: signal.values,
            tnc355: signal.tnc355,
            notes: signal.notes,
            source: signal.source,
        }
    }
}
