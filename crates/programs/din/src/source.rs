//! The text of a file by its lines, whatever the dialect.

use std::sync::Arc;

use bahn_text::{Encoding, LineIndex};

/// Most lines of a file.
pub(crate) const MAX_LINES: usize = 10_000_000;

/// A file whose bytes were read as text.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    name: Arc<str>,
    text: String,
    encoding: Encoding,
    lines: LineIndex,
}

impl Source {
    /// The text of bytes that are no UTF-8 has one character for each byte.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Source {
        let (text, encoding) = Encoding::read(bytes);
        Source {
            name: name.into(),
            lines: LineIndex::up_to(&text, MAX_LINES),
            text,
            encoding,
        }
    }

    pub fn name(&self) -> &Arc<str> {
        &self.name
    }

    pub fn line_count(&self) -> u32 {
        u32::try_from(self.lines.count(&self.text)).unwrap_or(u32::MAX)
    }

    /// A line without its ending, from 1; empty where there is none.
    pub fn line(&self, number: u32) -> &str {
        self.lines.line(&self.text, number as usize)
    }

    /// What stands after a line before the next one: its ending.
    pub fn ending(&self, number: u32) -> &str {
        let whole = self.lines.whole(&self.text, number as usize);
        let own = self.lines.range(&self.text, number as usize);
        self.text.get(own.end..whole.end).unwrap_or_default()
    }

    /// A text in the bytes that the file is written in.
    pub fn encoded(&self, text: &str) -> Vec<u8> {
        // What has no byte there is not written by the listing.
        self.encoding.write(text)
    }

    /// More lines than are read.
    pub fn is_too_long(&self) -> bool {
        self.line_count() as usize >= MAX_LINES
    }
}
