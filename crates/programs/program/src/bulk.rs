//! Loops over many blocks, compiled once for each language, so that no block costs a call through a table.

use std::sync::Arc;

use crate::Block;
use crate::language::{Landmark, Language};
use crate::lines::{Lines, RawBlock};
use crate::rope::Rope;
use crate::survey::{Frame, survey};

/// What a language can do with many blocks.
pub(crate) trait Bulk: Language {
    /// The places of all blocks of a text whose first line has the given number.
    fn cut(&self, text: &[u8], line: u32) -> Vec<RawBlock>;

    /// Appends `count` blocks of a text after the first `skip`.
    fn read_all(&self, text: &[u8], skip: usize, count: usize, may_begin: bool, blocks: &mut Vec<Block>);

    /// A text with other numbers before its blocks, from `first` on.
    fn renumber(&self, text: &[u8], first: u32, step: u32) -> Vec<u8>;

    /// Cuts a file into pieces.
    fn survey(&self, file: &Arc<Vec<u8>>, start: usize) -> (Rope, Frame);

    /// The labels but 0 that blocks of a text set, each with the number of its block in the list, and the END
    /// block if one of them is.
    fn landmarks(&self, text: &[u8], blocks: &[RawBlock]) -> (Vec<(u16, u32)>, Option<u32>);
}

impl<L: Language> Bulk for L {
    fn cut(&self, text: &[u8], line: u32) -> Vec<RawBlock> {
        raw_blocks(self, text, line).collect()
    }

    fn read_all(&self, text: &[u8], skip: usize, count: usize, may_begin: bool, blocks: &mut Vec<Block>) {
        let mut may_begin = may_begin && skip == 0;
        for raw in raw_blocks(self, text, 1).skip(skip).take(count) {
            blocks.push(Block::EMPTY);
            if let Some(block) = blocks.last_mut() {
                self.read(raw.text(text), may_begin, block);
            }
            may_begin = false;
        }
    }

    fn renumber(&self, text: &[u8], first: u32, step: u32) -> Vec<u8> {
        let mut new = Vec::with_capacity(text.len() + text.len() / 4);
        let mut copied = 0;
        for (number, raw) in (first..).zip(raw_blocks(self, text, 1)) {
            new.extend_from_slice(text.get(copied..raw.start).unwrap_or_default());
            self.write_number(raw.text(text), number, step, &mut new);
            copied = raw.end;
        }
        new.extend_from_slice(text.get(copied..).unwrap_or_default());
        new
    }

    fn survey(&self, file: &Arc<Vec<u8>>, start: usize) -> (Rope, Frame) {
        survey(self, file, start)
    }

    fn landmarks(&self, text: &[u8], blocks: &[RawBlock]) -> (Vec<(u16, u32)>, Option<u32>) {
        let mut labels = Vec::new();
        let mut end = None;
        for (number, raw) in (0..).zip(blocks) {
            match self.landmark(raw.text(text)) {
                Some(Landmark::Label(label)) if label > 0 => labels.push((label, number)),
                Some(Landmark::End(_)) if end.is_none() => end = Some(number),
                _ => {}
            }
        }
        (labels, end)
    }
}

/// The blocks of a text.
pub(crate) fn raw_blocks<'a, L: Language + ?Sized>(
    language: &'a L,
    text: &'a [u8],
    line: u32,
) -> impl Iterator<Item = RawBlock> + use<'a, L> {
    let mut lines = Lines::new(text, line);
    std::iter::from_fn(move || language.next_block(&mut lines))
}
