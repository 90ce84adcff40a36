//! What words of DIN 66025 mean: `data/din.tsv`.

use std::ops::Range;

use bahn_din::SpanKind;

use crate::language::{Completion, CompletionKind};
use crate::markdown::Markdown;

/// A row of the table.
struct Word {
    word: &'static str,
    /// `G`, `A`ddress, `V`ariable, `C`ommand.
    part: &'static str,
    title: &'static str,
    unit: &'static str,
    rule: &'static str,
    source: &'static str,
}

fn words() -> impl Iterator<Item = Word> {
    let rows = include_str!("../../data/din.tsv").lines().skip(1);
    rows.filter_map(|line| {
        let mut columns = line.split('\t');
        let mut next = || columns.next();
        Some(Word {
            word: next()?,
            part: next()?,
            title: next()?,
            unit: next()?,
            rule: next()?,
            source: next()?,
        })
    })
}

/// What a word means.
pub(super) fn meaning(text: &str, kind: SpanKind) -> Option<String> {
    let capitals = text.to_ascii_uppercase();
    let capitals = capitals.split_whitespace().collect::<Vec<_>>().join(" ");
    let found = match kind {
        SpanKind::Function => function(&capitals)?,
        SpanKind::Address => words().find(|row| row.part == "A" && row.word == capitals)?,
        SpanKind::Command => {
            // The longest name that the command begins with.
            let begins = words().filter(|row| row.part == "C" && capitals.starts_with(row.word));
            begins.max_by_key(|row| row.word.len())?
        }
        _ => return None,
    };
    let text = Markdown::titled(&format!("{}: {}", found.word, found.title));
    Some(
        text.paragraph(found.rule)
            .fact("Unit", found.unit)
            .source(found.source)
            .text(),
    )
}

/// G, M or H with its number.
fn function(text: &str) -> Option<Word> {
    const ORDERED: Word = Word {
        word: "M",
        part: "M",
        title: "technology function",
        unit: "",
        rule: "When it goes out and whether the path waits for it is said by the channel parameter list: `bahn channel explain`.",
        source: "(public)",
    };
    match text.get(..1)? {
        "M" => Some(ORDERED),
        "H" => Some(Word { word: "H", ..ORDERED }),
        _ => {
            let number: u16 = text.get(1..)?.parse().ok()?;
            words().find(|row| row.part == "G" && row.word == format!("G{number:02}"))
        }
    }
}

/// Title and rule of a variable.
pub(super) fn variable(name: &str) -> (&'static str, &'static str) {
    let rows = words().filter(|row| row.part == "V" && name.starts_with(row.word));
    let longest = rows.max_by_key(|row| row.word.len());
    longest.map_or(("Variable", ""), |row| (row.title, row.rule))
}

/// All functions and commands.
pub(super) fn completions(range: Range<usize>) -> Vec<Completion> {
    words()
        .map(|row| {
            let mut own = item(
                range.clone(),
                row.word.to_owned(),
                row.title.to_owned(),
                row.word.to_owned(),
            );
            own.documentation = row.rule.to_owned();
            own
        })
        .collect()
}

pub(super) fn item(range: Range<usize>, label: String, detail: String, snippet: String) -> Completion {
    Completion {
        label,
        detail,
        documentation: String::new(),
        kind: CompletionKind::Word,
        range,
        snippet: snippet.replace('$', "\\$"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_complete() {
        assert_eq!(
            words().count(),
            include_str!("../../data/din.tsv").lines().count() - 1
        );
        for row in words() {
            assert!(
                matches!(row.part, "G" | "A" | "V" | "C") && !row.title.is_empty(),
                "{}",
                row.word
            );
            assert!(
                row.source.starts_with('[') || row.source == "(public)",
                "{}",
                row.word
            );
        }
    }

    /// What the table names can be read.
    #[test]
    fn functions_of_the_table_are_read() {
        for row in words().filter(|row| row.part == "G") {
            let text = format!("%1\nN10 {} X1 F1 I1 J0\n", row.word);
            let program = bahn_din::Program::from_bytes("a.nc", text.as_bytes());
            let unknown = program
                .faults()
                .into_iter()
                .find(|fault| fault.message.contains("unknown"));
            assert_eq!(unknown, None, "{}", row.word);
        }
    }
}
