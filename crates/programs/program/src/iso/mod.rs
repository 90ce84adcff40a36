//! HEIDENHAIN DIN/ISO: one block a line, words of a letter and a number, G functions that stay in force.
//!
//! A block becomes the same operations as one in plain language. What it leaves to the functions in force stays open
//! in its [`Modality`](crate::Modality), which whoever executes it fills in.

mod code;
mod cycle;
mod frame;
mod function;
mod read;
mod special;
mod words;
mod write;
mod write_cycle;

use std::io::Write;

use crate::format::FormatOptions;
use crate::language::{Landmark, Language, WordSpan};
use crate::lines::{BlockText, Lines, RawBlock};
use crate::parse::cursor::Cursor;
use crate::parse::{frames_begin, language_faults, prefix};
use crate::text::trim;
use crate::{Block, BlockError, Operation};

/// HEIDENHAIN DIN/ISO.
///
/// ```
/// use bahn_program::{Operation, Program};
///
/// let text = "%7 G71 *\nN10 T1 G17 S500 *\nN20 G00 G40 G90 X+10 Y+5 M3 *\nN99999 %7 G71 *\n";
/// let program = Program::from_bytes("7.I", text.into());
/// assert_eq!((program.block_count(), program.number_of(2)), (4, 20));
/// assert!(matches!(program.decode(0).blocks[2].operation, Operation::Motion(_)));
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct IsoLanguage;

impl Language for IsoLanguage {
    fn name(&self) -> &'static str {
        "HEIDENHAIN DIN/ISO"
    }

    fn refuses(&self, first_block: BlockText<'_>) -> Option<String> {
        frames_begin(first_block.bytes)
            .then(|| "this is a program in plain language: its file ends with .H".to_owned())
    }

    #[inline]
    fn next_block(&self, lines: &mut Lines<'_>) -> Option<RawBlock> {
        lines.next_with_text()
    }

    #[inline]
    fn landmark(&self, text: BlockText<'_>) -> Option<Landmark> {
        if !read::may_be_landmark(text.bytes) {
            return None;
        }
        let mut block = Block::EMPTY;
        read::read_block(text, true, &mut block);
        match block.operation {
            Operation::Label(label) => Some(Landmark::Label(label)),
            // Only the last block has a number before its name.
            Operation::Begin(header) if self.number(text).is_none_or(|number| number <= 1) => {
                Some(Landmark::Frame(header))
            }
            Operation::Begin(header) => Some(Landmark::End(header)),
            _ => None,
        }
    }

    #[inline]
    fn read(&self, text: BlockText<'_>, may_begin: bool, block: &mut Block) {
        read::read_block(text, may_begin, block);
    }

    fn faults(&self, text: BlockText<'_>, may_begin: bool) -> Vec<BlockError> {
        let (code, _) = code::split(text.bytes);
        language_faults(code, &self.words(text), |code| read::fault(code, may_begin))
    }

    fn words(&self, text: BlockText<'_>) -> Vec<WordSpan> {
        words::block_words(text.bytes)
    }

    fn stands_alone(&self, text: BlockText<'_>) -> bool {
        let (code, _) = code::split(text.bytes);
        let mut c = Cursor::new(code);
        prefix(&mut c);
        c.rest().is_empty()
    }

    fn write(&self, block: &Block, options: FormatOptions, text: &mut String) {
        write::write_block(block, options, text);
    }

    fn write_number(&self, text: BlockText<'_>, number: u32, step: u32, new: &mut Vec<u8>) {
        let mut c = Cursor::new(text.bytes);
        let skip = prefix(&mut c);
        let ends = matches!(self.landmark(text), Some(Landmark::End(_) | Landmark::Frame(_)));
        let number = match (number, step) {
            // The first block has none.
            (0, _) => None,
            (number, step) if ends => Some(write::last_number(number, step)),
            (_, 0) => None,
            (number, step) => Some(u64::from(number) * u64::from(step)),
        };
        // Writing to a vector cannot fail.
        if let Some(number) = number {
            let _ = write!(new, "N{number} ");
        }
        if skip {
            new.extend_from_slice(b"/ ");
        }
        new.extend_from_slice(trim(c.rest()));
    }

    fn write_line_number(&self, number: u32, block: &Block, options: FormatOptions, text: &mut String) {
        write::write_number(number, block, options, text);
    }

    fn number(&self, text: BlockText<'_>) -> Option<u32> {
        let text = trim(text.bytes);
        let text = text.strip_prefix(b"/").map_or(text, trim);
        let [b'N' | b'n', digits @ ..] = text else {
            return None;
        };
        let length = digits.iter().take_while(|b| b.is_ascii_digit()).count();
        let digits = std::str::from_utf8(digits.get(..length)?).ok()?;
        digits.parse().ok()
    }

    fn has_numbers(&self) -> bool {
        true
    }

    fn characters_max(&self, limits: &bahn_parameters::Limits) -> Option<u32> {
        Some(limits.iso_characters_max)
    }

    fn frames(&self) -> [&'static str; 2] {
        ["%NAME G71", "N99999 %NAME G71"]
    }
}
