//! The order of the house: arrows between rooms, file lengths, unfinished work.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms from the ground floor up: a room may only use rooms that stand before it here and are named
/// behind it.
const ROOMS: &[(&str, &[&str])] = &[
    ("path", &[]),
    ("picture", &[]),
    ("parameters", &["path"]),
    ("program", &["path", "parameters"]),
    ("interpreter", &["path", "parameters", "program"]),
    ("motion", &["path"]),
    ("workpiece", &["path", "picture"]),
    ("exchange", &[]),
    ("plc", &["exchange", "parameters"]),
    ("servo", &["parameters"]),
    ("machine", &["servo"]),
    (
        "control",
        &[
            "path",
            "parameters",
            "program",
            "interpreter",
            "motion",
            "exchange",
            "plc",
            "servo",
        ],
    ),
    (
        "bahn",
        &[
            "path",
            "parameters",
            "program",
            "interpreter",
            "motion",
            "picture",
            "workpiece",
            "exchange",
            "plc",
            "servo",
            "machine",
            "machines",
            "control",
        ],
    ),
];

/// Longer files hold more than one idea.
const LINES_MAX: usize = 700;

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
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let dependencies = manifest.split("[dependencies]").nth(1).unwrap_or_default();
        let dependencies = dependencies.split("\n[").next().unwrap_or_default();
        for line in dependencies.lines() {
            let Some(used) = line.strip_prefix("bahn-") else {
                continue;
            };
            let used = used.split(['.', ' ', '=']).next().unwrap_or_default();
            assert!(allowed.contains(&used), "{room} must not use {used}");
        }
    }
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
