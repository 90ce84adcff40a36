//! The listing: words in capitals with one blank between them; everything else as it stands.

use super::block::{self, Reading, WordKind};
use super::line::{comments, glyphs, is_blank};
use super::program::Program;
use crate::line::{self, Glyph};
use crate::rewriting::{emptied, in_order, is_parted, is_plain, of_word, rewritten, tight};

impl Program {
    /// The text with each block written anew: addresses in capitals, words one blank apart, none within them, none at the
    /// ends of a line. It is the same program, and its own listing.
    ///
    /// Comments stay to the byte, and so do lines that hold nothing else, numbers, the order of words, what cannot be read, and what has a comment within
    /// a word. Each line keeps its ending.
    ///
    /// ```
    /// use bahn_din::system900::Program;
    ///
    /// let program = Program::from_bytes("P1000.900", b"n10g1 x : 25f2000   m7 { Start }\n");
    /// assert_eq!(program.listing(), "N10 G1 X:25 F2000 M7 { Start }\n");
    /// ```
    pub fn listing(&self) -> String {
        rewritten(self.source(), |number, text| {
            if text.trim_ascii().is_empty() {
                return emptied(self.source(), number);
            }
            let old = Read::of(text).filter(|read| !is_blank(&read.glyphs))?;
            let new = old.written()?;
            old.says_as_much_as(&Read::of(&new)?).then_some(new)
        })
    }
}

/// A line that could be read.
struct Read {
    glyphs: Vec<Glyph>,
    reading: Reading,
    /// Comments with their columns.
    comments: Vec<(u32, String)>,
}

impl Read {
    fn of(text: &str) -> Option<Read> {
        let characters: Vec<char> = text.chars().collect();
        let glyphs = glyphs(text);
        let reading = block::read(1, &glyphs);
        reading.faults.is_empty().then(|| Read {
            comments: line::said(&characters, &comments(&characters)),
            reading,
            glyphs,
        })
    }

    /// The line anew; `None` with a comment within a word, or with characters beyond ASCII between its words.
    fn written(&self) -> Option<String> {
        if !is_plain(&self.glyphs) {
            return None;
        }
        let mut parts = self.comments.clone();
        let words = self
            .reading
            .block
            .words
            .iter()
            .map(|word| (word.span.column, word.span.length));
        for (column, length) in self.head().into_iter().chain(words) {
            if is_parted((column, length), &self.comments) {
                return None;
            }
            parts.push((column, tight(of_word(&self.glyphs, column, length), false)));
        }
        Some(in_order(parts))
    }

    /// The `/` and the number of the block: column and length of each.
    fn head(&self) -> Vec<(u32, u32)> {
        let first = self.reading.block.words.first().map(|word| word.span.column);
        let before = |glyph: &&Glyph| first.is_none_or(|first| glyph.column < first);
        let head = self.glyphs.iter().take_while(before);
        let mut head = head.filter(|glyph| !glyph.character.is_whitespace()).peekable();
        let mut found = Vec::new();
        if let Some(skip) = head.next_if(|glyph| glyph.character == '/') {
            found.push((skip.column, 1));
        }
        if let (Some(first), Some(last)) = (head.next(), head.last()) {
            found.push((first.column, last.column - first.column + 1));
        }
        found
    }

    fn says_as_much_as(&self, other: &Read) -> bool {
        let texts = |read: &Read| -> Vec<String> {
            let texts = read.comments.iter().map(|(_, text)| text.clone());
            texts.collect()
        };
        let says = |read: &Read| -> (bool, Option<u32>, Vec<WordKind>) {
            let block = &read.reading.block;
            let words = block.words.iter().map(|word| word.kind.clone());
            (block.may_be_skipped, block.number, words.collect())
        };
        says(self) == says(other) && texts(self) == texts(other)
    }
}
