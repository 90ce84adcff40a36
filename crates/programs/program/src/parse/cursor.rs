//! Reading position in the text of a block.

use std::borrow::Cow;

use bahn_parameters::MessageId;

use crate::text::{is_blank, to_words};

/// A fault at a range of bytes of the text being read.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub(crate) message: MessageId,
    pub(crate) start: usize,
    pub(crate) end: usize,
    pub(crate) detail: Cow<'static, str>,
    /// What to do about it, where that of the message would mislead.
    pub(crate) help: Option<&'static str>,
}

/// What to do where something stands in place of a number.
pub(crate) const WRITE_A_NUMBER: &str = "Write a number or a Q parameter; the letter O is no zero.";

/// What a parsing function gives. The fault is boxed to keep the good case small.
pub(crate) type Parsed<T> = Result<T, Box<Fault>>;

/// Reading position in the text of a block, which begins after block number and `/`.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Cursor<'a> {
        Cursor { bytes, position: 0 }
    }

    pub(crate) fn position(&self) -> usize {
        self.position
    }

    pub(crate) fn go_to(&mut self, position: usize) {
        self.position = position;
    }

    /// What is not read yet.
    #[inline]
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }

    /// The next byte; a blank at the end.
    #[inline]
    pub(crate) fn peek(&self) -> u8 {
        self.peek_at(0)
    }

    /// The byte `offset` after the next one; a blank at the end.
    #[inline]
    pub(crate) fn peek_at(&self, offset: usize) -> u8 {
        self.bytes.get(self.position + offset).copied().unwrap_or(b' ')
    }

    /// Whether a digit stands directly before the position.
    pub(crate) fn touches_digit(&self) -> bool {
        let before = self
            .position
            .checked_sub(1)
            .and_then(|before| self.bytes.get(before));
        before.is_some_and(u8::is_ascii_digit)
    }

    /// Whether there is a byte `offset` after the next one.
    #[inline]
    pub(crate) fn remains(&self, offset: usize) -> bool {
        self.position + offset < self.bytes.len()
    }

    /// The next byte as a capital.
    #[inline]
    pub(crate) fn peek_upper(&self) -> u8 {
        self.peek().to_ascii_uppercase()
    }

    /// Goes on by so many bytes, at most to the end.
    #[inline]
    pub(crate) fn advance(&mut self, count: usize) {
        self.position = (self.position + count).min(self.bytes.len());
    }

    #[inline]
    pub(crate) fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.position)
            && is_blank(byte)
        {
            self.position += 1;
        }
    }

    /// Skips blanks; whether nothing of the code is left: the rest is empty, a comment, or annotation
    /// printed after three or more dots, which is never code (spec of the plain language, rule 8).
    #[inline]
    pub(crate) fn at_end(&mut self) -> bool {
        self.skip_blanks();
        match self.bytes.get(self.position) {
            None | Some(b';') => true,
            Some(b'.') => self.at_annotation(),
            Some(_) => false,
        }
    }

    /// Whether three dots follow.
    #[inline]
    pub(crate) fn at_annotation(&self) -> bool {
        self.peek() == b'.' && self.rest().starts_with(b"...")
    }

    /// Skips blanks, then reads the byte if it is the expected one.
    #[inline]
    pub(crate) fn accept(&mut self, expected: u8) -> bool {
        self.skip_blanks();
        let found = self.peek_upper() == expected;
        if found {
            self.position += 1;
        }
        found
    }

    /// Skips blanks, then reads a keyword in any case; without it nothing is read. What follows may touch
    /// it: `LBL2`, `DEF9`.
    #[inline]
    pub(crate) fn keyword(&mut self, keyword: &str) -> bool {
        let start = self.position;
        self.skip_blanks();
        let found = self
            .rest()
            .get(..keyword.len())
            .is_some_and(|b| b.eq_ignore_ascii_case(keyword.as_bytes()));
        self.position = if found {
            self.position + keyword.len()
        } else {
            start
        };
        found
    }

    /// Reads a keyword that no letter may follow.
    pub(crate) fn word(&mut self, word: &str) -> bool {
        let start = self.position;
        let found = self.keyword(word) && !self.peek().is_ascii_alphabetic();
        if !found {
            self.position = start;
        }
        found
    }

    /// Where the word at the position ends: before a blank, `;` or annotation.
    pub(crate) fn word_end(&self) -> usize {
        let rest = self.rest();
        let length = rest
            .iter()
            .enumerate()
            .position(|(i, &b)| {
                is_blank(b) || b == b';' || rest.get(i..).is_some_and(|r| r.starts_with(b"..."))
            })
            .unwrap_or(rest.len());
        self.position + length
    }

    /// The rest of the code, up to comment or annotation, which is read.
    pub(crate) fn code(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = code_length(rest);
        self.position += length;
        rest.get(..length).unwrap_or_default()
    }

    /// The rest of the code as text, with single spaces between its words.
    pub(crate) fn name(&mut self) -> Box<str> {
        to_words(self.code())
    }

    /// A fault from a byte to the reading position.
    #[cold]
    pub(crate) fn fault_from<T>(
        &self,
        start: usize,
        message: MessageId,
        detail: impl Into<Cow<'static, str>>,
    ) -> Parsed<T> {
        Err(Box::new(Fault {
            message,
            start,
            end: self.position,
            detail: detail.into(),
            help: None,
        }))
    }

    /// A fault of the word that begins at the reading position, after blanks.
    #[cold]
    pub(crate) fn fault_at_word<T>(
        &mut self,
        message: MessageId,
        detail: impl Into<Cow<'static, str>>,
    ) -> Parsed<T> {
        self.skip_blanks();
        let end = self.word_end();
        Err(Box::new(Fault {
            message,
            start: self.position,
            end,
            detail: detail.into(),
            help: None,
        }))
    }

    /// The fault of a word that has no place in the block.
    #[cold]
    pub(crate) fn unexpected<T>(&mut self) -> Parsed<T> {
        self.fault_at_word(MessageId::UnexpectedText, "this word has no place in the block")
    }

    /// The fault of a word that only later controls know.
    #[cold]
    pub(crate) fn not_known<T>(&mut self) -> Parsed<T> {
        self.fault_at_word(MessageId::BlockNotKnown, "no control here knows this word")
    }

    /// The fault of a number that should stand here, in the word that begins at `start`.
    #[cold]
    pub(crate) fn number_missing<T>(&mut self, start: usize, what: &'static str) -> Parsed<T> {
        if start >= self.position {
            return with_help(
                self.fault_at_word(MessageId::EntryValueIncorrect, what),
                WRITE_A_NUMBER,
            );
        }
        let end = self.word_end();
        Err(Box::new(Fault {
            message: MessageId::EntryValueIncorrect,
            start,
            end,
            detail: what.into(),
            help: Some(WRITE_A_NUMBER),
        }))
    }
}

/// A fault with what to do about it.
#[cold]
pub(crate) fn with_help<T>(parsed: Parsed<T>, help: &'static str) -> Parsed<T> {
    parsed.map_err(|mut fault| {
        fault.help = Some(help);
        fault
    })
}

/// Length of the code at the front of a line: up to `;` or three dots.
pub(crate) fn code_length(line: &[u8]) -> usize {
    memchr::memchr2_iter(b';', b'.', line)
        .find(|&i| {
            line.get(i..)
                .is_some_and(|rest| rest.starts_with(b";") || rest.starts_with(b"..."))
        })
        .unwrap_or(line.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_ends_at_comment_and_annotation() {
        let code = |line: &'static str| &line[..code_length(line.as_bytes())];
        assert_eq!(code("STOP M6 ; change"), "STOP M6 ");
        assert_eq!(code("TOOL DEF 5......Tool definition"), "TOOL DEF 5");
        assert_eq!(code("CALL PGM ..\\A.H"), "CALL PGM ..\\A.H");
    }

    #[test]
    fn keywords_may_touch_what_follows() {
        let mut c = Cursor::new(b" lbl2");
        assert!(!c.word("LBLX") && !c.keyword("LX"));
        assert!(c.keyword("LBL"));
        assert_eq!(c.peek(), b'2');
    }
}
