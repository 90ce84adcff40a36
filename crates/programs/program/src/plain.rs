//! HEIDENHAIN plain language.

use crate::format::number::push_integer;
use crate::format::{FormatOptions, write_block};
use crate::language::{Landmark, Language, WordSpan};
use crate::lines::{BlockText, Lines, RawBlock, stands_alone};
use crate::parse::cursor::code_length;
use crate::parse::{block_words, faults, frames_or_labels, is_din_iso, read_block, renumber, whole_program};
use crate::text::{is_blank, trim, trim_continuation};
use crate::{Block, BlockError, Operation};

/// HEIDENHAIN plain language: one block a line, or several lines that `~` joins.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlainLanguage;

impl Language for PlainLanguage {
    fn name(&self) -> &'static str {
        "HEIDENHAIN plain language"
    }

    fn refuses(&self, first_block: BlockText<'_>) -> Option<String> {
        is_din_iso(first_block.bytes).then(whole_program)
    }

    #[inline]
    fn next_block(&self, lines: &mut Lines<'_>) -> Option<RawBlock> {
        loop {
            let line = lines.number();
            let (start, mut end) = lines.line()?;
            let bytes = lines.bytes(start, end);
            let Some(last) = bytes.iter().rposition(|&b| !is_blank(b)) else {
                continue;
            };
            let mut joined = false;
            let comment = bytes.get(last) == Some(&b'~') && stands_alone(bytes);
            if comment {
                while continues(lines.bytes(start, end))
                    && let Some(next_end) = text_line(lines)
                {
                    joined = true;
                    end = next_end;
                }
            } else if bytes.get(last) == Some(&b'~') {
                // At the end of the text there is nothing to join.
                end = start + trim_continuation(bytes).len();
                let mut before = bytes;
                while goes_on(before, lines)
                    && let Some((next_start, next_end)) = lines.line()
                {
                    joined = true;
                    end = next_end;
                    before = lines.bytes(next_start, next_end);
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

    #[inline]
    fn landmark(&self, text: BlockText<'_>) -> Option<Landmark> {
        if !text.joined && !frames_or_labels(text.bytes) {
            return None;
        }
        let mut block = Block::EMPTY;
        read_block(text, true, &mut block);
        match block.operation {
            Operation::Label(label) => Some(Landmark::Label(label)),
            Operation::Begin(header) => Some(Landmark::Begin(header)),
            Operation::End(header) => Some(Landmark::End(header)),
            _ => None,
        }
    }

    #[inline]
    fn read(&self, text: BlockText<'_>, may_begin: bool, block: &mut Block) {
        read_block(text, may_begin, block);
    }

    fn faults(&self, text: BlockText<'_>, may_begin: bool) -> Vec<BlockError> {
        faults(text, may_begin)
    }

    fn words(&self, text: BlockText<'_>) -> Vec<WordSpan> {
        block_words(text)
    }

    fn stands_alone(&self, text: BlockText<'_>) -> bool {
        stands_alone(text.bytes)
    }

    fn write(&self, block: &Block, options: FormatOptions, text: &mut String) {
        write_block(block, options, text);
    }

    fn write_number(&self, text: BlockText<'_>, number: u32, _step: u32, new: &mut Vec<u8>) {
        renumber(text.bytes, number, new);
    }

    fn write_line_number(&self, number: u32, _: &Block, _: FormatOptions, text: &mut String) {
        push_integer(text, u64::from(number), 1);
        text.push(' ');
    }

    fn frames(&self) -> [&'static str; 2] {
        ["BEGIN PGM", "END PGM"]
    }
}

/// Reads the next line if a comment may go on in it: it has neither a block number nor the look of a block that
/// frames the program. Where it ends.
#[cold]
fn text_line(lines: &mut Lines<'_>) -> Option<usize> {
    let before = *lines;
    let (start, end) = lines.line()?;
    let text = trim(lines.bytes(start, end));
    let own_comment = matches!(text, [b';' | b'*', ..]);
    if text.is_empty() || own_comment || is_numbered(text) || frames(text) {
        *lines = before;
        return None;
    }
    Some(end)
}

/// Whether a line of a block is joined with the next one: it ends with `~`. After a comment that may be part of the comment,
/// as in [`continues`]; a line with a block number is then a block of its own.
#[inline]
fn goes_on(line: &[u8], lines: &Lines<'_>) -> bool {
    if line.iter().rfind(|&&b| !is_blank(b)) != Some(&b'~') {
        return false;
    }
    code_length(line) == line.len() || continues(line) && !next_is_numbered(*lines)
}

/// Whether the next line begins with a block number, or frames the program.
#[cold]
fn next_is_numbered(mut lines: Lines<'_>) -> bool {
    let Some((start, end)) = lines.line() else {
        return false;
    };
    let text = trim(lines.bytes(start, end));
    is_numbered(text) || frames(text)
}

fn is_numbered(text: &[u8]) -> bool {
    matches!(text, [b'0'..=b'9' | b'/', ..] | [b'N' | b'n', b'0'..=b'9', ..])
}

fn frames(text: &[u8]) -> bool {
    let starts = |word: &str| {
        text.get(..word.len())
            .is_some_and(|front| front.eq_ignore_ascii_case(word.as_bytes()))
    };
    starts("BEGIN") || starts("END")
}

/// Whether a comment goes on in the next line: one `~` ends it; a rule of several joins nothing.
fn continues(comment: &[u8]) -> bool {
    matches!(trim(comment), [.., before, b'~'] if *before != b'~')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(file: &[u8]) -> Vec<(&[u8], u32, bool)> {
        let mut lines = Lines::new(file, 1);
        std::iter::from_fn(|| PlainLanguage.next_block(&mut lines))
            .map(|raw| (raw.text(file).bytes, raw.line, raw.joined))
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
            blocks(b"12 L X+1 ; a ~\n13 L Y+1"),
            [(&b"12 L X+1 ; a"[..], 1, false), (b"13 L Y+1", 2, false)]
        );
        assert_eq!(blocks(b"L X+1 ; a ~~\nL Y+1").len(), 2);
        assert_eq!(blocks(b"12 L X+1 ; a ~\n Y+1 ; b ~\n13 L Y+1").len(), 2);
        assert_eq!(
            blocks(b"12 CYCL DEF 200 ~\n Q200=2 ; A ~\n ; b ~\n Q201=3").len(),
            1
        );
        assert_eq!(
            blocks(b"12 ; ~~~\nB"),
            [(&b"12 ; ~~~"[..], 1, false), (b"B", 2, false)]
        );
    }
}
