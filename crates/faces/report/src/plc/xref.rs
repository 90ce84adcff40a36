//! Where operands and labels are used.

mod meaning;

use std::collections::BTreeMap;

use bahn_plc::{Access, Label, LabelPlace, PlcProgram, SourceLine, Subject, accesses};

use meaning::{fixed_name, is_read_outside};

/// Where the operands and labels of a program are used.
#[derive(Debug, serde::Serialize)]
pub struct Reference {
    operands: Vec<OperandUse>,
    labels: Vec<LabelUse>,
}

/// Where an operand is used.
#[derive(Debug, serde::Serialize)]
struct OperandUse {
    operand: String,
    /// The name of its fixed meaning.
    name: Option<&'static str>,
    /// First and last operand that one with `[X]` may be.
    range: Option<String>,
    read: Vec<Place>,
    written: Vec<Place>,
    /// Other operands of the program in the same memory, as W0 and B3 in D0.
    overlaps: Vec<String>,
    /// Written, but read nowhere in the program, neither itself nor through an overlap or an index, nor by
    /// control or machine.
    unused: bool,
    /// Assigned unconditionally in several lines, itself or through an overlap: the last one wins.
    written_twice: bool,
}

/// Where a label is used.
#[derive(Debug, serde::Serialize)]
struct LabelUse {
    label: String,
    kind: &'static str,
    defined: Place,
    used: Vec<Place>,
    unused: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
struct Place {
    file: String,
    line: u32,
}

type Uses = Vec<(Access, Place)>;

impl Reference {
    /// Where the operands and labels of a program are used.
    pub fn of(program: &PlcProgram) -> Reference {
        let mut uses: BTreeMap<Subject, Uses> = BTreeMap::new();
        for instruction in &program.code {
            let line = SourceLine {
                file: instruction.file.into(),
                line: instruction.line,
            };
            for (subject, access) in accesses(&instruction.op) {
                uses.entry(subject)
                    .or_default()
                    .push((access, place(program, line)));
            }
        }
        let mut labels: Vec<&Label> = program.labels.iter().collect();
        labels.sort_by_key(|label| label.defined);
        Reference {
            operands: uses
                .iter()
                .map(|(subject, own)| OperandUse::new(*subject, own, &uses))
                .collect(),
            labels: labels.iter().map(|label| LabelUse::new(program, label)).collect(),
        }
    }

    /// Leaves the operands of these names or kinds, as `M2045` and `O`, and no label.
    pub fn only(&mut self, wanted: &[String]) {
        self.operands
            .retain(|operand| wanted.iter().any(|wanted| operand.is_meant(wanted)));
        self.labels.clear();
    }

    /// The reference as lines for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for operand in &self.operands {
            let name = operand.name.map_or(String::new(), |name| format!("  {name}"));
            let range = operand
                .range
                .as_ref()
                .map_or(String::new(), |range| format!("  ({range})"));
            let note = match (operand.unused, operand.written_twice) {
                (true, true) => "  (never read, assigned twice)",
                (true, false) => "  (never read)",
                (false, true) => "  (assigned twice)",
                (false, false) => "",
            };
            text += &format!("{}{name}{range}{note}\n", operand.operand);
            text += &row("read", &operand.read);
            text += &row("written", &operand.written);
            if !operand.overlaps.is_empty() {
                text += &format!("    {:<8} {}\n", "overlaps", operand.overlaps.join(" "));
            }
        }
        for label in &self.labels {
            let note = if label.unused { "  (never used)" } else { "" };
            text += &format!("{} {}{note}\n", label.kind, label.label);
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
    fn new(subject: Subject, own: &Uses, all: &BTreeMap<Subject, Uses>) -> OperandUse {
        let of = |wanted: fn(Access) -> bool| -> Vec<Place> {
            let chosen = own.iter().filter(|(access, _)| wanted(*access));
            chosen.map(|(_, place)| place.clone()).collect()
        };
        let others = all
            .iter()
            .filter(|(other, _)| **other != subject && other.meets(subject));
        let mut is_read = is_read_outside(subject);
        let mut assignments = own.iter().filter(|use_| use_.0 == Access::Assign).count();
        let is_assigned = assignments > 0;
        let mut overlaps = Vec::new();
        for (other, uses) in others {
            is_read |= uses.iter().any(|(access, _)| *access == Access::Read);
            assignments += uses.iter().filter(|use_| use_.0 == Access::Assign).count();
            // What an index may reach is said by its range.
            if !subject.is_indexed() && !other.is_indexed() {
                overlaps.push(other.to_string());
            }
        }
        let read = of(|access| access == Access::Read);
        OperandUse {
            operand: subject.to_string(),
            name: fixed_name(subject),
            range: subject.range(),
            unused: read.is_empty() && !is_read,
            written_twice: is_assigned && assignments > 1,
            written: of(|access| access != Access::Read),
            read,
            overlaps,
        }
    }

    /// Whether it is the operand `M2045` or of the kind `O`.
    fn is_meant(&self, wanted: &str) -> bool {
        let wanted = wanted.trim();
        let plain = self.operand.trim_end_matches("[X]");
        [
            self.operand.as_str(),
            plain,
            plain.trim_end_matches(|c: char| c.is_ascii_digit()),
        ]
        .iter()
        .any(|name| name.eq_ignore_ascii_case(wanted))
    }
}

impl LabelUse {
    fn new(program: &PlcProgram, label: &Label) -> LabelUse {
        LabelUse {
            label: label.name.clone(),
            kind: match label.place {
                LabelPlace::Code(_) => "LBL",
                LabelPlace::Field(_) => "KFIELD",
            },
            defined: place(program, label.defined),
            used: label.used.iter().map(|line| place(program, *line)).collect(),
            unused: label.used.is_empty(),
        }
    }
}

fn place(program: &PlcProgram, line: SourceLine) -> Place {
    Place {
        file: program
            .files
            .get(line.file)
            .map(|file| file.name.clone())
            .unwrap_or_default(),
        line: line.line,
    }
}
