//! Which file of a room uses which, and which files use each other in a circle.
//!
//! A file uses another when it names something that the other defines. A name that a file imports is followed to
//! the file that defines it, and importing a name only for others (`pub use`) is no use: so a whole, `x.rs`, may
//! either define what its parts in `x/` share and pass their names on, or use its parts and give them what they
//! need as arguments. Where it does both, it and they are a circle like any other.

use std::collections::{BTreeMap, BTreeSet};

use crate::names::{Files, Texts};
use crate::source::{has_word, is_of_name};

/// What each file of a room uses.
pub struct Uses(BTreeMap<String, BTreeSet<String>>);

impl Uses {
    /// Those of the files of a room.
    pub fn of(files: &Files<'_>) -> Uses {
        let used = |file| (String::from(file), used_by(files, file));
        Uses(files.names().map(used).collect())
    }

    /// Files that reach each other, two and more.
    pub fn circles(&self) -> Vec<Vec<String>> {
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

/// The files that a file uses.
fn used_by<'a>(files: &Files<'a>, file: &'a str) -> BTreeSet<String> {
    let body = files.body(file);
    let of_imports = files
        .imports(file)
        .iter()
        .filter(|import| !import.is_public || has_word(body, import.name))
        .filter_map(|import| files.imported(import));
    let of_paths = paths(body)
        .into_iter()
        .filter_map(|path| files.named(file, &path));
    let used = of_imports.chain(of_paths).map(|(used, _)| used);
    used.filter(|used| *used != file).map(str::to_owned).collect()
}

/// The paths of two and more names in a text.
fn paths(code: &str) -> Vec<Vec<&str>> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(start) = rest.find(is_of_name) {
        let is_after_path = rest[..start].ends_with("::");
        rest = &rest[start..];
        let mut path = Vec::new();
        loop {
            let (name, after) = rest.split_at(rest.find(|c| !is_of_name(c)).unwrap_or(rest.len()));
            path.push(name);
            rest = after;
            match after.strip_prefix("::") {
                Some(more) if more.starts_with(is_of_name) => rest = more,
                _ => break,
            }
        }
        if path.len() > 1 && !is_after_path {
            found.push(path);
        }
    }
    found
}

/// Which files are in a circle, of files given as names with texts.
fn circles<const N: usize>(files: [(&str, &str); N]) -> Vec<Vec<String>> {
    let files = files.map(|(name, text)| (name.to_owned(), text.to_owned()));
    Uses::of(&Files::of(&Texts::of(files))).circles()
}

#[test]
fn a_whole_that_uses_its_parts_is_not_used_by_them() {
    let part = ("run::way", "use super::Run;\nfn go(run: &Run) {}");
    let whole = "mod way;\npub struct Run;\nfn all(run: &Run) { way::go(run) }";
    assert_eq!(circles([("run", whole), part]), [["run", "run::way"]]);
    // It defines what the part uses, and passes on what the part has.
    let whole = "mod way;\npub use way::go;\npub struct Run;";
    assert!(circles([("run", whole), part]).is_empty());
    let own = ("run::way", "use super::Run;\npub fn way(run: &Run) {}");
    let whole = "mod way;\npub use way::way;\npub struct Run;";
    assert!(circles([("run", whole), own]).is_empty());
    // It uses the part, which gets what it needs.
    let whole = "mod way;\nstruct Run { length: f64 }\nfn all(run: &Run) { way::go(run.length) }";
    assert!(circles([("run", whole), ("run::way", "pub fn go(length: f64) {}")]).is_empty());
}

#[test]
fn names_are_followed_to_the_file_that_defines_them() {
    // `b` has `Kind` from its neighbour, by the whole; the whole uses `b`.
    let whole = "mod a;\nmod b;\npub use a::Kind;\nfn all() { b::go(Kind) }";
    let b = ("x::b", "use super::Kind;\npub fn go(kind: Kind) {}");
    assert!(circles([("x", whole), ("x::a", "pub enum Kind {}"), b]).is_empty());
    let a = (
        "x::a",
        "use crate::x::b;\npub enum Kind {}\nfn c() { b::go(Kind) }",
    );
    assert_eq!(circles([("x", whole), a, b]), [["x::a", "x::b"]]);
    // The front passes on, too, in groups and under other names.
    let front = "mod a;\nmod b;\npub use {a::{self as first, Kind as Sort}, b::*};";
    let a = ("a", "pub enum Kind {}\nfn c() { crate::go() }");
    let b = ("b", "pub fn go() { let _ = crate::Sort::new(); }");
    assert_eq!(circles([("lib", front), a, b]), [["a", "b"]]);
}
