//! What words mean: `data/words.tsv`.

use std::sync::LazyLock;

/// What a word does in its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// It says what the block does.
    Function,
    /// It stands before a value, or is a word of its own.
    Address,
    /// A word M with its number.
    M,
    /// A G function that is a cycle; the title names it in plain language.
    Cycle,
    /// A D function; the title names it in plain language.
    Calculation,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word {
    /// Whether plain language and DIN/ISO have it.
    pub(super) languages: [bool; 2],
    pub(super) word: &'static str,
    pub(super) part: Part,
    pub(super) title: &'static str,
    /// `length`, `degrees`, `feed`, `rpm`; empty without one.
    pub(super) unit: &'static str,
    pub(super) rule: &'static str,
    pub(super) source: &'static str,
    /// What is written, with places to fill in; empty where the word stands for itself.
    pub(super) snippet: &'static str,
}

/// All words of the table `data/words.tsv`.
pub(super) fn words() -> &'static [Word] {
    static WORDS: LazyLock<Vec<Word>> = LazyLock::new(|| {
        let rows = include_str!("../../data/words.tsv").lines().skip(1);
        rows.filter_map(row).collect()
    });
    &WORDS
}

/// Reads a row; a test proves that all can be read.
fn row(line: &'static str) -> Option<Word> {
    let mut columns = line.split('\t');
    let mut next = || columns.next();
    Some(Word {
        languages: match next()? {
            "plain" => [true, false],
            "iso" => [false, true],
            "both" => [true, true],
            _ => return None,
        },
        word: next()?,
        part: match next()? {
            "function" => Part::Function,
            "address" => Part::Address,
            "m" => Part::M,
            "cycle" => Part::Cycle,
            "fn" => Part::Calculation,
            _ => return None,
        },
        title: next()?,
        unit: next()?,
        rule: next()?,
        source: next()?,
        snippet: next()?,
    })
}

/// Words of DIN/ISO, or of plain language.
pub(super) fn of_language(is_iso: bool) -> impl Iterator<Item = &'static Word> {
    words()
        .iter()
        .filter(move |word| word.languages[usize::from(is_iso)])
}

/// A word of a language as a part of a block, written in capitals.
pub(super) fn find(is_iso: bool, part: Part, word: &str) -> Option<&'static Word> {
    of_language(is_iso).find(|row| row.part == part && row.word == word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_parameters::ControlModel;
    use bahn_parameters::conformance::{Kind, find};
    use bahn_program::{IsoLanguage, Language, PlainLanguage};
    use std::collections::HashSet;

    #[test]
    fn every_row_can_be_read_and_stands_once() {
        let lines = include_str!("../../data/words.tsv").lines().count() - 1;
        assert_eq!(words().len(), lines);
        let mut seen = HashSet::new();
        for word in words() {
            assert!(
                seen.insert((word.languages, word.word, word.part as u8)),
                "{} twice",
                word.word
            );
            let cited = word.source.starts_with('[') || word.source == "(public)";
            assert!(
                !word.title.is_empty() && (cited || word.part == Part::M),
                "{word:?}"
            );
        }
    }

    /// What is cited of M functions stands in the registry.
    #[test]
    fn m_functions_are_those_of_the_registry() {
        for word in words().iter().filter(|word| word.part == Part::M) {
            let known = ControlModel::ALL
                .iter()
                .any(|model| find(*model, Kind::MFunction, word.word).is_some());
            assert!(known, "{}", word.word);
        }
    }

    /// A snippet whose places keep their proposals is a block without faults.
    #[test]
    fn snippets_can_be_read() {
        for word in words()
            .iter()
            .filter(|word| !word.snippet.is_empty() && word.part == Part::Function)
        {
            let text = filled(word.snippet);
            let faults = match word.languages {
                [true, _] => PlainLanguage.parse_block(&text).faults,
                _ => IsoLanguage.parse_block(&text).faults,
            };
            assert!(faults.is_empty(), "{text}: {faults:?}");
        }
    }

    /// `X${1:+0}` as `X+0`.
    fn filled(snippet: &str) -> String {
        let mut text = String::new();
        let mut rest = snippet;
        while let Some((before, open)) = rest.split_once("${") {
            text += before;
            let (place, after) = open.split_once('}').unwrap();
            text += place.split_once(':').unwrap().1;
            rest = after;
        }
        text + rest
    }
}
