//! What is wrong in a line.

use bahn_text::{Diagnostic, Span, nearest};

/// What is wrong in a part of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault<'a> {
    /// The part: a slice of the line.
    part: &'a str,
    /// What is wrong with it, in words.
    message: String,
    /// What to do about it.
    help: Option<String>,
}

impl<'a> Fault<'a> {
    /// A fault of a part, which is a slice of the line.
    pub fn new(part: &'a str, message: impl Into<String>) -> Fault<'a> {
        Fault {
            part,
            message: message.into(),
            help: None,
        }
    }

    /// What is wrong, in words.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// With the known word that was probably meant, if one is near.
    pub fn meant<'k>(self, word: &str, known: impl IntoIterator<Item = &'k str>) -> Fault<'a> {
        let help = nearest(word, known).map(|known| format!("did you mean `{known}`?"));
        Fault { help, ..self }
    }

    /// At its place in the line of this number, from 1.
    pub(crate) fn in_line(self, number: usize, line: &str) -> Diagnostic {
        Diagnostic::error(span(number, line, self.part), self.message).with_help(self.help)
    }
}

/// The place of a part, which is a slice of the line.
pub(crate) fn span(number: usize, line: &str, part: &str) -> Span {
    let at = (part.as_ptr() as usize).saturating_sub(line.as_ptr() as usize);
    let before = line.get(..at).unwrap_or_default();
    Span::new(number, before.chars().count() + 1, part.chars().count().max(1))
}
