//! Texts of open documents: bytes here, lines and UTF-16 units there.

mod document;
mod lines;
mod words;

#[cfg(test)]
pub(crate) use document::Change;
pub(crate) use document::Text;
pub(crate) use lines::LineIndex;
pub(crate) use words::word_at;
