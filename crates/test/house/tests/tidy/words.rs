//! Words that docs/glossary.md has replaced, in the names of the code.
//!
//! One word has one meaning, in names as in texts. A comment may use them where they mean something else: a face lies
//! behind the part; names do without.

use std::collections::{BTreeMap, BTreeSet};

use crate::source::is_of_name;

/// A word, or several in this order, and what a name says instead.
const REPLACED: &[(&str, &str)] = &[
    ("behind", "after, past"),
    ("deed", "action, command"),
    ("deeds", "actions, commands"),
    ("lend", "hand over"),
    ("lender", "owner"),
    ("lends", "hand over"),
    ("lent", "handed over"),
    ("told", "reported"),
    ("way_deg", "angle_deg"),
    ("way_mm", "distance_mm"),
];

/// The replaced words of a name, each with what it says instead.
fn replaced(name: &str) -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    let parts = parts(name);
    REPLACED.iter().filter(move |(word, _)| {
        let word: Vec<&str> = word.split('_').collect();
        parts.windows(word.len()).any(|some| some == word)
    })
}

/// The words that a name is made of, in small letters.
fn parts(name: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    let mut before = '_';
    for letter in name.chars() {
        if letter == '_' || letter.is_uppercase() && !before.is_uppercase() {
            parts.push(String::new());
        }
        if letter != '_' {
            let last = parts.len() - 1;
            parts[last].extend(letter.to_lowercase());
        }
        before = letter;
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// The names of a text: what stands neither in comments nor in texts.
fn names(text: &str) -> BTreeSet<&str> {
    let mut names = BTreeSet::new();
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(length) = text_length(rest) {
            length
        } else if is_of_name(letter) {
            let length = rest.find(|letter| !is_of_name(letter)).unwrap_or(rest.len());
            names.insert(&rest[..length]);
            length
        } else {
            letter.len_utf8()
        };
        rest = &rest[length..];
    }
    names
}

/// How long the text or letter in quotes is that stands first; `None` if none does.
fn text_length(code: &str) -> Option<usize> {
    let plain = code.strip_prefix('b').unwrap_or(code);
    let head = code.len() - plain.len();
    if let Some(raw) = plain.strip_prefix('r') {
        let marks = raw.len() - raw.trim_start_matches('#').len();
        let inside = raw[marks..].strip_prefix('"')?;
        let end = format!("\"{}", "#".repeat(marks));
        let length = inside.find(&end)? + end.len();
        return Some(head + 1 + marks + 1 + length);
    }
    if plain.starts_with('"') {
        return quoted(plain, '"').map(|length| head + length);
    }
    // A letter in quotes, not the name of a lifetime.
    let inside = plain.strip_prefix('\'')?;
    let is_letter = inside.starts_with('\\') || inside.chars().nth(1) == Some('\'');
    is_letter.then(|| quoted(plain, '\'').map(|length| head + length))?
}

/// How long a text is with its quotes.
fn quoted(text: &str, quote: char) -> Option<usize> {
    let mut is_escaped = false;
    let end = text.char_indices().skip(1).find(|(_, letter)| {
        let ends = *letter == quote && !is_escaped;
        is_escaped = *letter == '\\' && !is_escaped;
        ends
    });
    end.map(|(at, letter)| at + letter.len_utf8())
}

/// The replaced words in the names of some texts, each with what is said instead and one of the names that have it.
pub fn found<'a>(
    texts: impl IntoIterator<Item = &'a str>,
) -> BTreeMap<&'static str, (&'static str, &'a str)> {
    let names: BTreeSet<&str> = texts.into_iter().flat_map(names).collect();
    let words = names.into_iter().flat_map(|name| {
        let words = replaced(name);
        words.map(move |(word, instead)| (*word, (*instead, name)))
    });
    words.collect()
}

#[test]
fn names_are_taken_apart() {
    assert_eq!(parts("TransferDeed"), ["transfer", "deed"]);
    assert_eq!(parts("BEHIND_MAX"), ["behind", "max"]);
    assert_eq!(parts("_way_mm"), ["way", "mm"]);
    assert_eq!(parts("blend"), ["blend"]);
}

#[test]
fn words_in_names_are_found_and_no_others() {
    let code = r##"
        //! Behind the part.
        fn stop_behind<'told>(c: char, way: f64) -> &'told str {
            let _ = (b"lent", r#"a "deed""#, "it \"lends\"", '"', '\'', b'\\');
            way_of(way_mm, half_way, blend)
        }
    "##;
    let found = found([code]).into_iter();
    let found: Vec<_> = found.map(|(word, (_, name))| (word, name)).collect();
    assert_eq!(
        found,
        [("behind", "stop_behind"), ("told", "told"), ("way_mm", "way_mm")]
    );
}
