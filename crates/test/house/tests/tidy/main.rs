//! The order of the house: arrows between rooms, file lengths, unfinished work.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

mod names;
mod rooms;
mod source;
mod switches;
mod texts;
mod uses;
mod wholes;
mod words;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::names::{Files, Texts};
use crate::rooms::ROOMS;
use crate::source::{code_of, has_word, source_files};
use crate::uses::Uses;
use bahn_house as house;
use bahn_house::root;

/// The crate of the shipped machines, data alone: it uses no room.
const DATA: &str = "machines";

/// Longer files hold more than one idea.
const LINES_MAX: usize = 700;

/// A larger room, its tests apart, has more than one concern.
const ROOM_MAX: usize = 16_000;

/// Rooms that are larger. None should be; one that is divided leaves the list.
const TOO_LARGE: &[&str] = &[];

/// The rooms that speak to people by standard output and standard error, or end the process.
const FACES: &[&str] = &["bahn", "browser", "terminal"];

/// Files that use each other in a circle. None should; a circle that is opened leaves the list.
const CIRCLES: &[(&str, &str)] = &[];

/// Types of many fields with methods in several files, and these files. None should be.
const TOO_MUCH: &[(&str, &str, &str)] = &[];

/// Rooms whose names still have words that docs/glossary.md has replaced, and these. A room that says them otherwise
/// leaves the list.
const REPLACED_WORDS: &[(&str, &str)] = &[];

/// Arrays of five or nine numbers, letters or the like that are not those of axes.
const NOT_OF_AXES: &[(&str, &str)] = &[
    ("kernel/src/touched.rs", "the sums of a circle through points"),
    (
        "tnc/src/handwheel.rs",
        "the rapid traverses from which on a factor is possible, the positions of a switch",
    ),
    (
        "panel/src/pages/supplementary/oscilloscope.rs",
        "the parts of a memory before its trigger",
    ),
    ("path/src/region/offset.rs", "the places of segments"),
    ("plc/src/modules/coordinates.rs", "the coordinates of a spindle"),
    (
        "parameters/src/settings/tables.rs",
        "the columns of a pocket table",
    ),
    ("workpiece/benches/tools.rs", "corner radii"),
];

/// Tables in which controls are known by their names, and why.
const NAMES_OF_CONTROLS: &[(&str, &str)] = &[
    (
        "exchange/src/signal.rs",
        "markers that the manual lists for a control that is none of the models",
    ),
    (
        "link/src/lsv2/peer.rs",
        "what a control at the other end says that it is; features follow",
    ),
];

const UNFINISHED: &[&str] = &["todo!(", "unimplemented!(", "FIXME", "HACK"];

/// Whether a file is one of those that look for marks, and has them all.
fn is_this_check(file: &Path) -> bool {
    file.ends_with("tests/tidy/main.rs")
}

#[test]
fn arrows_point_down() {
    let disorder = disorder(ROOMS);
    assert!(disorder.is_empty(), "{}", disorder.join("\n"));
    assert_eq!(dependencies(&root().join(DATA)), [""; 0]);
    for folder in house::rooms() {
        let room = house::name(&folder);
        let (_, allowed) = ROOMS.iter().find(|(name, _)| *name == room).unwrap_or_else(|| {
            panic!("the room {room} is not in the plan of the house: add it to ROOMS and ARCHITECTURE.md")
        });
        let used = dependencies(&folder);
        let rooms: Vec<&str> = used
            .iter()
            .filter_map(|used| used.strip_prefix("bahn-"))
            .collect();
        for room_used in &rooms {
            assert!(allowed.contains(room_used), "{room} must not use {room_used}");
        }
        let stale: Vec<_> = allowed.iter().filter(|room| !rooms.contains(room)).collect();
        assert!(stale.is_empty(), "{room} may use {stale:?}, and does not");
        let code: String = source_files(&folder.join("src"))
            .iter()
            .map(|file| fs::read_to_string(file).unwrap())
            .collect();
        let unused: Vec<_> = used
            .iter()
            .filter(|used| !has_word(&code, &used.replace('-', "_")))
            .collect();
        assert!(
            unused.is_empty(),
            "{room} depends on {unused:?}, and does not use it"
        );
    }
}

/// A room uses rooms of its layer and of those below.
#[test]
fn layers_stand_in_order() {
    let rooms = house::rooms();
    let mut upward = Vec::new();
    for room in &rooms {
        let used = dependencies(room);
        let is_used = |other: &&PathBuf| used.contains(&format!("bahn-{}", house::name(other)));
        let above = rooms.iter().filter(is_used);
        let above = above.filter(|other| house::layer(other) > house::layer(room));
        upward.extend(above.map(|other| format!("{} uses {}", room.display(), other.display())));
    }
    assert!(upward.is_empty(), "{}", upward.join("\n"));
}

/// What is wrong with the order of rooms: one that uses a room which does not stand before it, or a name that stands twice.
fn disorder(rooms: &[(&str, &[&str])]) -> Vec<String> {
    let mut before = BTreeSet::from([DATA]);
    let mut faults = Vec::new();
    for (room, allowed) in rooms {
        let above = allowed.iter().filter(|used| !before.contains(**used));
        faults.extend(above.map(|used| format!("{used} does not stand before {room}, which uses it")));
        let mut named = BTreeSet::new();
        let twice = allowed.iter().filter(|used| !named.insert(**used));
        faults.extend(twice.map(|used| format!("{used} stands twice after {room}")));
        if !before.insert(room) {
            faults.push(format!("{room} stands twice"));
        }
    }
    faults
}

#[test]
fn disorder_is_found() {
    assert_eq!(disorder(&[("path", &[]), ("motion", &["path", DATA])]), [""; 0]);
    for (rooms, fault) in [
        (
            &[("motion", &["path"][..]), ("path", &[])][..],
            "path does not stand before motion, which uses it",
        ),
        (
            &[("path", &["path"][..])],
            "path does not stand before path, which uses it",
        ),
        (
            &[("path", &[][..]), ("motion", &["path", "path"])],
            "path stands twice after motion",
        ),
        (&[("path", &[][..]), ("path", &[])], "path stands twice"),
    ] {
        assert_eq!(disorder(rooms), [fault]);
    }
}

/// What a crate depends on, without what only its tests do.
fn dependencies(folder: &Path) -> Vec<String> {
    let manifest: toml::Table = fs::read_to_string(folder.join("Cargo.toml"))
        .unwrap()
        .parse()
        .unwrap();
    let dependencies = manifest.get("dependencies").and_then(toml::Value::as_table);
    dependencies
        .map(|table| table.keys().cloned().collect())
        .unwrap_or_default()
}

#[test]
fn files_hold_one_idea_and_no_unfinished_work() {
    let mut faults = Vec::new();
    for file in source_files(&root().join("crates")) {
        let text = fs::read_to_string(&file).unwrap();
        let name = file.display();
        if text.lines().count() > LINES_MAX {
            faults.push(format!("{name} has more than {LINES_MAX} lines"));
        }
        if is_this_check(&file) {
            continue;
        }
        for mark in UNFINISHED.iter().filter(|mark| text.contains(**mark)) {
            faults.push(format!("{name} contains {mark}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A room is as large as its concern: who has much to say leaves what is computed to a room below.
#[test]
fn rooms_have_one_concern() {
    let lines = |texts: Vec<PathBuf>| -> usize {
        let texts = texts.iter().filter(|file| !file.ends_with("tests.rs"));
        texts.map(|file| code_of(file).lines().count()).sum()
    };
    let sizes = house::rooms()
        .into_iter()
        .map(|folder| (house::name(&folder), lines(source_files(&folder.join("src")))));
    let large = sizes.filter(|(_, lines)| *lines > ROOM_MAX).map(|(room, _)| room);
    assert_as_known(
        large.collect(),
        TOO_LARGE.iter().map(|room| (*room).to_owned()).collect(),
    );
}

/// What is found out is handed back as data: people are spoken to in one place.
#[test]
fn faces_alone_print() {
    let marks = ["println!(", "print!(", "process::exit", "stdout()", "stderr()"];
    let mut faults = Vec::new();
    for (room, _) in ROOMS.iter().filter(|(room, _)| !FACES.contains(room)) {
        for file in source_files(&house::file(room).join("src")) {
            let code = code_of(&file);
            let lines = code
                .lines()
                .filter(|line| marks.iter().any(|mark| line.contains(mark)));
            faults.extend(lines.map(|line| format!("{}: {}", file.display(), line.trim())));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// What is compiled in lies in the crate itself, so that a packaged crate is whole.
#[test]
fn nothing_outside_a_crate_is_compiled_into_it() {
    for file in source_files(&root().join("crates")) {
        let crate_folder = file
            .ancestors()
            .find(|path| path.join("Cargo.toml").exists())
            .unwrap();
        let text = fs::read_to_string(&file).unwrap();
        let macros = ["include_str!(\"", "include_bytes!(\""];
        for path in macros.iter().flat_map(|name| text.split(name).skip(1)) {
            let path = path.split('"').next().unwrap();
            if is_this_check(&file) {
                continue;
            }
            let target = fs::canonicalize(file.with_file_name(path)).unwrap();
            let own = fs::canonicalize(crate_folder).unwrap();
            assert!(target.starts_with(own), "{} includes {path}", file.display());
        }
    }
}

/// Code numbers that the operator enters are a table of the room `parameters`: nobody else spells one.
#[test]
fn code_numbers_stand_in_one_room() {
    let table = fs::read_to_string(house::file("parameters/src/code_numbers.rs")).unwrap();
    let numbers: Vec<&str> = table
        .lines()
        .filter_map(|line| {
            line.strip_prefix("pub const ")?
                .split_once("= ")?
                .1
                .strip_suffix(';')
        })
        .filter(|number| number.contains('_'))
        .collect();
    assert!(numbers.len() >= 8, "{numbers:?}");
    let mut faults = Vec::new();
    for room in house::rooms()
        .iter()
        .filter(|room| house::name(room) != "parameters")
    {
        for file in source_files(&room.join("src")) {
            let code = code_of(&file);
            let spelled = numbers.iter().filter(|number| has_word(&code, number));
            faults.extend(spelled.map(|number| format!("{} has {number}", file.display())));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The differences of the control models are data of the room `parameters`: nobody else asks which model it is.
#[test]
fn models_are_compared_in_one_room() {
    let comparisons = ["ControlModel::Tnc", "== model", "model() =="];
    let mut faults = Vec::new();
    for file in source_files(&root().join("crates")) {
        let path = file.to_string_lossy();
        if !path.contains("/src/")
            || path.contains("crates/models/parameters/")
            || path.ends_with("/tests.rs")
        {
            continue;
        }
        let code = code_of(&file);
        for (number, line) in (1..).zip(code.lines()) {
            // The model that is taken when nobody names one.
            let default =
                path.ends_with("plc/src/compile/options.rs") && line.contains("model: ControlModel::");
            if comparisons.iter().any(|mark| line.contains(mark)) && !default {
                faults.push(format!("{path}:{number}: {}", line.trim()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Nobody else knows a control by its name either: a model is typed, and what it does otherwise is asked of it.
#[test]
fn controls_are_known_by_name_in_tables_only() {
    let mut faults = Vec::new();
    let mut known: BTreeSet<&str> = NAMES_OF_CONTROLS.iter().map(|(file, _)| *file).collect();
    for file in source_files(&root().join("crates")) {
        let path = file.to_string_lossy();
        if !path.contains("/src/") || path.contains("crates/models/parameters/") || path.contains("/tests") {
            continue;
        }
        let named: Vec<String> = code_of(&file)
            .lines()
            .filter(|line| names_a_control(line))
            .map(|line| format!("{path}: {}", line.trim()))
            .collect();
        let other = NAMES_OF_CONTROLS.iter().find(|(other, _)| path.ends_with(other));
        match other {
            Some((other, _)) if !named.is_empty() => drop(known.remove(other)),
            _ => faults.extend(named),
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(known.is_empty(), "no such names any more: {known:?}");
}

/// Whether a text of a line begins with the name of a control: letters, and its number.
fn names_a_control(line: &str) -> bool {
    line.split('"').skip(1).step_by(2).any(|text| {
        let name = text.to_ascii_lowercase();
        let number = name
            .trim_start_matches('i')
            .strip_prefix("tnc")
            .map(str::trim_start);
        number.is_some_and(|number| number.starts_with(|letter: char| letter.is_ascii_digit()))
    })
}

#[test]
fn names_of_controls_are_distinguished_from_drives() {
    for name in [
        "name.starts_with(\"ITNC530\")",
        "model == \"TNC 151\"",
        "of(\"tnc415b\")",
    ] {
        assert!(names_a_control(name), "{name}");
    }
    for other in ["join(\"TNC:1.H\")", "(\"tnc-plain\", \"h\")", "a TNC 415"] {
        assert!(!names_a_control(other), "{other}");
    }
}

/// Machine parameters have typed getters: their numbers stand in the room `parameters`.
#[test]
fn parameter_numbers_stand_in_one_room() {
    let mut faults = Vec::new();
    for file in source_files(&root().join("crates")) {
        let path = file.to_string_lossy();
        if !path.contains("/src/") || path.contains("crates/models/parameters/") {
            continue;
        }
        let code = code_of(&file);
        for (number, line) in (1..).zip(code.lines()) {
            let raw = line.split(".get(").skip(1).any(|rest| {
                let first = rest.split([',', ')']).next().unwrap_or_default();
                rest[first.len()..].starts_with(',') && first.parse::<u16>().is_ok()
            });
            if raw {
                faults.push(format!("{path}:{number}: {}", line.trim()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// How many axes there are, two types know: `PerAxis` those of a path, `PerPlcAxis` those of a list of machine
/// parameters. Nobody has an array of nine or five of them, or counts them otherwise.
#[test]
fn axes_are_counted_in_one_place() {
    let mut faults = Vec::new();
    let mut known: BTreeSet<&str> = NOT_OF_AXES.iter().map(|(file, _)| *file).collect();
    let rooms = ["crates", "machines", "fuzz/fuzz_targets"].map(|folder| source_files(&root().join(folder)));
    for file in rooms.iter().flatten().filter(|file| !is_this_check(file)) {
        let path = file.to_string_lossy();
        let other = NOT_OF_AXES.iter().find(|(other, _)| path.ends_with(other));
        let text = fs::read_to_string(file).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            let counts = line.contains("Axis::COUNT") || line.contains("Axis::ALL.map(");
            let array = is_array_of_axes(line);
            if let (true, Some((other, _))) = (array, other) {
                known.remove(other);
            } else if (array || counts) && !path.ends_with("path/src/axis.rs") {
                faults.push(format!("{path}:{number}: {}", line.trim()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(known.is_empty(), "no such arrays any more: {known:?}");
}

/// Whether a line has an array of literal length 5 or 9 whose elements may be of axes: numbers, letters, what is or is
/// not, axes and their numbers. What is given in other types (texts, keys, pairs) is no value of an axis.
fn is_array_of_axes(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    ["; 5]", "; 9]"].iter().any(|end| {
        code.match_indices(end).any(|(at, _)| {
            let element = code[..at].rsplit('[').next().unwrap_or_default();
            let literal = element.starts_with(|c: char| c.is_ascii_digit() || c == '-');
            let types = [
                "f32", "f64", "u8", "i32", "usize", "bool", "char", "true", "false", "None",
            ];
            let of_axis = element.starts_with("Option<") || element.contains("Axis");
            literal || of_axis || types.contains(&element)
        })
    })
}

#[test]
fn arrays_of_axes_are_distinguished_from_others() {
    for array in [
        "axes: [Option<AxisId>; 5],",
        "[TestAxis::default(); 5]",
        "[0.0; 9].into()",
        "[[1.0; 5]; 3]",
    ] {
        assert!(is_array_of_axes(array), "{array}");
    }
    for other in [
        "[0.0; PLC_AXES]",
        "[Bit; 5]",
        "[[f64; 2]; 5]",
        "[f64; 15]",
        "// [f64; 5]",
    ] {
        assert!(!is_array_of_axes(other), "{other}");
    }
}

/// Arrows point down within a room, too: no file uses one that uses it, but for the circles that are known.
#[test]
fn files_use_each_other_in_no_circle() {
    let found = rooms().into_iter().flat_map(|(room, texts)| {
        let circles = Uses::of(&Files::of(&texts)).circles().into_iter();
        circles.map(move |files| format!("{room}: {}", files.join(" ")))
    });
    let known = CIRCLES.iter().map(|(room, files)| format!("{room}: {files}"));
    assert_as_known(found.collect(), known.collect());
}

/// A list of what is known to be out of order names all of that and nothing else, so that it shrinks.
fn assert_as_known(found: BTreeSet<String>, known: BTreeSet<String>) {
    let new: Vec<_> = found.difference(&known).cloned().collect();
    let gone: Vec<_> = known.difference(&found).cloned().collect();
    assert!(
        new.is_empty() && gone.is_empty(),
        "new:\n{}\nno more:\n{}",
        new.join("\n"),
        gone.join("\n")
    );
}

/// The rooms by their names, with the texts of their files.
fn rooms() -> Vec<(String, Texts)> {
    let room = |folder: PathBuf| (house::name(&folder), Texts::below(&folder.join("src")));
    house::rooms().into_iter().map(room).collect()
}

/// Whoever opens the documentation of a room sees its use.
#[test]
fn front_pages_have_an_example() {
    let without: Vec<PathBuf> = house::rooms()
        .into_iter()
        .map(|room| room.join("src/lib.rs"))
        .filter(|file| !std::fs::read_to_string(file).unwrap().contains("\n//! ```"))
        .collect();
    assert!(without.is_empty(), "{without:?}");
}

/// Nothing is too much for its file: a type of many fields has its methods in one.
#[test]
fn no_type_is_too_much() {
    let found = rooms().into_iter().flat_map(|(room, texts)| {
        let types = wholes::too_much(&Files::of(&texts)).into_iter();
        let said = types.map(|(name, files)| format!("{room} {name}: {}", Vec::from_iter(files).join(" ")));
        said.collect::<Vec<_>>()
    });
    let known = TOO_MUCH
        .iter()
        .map(|(room, name, files)| format!("{room} {name}: {files}"));
    assert_as_known(found.collect(), known.collect());
}

/// Names speak as the glossary does.
#[test]
fn names_have_the_words_of_the_glossary() {
    let mut found = BTreeSet::new();
    let mut named = Vec::new();
    for folder in house::rooms() {
        let room = house::name(&folder);
        let texts: Vec<String> = source_files(&folder)
            .iter()
            .map(|file| fs::read_to_string(file).unwrap())
            .collect();
        let words = words::found(texts.iter().map(String::as_str));
        for (word, (instead, name)) in &words {
            named.push(format!("{room}: `{name}` has {word}, say {instead}"));
        }
        if !words.is_empty() {
            found.insert(format!("{room}: {}", Vec::from_iter(words.into_keys()).join(" ")));
        }
    }
    let known = REPLACED_WORDS
        .iter()
        .map(|(room, words)| format!("{room}: {words}"));
    let known: BTreeSet<String> = known.collect();
    assert!(
        found == known,
        "found:\n{}\nknown:\n{}\n{}",
        Vec::from_iter(found).join("\n"),
        Vec::from_iter(known).join("\n"),
        named.join("\n")
    );
}
