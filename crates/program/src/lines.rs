//! Cuts a file into the raw text of its blocks: one line each, or several that `~` joins.

use std::ops::Range;

use crate::text::{is_blank, to_text, trim, trim_continuation};

/// Where the text of a block lies in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RawBlock {
    /// First byte of its first line.
    pub(crate) start: usize,
    /// Behind the last byte of its last line, without the line end.
    pub(crate) end: usize,
    /// Number of its first line in the file, from 1.
    pub(crate) line: u32,
    /// Whether `~` joins several lines.
    pub(crate) joined: bool,
}

impl RawBlock {
    /// The block's bytes.
    #[inline]
    pub(crate) fn bytes(self, file: &[u8]) -> &[u8] {
        file.get(self.start..self.end).unwrap_or_default()
    }
}

/// Iterator over the blocks of a file. Lines without text are no blocks.
///
/// Lines end with LF, CR LF or CR; between two blocks a form feed does it too [001:267].
#[derive(Clone, Debug)]
pub(crate) struct RawBlocks<'a> {
    file: &'a [u8],
    next: usize,
    line: u32,
}

impl<'a> RawBlocks<'a> {
    /// Blocks from a byte that begins the line of the given number.
    pub(crate) fn from(file: &'a [u8], start: usize, line: u32) -> RawBlocks<'a> {
        RawBlocks {
            file,
            next: start,
            line,
        }
    }

    /// The extent of the next line, which is consumed, if it may go on with a comment: it has neither a block
    /// number nor the look of a block that frames the program.
    #[cold]
    fn text_line(&mut self) -> Option<(usize, usize)> {
        let before = (self.next, self.line);
        let found = self.line().filter(|&(start, end)| {
            let line = self.file.get(start..end).unwrap_or_default();
            let text = trim(line);
            let starts = |word: &str| {
                text.get(..word.len())
                    .is_some_and(|front| front.eq_ignore_ascii_case(word.as_bytes()))
            };
            let numbered = matches!(
                text,
                [b'0'..=b'9' | b'/' | b';' | b'*', ..] | [b'N' | b'n', b'0'..=b'9', ..]
            );
            !text.is_empty() && !numbered && !starts("BEGIN") && !starts("END")
        });
        if found.is_none() {
            (self.next, self.line) = before;
        }
        found
    }

    /// The extent of the next line, which is consumed.
    #[inline]
    fn line(&mut self) -> Option<(usize, usize)> {
        let start = self.next;
        let rest = self.file.get(start..).filter(|rest| !rest.is_empty())?;
        let (length, terminator) = line_end(rest);
        self.next = start + length + terminator;
        self.line = self.line.saturating_add(u32::from(terminator > 0));
        Some((start, start + length))
    }
}

impl Iterator for RawBlocks<'_> {
    type Item = RawBlock;

    #[inline]
    fn next(&mut self) -> Option<RawBlock> {
        loop {
            let line = self.line;
            let (start, mut end) = self.line()?;
            let bytes = self.file.get(start..end).unwrap_or_default();
            let Some(last) = bytes.iter().rposition(|&b| !is_blank(b)) else {
                continue;
            };
            let mut joined = false;
            let comment = bytes.get(last) == Some(&b'~') && stands_alone(bytes);
            if comment {
                while continues(self.file.get(start..end).unwrap_or_default())
                    && let Some((_, next_end)) = self.text_line()
                {
                    joined = true;
                    end = next_end;
                }
            } else if bytes.get(last) == Some(&b'~') {
                // At the end of the file there is nothing to join.
                end = start + trim_continuation(bytes).len();
                while let Some((next_start, next_end)) = self.line() {
                    joined = true;
                    end = next_end;
                    let next = self.file.get(next_start..next_end).unwrap_or_default();
                    if next.iter().rfind(|&&b| !is_blank(b)) != Some(&b'~') {
                        break;
                    }
                }
            }
            return Some(RawBlock {
                start,
                end,
                line,
                joined,
            });
        }
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

/// The lines that begin in a range of the file, without their line ends.
pub(crate) fn lines(file: &[u8], range: Range<usize>) -> impl Iterator<Item = &[u8]> {
    let mut lines = RawBlocks::from(file, range.start, 0);
    std::iter::from_fn(move || {
        let (start, end) = lines.line()?;
        if start < range.end {
            file.get(start..end)
        } else {
            None
        }
    })
}

/// The line `offset` lines behind the front of a text, without its line end.
pub(crate) fn line_at(text: &[u8], offset: u32) -> String {
    let line = lines(text, 0..text.len()).nth(usize::try_from(offset).unwrap_or(usize::MAX));
    to_text(line.unwrap_or_default())
}

/// Whether a line is a comment or structuring only.
pub(crate) fn stands_alone(line: &[u8]) -> bool {
    let mut rest = trim(line);
    if let [b'N' | b'n', behind @ ..] = rest
        && behind.first().is_some_and(u8::is_ascii_digit)
    {
        rest = behind;
    }
    let first = rest
        .iter()
        .find(|&&b| !is_blank(b) && b != b'/' && !b.is_ascii_digit());
    matches!(first, Some(b';' | b'*'))
}

/// Whether a comment goes on in the next line: one `~` ends it; a rule of several joins nothing.
fn continues(comment: &[u8]) -> bool {
    matches!(trim(comment), [.., before, b'~'] if *before != b'~')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(file: &[u8]) -> Vec<(&[u8], u32, bool)> {
        RawBlocks::from(file, 0, 1)
            .map(|raw| (raw.bytes(file), raw.line, raw.joined))
            .collect()
    }

    #[test]
    fn every_line_end_counts_once() {
        assert_eq!(blocks(b"A\nB"), [(&b"A"[..], 1, false), (b"B", 2, false)]);
        assert_eq!(blocks(b"A\r\nB\r\n"), [(&b"A"[..], 1, false), (b"B", 2, false)]);
        assert_eq!(blocks(b"A\rB\r"), [(&b"A"[..], 1, false), (b"B", 2, false)]);
        assert_eq!(blocks(b"A\n\x0cB"), [(&b"A"[..], 1, false), (b"\x0cB", 2, false)]);
        assert_eq!(
            blocks(b"A\x0cB\nC"),
            [(&b"A"[..], 1, false), (b"B", 2, false), (b"C", 3, false)]
        );
        assert_eq!(
            blocks(b"A\n\x0c\nB\x0c"),
            [(&b"A"[..], 1, false), (b"B\x0c", 3, false)]
        );
    }

    #[test]
    fn blank_lines_are_no_blocks() {
        assert_eq!(blocks(b"\n \t\r\n\nA\n\n\0\0\x1a"), [(&b"A"[..], 4, false)]);
    }

    #[test]
    fn tildes_join_lines() {
        assert_eq!(
            blocks(b"A ~\n B ~ \n C\nD"),
            [(&b"A ~\n B ~ \n C"[..], 1, true), (b"D", 4, false)]
        );
        assert_eq!(blocks(b"A ~"), [(&b"A"[..], 1, false)]);
        assert_eq!(
            blocks(b"12 ; a ~\n  b ~\n c\n13 L"),
            [(&b"12 ; a ~\n  b ~\n c"[..], 1, true), (b"13 L", 4, false)]
        );
        for own in ["13 L X+1", "N13 L X+1", "; b", "BEGIN PGM 1 MM", "END PGM 1 MM"] {
            let text = format!("12 ; a ~\n{own}");
            assert_eq!(blocks(text.as_bytes()).len(), 2, "{own}");
        }
        assert_eq!(
            blocks(b"12 ; ~~~\nB"),
            [(&b"12 ; ~~~"[..], 1, false), (b"B", 2, false)]
        );
    }
}
