//! The order of the house: arrows between rooms, file lengths, unfinished work.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms from the ground floor up: a room may only use rooms that stand before it here and are named
/// behind it.
const ROOMS: &[(&str, &[&str])] = &[
    ("path", &[]),
    ("picture", &[]),
    ("browser", &[]),
    ("parameters", &["path"]),
    ("program", &["path", "parameters"]),
    ("dialogue", &["path", "parameters", "program"]),
    ("reader", &["path", "parameters", "program"]),
    ("interpreter", &["path", "parameters", "program", "reader"]),
    ("motion", &["path"]),
    ("din", &["path"]),
    ("nc", &["path", "parameters", "program", "reader", "din"]),
    ("technology", &["path", "motion", "din"]),
    ("workpiece", &["path", "picture"]),
    ("viewer", &["path", "workpiece"]),
    ("exchange", &[]),
    ("plc", &["exchange", "parameters"]),
    ("convert", &["path", "parameters", "program", "interpreter"]),
    (
        "lsp",
        &[
            "path",
            "parameters",
            "program",
            "dialogue",
            "technology",
            "interpreter",
            "exchange",
            "plc",
            "din",
            "technology",
            "convert",
        ],
    ),
    ("servo", &["parameters"]),
    ("machine", &["servo"]),
    (
        "control",
        &[
            "path",
            "parameters",
            "program",
            "reader",
            "interpreter",
            "motion",
            "exchange",
            "plc",
            "servo",
        ],
    ),
    (
        "host",
        &[
            "path",
            "parameters",
            "program",
            "reader",
            "din",
            "nc",
            "interpreter",
            "exchange",
            "plc",
            "servo",
            "machine",
            "control",
        ],
    ),
    ("link", &["parameters", "program", "control", "host"]),
    (
        "panel",
        &[
            "path",
            "parameters",
            "program",
            "dialogue",
            "exchange",
            "plc",
            "servo",
            "machine",
            "control",
            "host",
            "picture",
            "workpiece",
            "viewer",
            "interpreter",
            "reader",
            "motion",
        ],
    ),
    ("server", &["panel", "viewer"]),
    ("terminal", &["panel"]),
    (
        "bahn",
        &[
            "path",
            "parameters",
            "program",
            "reader",
            "interpreter",
            "motion",
            "picture",
            "workpiece",
            "viewer",
            "exchange",
            "plc",
            "servo",
            "machine",
            "machines",
            "control",
            "host",
            "link",
            "panel",
            "server",
            "terminal",
            "din",
            "nc",
            "technology",
            "convert",
            "lsp",
        ],
    ),
];

/// Longer files hold more than one idea.
const LINES_MAX: usize = 700;

/// Files that use each other in a circle. None should; a circle that is opened leaves the list.
const CIRCLES: &[(&str, &[&str])] = &[];

/// What holds the parts of a room together, with its file. It only orders: what its parts do stands with them, and
/// they get what they may touch.
const WHOLES: &[(&str, &str, &str)] = &[
    ("interpreter", "Run", "run.rs"),
    ("control", "Control", "control.rs"),
    ("control", "Kernel", "kernel.rs"),
    ("control", "Channel", "channel.rs"),
    ("control", "MachineSide", "machine.rs"),
    ("control", "ProgramRun", "run.rs"),
];

/// Arrays of five or nine numbers, letters or the like that are not those of axes.
const NOT_OF_AXES: &[(&str, &str)] = &[
    ("control/src/touched.rs", "the sums of a circle through points"),
    (
        "control/src/handwheel.rs",
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

const UNFINISHED: &[&str] = &["todo!(", "unimplemented!(", "FIXME", "HACK"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn arrows_point_down() {
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        let room = folder.file_name().unwrap().to_string_lossy().into_owned();
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

/// Whether a name stands in the code, and not as part of a longer one.
fn has_word(code: &str, name: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(name)
        .any(|(at, _)| !code[..at].ends_with(part) && !code[at + name.len()..].starts_with(part))
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
        if file.ends_with("tidy.rs") {
            continue;
        }
        for mark in UNFINISHED.iter().filter(|mark| text.contains(**mark)) {
            faults.push(format!("{name} contains {mark}"));
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
            if file.ends_with("tidy.rs") {
                continue;
            }
            let target = fs::canonicalize(file.with_file_name(path)).unwrap();
            let own = fs::canonicalize(crate_folder).unwrap();
            assert!(target.starts_with(own), "{} includes {path}", file.display());
        }
    }
}

/// The differences of the control models are data of the room `parameters`: nobody else asks which model it is.
#[test]
fn models_are_compared_in_one_room() {
    let comparisons = ["ControlModel::Tnc", "== model", "model() =="];
    let mut faults = Vec::new();
    for file in source_files(&root().join("crates")) {
        let path = file.to_string_lossy();
        if !path.contains("/src/") || path.contains("crates/parameters/") || path.ends_with("/tests.rs") {
            continue;
        }
        let code = code_of(&file);
        for (number, line) in (1..).zip(code.lines()) {
            // The model that is taken when nobody names one.
            let default = path.ends_with("plc/src/compile/mod.rs") && line.contains("model: ControlModel::");
            if comparisons.iter().any(|mark| line.contains(mark)) && !default {
                faults.push(format!("{path}:{number}: {}", line.trim()));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Machine parameters have typed getters: their numbers stand in the room `parameters`.
#[test]
fn parameter_numbers_stand_in_one_room() {
    let mut faults = Vec::new();
    for file in source_files(&root().join("crates")) {
        let path = file.to_string_lossy();
        if !path.contains("/src/") || path.contains("crates/parameters/") {
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
    for file in rooms.iter().flatten().filter(|file| !file.ends_with("tidy.rs")) {
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
fn arrays_of_axes_are_told_from_others() {
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
    let mut found = Vec::new();
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        let room = folder.file_name().unwrap().to_string_lossy().into_owned();
        for circle in Uses::of(&folder.join("src")).circles() {
            found.push((room.clone(), circle));
        }
    }
    let known: Vec<(String, Vec<String>)> = CIRCLES
        .iter()
        .map(|(room, files)| {
            (
                (*room).to_owned(),
                files.iter().map(|file| (*file).to_owned()).collect(),
            )
        })
        .collect();
    let mut faults = Vec::new();
    for (room, files) in &found {
        let is_known = known
            .iter()
            .any(|(of, known)| of == room && files.iter().all(|file| known.contains(file)));
        if !is_known {
            faults.push(format!("a new circle in {room}: {}", files.join(", ")));
        }
    }
    for circle in &known {
        if !found.contains(circle) {
            faults.push(format!("this circle is no more as listed: {circle:?}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Whoever opens the documentation of a room sees its use.
#[test]
fn front_pages_have_an_example() {
    let crates = std::fs::read_dir(root().join("crates")).unwrap();
    let without: Vec<PathBuf> = crates
        .map(|room| room.unwrap().path().join("src/lib.rs"))
        .filter(|file| !std::fs::read_to_string(file).unwrap().contains("\n//! ```"))
        .collect();
    assert!(without.is_empty(), "{without:?}");
}

/// The methods of a whole stand in its own file: a file that gets parts of it has functions, or parts, of its own.
#[test]
fn a_whole_has_its_methods_in_its_own_file() {
    for (room, whole, file) in WHOLES {
        let folder = root().join("crates").join(room).join("src");
        let found: Vec<PathBuf> = source_files(&folder)
            .into_iter()
            .filter(|file| has_methods_of(&code_of(file), whole))
            .collect();
        assert_eq!(found, [folder.join(file)], "files with `impl {whole}`");
    }
}

/// Whether the code has methods of a type that are those of no trait.
fn has_methods_of(code: &str, of: &str) -> bool {
    let heads = code.match_indices("impl").filter_map(|(at, mark)| {
        let is_word = code[..at].chars().next_back().is_none_or(char::is_whitespace);
        let head = code[at + mark.len()..].split('{').next()?;
        is_word.then_some(head)
    });
    heads.into_iter().any(|head| {
        // Behind the generic parameters of `impl<'a> Type<'a>`.
        let name = match head.strip_prefix('<') {
            Some(generic) => generic.split_once("> ").map_or("", |(_, name)| name),
            None => head.trim_start(),
        };
        let name = name.split(['<', ' ', '\n']).next().unwrap_or_default();
        name.rsplit("::").next() == Some(of) && !head.contains(" for ")
    })
}

#[test]
fn methods_are_told_from_those_of_traits() {
    assert!(has_methods_of("struct Run;\nimpl Run {", "Run"));
    assert!(has_methods_of("impl<'a> crate::run::Run<'a> {", "Run"));
    assert!(!has_methods_of(
        "impl Runner {\n fn run(&self) -> impl Iterator<Item = Run> {",
        "Run"
    ));
    assert!(!has_methods_of("impl Drop for Run {", "Run"));
    assert!(!has_methods_of("impl Run for Machine {", "Run"));
}

/// Which file of a room uses which.
struct Uses(BTreeMap<String, BTreeSet<String>>);

impl Uses {
    fn of(folder: &Path) -> Uses {
        let name = |file: &Path| {
            let relative = file.strip_prefix(folder).unwrap().with_extension("");
            let parts: Vec<_> = relative.iter().map(|part| part.to_str().unwrap()).collect();
            parts.join("::").trim_end_matches("::mod").to_owned()
        };
        let files: BTreeMap<String, PathBuf> = source_files(folder)
            .into_iter()
            .map(|file| (name(&file), file))
            .filter(|(name, _)| name != "lib" && name != "main")
            .collect();
        let uses = files.iter().map(|(name, file)| {
            let code = code_of(file);
            let used = paths(&code, name)
                .iter()
                .filter_map(|path| {
                    (1..=path.len())
                        .rev()
                        .map(|count| path[..count].join("::"))
                        .find(|p| files.contains_key(p))
                })
                // A file and the files below it are one.
                .filter(|used| {
                    !format!("{used}::").starts_with(&format!("{name}::"))
                        && !format!("{name}::").starts_with(&format!("{used}::"))
                })
                .collect();
            (name.clone(), used)
        });
        Uses(uses.collect())
    }

    /// Files that reach each other, two and more.
    fn circles(&self) -> Vec<Vec<String>> {
        let reach: BTreeMap<&String, BTreeSet<&String>> =
            self.0.keys().map(|file| (file, self.reached(file))).collect();
        let mut circles: Vec<Vec<String>> = Vec::new();
        for (file, reached) in &reach {
            if circles.iter().any(|circle| circle.contains(file)) {
                continue;
            }
            let circle: Vec<String> = reached
                .iter()
                .filter(|other| reach[**other].contains(file))
                .map(|other| (*other).clone())
                .collect();
            if circle.len() > 1 {
                circles.push(circle);
            }
        }
        circles
    }

    fn reached<'a>(&'a self, from: &'a String) -> BTreeSet<&'a String> {
        let mut reached = BTreeSet::new();
        let mut waiting = vec![from];
        while let Some(file) = waiting.pop() {
            waiting.extend(self.0[file].iter().filter(|next| reached.insert(*next)));
        }
        reached
    }
}

/// The paths below `crate` and `super` that a file names, from the root of its crate.
fn paths<'a>(code: &'a str, file: &'a str) -> Vec<Vec<&'a str>> {
    let above: Vec<&str> = file.split("::").collect();
    let mut found = Vec::new();
    for mark in ["crate::", "super::"] {
        for (at, _) in code.match_indices(mark) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let mut written = Vec::new();
            names(&code[at..], &mut Vec::new(), &mut written);
            found.extend(written.into_iter().map(|path| from_root(&path, &above)));
        }
    }
    found
}

/// The names of a path, of each branch where it ends in braces; what is left behind it.
fn names<'a>(text: &'a str, before: &mut Vec<&'a str>, found: &mut Vec<Vec<&'a str>>) -> &'a str {
    let depth = before.len();
    let mut rest = text;
    loop {
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
        let (name, behind) = rest.split_at(end.unwrap_or(rest.len()));
        if !name.is_empty() {
            before.push(name);
        }
        rest = behind;
        if let Some(more) = behind.strip_prefix("::") {
            rest = more;
            if let Some(mut group) = more.strip_prefix('{') {
                while let Some(branch) = group.trim_start().strip_prefix(',').or(Some(group.trim_start())) {
                    let branch = branch.trim_start();
                    if branch.is_empty() || branch.starts_with('}') {
                        rest = branch.strip_prefix('}').unwrap_or(branch);
                        break;
                    }
                    let behind = names(branch, before, found);
                    // Renamed: `as other`.
                    group = behind.find([',', '}']).map_or("", |at| &behind[at..]);
                }
                break;
            }
            continue;
        }
        found.push(before.clone());
        break;
    }
    before.truncate(depth);
    rest
}

/// A path from the root of its crate, as the file below `above` writes it.
fn from_root<'a>(path: &[&'a str], above: &[&'a str]) -> Vec<&'a str> {
    let mut base = above.len();
    let mut own = Vec::new();
    for part in path {
        match *part {
            "crate" => base = 0,
            "super" => base = base.saturating_sub(1),
            part => own.push(part),
        }
    }
    [&above[..base], &own].concat()
}

#[test]
fn paths_are_found_in_groups() {
    let code = "use crate::{UsageError, files::{self, NewFile as N}, mp};\nlet x = super::emit::cost();";
    let found: Vec<String> = paths(code, "plc::run")
        .iter()
        .map(|path| path.join("::"))
        .collect();
    assert_eq!(
        found,
        [
            "UsageError",
            "files::self",
            "files::NewFile",
            "mp",
            "plc::emit::cost"
        ]
    );
}

/// The text of a file without comments and without its tests.
fn code_of(file: &Path) -> String {
    let text = fs::read_to_string(file).unwrap();
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    text.lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(source_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}
