//! The words of a rule.

use std::str::FromStr;

use crate::fault::{Fault, span};
use bahn_text::Span;

/// The words of a line, one after the other. A word holds no blank, and neither `#` nor `;`, with which a comment begins.
#[derive(Clone, Debug)]
pub struct Words<'a> {
    line: &'a str,
    number: usize,
    rest: &'a str,
}

impl<'a> Words<'a> {
    /// Those of a part of a line.
    pub fn of(part: &'a str) -> Words<'a> {
        Words::new(0, part)
    }

    /// Those of a line of this number, from 1.
    pub(crate) fn new(number: usize, line: &'a str) -> Words<'a> {
        Words {
            line,
            number,
            rest: line,
        }
    }

    /// The next word that must be there; `what` is missing otherwise.
    ///
    /// # Errors
    /// At the end of the line.
    pub fn some(&mut self, what: &str) -> Result<&'a str, Fault<'a>> {
        let end = self.line.trim_end();
        let end = end.get(end.len()..).unwrap_or_default();
        self.next()
            .ok_or_else(|| Fault::new(end, format!("{what} is missing")))
    }

    /// One of these words must follow.
    ///
    /// # Errors
    /// When another one does, or none.
    pub fn one_of(&mut self, known: &[&'static str]) -> Result<&'static str, Fault<'a>> {
        let quoted: Vec<String> = known.iter().map(|word| format!("`{word}`")).collect();
        let list = match quoted.as_slice() {
            [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
            all => all.join(", "),
        };
        let word = self.some(&list)?;
        let found = known.iter().find(|known| **known == word);
        found.copied().ok_or_else(|| {
            Fault::new(word, format!("`{word}` stands where {list} is expected"))
                .meant(word, known.iter().copied())
        })
    }

    /// A number that is finite and not negative; `what` says which.
    ///
    /// # Errors
    /// When it is none.
    pub fn number(&mut self, what: &str) -> Result<f64, Fault<'a>> {
        let word = self.some(what)?;
        number(word).ok_or_else(|| Fault::new(word, format!("`{word}` is not {what}")))
    }

    /// Nothing must follow.
    ///
    /// # Errors
    /// When something does.
    pub fn end(&mut self) -> Result<(), Fault<'a>> {
        match self.next() {
            Some(more) => Err(Fault::new(more, format!("`{more}` is too much"))),
            None => Ok(()),
        }
    }

    /// Where a word of this line stands.
    pub fn span(&self, word: &str) -> Span {
        span(self.number, self.line, word)
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let rest = self.rest.trim_start();
        let end = rest.find(|c: char| c.is_whitespace() || matches!(c, '#' | ';'));
        let (word, rest) = rest.split_at(end.unwrap_or(rest.len()));
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }
}

/// A number that is finite and not negative.
fn number(text: &str) -> Option<f64> {
    let number = f64::from_str(text).ok();
    number.filter(|number| number.is_finite() && *number >= 0.0)
}
