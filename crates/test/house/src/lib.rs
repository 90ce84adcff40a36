//! The order of the house, looked at without building it: the folders of the rooms, each in that of its layer, below `crates`.
//!
//! ```
//! assert!(bahn_house::rooms().iter().any(|room| bahn_house::name(room) == "motion"));
//! ```
#![allow(
    clippy::unwrap_used,
    reason = "tests alone ask, and what fails here fails the test"
)]

use std::fs;
use std::path::{Path, PathBuf};

/// The layers from the ground up, each a folder of rooms.
pub const LAYERS: [&str; 10] = [
    "base", "drives", "models", "programs", "kernel", "families", "machine", "part", "faces", "test",
];

/// The folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .find(|folder| folder.join("Cargo.lock").exists())
        .unwrap()
        .to_owned()
}

/// The folder of each room, by layer and name.
pub fn rooms() -> Vec<PathBuf> {
    let mut found = Vec::new();
    manifests_below(&root().join("crates"), &mut found);
    found.sort_by_key(|room| (layer(room), name(room)));
    found
}

/// The place of a room's layer among them.
pub fn layer(room: &Path) -> usize {
    let folder = name(room.parent().unwrap());
    let place = LAYERS.iter().position(|layer| *layer == folder);
    assert!(place.is_some(), "{folder} is no layer: {}", room.display());
    place.unwrap()
}

fn manifests_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.join("Cargo.toml").exists() {
            found.push(path);
        } else if path.is_dir() {
            manifests_below(&path, found);
        }
    }
}

/// The name of a room.
pub fn name(room: &Path) -> String {
    room.file_name().unwrap().to_string_lossy().into_owned()
}

/// A file that is named as the documents name it, from its room on: `path/src/frame.rs`.
pub fn file(named: &str) -> PathBuf {
    let (room, rest) = named.split_once('/').unwrap_or((named, ""));
    rooms()
        .into_iter()
        .find(|folder| name(folder) == room)
        .map_or_else(|| root().join(named), |folder| folder.join(rest))
}

/// A document of the project is this text; with BAHN_WRITE_DOCS=1 it becomes so. `written_by` is the command that makes it anew.
///
/// # Panics
/// When it is another text.
pub fn holds_text(document: &str, text: &str, written_by: &str) {
    let path = root().join(document);
    if std::env::var_os("BAHN_WRITE_DOCS").is_some() {
        fs::write(&path, text).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == text, "{document} is made anew by `{written_by}`");
}

/// Whether a room has a test in a file of a name, or in a folder of that name.
pub fn has_test(room: &str, file: &str, test: &str) -> bool {
    let Some(room) = rooms().into_iter().find(|folder| name(folder) == room) else {
        return false;
    };
    let mut sources = Vec::new();
    for part in ["src", "tests"] {
        sources_below(&room.join(part), &mut sources);
    }
    let head = format!("fn {test}(");
    sources
        .iter()
        .filter(|path| {
            let folder = path.parent().map(name);
            path.file_stem().is_some_and(|stem| stem == file) || folder.is_some_and(|folder| folder == file)
        })
        .any(|path| fs::read_to_string(path).unwrap().contains(&head))
}

fn sources_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder)
        .into_iter()
        .flatten()
        .map(|entry| entry.unwrap().path())
    {
        if path.is_dir() {
            sources_below(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
}
