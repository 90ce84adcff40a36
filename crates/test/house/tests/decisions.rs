//! docs/decisions.md is made of the decisions that stand beside the code, as `//! Decision: ..` on the front page of a
//! file: paragraphs that end with an empty line of the comment. `(also ..)` at the end names further files.
#![allow(clippy::unwrap_used, reason = "a helper that panics fails its test")]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use bahn_house as house;
use bahn_house::holds_text;

const MARK: &str = "Decision: ";
const HEAD: &str = "# Decisions\n\n\
    Where the manuals are silent or contradict each other, or where a rule is not what one would expect, this is what was decided, by\n\
    room, and the file that holds it. What a manual says stands with its citation in the code, not here. The page is made of the\n\
    code: each decision is a `//! Decision:` of its file (`make decisions`).\n";

/// The decisions of a file and, for each, further files that hold it.
fn decisions_of(source: &str) -> Vec<(String, Vec<String>)> {
    let comment = source.lines().map_while(|line| line.strip_prefix("//!"));
    let comment: Vec<&str> = comment.map(str::trim).collect();
    let paragraphs = comment.split(|line| line.is_empty());
    let decisions = paragraphs.filter_map(|lines| lines.join(" ").strip_prefix(MARK).map(str::to_owned));
    decisions.map(|text| without_files(&text)).collect()
}

/// `It is so (also `a/src/b.rs`)`: what was decided, and the files.
fn without_files(text: &str) -> (String, Vec<String>) {
    let Some((text, also)) = text.trim_end_matches(')').rsplit_once(" (also ") else {
        return (text.to_owned(), Vec::new());
    };
    let files = also.split('`').skip(1).step_by(2).map(str::to_owned);
    (text.to_owned(), files.collect())
}

#[test]
fn decisions_are_read() {
    let source = "//! What it is.\n//!\n//! Decision: It is so, because\n//! it is (also `a/src/b.rs`, `a/data/c.tsv`)\n//!\n//! Decision: Or so (f(x))\n\nuse a;\n//! Decision: none";
    let read = decisions_of(source);
    let files = ["a/src/b.rs", "a/data/c.tsv"].map(str::to_owned).to_vec();
    assert_eq!(
        read,
        [
            ("It is so, because it is".to_owned(), files),
            ("Or so (f(x))".to_owned(), Vec::new())
        ]
    );
}

fn sources_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The page by room, in the order of the rooms' folders.
fn page() -> String {
    let mut page = HEAD.to_owned();
    for room in house::rooms() {
        let mut rows = String::new();
        for file in sources_below(&room.join("src")) {
            let inside = file
                .strip_prefix(room.parent().unwrap())
                .unwrap()
                .display()
                .to_string();
            for (text, also) in decisions_of(&fs::read_to_string(&file).unwrap()) {
                let mut places = format!("`{inside}`");
                for file in &also {
                    assert!(
                        house::file(file).exists(),
                        "{file} is not there: {inside}: {text}"
                    );
                    write!(places, ", `{file}`").unwrap();
                }
                writeln!(rows, "| {} | {places} |", text.replace('|', "\\|")).unwrap();
            }
        }
        if !rows.is_empty() {
            write!(
                page,
                "\n## {}\n\n| decision | where |\n|---|---|\n{rows}",
                house::name(&room)
            )
            .unwrap();
        }
    }
    page
}

#[test]
fn the_document_has_those_of_the_code() {
    let page = page();
    assert!(page.lines().filter(|line| line.starts_with("| ")).count() > 250);
    holds_text("docs/decisions.md", &page, "make decisions");
}
