//! The text of source files, as the checks read it.

use std::fs;
use std::path::{Path, PathBuf};

/// The text of a file without comments and without its tests.
pub fn code_of(file: &Path) -> String {
    without_tests(&fs::read_to_string(file).unwrap())
}

/// A text without comments and without what is compiled for tests alone, wherever it stands.
pub fn without_tests(text: &str) -> String {
    const MARK: &str = "#[cfg(test)]";
    let text: Vec<&str> = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect();
    let text = text.join("\n");
    let mut code = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some((before, marked)) = rest.split_once(MARK) {
        code.push_str(before);
        rest = &marked[end_of_item(marked)..];
    }
    code + rest
}

/// Where the item that a text begins with ends: with its braces, or at a semicolon or comma outside of any.
fn end_of_item(text: &str) -> usize {
    let mut depth = 0;
    for (at, letter) in text.char_indices() {
        match letter {
            '{' | '(' | '[' => depth += 1,
            '}' if depth == 1 => return at + 1,
            '}' | ')' | ']' => depth -= 1,
            ';' | ',' if depth == 0 => return at + 1,
            _ => {}
        }
    }
    text.len()
}

#[test]
fn tests_are_left_out_wherever_they_stand() {
    let text = "mod a; // it\n#[cfg(test)]\nmod tests;\nmod b;\n#[cfg(test)]\nfn c(d: [u8; 2], e: u8) { f({}); }\nfn g() {}";
    let code: Vec<String> = without_tests(text)
        .lines()
        .map(|line| line.trim().to_owned())
        .collect();
    assert_eq!(code, ["mod a;", "", "mod b;", "", "fn g() {}"]);
}

/// The Rust files below a folder.
pub fn source_files(folder: &Path) -> Vec<PathBuf> {
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

/// Whether a letter may be part of a name.
pub fn is_of_name(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// Whether a name stands in the code, and not as part of a longer one.
pub fn has_word(code: &str, name: &str) -> bool {
    code.match_indices(name)
        .any(|(at, _)| !code[..at].ends_with(is_of_name) && !code[at + name.len()..].starts_with(is_of_name))
}
