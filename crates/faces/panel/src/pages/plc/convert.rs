//! CONVERT: a PLC program with its line numbers, and the list of what uses each operand, as a text file [000:11330-11366].

use std::collections::BTreeMap;

use bahn_plc::{Access, PlcProgram, Subject, accesses};
use bahn_screen::programs::NAME_MAX;

use super::form::unformatted;
use super::{compile, source};
use crate::page::Turn;
use crate::pages::ask::Name;
use crate::site::Site;

/// Ending of texts [000:6844].
const ENDING: &str = ".A";
/// Characters of a line of the cross-reference list.
const WIDTH: usize = 72;
/// Width of a column: an operand.
const COLUMN: usize = 10;

/// What becomes of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// The source with line numbers.
    Listing,
    /// What uses each operand.
    References,
    /// Listing and references in a text.
    Both,
    /// Without the columns that its editor makes.
    Unformatted,
}

/// The soft keys of CONVERT [000:11352].
pub(super) const FORMS: [(&str, Form); 4] = [
    ("LISTING", Form::Listing),
    ("CROSSREF", Form::References),
    ("LISTING+CROSSREF", Form::Both),
    ("UNFORM.", Form::Unformatted),
];

/// Names of the soft keys, in the order of [`FORMS`].
pub(super) const KEYS: [&str; 4] = ["LISTING", "CROSSREF", "LISTING+CROSSREF", "UNFORM."];

/// Asks for the name of the text, and writes it.
pub(super) fn ask(name: &str, form: Form, site: &Site) -> Turn {
    let (name, prompt) = (
        name.to_owned(),
        format!("{} {ENDING}", site.words("DESTINATION FILE =")),
    );
    Turn::Open(Name::ask(prompt, NAME_MAX, move |new, site| {
        let new = match new.contains('.') {
            true => new,
            false => new + ENDING,
        };
        let text = text_of(&name, form, site);
        match text.and_then(|text| source::create(&new, text.as_bytes(), site)) {
            Ok(()) => Turn::CloseSaying(format!("{name} -> {new}")),
            Err(why) => Turn::CloseSaying(why),
        }
    }))
}

fn text_of(name: &str, form: Form, site: &Site) -> Result<String, String> {
    let mut text = String::new();
    let listing = matches!(form, Form::Listing | Form::Both);
    let references = matches!(form, Form::References | Form::Both);
    if form == Form::Unformatted {
        for line in &source::Source::read(name, site)?.lines {
            text.push_str(&unformatted(line));
            text.push('\n');
        }
    }
    if listing {
        let file = source::Source::read(name, site)?;
        for (number, line) in (1..).zip(&file.lines) {
            text.push_str(format!("{number:>5} {line}").trim_end());
            text.push('\n');
        }
    }
    if references {
        let compiled = compile::source_of(name, site).compilation;
        let program = compiled
            .program
            .ok_or_else(|| format!("{name}: {} {}", compiled.errors.len(), site.words("ERRORS")))?;
        if listing {
            text.push('\n');
        }
        text.push_str(&cross_references(&program));
    }
    Ok(text)
}

/// Each operand with the lines that use it, those that write it with a star; a line of another file has its name.
fn cross_references(program: &PlcProgram) -> String {
    let mut used: BTreeMap<Subject, Vec<String>> = BTreeMap::new();
    for instruction in &program.code {
        for (subject, access) in accesses(&instruction.op) {
            let place = match instruction.file {
                0 => instruction.line.to_string(),
                _ => program.place(instruction),
            };
            let star = if access == Access::Read { "" } else { "*" };
            let places = used.entry(subject).or_default();
            let place = format!("{place}{star}");
            if places.last() != Some(&place) {
                places.push(place);
            }
        }
    }
    let mut text = String::new();
    for (subject, places) in used {
        let mut line = format!("{:<COLUMN$}", subject.to_string());
        for place in places {
            if line.len() + place.len() + 1 > WIDTH {
                text.push_str(line.trim_end());
                text.push('\n');
                line = " ".repeat(COLUMN);
            }
            line = line + &place + " ";
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}
