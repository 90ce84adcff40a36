//! One version of the text of a document, and the next one that an edit makes of it.

use std::ops::Range;
use std::sync::Arc;

use bahn_text::Span;
use lsp_types::{Position, TextDocumentContentChangeEvent};

use super::LineIndex;

/// A text with its lines.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub(crate) text: Arc<str>,
    pub(crate) lines: LineIndex,
}

/// A part of the text that is replaced, as a client sends it.
pub(crate) type Change = TextDocumentContentChangeEvent;

impl Text {
    pub(crate) fn new(text: &str) -> Text {
        Text {
            lines: LineIndex::of(text),
            text: text.into(),
        }
    }

    /// The text after changes, one after the other. A range that lies wrong is taken as far as there is text.
    pub(crate) fn changed(&self, changes: &[Change]) -> Text {
        let mut text = self.text.to_string();
        let mut lines = None;
        for change in changes {
            match change.range {
                None => text.clone_from(&change.text),
                Some(range) => {
                    let lines = lines.get_or_insert_with(|| LineIndex::of(&text));
                    let start = lines.offset(&text, range.start);
                    let end = lines.offset(&text, range.end).max(start);
                    text.replace_range(start..end, &change.text);
                }
            }
            lines = None;
        }
        Text::new(&text)
    }

    pub(crate) fn position(&self, offset: usize) -> Position {
        self.lines.position(&self.text, offset)
    }

    pub(crate) fn offset(&self, position: Position) -> usize {
        self.lines.offset(&self.text, position)
    }

    pub(crate) fn range(&self, range: &Range<usize>) -> lsp_types::Range {
        lsp_types::Range::new(self.position(range.start), self.position(range.end))
    }

    /// Bytes as faults have their places.
    pub(crate) fn span(&self, range: &Range<usize>) -> Span {
        self.lines.span(&self.text, range.clone())
    }

    /// The place of a fault as the protocol has it.
    pub(crate) fn range_of(&self, span: Span) -> lsp_types::Range {
        self.range(&self.lines.bytes(&self.text, span))
    }

    /// A part of it; nothing where there is no such part.
    pub(crate) fn get(&self, range: Range<usize>) -> &str {
        self.text.get(range).unwrap_or_default()
    }

    /// The bytes of the line that holds a byte, without its end.
    pub(crate) fn line_at(&self, offset: usize) -> Range<usize> {
        self.lines.range(&self.text, self.lines.line_of(offset))
    }

    /// The bytes of a line in which so many characters stand from a column on; both count from 1, the column from the
    /// beginning of the line at a byte.
    pub(crate) fn characters(&self, line: Range<usize>, column: usize, length: usize) -> Range<usize> {
        let text = self.get(line.clone());
        let byte_of = |count: usize| {
            let found = text.char_indices().nth(count);
            line.start + found.map_or(text.len(), |(at, _)| at)
        };
        let first = column.saturating_sub(1);
        let range = byte_of(first)..byte_of(first.saturating_add(length));
        match range.is_empty() && !text.is_empty() {
            // After the last character stands what is missing: the last one shows it.
            true => byte_of(text.chars().count().saturating_sub(1))..line.end,
            false => range,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What a client does: it holds its text as UTF-16 and replaces units.
    fn replaced(text: &str, start: usize, end: usize, new: &str) -> (String, lsp_types::Range) {
        let units: Vec<char> = text.chars().collect();
        let (start, end) = (start.min(units.len()), end.min(units.len()));
        let (start, end) = (start.min(end), start.max(end));
        let place = |count: usize| {
            let before: String = units[..count].iter().collect();
            let line = before.matches('\n').count();
            let last = before.rsplit('\n').next().unwrap();
            Position::new(line as u32, last.encode_utf16().count() as u32)
        };
        let range = lsp_types::Range::new(place(start), place(end));
        let text = units[..start]
            .iter()
            .chain(new.chars().collect::<Vec<_>>().iter())
            .chain(&units[end..])
            .collect();
        (text, range)
    }

    proptest! {
        /// Whatever is edited, server and client have the same text.
        #[test]
        fn edits_keep_the_texts_equal(
            first in "[aä𝄞\n 1]{0,60}",
            edits in prop::collection::vec((0usize..80, 0usize..80, "[bö𝄞\n]{0,9}"), 1..12),
            at_once in 1usize..4,
        ) {
            let mut client = first.clone();
            let mut server = Text::new(&first);
            for some in edits.chunks(at_once) {
                let mut changes = Vec::new();
                for (start, end, new) in some {
                    let (text, range) = replaced(&client, *start, *end, new);
                    client = text;
                    changes.push(Change { range: Some(range), range_length: None, text: new.clone() });
                }
                server = server.changed(&changes);
                prop_assert_eq!(&*server.text, client.as_str());
                prop_assert_eq!(&server.lines, &LineIndex::of(&client));
            }
        }

        /// Ranges that lie anywhere change something or nothing, and break nothing.
        #[test]
        fn wrong_ranges_do_no_harm(text in "[aä𝄞\r\n]{0,20}", a: [u32; 4], new in "[xü]{0,3}") {
            let range = lsp_types::Range::new(Position::new(a[0] % 9, a[1] % 9), Position::new(a[2], a[3]));
            let change = Change { range: Some(range), range_length: None, text: new };
            let text = Text::new(&text).changed(&[change]);
            prop_assert_eq!(&text.lines, &LineIndex::of(&text.text));
        }
    }
}
