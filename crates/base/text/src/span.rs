//! A place in a file.
//!
//! Decision: Columns count characters: they are what people count, and what is shown. The language server alone
//! converts them to the UTF-16 units of its protocol (also `lsp/src/text/lines.rs`)

/// A place in a file. Lines and columns count from 1. Columns and lengths count characters (Unicode scalar values), not
/// bytes and not UTF-16 units: who speaks to an editor converts them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The line; 0 is the file as a whole.
    pub line: u32,
    /// The first character of the line that is meant; 0 is the line as a whole.
    pub column: u32,
    /// How many characters are meant; 0 is none, as where something is missing.
    pub length: u32,
}

impl Span {
    /// The file as a whole.
    pub const FILE: Span = Span {
        line: 0,
        column: 0,
        length: 0,
    };

    /// Characters of a line; numbers beyond 32 bits are the largest.
    pub fn new(line: usize, column: usize, length: usize) -> Span {
        Span {
            line: small(line),
            column: small(column),
            length: small(length),
        }
    }

    /// A line as a whole.
    pub fn line(line: usize) -> Span {
        Span::new(line, 0, 0)
    }

    /// The word of a line that begins at a column, at least one character.
    pub fn word(line: usize, column: usize, text: &str) -> Span {
        let word = text.chars().skip(column.saturating_sub(1));
        let length = word.take_while(|c| !c.is_whitespace()).count();
        Span::new(line, column.max(1), length.max(1))
    }

    /// First character and number of characters; `None` for the line as a whole.
    pub fn columns(self) -> Option<(u32, u32)> {
        (self.column > 0).then_some((self.column, self.length))
    }
}

/// Numbers of a place have 32 bits.
pub(crate) fn small(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_ends_at_a_blank() {
        assert_eq!(Span::word(3, 5, "L X Höhe Y"), Span::new(3, 5, 4));
        assert_eq!(Span::word(3, 99, "L X"), Span::new(3, 99, 1), "what is missing");
        assert_eq!(Span::line(3).columns(), None);
    }
}
