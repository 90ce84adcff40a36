//! A place in a line that is read.

use crate::line::{Glyph, LineFault, fault_at};

/// Reads a line from left to right.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    line: &'a [Glyph],
    at: usize,
    /// Operators that were read.
    operators: u32,
}

/// Most operators of a block, so that what it calculates is never nested deep.
const MAX_OPERATORS: u32 = 500;

impl<'a> Cursor<'a> {
    pub fn new(line: &'a [Glyph]) -> Cursor<'a> {
        Cursor {
            line,
            at: 0,
            operators: 0,
        }
    }

    /// The next character, in capitals.
    pub fn peek(&self) -> Option<char> {
        self.peek_at(0)
    }

    /// The one that many after it.
    pub fn peek_at(&self, ahead: usize) -> Option<char> {
        self.line
            .get(self.at + ahead)
            .map(|glyph| glyph.character.to_ascii_uppercase())
    }

    /// The rest of the line.
    pub fn rest(&self) -> &'a [Glyph] {
        self.line.get(self.at..).unwrap_or_default()
    }

    pub fn advance(&mut self, by: usize) {
        self.at = (self.at + by).min(self.line.len());
    }

    pub fn skip_blanks(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.at += 1;
        }
    }

    /// Takes a character if it is the next one after blanks.
    pub fn eat(&mut self, character: char) -> bool {
        self.skip_blanks();
        let there = self.peek() == Some(character);
        if there {
            self.at += 1;
        }
        there
    }

    /// Takes an operator if it is the next character after blanks.
    pub fn eat_operator(&mut self, character: char) -> Result<bool, LineFault> {
        let there = self.eat(character);
        self.operators += u32::from(there);
        if self.operators > MAX_OPERATORS {
            let message = format!("more than {MAX_OPERATORS} operators in a block");
            return Err(self.fault(self.at.saturating_sub(1), message));
        }
        Ok(there)
    }

    pub fn is_done(&mut self) -> bool {
        self.skip_blanks();
        self.at >= self.line.len()
    }

    /// Where it stands, to begin a fault there.
    pub fn mark(&self) -> usize {
        self.at
    }

    /// Stands where it stood before, or where a part of the line ends.
    pub fn go_to(&mut self, mark: usize) {
        self.at = mark;
    }

    /// Characters as long as they please, in capitals.
    pub fn take_while(&mut self, pleases: impl Fn(char) -> bool) -> String {
        let mut taken = String::new();
        while let Some(character) = self.peek().filter(|c| pleases(*c)) {
            taken.push(character);
            self.at += 1;
        }
        taken
    }

    /// The letters that stand next, which stay.
    pub fn letters(&self) -> String {
        self.clone().take_while(|c| c.is_ascii_alphabetic())
    }

    /// Column and length of what was read since a mark.
    pub fn span(&self, mark: usize) -> (u32, u32) {
        let column = |index: usize| self.line.get(index).map(|glyph| glyph.column);
        let after = self.line.last().map_or(1, |glyph| glyph.column.saturating_add(1));
        let first = column(mark).unwrap_or(after);
        // Blanks after a word are none of it.
        let read = self.line.get(mark..self.at).unwrap_or_default();
        let last = read.iter().rfind(|glyph| !glyph.character.is_whitespace());
        let length = last.map_or(1, |last| last.column.saturating_sub(first).saturating_add(1));
        (first, length)
    }

    /// A fault of what was read since a mark.
    pub fn fault(&self, mark: usize, message: impl Into<String>) -> LineFault {
        let (column, length) = self.span(mark);
        fault_at(column, length, message.into())
    }

    /// A fault of a word that is not known: takes what looks like it, so that it is named whole.
    pub fn unknown(&mut self, mark: usize, what: &str) -> LineFault {
        self.go_to(mark);
        self.word();
        self.fault(mark, format!("unknown {what} {}", self.text(mark)))
    }

    /// A word as somebody would name it: `T12`, `#HSC`, `V.P.NAME`, `[LABEL]`; at least one character.
    pub fn word(&mut self) -> String {
        let mut name = self.take_while(|c| matches!(c, '$' | '#' | '@' | '%'));
        if name.is_empty() && self.peek() == Some('[') {
            name += &self.take_while(|c| c != ']');
            name.extend(self.peek());
            self.advance(1);
            return name;
        }
        name += &self.take_while(|c| c.is_alphabetic() || c == '_');
        name += &self.take_while(|c| c.is_ascii_digit() || c == '.');
        if name.contains(['.', '_']) {
            name += &self.take_while(|c| c.is_alphanumeric() || matches!(c, '_' | '.'));
        }
        if name.is_empty() {
            name.extend(self.peek());
            self.advance(1);
        }
        name
    }

    /// What was read since a mark, as it is written.
    pub fn text(&self, mark: usize) -> String {
        let glyphs = self.line.get(mark..self.at).unwrap_or_default();
        glyphs.iter().map(|glyph| glyph.character).collect()
    }
}
