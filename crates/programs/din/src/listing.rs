//! The listing: words in capitals with one blank between them; everything else as it stands.

use crate::block::{self, Block, Word, WordKind};
use crate::line::{self, Comment, Glyph, Macros};
use crate::program::Program;

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
        let mut listing = String::new();
        for number in 1..=self.line_count() {
            match self.listed(number) {
                Some(text) => listing.push_str(&text),
                None => listing.push_str(self.line(number)),
            }
            listing.push_str(self.ending(number));
        }
        listing
    }

    /// A line anew; `None` where it stays as it stands.
    fn listed(&self, number: u32) -> Option<String> {
        let text = self.line(number);
        if self.is_commented(number) {
            return None;
        }
        if text.trim_ascii().is_empty() {
            // Without blanks the last line may be none, and endings around one be a single one.
            let (before, own) = (self.ending(number.saturating_sub(1)), self.ending(number));
            let stays = own.is_empty() || before == "\r" && own == "\n";
            return (!stays).then(String::new);
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
        let said = |comment: Comment| {
            let text = characters.get(comment.start..comment.end)?.iter().collect();
            Some((u32::try_from(comment.start).ok()? + 1, text))
        };
        let comments = line::comments(&characters).into_iter().filter_map(said);
        Some(Read {
            comments: comments.collect(),
            number,
            block,
            glyphs,
        })
    }

    /// The line anew; `None` with a comment within a word, or with characters beyond ASCII between its words.
    fn written(&self) -> Option<String> {
        // Whatever blanks they are in their code page, without them the bytes of the file may be another one.
        if !self.glyphs.iter().all(|glyph| glyph.character.is_ascii()) {
            return None;
        }
        let mut parts: Vec<(u32, String)> = self.comments.clone();
        // After a comment it is not the name of its block, and stays there.
        parts.extend(self.number.clone());
        for word in &self.block.words {
            let span = word.column..word.column.checked_add(word.length)?;
            if self.comments.iter().any(|(column, _)| span.contains(column)) {
                return None;
            }
            parts.push((word.column, self.word(word)));
        }
        parts.sort_by_key(|(column, _)| *column);
        let parts: Vec<String> = parts.into_iter().map(|(_, text)| text).collect();
        Some(parts.join(" "))
    }

    fn word(&self, word: &Word) -> String {
        let own = self
            .glyphs
            .iter()
            .skip_while(|glyph| glyph.column < word.column)
            .take_while(|glyph| glyph.column - word.column < word.length);
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

/// Characters of a word in capitals. Of the blanks one stays where letters or digits would join that are no address and
/// its number, and in a command before its brackets.
fn tight<'a>(glyphs: impl Iterator<Item = &'a Glyph>, is_command: bool) -> String {
    let mut text = String::new();
    let mut is_blank = false;
    for glyph in glyphs {
        if glyph.character.is_whitespace() {
            is_blank = true;
            continue;
        }
        let before = text.chars().next_back();
        let joins = |before: char| {
            let is_word = before.is_ascii_alphanumeric() || matches!(before, '_' | '.' | ']' | '\'');
            let is_value = before.is_ascii_alphabetic() && glyph.character.is_ascii_digit();
            let opens = is_command && glyph.character == '[';
            opens || is_word && glyph.character.is_ascii_alphanumeric() && !is_value
        };
        if is_blank && before.is_some_and(joins) {
            text.push(' ');
        }
        is_blank = false;
        text.push(glyph.character.to_ascii_uppercase());
    }
    text
}
