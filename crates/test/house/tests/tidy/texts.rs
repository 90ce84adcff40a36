//! Bytes become text, and faults of files get their places, in the room `text` alone.

use std::fs;
use std::path::PathBuf;

use crate::source::{code_of, source_files};
use bahn_house as house;

/// Byte order marks: who knows them decodes files by itself.
const MARKS: &[&str] = &["\\u{feff}", "\\xef\\xbb\\xbf", "\\xEF\\xBB\\xBF"];

/// Files with such marks, and why.
const NOT_DECODED: &[(&str, &str)] = &[
    ("dialogue/src/entry.rs", "characters that no text of a block has"),
    ("dialogue/src/typing.rs", "characters that no text of a block has"),
];

/// Types with a place in a file of their own, and why.
const OWN_PLACES: &[(&str, &str)] = &[
    ("bahn/src/check/report.rs: Entry", "what JSON says"),
    ("bahn/src/diagnostics.rs: Item", "what JSON says"),
    ("bahn/src/mp/check.rs: Item", "what JSON says"),
    ("bahn/src/refused.rs: FaultReport", "what JSON says"),
    ("bahn/src/table/check.rs: Item", "what JSON says"),
    ("report/src/plc/list.rs: Entry", "what JSON says"),
    ("panel/src/pages/plc/editor.rs: Editor", "where the cursor stands"),
    (
        "plc/src/compile/report.rs: Place",
        "a word whose length nobody knows yet",
    ),
    ("program/src/error.rs: BlockError", "a place within a block"),
];

/// The source files of all rooms but `text`, with their names from the room on.
fn others() -> impl Iterator<Item = (String, PathBuf)> {
    let rooms = house::rooms()
        .into_iter()
        .filter(|room| house::name(room) != "text");
    let named = rooms.flat_map(|room| {
        let files = source_files(&room.join("src")).into_iter();
        files.map(move |file| {
            let name = file.strip_prefix(room.parent().unwrap()).unwrap();
            (name.to_string_lossy().into_owned(), file)
        })
    });
    named.filter(|(name, _)| !name.ends_with("/tests.rs"))
}

#[test]
fn bytes_become_text_in_one_room() {
    let mut faults = Vec::new();
    let mut known: Vec<&str> = NOT_DECODED.iter().map(|(file, _)| *file).collect();
    for (name, file) in others() {
        let code = code_of(&file);
        let found = MARKS.iter().filter(|mark| code.contains(**mark));
        let found: Vec<_> = found.map(|mark| format!("{name} has {mark}")).collect();
        match known.iter().position(|known| *known == name) {
            Some(at) if !found.is_empty() => drop(known.remove(at)),
            _ => faults.extend(found),
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(known.is_empty(), "no such files any more: {known:?}");
}

/// A place in a file is a `bahn_text::Span`: nobody else has line and column of one side by side.
#[test]
fn places_have_one_type() {
    let mut faults = Vec::new();
    let mut known: Vec<&str> = OWN_PLACES.iter().map(|(place, _)| *place).collect();
    for (name, file) in others() {
        for place in types_with_places(&fs::read_to_string(&file).unwrap()) {
            let place = format!("{name}: {place}");
            match known.iter().position(|known| *known == place) {
                Some(at) => drop(known.remove(at)),
                None => faults.push(place),
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(known.is_empty(), "no such types any more: {known:?}");
}

/// The structures of a text that have fields `line` and `column`, which are numbers.
fn types_with_places(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut current = ("", false, false);
    for line in text.lines().map(str::trim) {
        let code = line
            .trim_start_matches("pub ")
            .trim_start_matches("pub(crate) ")
            .trim_start_matches("pub(super) ");
        let is_number = ["u32,", "usize,", "Option<u32>,"]
            .iter()
            .any(|end| code.ends_with(end));
        if let Some(rest) = code.strip_prefix("struct ") {
            let name = rest
                .split(|c: char| !c.is_alphanumeric())
                .next()
                .unwrap_or_default();
            current = (name, false, false);
        } else if code.starts_with("line: ") && is_number {
            current.1 = true;
        } else if code.starts_with("column: ") && is_number {
            current.2 = true;
        } else if code == "}" {
            if let (name, true, true) = current {
                found.push(name);
            }
            current = ("", false, false);
        }
    }
    found
}

#[test]
fn places_are_found() {
    let text =
        "pub struct Fault {\n    pub line: u32,\n    pub column: usize,\n}\nstruct Row { line: u32 }\n";
    assert_eq!(types_with_places(text), ["Fault"]);
    assert_eq!(
        types_with_places("struct Table {\n    line: String,\n    column: u32,\n}\n"),
        [""; 0]
    );
}

/// What finds the bytes of a file by its name is a `bahn_text::Files`: no other room has a trait for that.
#[test]
fn files_by_name_have_one_trait() {
    let faults: Vec<String> = others()
        .flat_map(|(name, file)| {
            let code = code_of(&file);
            let traits: Vec<String> = traits_with_files(&code)
                .iter()
                .map(|found| format!("{name}: {found}"))
                .collect();
            traits
        })
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The traits of a text with a method that gives bytes, if there are any, for a name or a path.
fn traits_with_files(code: &str) -> Vec<&str> {
    let gives_bytes = |method: &str| {
        let head = method.split(['{', ';']).next().unwrap_or_default();
        let (of, gives) = head.split_once("->").unwrap_or((head, ""));
        let gives = gives.trim();
        (of.contains("&str") || of.contains("&Path"))
            && gives.starts_with("Option<")
            && gives.contains("Vec<u8>")
    };
    let mut found = Vec::new();
    for part in code.split("trait ").skip(1) {
        let body = part.split("\n}").next().unwrap_or_default();
        if body.split("fn ").skip(1).any(gives_bytes) {
            found.extend(part.split(|c: char| !c.is_alphanumeric()).next());
        }
    }
    found
}

#[test]
fn traits_with_files_are_found() {
    let text = "pub trait Shelf: Send {\n    fn text(&self, name: &str) -> Option<(String, Vec<u8>)>;\n}\n\
                trait Disk {\n    fn list(&self);\n    fn read(&self, path: &Path) -> Option<Vec<u8>> {\n        None\n    }\n}\n";
    assert_eq!(traits_with_files(text), ["Shelf", "Disk"]);
    let others = "trait Port {\n    fn take(&mut self) -> Option<Vec<u8>>;\n    fn say(&self, text: &str);\n}\n\
                  fn read(name: &str) -> Option<Vec<u8>> {\n    None\n}\n";
    assert_eq!(traits_with_files(others), [""; 0]);
}
