//! From citations to chapters: `[000:3174-3176]` is for those who have the text at hand, everybody else is
//! told the manual and the chapter.
//!
//! Decision: Printed sources are chapters, by a table of line ranges; comments keep lines

use std::sync::OnceLock;

/// Which lines of which manual make which chapter.
const CHAPTERS: &str = include_str!("../data/chapters.tsv");

/// The manuals by the number that citations give them.
const MANUALS: [(&str, &str); 5] = [
    ("000", "Technical manual TNC 407/415/425"),
    ("001", "Interface manual TNC 151/155"),
    ("002", "Parameter manual System 900"),
    ("003", "User's manual TNC 360"),
    ("004", "Functional description TF5200 M/H functions"),
];

/// One row of the table.
struct Chapter {
    manual: &'static str,
    first: u32,
    last: u32,
    number: &'static str,
    title: &'static str,
}

/// The chapters that a source names, each once and in the order of the source; `bahn` prints these instead
/// of lines. What cites nothing is handed back as it is.
///
/// ```
/// use bahn_parameters::chapters;
/// assert_eq!(
///     chapters("[003:7868-7871] [000:10095]"),
///     [
///         "User's manual TNC 360, chapter 12.6 TNC Error Messages",
///         "Technical manual TNC 407/415/425, chapter 5 Machine parameters, 3.1 Measuring systems and machines",
///     ]
/// );
/// assert_eq!(chapters("(own message of Bahn)"), ["(own message of Bahn)"]);
/// ```
pub fn chapters(source: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for (manual, line) in citations(source) {
        let chapter = chapter(manual, line);
        if !chapter.is_empty() && !found.contains(&chapter) {
            found.push(chapter);
        }
    }
    if found.is_empty() && !source.is_empty() {
        found.push(source.to_owned());
    }
    found
}

/// A text in whose brackets manual and chapter stand instead of lines.
///
/// ```
/// use bahn_parameters::with_chapters;
/// assert_eq!(
///     with_chapters("the path stops [001:2550-2562]"),
///     "the path stops (Interface manual TNC 151/155, chapter 8.5 Setting software limit switch ranges)"
/// );
/// ```
pub fn with_chapters(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, bracket)) = rest.split_once('[') {
        let inside = bracket.split_once(']');
        let Some((inside, after)) = inside.filter(|(inside, _)| citations(inside).next().is_some()) else {
            result.push_str(before);
            result.push('[');
            rest = bracket;
            continue;
        };
        result.push_str(before);
        result.push_str(&format!("({})", chapters(inside).join("; ")));
        rest = after;
    }
    result + rest
}

/// The citations in a text: number of the manual and first line.
fn citations(text: &str) -> impl Iterator<Item = (&str, u32)> {
    let words = text.split(|c: char| !(c.is_ascii_digit() || c == ':' || c == '-'));
    words.filter_map(|word| {
        let (manual, lines) = word.split_once(':')?;
        let is_manual = MANUALS.iter().any(|(number, _)| *number == manual);
        let first = lines.split('-').next()?.parse().ok()?;
        is_manual.then_some((manual, first))
    })
}

/// Manual and chapter of a line; the manual alone where the table ends.
fn chapter(manual: &str, line: u32) -> String {
    let name = MANUALS.iter().find(|(number, _)| *number == manual);
    let name = name.map_or("", |(_, name)| *name);
    let rows = rows();
    let at = rows.partition_point(|row| (row.manual, row.first) <= (manual, line));
    let row = at.checked_sub(1).and_then(|at| rows.get(at));
    match row.filter(|row| row.manual == manual && line <= row.last) {
        Some(row) => format!("{name}, chapter {} {}", row.number, row.title),
        None => name.to_owned(),
    }
}

fn rows() -> &'static [Chapter] {
    static ROWS: OnceLock<Vec<Chapter>> = OnceLock::new();
    ROWS.get_or_init(|| CHAPTERS.lines().skip(1).filter_map(row).collect())
}

/// Reads one row; a test proves that every row can be read.
fn row(line: &'static str) -> Option<Chapter> {
    let mut columns = line.split('\t');
    Some(Chapter {
        manual: columns.next()?,
        first: columns.next()?.parse().ok()?,
        last: columns.next()?.parse().ok()?,
        number: columns.next()?,
        title: columns.next()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ControlModel, Definition, MessageId};

    #[test]
    fn every_row_is_read_and_rows_touch() {
        assert_eq!(rows().len(), CHAPTERS.lines().count() - 1);
        for pair in rows().windows(2) {
            assert!(pair[0].first <= pair[0].last, "{}", pair[0].title);
            if pair[0].manual == pair[1].manual {
                assert_eq!(pair[0].last + 1, pair[1].first, "{}", pair[1].title);
            }
        }
    }

    /// Headings as the manuals print them [000:4930][003:4930][001:929].
    #[test]
    fn lines_are_found_in_their_chapters() {
        assert_eq!(
            chapters("000:4930"),
            [
                "Technical manual TNC 407/415/425, chapter 4 Machine integration, 3.2 Servo positioning in TNC controls"
            ]
        );
        assert_eq!(
            chapters("[003:4930-4960]"),
            ["User's manual TNC 360, chapter 8.2 Simple Fixed Cycles"]
        );
        assert_eq!(
            chapters("[001:929-932]"),
            ["Interface manual TNC 151/155, chapter 3.5 Emergency Stop"]
        );
        assert_eq!(chapters("000:999999"), ["Technical manual TNC 407/415/425"]);
        assert_eq!(chapters(""), [""; 0]);
        assert_eq!(with_chapters("B100[X] and 1:2 [open"), "B100[X] and 1:2 [open");
    }

    #[test]
    fn every_source_of_a_parameter_or_message_has_a_chapter() {
        let sources = ControlModel::FAMILIES.into_iter().flat_map(|model| {
            let parameters = Definition::all(model).iter().map(|row| row.source);
            parameters.chain(MessageId::ALL.iter().map(|id| id.source()))
        });
        for source in sources.filter(|source| !source.starts_with("(own")) {
            for chapter in chapters(source) {
                assert!(chapter.contains(", chapter "), "{source}: {chapter}");
            }
        }
    }
}
