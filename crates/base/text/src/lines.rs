//! Where the lines of a text begin.

use std::ops::Range;

use crate::span::Span;

/// The lines of a text, from 1. They end with LF, CR LF or CR.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineIndex {
    starts: Vec<usize>,
}

impl LineIndex {
    /// Finds the lines of a text.
    pub fn of(text: &str) -> LineIndex {
        LineIndex::up_to(text, usize::MAX)
    }

    /// Finds the first lines of a text; the last one of them is all that is left.
    pub fn up_to(text: &str, most: usize) -> LineIndex {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for at in memchr::memchr2_iter(b'\n', b'\r', bytes) {
            if starts.len() >= most {
                break;
            }
            if bytes.get(at..at + 2) != Some(b"\r\n") {
                starts.push(at + 1);
            }
        }
        LineIndex { starts }
    }

    /// How many there are; after the last line end none begins that is empty.
    pub fn count(&self, text: &str) -> usize {
        let last_is_empty = self.starts.last() == Some(&text.len());
        self.starts.len() - usize::from(last_is_empty)
    }

    /// The line that holds a byte.
    pub fn at(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset).max(1)
    }

    /// The bytes of a line with its end; of one after the last none, at the end of the text.
    pub fn whole(&self, text: &str, line: usize) -> Range<usize> {
        let start = |line: usize| line.checked_sub(1).and_then(|at| self.starts.get(at)).copied();
        start(line).unwrap_or(text.len())..start(line + 1).unwrap_or(text.len())
    }

    /// The bytes of a line without its end.
    pub fn range(&self, text: &str, line: usize) -> Range<usize> {
        let whole = self.whole(text, line);
        let own = text.get(whole.clone()).unwrap_or_default();
        whole.start..whole.start + own.trim_end_matches(['\r', '\n']).len()
    }

    /// A line without its end; empty where there is none.
    pub fn line<'t>(&self, text: &'t str, line: usize) -> &'t str {
        text.get(self.range(text, line)).unwrap_or_default()
    }

    /// The place of bytes; a byte inside a character counts as that character. Line ends within it count as characters.
    pub fn span(&self, text: &str, bytes: Range<usize>) -> Span {
        let start = boundary(text, bytes.start);
        let end = boundary(text, bytes.end).max(start);
        let line = self.at(start);
        let count = |range: Range<usize>| text.get(range).map_or(0, |part| part.chars().count());
        let before = count(self.whole(text, line).start..start);
        Span::new(line, before + 1, count(start..end))
    }

    /// The bytes of a place; of a whole line those without its end. A place beyond the text is its end.
    pub fn bytes(&self, text: &str, span: Span) -> Range<usize> {
        let Some((column, length)) = span.columns() else {
            return self.range(text, span.line as usize);
        };
        let start = self.whole(text, span.line as usize).start;
        let byte_of = |from: usize, count: u32| {
            let rest = text.get(from..).unwrap_or_default();
            let found = rest.char_indices().nth(count as usize);
            from + found.map_or(rest.len(), |(at, _)| at)
        };
        let first = byte_of(start, column - 1);
        first..byte_of(first, length)
    }
}

/// The begin of the character that holds a byte.
fn boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lines_end_as_any_system_ends_them() {
        let text = "; Höhe\r\nL X+5\rC\n\nM30\n";
        let lines = LineIndex::of(text);
        assert_eq!(lines.count(text), 5);
        let all: Vec<&str> = (1..=6).map(|line| lines.line(text, line)).collect();
        assert_eq!(all, ["; Höhe", "L X+5", "C", "", "M30", ""]);
        assert_eq!(lines.at(text.find('X').unwrap()), 2);
        assert_eq!((lines.at(0), lines.at(text.len())), (1, 6));
        assert_eq!(lines.range(text, 99), text.len()..text.len());
        assert_eq!(
            (LineIndex::of("").count(""), LineIndex::of("a").count("a")),
            (0, 1)
        );
        assert_eq!(LineIndex::up_to("a\nb\nc\n", 2).line("a\nb\nc\n", 2), "b\nc");
    }

    proptest! {
        /// The place of bytes leads back to them, also over line ends.
        #[test]
        fn places_lead_back(text in "[aä𝄞\r\n ]{0,40}", from in 0..60_usize, length in 0..20_usize) {
            let lines = LineIndex::of(&text);
            let bytes = boundary(&text, from)..boundary(&text, from + length);
            let span = lines.span(&text, bytes.clone());
            prop_assert_eq!(lines.bytes(&text, span), bytes);
            prop_assert!(span.line >= 1 && span.column >= 1);
        }
    }
}
