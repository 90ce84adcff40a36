//! What an instruction, an operand or a label means.

use bahn_exchange::signal::{self, Signal, SignalOperand};
use bahn_parameters::conformance::{Entry, Kind, find};
use bahn_plc::{LineOperand, LineWords, Nesting, instructions, modules, nesting};

use super::PlcSource;
use crate::language::{Analysis, Hover, Role, Thing, mentions_of};
use crate::markdown::Markdown;

pub(super) fn hover(source: &PlcSource, at: usize) -> Option<Hover> {
    let words = source.line_at(at)?.words.as_ref()?;
    if words.instruction_at.start <= at && at < words.instruction_at.end.max(words.instruction_at.start + 1) {
        return Some(Hover {
            range: words.instruction_at.clone(),
            text: instruction(words.instruction),
        });
    }
    let is_operand =
        words.operand_at.start <= at && at <= words.operand_at.end && !words.operand_at.is_empty();
    is_operand
        .then(|| operand(source, words))
        .flatten()
        .map(|text| Hover {
            range: words.operand_at.clone(),
            text,
        })
}

/// An instruction with all of its forms.
pub(super) fn instruction(name: &str) -> String {
    let forms: Vec<_> = instructions().filter(|form| form.instruction == name).collect();
    let lines = forms.iter().map(|form| {
        let operands = if form.operands.is_empty() {
            String::new()
        } else {
            format!(" {}", form.operands)
        };
        let time = if form.time_us.is_empty() {
            String::new()
        } else {
            format!(" ({} µs)", form.time_us)
        };
        let conditions = if form.conditions.is_empty() {
            String::new()
        } else {
            format!("; {}", form.conditions)
        };
        format!("{}{operands}: {}{conditions}{time}", form.form, form.does)
    });
    let sources: Vec<&str> = forms.iter().map(|form| form.source).collect();
    let structure = match nesting(name) {
        Nesting::Opens => "opens what a later line closes",
        Nesting::Closes => "closes what an earlier line opened",
        Nesting::Both => "ends one part of a structure and begins the other",
        Nesting::Neither => "",
    };
    Markdown::titled(name)
        .list(lines)
        .fact("Structure", structure)
        .source(&sources.join(" "))
        .text()
}

fn operand(source: &PlcSource, words: &LineWords) -> Option<String> {
    let places = |thing: &Thing, role: Role| {
        let all = mentions_of(source.mentions(), thing).filter(|mention| mention.role == role);
        let lines: Vec<String> = all
            .take(12)
            .map(|mention| (source.text.lines.line_of(mention.range.start) + 1).to_string())
            .collect();
        lines.join(", ")
    };
    Some(match &words.operand {
        LineOperand::Bit(bit) => {
            let thing = Thing::Operand(bit.bit.to_string());
            let found = signal::all().iter().find(|signal| match signal.operand {
                SignalOperand::Bit(own) => own == bit.bit,
                SignalOperand::Bits(range) => range.iter().any(|own| own == bit.bit),
                _ => false,
            });
            of_signal(source, &bit.to_string(), found)
                .fact("Set in lines", &places(&thing, Role::Sets))
                .fact("Read in lines", &places(&thing, Role::Uses))
                .text()
        }
        LineOperand::Number(number) => {
            let thing = Thing::Operand(number.number.to_string());
            let found = signal::named(SignalOperand::Number(number.number));
            of_signal(source, &number.to_string(), found)
                .fact("Written in lines", &places(&thing, Role::Sets))
                .fact("Read in lines", &places(&thing, Role::Uses))
                .text()
        }
        LineOperand::Constant(value) => Markdown::titled(&format!("K{value:+}"))
            .fact("Hexadecimal", &format!("${value:X}"))
            .text(),
        LineOperand::Module(number) => {
            let module = modules().iter().find(|module| module.number == *number);
            let entry = find(source.model, Kind::Module, &number.to_string());
            Markdown::titled(&format!(
                "Module {number}: {}",
                module.map_or("not known", |module| module.name)
            ))
            .fact("Here", &entry.and_then(Entry::remark).unwrap_or_default())
            .source(entry.map_or("", |entry| entry.source))
            .text()
        }
        LineOperand::Label(name) | LineOperand::Field(name) => {
            let thing = Thing::PlcLabel(name.clone());
            Markdown::titled(&format!("Label {name}"))
                .fact("Set in lines", &places(&thing, Role::Sets))
                .fact("Used in lines", &places(&thing, Role::Uses))
                .source("[000:14002-14004]")
                .text()
        }
        LineOperand::File(name) => Markdown::titled(&format!("Source file {name}"))
            .source("[000:14616]")
            .text(),
        LineOperand::Text(text) => Markdown::titled(&text.to_string()).text(),
        LineOperand::None => return None,
    })
}

/// An operand with a fixed meaning, if it has one.
fn of_signal(source: &PlcSource, name: &str, signal: Option<&Signal>) -> Markdown {
    let Some(signal) = signal else {
        return Markdown::titled(name);
    };
    let entry = find(source.model, Kind::Marker, name);
    Markdown::titled(&format!("{name} {}", signal.name))
        .paragraph(signal.function)
        .fact("Set by", signal.set_by)
        .fact("Reset by", signal.reset_by)
        .fact("Values", signal.values)
        .fact("Part", signal.role)
        .fact("Here", &entry.and_then(Entry::remark).unwrap_or_default())
        .source(signal.source)
}
