//! `bahn plc xref`: where operands and labels are used.

use std::collections::BTreeMap;

use bahn_exchange::{Bit, BitArea};
use bahn_plc::{Instruction, Op, PlcProgram, Target, TextOperand, Value};

use super::operand::Operand;
use super::options::XrefOptions;
use super::print_json;
use super::source::Source;
use crate::cli::Format;
use crate::{Outcome, UsageError, console};

/// Prints the cross-reference of a program.
pub(super) fn command(options: &XrefOptions) -> Result<Outcome, UsageError> {
    let source = Source::compile(&options.program)?;
    let Some(program) = source.program() else {
        return Ok(Outcome::ProgramError);
    };
    let mut reference = Reference::of(&program);
    if !options.only.is_empty() {
        reference.operands.retain(|operand| {
            let wanted = |text: &String| {
                let text = text.trim();
                operand.operand.eq_ignore_ascii_case(text)
                    || operand
                        .operand
                        .trim_end_matches(|c: char| c.is_ascii_digit())
                        .eq_ignore_ascii_case(text)
            };
            options.only.iter().any(wanted)
        });
        reference.labels.clear();
    }
    match options.format {
        Format::Json => print_json(&reference)?,
        Format::Text => console::print(&reference.text())?,
    }
    Ok(Outcome::Fine)
}

#[derive(Debug, serde::Serialize)]
struct Reference {
    operands: Vec<OperandUse>,
    labels: Vec<LabelUse>,
}

/// Where an operand is used.
#[derive(Debug, serde::Serialize)]
struct OperandUse {
    operand: String,
    read: Vec<Place>,
    written: Vec<Place>,
    /// Written, but read nowhere: outputs are read by the machine and do not count.
    unused: bool,
    /// Assigned unconditionally in several lines: the last one wins.
    written_twice: bool,
}

/// Where a label is used.
#[derive(Debug, serde::Serialize)]
struct LabelUse {
    label: String,
    defined: Place,
    used: Vec<Place>,
    unused: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
struct Place {
    file: String,
    line: u32,
}

/// What an instruction does with an operand.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Access {
    Read,
    /// Sets it whatever the accumulator is.
    Assign,
    /// Sets, resets, counts or stores to it among others.
    Change,
}

/// Sorts operands by kind, then number.
type Key = (usize, u16);

#[derive(Default)]
struct Uses {
    name: String,
    places: Vec<(Access, Place)>,
}

impl Reference {
    fn of(program: &PlcProgram) -> Reference {
        let mut uses: BTreeMap<Key, Uses> = BTreeMap::new();
        for instruction in &program.code {
            for (key, name, access) in accesses(&instruction.op) {
                let entry = uses.entry(key).or_default();
                entry.name = name;
                entry.places.push((access, place(program, instruction)));
            }
        }
        Reference {
            operands: uses
                .into_iter()
                .map(|(key, uses)| OperandUse::new(key, &uses))
                .collect(),
            labels: labels(program),
        }
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for operand in &self.operands {
            let note = match (operand.unused, operand.written_twice) {
                (true, true) => "  (never read, assigned twice)",
                (true, false) => "  (never read)",
                (false, true) => "  (assigned twice)",
                (false, false) => "",
            };
            text += &format!("{}{note}\n", operand.operand);
            text += &row("read", &operand.read);
            text += &row("written", &operand.written);
        }
        for label in &self.labels {
            let note = if label.unused { "  (never used)" } else { "" };
            text += &format!("LBL {}{note}\n", label.label);
            text += &row("defined", std::slice::from_ref(&label.defined));
            text += &row("used", &label.used);
        }
        text
    }
}

fn row(what: &str, places: &[Place]) -> String {
    if places.is_empty() {
        return String::new();
    }
    let places: Vec<String> = places
        .iter()
        .map(|place| format!("{}:{}", place.file, place.line))
        .collect();
    format!("    {what:<8} {}\n", places.join(" "))
}

impl OperandUse {
    fn new(key: Key, uses: &Uses) -> OperandUse {
        let of = |wanted: fn(Access) -> bool| -> Vec<Place> {
            let chosen = uses.places.iter().filter(|(access, _)| wanted(*access));
            chosen.map(|(_, place)| place.clone()).collect()
        };
        let read = of(|access| access == Access::Read);
        let written = of(|access| access != Access::Read);
        OperandUse {
            operand: uses.name.clone(),
            unused: read.is_empty() && key.0 != BitArea::O as usize,
            written_twice: of(|access| access == Access::Assign).len() > 1,
            read,
            written,
        }
    }
}

fn place(program: &PlcProgram, instruction: &Instruction) -> Place {
    Place {
        file: program.file_name(instruction.file).to_owned(),
        line: instruction.line,
    }
}

/// Labels with the jumps and calls to them. A label names the instruction behind it, so that labels at one
/// place share their uses.
fn labels(program: &PlcProgram) -> Vec<LabelUse> {
    let mut users: BTreeMap<usize, Vec<Place>> = BTreeMap::new();
    for instruction in &program.code {
        for target in targets(program, &instruction.op) {
            users.entry(target).or_default().push(place(program, instruction));
        }
    }
    let uses = program.labels.iter().map(|label| {
        let used = users.get(&label.at).cloned().unwrap_or_default();
        LabelUse {
            label: label.name.clone(),
            defined: Place {
                file: program
                    .files
                    .get(label.file)
                    .map(|file| file.name.clone())
                    .unwrap_or_default(),
                line: label.line,
            },
            unused: used.is_empty(),
            used,
        }
    });
    uses.collect()
}

fn targets(program: &PlcProgram, op: &Op) -> Vec<usize> {
    let code = |target: &Target| match target {
        Target::Code(at) => Some(*at),
        Target::Module(_) => None,
    };
    match op {
        Op::Jump { target, .. } => vec![*target],
        Op::Call { target, .. } | Op::Submit { target } => code(target).into_iter().collect(),
        Op::Case { table, .. } => program
            .cases
            .get(*table)
            .map(|entries| entries.iter().filter_map(code).collect())
            .unwrap_or_default(),
        _ => Vec::new(),
    }
}

/// The operands of an instruction.
fn accesses(op: &Op) -> Vec<(Key, String, Access)> {
    let bit = |operand: Bit, access| {
        let name = operand.to_string();
        (((operand.area() as usize), operand.number()), name, access)
    };
    let number = |operand: bahn_exchange::Number, access| {
        let kind = 5 + operand.size() as usize;
        ((kind, operand.address()), operand.to_string(), access)
    };
    let text = |string: u8, access| {
        (
            (8, string.into()),
            Operand::Text(string.into()).to_string(),
            access,
        )
    };
    let bits = |first: Bit, count: u8, access| -> Vec<(Key, String, Access)> {
        (0..u16::from(count))
            .filter_map(|offset| Bit::new(first.area(), first.number().checked_add(offset)?))
            .map(|operand| bit(operand, access))
            .collect()
    };
    match op {
        Op::LoadBit { bit: b, .. } | Op::GateBit { bit: b, .. } | Op::PushBit { bit: b } => {
            vec![bit(b.bit, Access::Read)]
        }
        Op::AssignBit { bit: b, .. } => {
            vec![bit(
                b.bit,
                if b.indexed { Access::Change } else { Access::Assign },
            )]
        }
        Op::SetBit { bit: b, .. } | Op::PullBit { bit: b } => vec![bit(b.bit, Access::Change)],
        Op::Load { value, .. }
        | Op::GateWord { value, .. }
        | Op::Arithmetic { value, .. }
        | Op::BitOperation { value, .. }
        | Op::TestBit { value }
        | Op::Compare { value, .. }
        | Op::Push { value } => match value {
            Value::Number(operand) => vec![number(operand.number, Access::Read)],
            Value::Constant(_) => Vec::new(),
        },
        Op::LoadBits { first, count } => bits(first.bit, *count, Access::Read),
        Op::AssignBits { first, count } => bits(first.bit, *count, Access::Assign),
        Op::Assign { number: n, .. } => {
            vec![number(
                n.number,
                if n.indexed { Access::Change } else { Access::Assign },
            )]
        }
        Op::StepNumber { number: n, .. } => {
            vec![number(n.number, Access::Read), number(n.number, Access::Change)]
        }
        Op::Pull { number: n } => vec![number(n.number, Access::Change)],
        Op::Case { number: n, .. } | Op::Reply { number: n } | Op::Cancel { number: n } => {
            vec![number(n.number, Access::Read)]
        }
        Op::LoadText { text: t } | Op::AppendText { text: t } | Op::CompareText { text: t, .. } => match t {
            TextOperand::Memory { string, .. } | TextOperand::Part { string } => {
                vec![text(*string, Access::Read)]
            }
            _ => Vec::new(),
        },
        Op::AssignText { string, indexed } => {
            vec![text(
                *string,
                if *indexed { Access::Change } else { Access::Assign },
            )]
        }
        Op::OverwriteText { string, .. } => vec![text(*string, Access::Change)],
        _ => Vec::new(),
    }
}
