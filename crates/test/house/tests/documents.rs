//! The documents lead where they say, and the index knows them all.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

use std::fs;
use std::path::{Path, PathBuf};

use bahn_house as house;
use bahn_house::root;

/// The pages that people read, from the root of the project.
fn pages() -> Vec<PathBuf> {
    let mut pages = Vec::new();
    for folder in ["", "docs", "examples", "examples/plc", "machines"] {
        pages.extend(texts_in(&root().join(folder)));
    }
    for machine in fs::read_dir(root().join("machines")).unwrap() {
        let folder = machine.unwrap().path();
        if folder.is_dir() {
            pages.extend(texts_in(&folder));
        }
    }
    pages
}

fn texts_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect()
}

/// The targets of the links and pictures of a page, without those in code.
fn links(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    prose
        .flat_map(|prose| prose.split("](").skip(1))
        .filter_map(|rest| rest.split(')').next())
        .filter(|target| !target.contains("://") && !target.starts_with(['#', '<']))
        .map(|target| target.split('#').next().unwrap_or_default())
        .collect()
}

#[test]
fn links_of_prose_are_found() {
    let text = "see [a](x.md#part), [b](https://example.org)\n```\n[c](no.md)\n```\n![d](y.png)";
    assert_eq!(links(text), ["x.md", "y.png"]);
}

#[test]
fn no_link_is_dead() {
    let mut dead = Vec::new();
    let pages = pages();
    assert!(pages.len() > 25, "{pages:?}");
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for target in links(&text) {
            if !page.with_file_name(target).exists() {
                dead.push(format!("{}: {target}", page.display()));
            }
        }
    }
    assert!(dead.is_empty(), "{}", dead.join("\n"));
}

/// Whoever opens the folder of the documents finds each of them in its index.
#[test]
fn the_index_names_every_document() {
    let index = fs::read_to_string(root().join("docs/README.md")).unwrap();
    let known = links(&index);
    for page in texts_in(&root().join("docs")) {
        let name = page.file_name().unwrap().to_str().unwrap();
        assert!(
            name == "README.md" || known.contains(&name),
            "docs/README.md does not name {name}"
        );
    }
}

/// The map stays one that is read at a sitting.
const MAP_BYTES: usize = 20_000;
/// Promises of the map that name their test.
const PROMISES: usize = 20;

/// The map of the code is short, and each of its promises names a test that is there.
#[test]
fn the_map_names_the_tests_of_its_promises() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    assert!(text.len() <= MAP_BYTES, "{} bytes", text.len());
    let rows = text
        .lines()
        .filter(|line| line.starts_with("| ") && !line.starts_with("| promise"));
    let mut count = 0;
    for row in rows {
        let named = row.trim_end_matches([' ', '|', '`']).rsplit('`').next().unwrap();
        let parts: Vec<&str> = named.split("::").collect();
        let [room, file, test] = parts[..] else {
            panic!("no test is named: {row}");
        };
        assert!(
            house::has_test(room, file, test),
            "there is no test {named}: {row}"
        );
        count += 1;
    }
    assert!(count >= PROMISES, "{count}");
}
