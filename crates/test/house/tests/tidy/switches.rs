//! What a value means stands where it is given: `Direction::Minus`, `Switch::Off`, not `false`.

use std::collections::BTreeSet;

use crate::source::{code_of, is_of_name, source_files};
use bahn_house as house;

/// Variants with a bare truth value, and why it says enough.
const PLAIN: &[(&str, &str)] = &[
    (
        "machine::ContactFault::Stuck",
        "what a PLC reads at an input: 0 or 1",
    ),
    ("panel::TransferAction::Answer", "yes or no to a question"),
    ("plc::OperandContent::Bit", "the value of a bit: 0 or 1"),
    ("technology::Value::Flag", "a flag of a list: 0 or 1"),
    ("why::Cause::Bit", "the value of a bit: 0 or 1"),
    ("why::Cause::Compare", "whether a comparison holds"),
    ("why::Source::Compare", "whether a comparison holds"),
];

/// Public functions with two truth values, and why they say enough.
const PLAIN_FUNCTIONS: &[(&str, &str)] = &[
    ("kernel::end_block", "two demands of the PLC, by their names"),
    ("kernel::hold", "what is wanted, and whether a program runs"),
    (
        "kernel::leave_path",
        "what a machine parameter permits, and what a probe has done",
    ),
    (
        "kernel::moves",
        "what has ended a positioning, and whether a run restores",
    ),
    (
        "kernel::stands_at_end",
        "the way back, and whether an axis moves, of the gates alone",
    ),
    ("machine::advance", "two contacts of the EMERGENCY STOP chain"),
    (
        "machine::holds",
        "voltage at a drive, and the control's readiness",
    ),
    (
        "machine::set_power",
        "voltage at a drive, and the control's readiness",
    ),
    ("tnc::follow_stop", "the NC stop, and what it ends"),
    ("tnc::put", "columns ST and F of a pocket table"),
    ("tnc::watch", "two answers of the operating mode"),
];

/// Names of truth values that are a direction of travel or a sense of rotation.
const DIRECTIONS: &[&str] = &[
    "backward",
    "ccw",
    "clockwise",
    "counter_clockwise",
    "cw",
    "down",
    "forward",
    "forwards",
    "left",
    "minus",
    "negative",
    "plus",
    "positive",
    "right",
    "up",
];

/// Such names where they are none, and why.
const NOT_DIRECTIONS: &[(&str, &str)] = &[
    ("dialogue: down", "which arrow key moves the cursor"),
    ("dialogue: right", "which arrow key moves the cursor"),
    (
        "kernel: backward",
        "the way back along a path, whatever its axes do",
    ),
    (
        "motion: backward",
        "the way back along a path, whatever its axes do",
    ),
    ("live: down", "whether a key is pressed; a field of JSON"),
    ("panel: down", "which arrow key moves the cursor; a field of JSON"),
    ("panel: negative", "the sign of a number that is entered"),
    ("path: forward", "in the sense of a contour, or against it"),
    ("path: minus", "a bit that says which direction"),
    ("plc: negative", "a bit that a PLC program gives and reads"),
    ("program: negative", "the sign of a value"),
    ("servo: negative", "the polarity of a signal"),
    (
        "servo: positive",
        "in which play is taken up, of a room below all directions",
    ),
    (
        "technology: backward",
        "a bit of a synchronisation: it acts on the way back",
    ),
    (
        "technology: forward",
        "a bit of a synchronisation: it acts on the way forward",
    ),
    ("tnc: left", "a marker of the PLC that jogs the spindle"),
    ("tnc: right", "a marker of the PLC that jogs the spindle"),
];

/// The code of all rooms, with the name of the room.
fn code() -> impl Iterator<Item = (String, String)> {
    house::rooms().into_iter().flat_map(|room| {
        let name = house::name(&room);
        let files = source_files(&room.join("src")).into_iter();
        let files = files.filter(|file| !file.ends_with("tests.rs"));
        files.map(move |file| (name.clone(), code_of(&file)))
    })
}

/// What stands between the bracket that a text begins with and the one that closes it.
fn bracketed(text: &str) -> &str {
    let mut depth = 0;
    for (at, letter) in text.char_indices() {
        match letter {
            '{' | '(' | '[' => depth += 1,
            '}' | ')' | ']' if depth == 1 => return &text[1..at],
            '}' | ')' | ']' => depth -= 1,
            _ => {}
        }
    }
    ""
}

/// The parts of a list, at commas outside of brackets.
fn parts(list: &str) -> Vec<&str> {
    let mut depth = 0;
    let parts = list.split(|letter| {
        match letter {
            '{' | '(' | '[' | '<' => depth += 1,
            '}' | ')' | ']' | '>' => depth -= 1,
            _ => {}
        }
        letter == ',' && depth == 0
    });
    parts.map(str::trim).filter(|part| !part.is_empty()).collect()
}

/// Whether a type is a truth value, or one that may be missing.
fn is_bare(kind: &str) -> bool {
    ["bool", "Option<bool>"].contains(&kind.trim())
}

/// The name that a text begins with.
fn name_of(text: &str) -> &str {
    let end = text.find(|letter| !is_of_name(letter)).unwrap_or(text.len());
    &text[..end]
}

/// What follows each of these words, from the name on.
fn after<'a>(code: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    code.match_indices(word)
        .map(move |(at, _)| &code[at + word.len()..])
}

/// Variants of the enums of a code that have a bare truth value: `Place::Level`.
fn bare_variants(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for text in after(code, "enum ") {
        let body = text.find('{').map_or("", |at| bracketed(&text[at..]));
        for variant in parts(body) {
            let variant = variant.rsplit([']', '\n']).next().unwrap_or_default().trim();
            let fields = variant.find('(').map_or("", |at| bracketed(&variant[at..]));
            if parts(fields).into_iter().any(is_bare) {
                found.push(format!("{}::{}", name_of(text), name_of(variant)));
            }
        }
    }
    found
}

/// Public functions of a code with more than one truth value.
fn functions_of_two(code: &str) -> Vec<String> {
    let is_truth = |part: &&str| part.split_once(':').is_some_and(|(_, kind)| is_bare(kind));
    let of_two = |text: &&str| {
        let arguments = text.find('(').map_or("", |at| bracketed(&text[at..]));
        parts(arguments).iter().filter(|part| is_truth(part)).count() > 1
    };
    let functions = after(code, "pub fn ").filter(of_two);
    functions.map(|text| name_of(text).to_owned()).collect()
}

/// Directions that are said by a truth value.
fn bare_directions(code: &str) -> BTreeSet<String> {
    let of = |word: &&str| {
        let named = |kind: &str| {
            let given = format!("{word}: {kind}");
            code.match_indices(&given).any(|(at, _)| {
                !code[..at].ends_with(is_of_name) && !code[at + given.len()..].starts_with(is_of_name)
            })
        };
        named("bool") || named("Option<bool>")
    };
    DIRECTIONS
        .iter()
        .filter(|word| of(word))
        .map(|word| (*word).to_owned())
        .collect()
}

/// Fails when what is found is not what is known.
fn compare(found: impl IntoIterator<Item = String>, known: &[(&str, &str)]) {
    let found: BTreeSet<String> = found.into_iter().collect();
    let known: BTreeSet<String> = known.iter().map(|(name, _)| (*name).to_owned()).collect();
    let new: Vec<_> = found.difference(&known).collect();
    assert!(new.is_empty(), "say with an enum what the value means: {new:#?}");
    let stale: Vec<_> = known.difference(&found).collect();
    assert!(stale.is_empty(), "no such ones any more: {stale:?}");
}

#[test]
fn variants_say_what_their_value_means() {
    let found = code().flat_map(|(room, code)| {
        let variants = bare_variants(&code).into_iter();
        variants.map(move |variant| format!("{room}::{variant}"))
    });
    compare(found, PLAIN);
}

#[test]
fn functions_take_one_truth_value_at_most() {
    let found = code().flat_map(|(room, code)| {
        let functions = functions_of_two(&code).into_iter();
        functions.map(move |function| format!("{room}::{function}"))
    });
    compare(found, PLAIN_FUNCTIONS);
}

#[test]
fn directions_have_a_type() {
    let found = code().flat_map(|(room, code)| {
        let directions = bare_directions(&code).into_iter();
        directions.map(move |word| format!("{room}: {word}"))
    });
    compare(found, NOT_DIRECTIONS);
}

#[test]
fn bare_values_are_found() {
    let code = "pub enum A { B, #[default]\n C(bool), D { e: bool }, F(G<u8, u8>, Option<bool>), H(fn(bool) -> u8) }";
    assert_eq!(bare_variants(code), ["A::C", "A::F"]);
    let code = "pub fn a(&self, b: bool, c: Option<bool>) {} pub fn d(e: bool, f: fn(bool, bool)) {} fn g(h: bool, i: bool) {}";
    assert_eq!(functions_of_two(code), ["a"]);
    let code = "struct A { clockwise: bool, setup: bool, up: Option<bool>, down: boolean }";
    assert_eq!(
        bare_directions(code),
        ["clockwise", "up"].map(str::to_owned).into()
    );
}
