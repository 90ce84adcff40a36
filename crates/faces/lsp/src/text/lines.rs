//! Where the lines of a text begin, as editors count them.

use std::ops::Range;

use bahn_text::Span;
use lsp_types::Position;

/// The lines of a text, from 0; places in them are UTF-16 units, as the protocol counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LineIndex(bahn_text::LineIndex);

impl LineIndex {
    pub(crate) fn of(text: &str) -> LineIndex {
        LineIndex(bahn_text::LineIndex::of(text))
    }

    /// The line that holds a byte.
    pub(crate) fn line_of(&self, offset: usize) -> usize {
        self.0.at(offset) - 1
    }

    /// The bytes of a line without its end; of one after the last the end of the text.
    pub(crate) fn range(&self, text: &str, line: usize) -> Range<usize> {
        self.0.range(text, line + 1)
    }

    /// Bytes as faults have them: lines from 1, characters.
    pub(crate) fn span(&self, text: &str, bytes: Range<usize>) -> Span {
        self.0.span(text, bytes)
    }

    /// The bytes of such a place.
    pub(crate) fn bytes(&self, text: &str, span: Span) -> Range<usize> {
        self.0.bytes(text, span)
    }

    /// The place of a byte; of one inside a character that of the character.
    pub(crate) fn position(&self, text: &str, offset: usize) -> Position {
        let mut offset = offset.min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line_of(offset);
        let start = self.range(text, line).start;
        let before = text.get(start..offset).unwrap_or_default();
        Position {
            line: small(line),
            character: small(before.encode_utf16().count()),
        }
    }

    /// The byte of a place; beyond the end of a line that end, beyond the last line the end of the text, inside a
    /// pair of units the character that they make.
    pub(crate) fn offset(&self, text: &str, position: Position) -> usize {
        let line = self.range(text, position.line as usize);
        let mut units = 0;
        let wanted = position.character as usize;
        let line_text = text.get(line.clone()).unwrap_or_default();
        for (at, character) in line_text.char_indices() {
            if units + character.len_utf16() > wanted {
                return line.start + at;
            }
            units += character.len_utf16();
        }
        line.end
    }
}

/// What the protocol counts has 32 bits.
fn small(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn umlauts_and_pairs_count_as_editors_count_them() {
        let text = "; Höhe 𝄞 x\r\nL X+5\rC\n";
        let lines = LineIndex::of(text);
        let x = text.find('x').unwrap();
        let at = Position::new(0, 10);
        assert_eq!(lines.position(text, x), at, "two units for the clef");
        assert_eq!(lines.offset(text, at), x);
        assert_eq!(
            lines.offset(text, Position::new(0, 8)),
            text.find('𝄞').unwrap(),
            "inside the pair"
        );
        assert_eq!(lines.offset(text, Position::new(0, 99)), text.find('\r').unwrap());
        assert_eq!(lines.position(text, text.find('C').unwrap()), Position::new(2, 0));
        assert_eq!(lines.offset(text, Position::new(9, 9)), text.len());
        assert_eq!(lines.line_of(text.len()), 3);
    }

    proptest! {
        /// Every character has one place, and that place leads back to it.
        #[test]
        fn places_lead_back(text in "[aä𝄞\r\n ]{0,40}") {
            let lines = LineIndex::of(&text);
            for (at, character) in text.char_indices() {
                let position = lines.position(&text, at);
                // No place lies inside CR LF.
                let inside = character == '\n' && text.get(..at).is_some_and(|before| before.ends_with('\r'));
                prop_assert!(inside || lines.offset(&text, position) == at, "{at} of {text:?}");
            }
        }
    }
}
