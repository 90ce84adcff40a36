//! The listing: words in capitals with one blank between them; everything else as it stands.

use crate::block::{self, Block, Word, WordKind};
use crate::line::{self, Glyph, Macros};
use crate::program::Program;
use crate::rewriting::{emptied, in_order, is_parted, is_plain, of_word, rewritten, tight};

impl Program {
    /// The text with each block written anew: addresses in capitals, words one blank apart, none within them, none at the
    /// ends of a line. It is the same program, and its own listing.
    ///
    /// Comments stay to the byte, and so do heads, the order of words, numbers, macros and every line that uses one, what
    /// cannot be read, and what has a comment within a word. Each line keeps its ending.
    ///
    /// ```
    /// use bahn_din::Program;
    ///
    /// let program = Program::from_bytes("part.nc", b"n10g01 x - 25f2000   m7 = 3 ; Start\nT5 x1\n");
    /// assert_eq!(program.listing(), "N10 G01 X-25 F2000 M7=3 ; Start\nT5 x1\n");
    /// ```
    pub fn listing(&self) -> String {
        rewritten(self.source(), |number, text| self.listed(number, text))
    }

    /// A line anew; `None` where it stays as it stands.
    fn listed(&self, number: u32, text: &str) -> Option<String> {
        if self.is_commented(number) {
            return None;
        }
        if text.trim_ascii().is_empty() {
            return emptied(self.source(), number);
        }
        // Whatever a macro stands for, it may join what stands beside it.
        if text.contains('"') {
            return None;
        }
        let old = Read::of(text, self.glyphs(number)?)?;
        let new = old.written()?;
        let again = Read::of(&new, line::glyphs(&new))?;
        old.says_as_much_as(&again).then_some(new)
    }
}

/// A line that could be read.
struct Read {
    glyphs: Vec<Glyph>,
    /// The number with its column.
    number: Option<(u32, String)>,
    block: Block,
    /// Comments with their columns.
    comments: Vec<(u32, String)>,
}

impl Read {
    fn of(text: &str, glyphs: Vec<Glyph>) -> Option<Read> {
        let block = block::read(&glyphs, &Macros::default()).ok()?;
        let (name, rest) = block::number(&glyphs);
        let digits = glyphs.get(..glyphs.len() - rest.len()).unwrap_or_default();
        let first = digits.iter().find(|glyph| !glyph.character.is_whitespace());
        let number = name
            .and(first)
            .map(|first| (first.column, tight(digits.iter(), false)));
        let characters: Vec<char> = text.chars().collect();
        Some(Read {
            comments: line::said(&characters, &line::comments(&characters)),
            number,
            block,
            glyphs,
        })
    }

    /// The line anew; `None` with a comment within a word, or with characters beyond ASCII between its words.
    fn written(&self) -> Option<String> {
        if !is_plain(&self.glyphs) {
            return None;
        }
        let mut parts: Vec<(u32, String)> = self.comments.clone();
        // After a comment it is not the name of its block, and stays there.
        parts.extend(self.number.clone());
        for word in &self.block.words {
            if is_parted((word.column, word.length), &self.comments) {
                return None;
            }
            parts.push((word.column, self.word(word)));
        }
        Some(in_order(parts))
    }

    fn word(&self, word: &Word) -> String {
        let own = of_word(&self.glyphs, word.column, word.length);
        match &word.kind {
            WordKind::AxisBracket(_, words) | WordKind::SpindleBracket(_, words) => {
                let name = tight(own.take_while(|glyph| glyph.character != '['), false);
                let words: Vec<String> = words.iter().map(|word| self.word(word)).collect();
                format!("{name}[{}]", words.join(" "))
            }
            WordKind::Call { local, name } => format!("{} {name}", if *local { "LL" } else { "L" }),
            WordKind::Command(_) => tight(own, true),
            WordKind::SetVariable(..) => {
                let text = tight(own, false);
                match text.split_once('=') {
                    Some((variable, value)) => format!("{variable} = {value}"),
                    None => text,
                }
            }
            _ => tight(own, false),
        }
    }

    fn says_as_much_as(&self, other: &Read) -> bool {
        let texts = |read: &Read| -> Vec<String> {
            let texts = read.comments.iter().map(|(_, text)| text.clone());
            texts.collect()
        };
        let number = |read: &Read| read.number.as_ref().map(|(_, text)| text.clone());
        self.block == other.block && number(self) == number(other) && texts(self) == texts(other)
    }
}
