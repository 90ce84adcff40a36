//! Lines of a text, and the places of blocks in it.
//!
//! Decision: A comment goes on after one `~`, unless the next line has a block number or frames the program; several
//! `~` are a rule

use crate::text::{is_blank, to_text, trim};

/// Where the text of a block lies in the text that is being cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawBlock {
    /// First byte of its first line.
    pub start: usize,
    /// After the last byte of its last line, without the line end.
    pub end: usize,
    /// Number of its first line, counted on from that of [`Lines::new`].
    pub line: u32,
    /// Whether it has several lines.
    pub joined: bool,
}

impl RawBlock {
    /// Its bytes, out of the text that was cut.
    #[inline]
    pub fn text(self, text: &[u8]) -> BlockText<'_> {
        BlockText {
            bytes: text.get(self.start..self.end).unwrap_or_default(),
            joined: self.joined,
        }
    }
}

/// The text of one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockText<'a> {
    /// Its bytes, without the last line end.
    pub bytes: &'a [u8],
    /// Whether it has several lines.
    pub joined: bool,
}

/// A text that is read line by line.
///
/// Lines end with LF, CR LF or CR; between two blocks a form feed does it too [001:267].
#[derive(Clone, Copy, Debug)]
pub struct Lines<'a> {
    text: &'a [u8],
    next: usize,
    number: u32,
}

impl<'a> Lines<'a> {
    /// Lines of a text; its first one has the given number.
    pub fn new(text: &'a [u8], number: u32) -> Lines<'a> {
        Lines {
            text,
            next: 0,
            number,
        }
    }

    /// Number of the next line.
    #[inline]
    pub fn number(&self) -> u32 {
        self.number
    }

    /// The next line with text, as a block.
    #[inline]
    pub fn next_with_text(&mut self) -> Option<RawBlock> {
        loop {
            let line = self.number();
            let (start, end) = self.line()?;
            if self.bytes(start, end).iter().all(|&byte| is_blank(byte)) {
                continue;
            }
            return Some(RawBlock {
                start,
                end,
                line,
                joined: false,
            });
        }
    }

    /// Bytes of a range of the text.
    #[inline]
    pub fn bytes(&self, start: usize, end: usize) -> &'a [u8] {
        self.text.get(start..end).unwrap_or_default()
    }

    /// First byte of the next line and the byte after its last, without the line end; the line is read.
    #[inline]
    pub fn line(&mut self) -> Option<(usize, usize)> {
        let start = self.next;
        let rest = self.text.get(start..).filter(|rest| !rest.is_empty())?;
        let (length, terminator) = line_end(rest);
        self.next = start + length + terminator;
        self.number = self.number.saturating_add(u32::from(terminator > 0));
        Some((start, start + length))
    }
}

/// Length of the line at the front of a text, and of its line end, which is 0 at the end of the text.
#[inline]
fn line_end(text: &[u8]) -> (usize, usize) {
    let mut from = 0;
    loop {
        let rest = text.get(from..).unwrap_or_default();
        let Some(length) = memchr::memchr3(b'\n', b'\r', b'\x0c', rest) else {
            return (text.len(), 0);
        };
        let end = from + length;
        match rest.get(length..).unwrap_or_default() {
            [b'\r', b'\n', ..] => return (end, 2),
            // Beside another line end a form feed is a blank.
            [b'\x0c', b'\r' | b'\n' | b'\x0c', ..] | [b'\x0c'] => from = end + 1,
            [b'\x0c', ..] if end == 0 => from = 1,
            _ => return (end, 1),
        }
    }
}

/// The lines of a text, without their line ends.
pub(crate) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut lines = Lines::new(text, 0);
    std::iter::from_fn(move || lines.line().map(|(start, end)| lines.bytes(start, end)))
}

/// The line `offset` lines after the front of a text, without its line end.
pub(crate) fn line_at(text: &[u8], offset: u32) -> String {
    let line = lines(text).nth(usize::try_from(offset).unwrap_or(usize::MAX));
    to_text(line.unwrap_or_default())
}

/// Whether a line is a comment or structuring only.
pub(crate) fn stands_alone(line: &[u8]) -> bool {
    let mut rest = trim(line);
    if let [b'N' | b'n', after @ ..] = rest
        && after.first().is_some_and(u8::is_ascii_digit)
    {
        rest = after;
    }
    let first = rest
        .iter()
        .find(|&&b| !is_blank(b) && b != b'/' && !b.is_ascii_digit());
    matches!(first, Some(b';' | b'*'))
}
