//! Programs that are still coming: their text is appended, and what was executed may be forgotten [003:1640-1690].

mod growth;

use std::ops::Range;

use crate::bulk::Bulk;
use crate::file_types::bulk_language_of;
use crate::language::Landmark;
use crate::lines::RawBlock;
use crate::plain::PlainLanguage;
use crate::rope::{PIECE_BLOCKS, Rope, pieces};
use crate::survey::Frame;
use crate::text::{line_end_of, text_start};
use crate::{Header, Program};

pub(crate) use growth::Growth;

/// Bytes that may come before BEGIN; with more the program has none *(inferred)*.
const LEADING_MAX: usize = 1 << 16;

impl Program {
    /// A program in plain language of which nothing has come yet. One that is named `.nc` or `.900` and turns out to
    /// be of DIN 66025 is [refused](Program::refused).
    ///
    /// ```
    /// use bahn_program::Program;
    ///
    /// let program = Program::growing("1.H").more(b"BEGIN PGM 1 MM\nL X+5\nL X+");
    /// assert_eq!(program.known(), 0..2); // nobody knows yet where X+ leads to
    /// let program = program.more(b"10\nEND PGM 1 MM\n");
    /// assert_eq!((program.known(), program.is_growing()), (0..4, false));
    /// assert_eq!(program.text_of(2), "L X+10");
    /// ```
    pub fn growing(name: impl Into<Box<str>>) -> Program {
        let rope = Rope::new(Vec::new(), 0, 1);
        let mut program = Program::of(name.into(), &PlainLanguage, rope, Frame::default(), "\n");
        program.growth = Some(Growth::default());
        program
    }

    /// Whether more of the program may come: its blocks after the known ones are not known yet. END PGM ends it.
    pub fn is_growing(&self) -> bool {
        self.growth.is_some()
    }

    /// The blocks that have come and are not forgotten. The last one is known when the one behind it begins.
    pub fn known(&self) -> Range<u32> {
        let first = match self.rope.first() {
            // The implied BEGIN.
            1 => 0,
            first => first,
        };
        first..self.block_count()
    }

    /// The program with more of its text; text after END PGM is no part of it.
    pub fn more(&self, bytes: &[u8]) -> Program {
        self.grown(bytes, false)
    }

    /// The program when nothing more comes.
    pub fn completed(&self) -> Program {
        self.grown(&[], true)
    }

    /// The program without the text of blocks before one, in pieces of some hundred. What refers to them finds
    /// nothing any more: only programs that do not jump back can be forgotten.
    pub fn forget(&self, before: u32) -> Program {
        let body = self.rope.body();
        let done = |index: &usize| self.rope.start(index + 1).0 <= before;
        let Some(last) = body.clone().take_while(done).last() else {
            return self.clone();
        };
        let (first, line) = self.rope.start(last + 1);
        let rest = self.rope.pieces().get(last + 1..).unwrap_or_default();
        let rope = Rope::new(rest.to_vec(), first, line);
        self.with_rope(rope, self.frame.clone(), self.growth.clone())
    }

    /// The first block after a block that sets a label, as far as it has come.
    pub fn label_after(&self, label: u16, block: u32) -> Option<u32> {
        let from = self.rope.of_block(block)?;
        let pieces = self.rope.pieces().iter().enumerate().skip(from);
        let set = pieces.flat_map(|(index, piece)| {
            let first = self.rope.start(index).0;
            piece.labels.iter().map(move |(label, at)| (*label, first + at))
        });
        set.filter(|(own, at)| *own == label && *at > block)
            .map(|(_, at)| at)
            .next()
    }

    /// Bytes of the text from a block on, with what is not known to be a block yet.
    pub fn bytes_from(&self, block: u32) -> u64 {
        let pending = self
            .growth
            .as_ref()
            .map_or(0, |growth| growth.pending.len() as u64);
        let Some((piece, raw)) = self.place(block) else {
            return match block < self.rope.first() {
                true => self.rope.bytes() + pending,
                false => pending,
            };
        };
        let at = self.rope.of_block(block).unwrap_or_default();
        let after = self.rope.pieces().get(at + 1..).unwrap_or_default();
        let after: usize = after.iter().map(|piece| piece.text().len()).sum();
        (piece.text().len().saturating_sub(raw.start) + after) as u64 + pending
    }

    fn grown(&self, bytes: &[u8], complete: bool) -> Program {
        let Some(growth) = &self.growth else {
            return self.clone();
        };
        let mut text = growth.pending.clone();
        text.extend_from_slice(bytes);
        if growth.began {
            return self.appended(text, complete);
        }
        if complete {
            // All of it is here.
            let language = self.language_by(&text);
            return Program::of_file(self.name.clone(), text, language);
        }
        let start = text_start(&text);
        let raws = self.language.cut(text.get(start..).unwrap_or_default(), 1);
        let settled = raws.get(..raws.len().saturating_sub(1)).unwrap_or_default();
        let begins = |raw: &RawBlock| {
            let block = raw.text(text.get(start..).unwrap_or_default());
            !self.language.stands_alone(block)
        };
        if settled.iter().any(begins) {
            let language = self.language_by(&text);
            if language.dialect().is_some() {
                return self.turned_out_din(language, text.split_off(start));
            }
        }
        let begin = settled.iter().find_map(|raw| {
            let block = raw.text(text.get(start..)?);
            match self.language.landmark(block) {
                Some(Landmark::Begin(header)) => Some((*raw, header)),
                _ => None,
            }
        });
        let mut frame = Frame::default();
        match begin {
            Some((raw, header)) => {
                frame.begin = Some(*header);
                frame.leading = raws
                    .first()
                    .map(|first| first.line)
                    .filter(|line| *line < raw.line);
                let began = self.with_rope(Rope::new(Vec::new(), 0, raw.line), frame, self.growth.clone());
                began.appended(text.split_off(start + raw.start), false)
            }
            None if text.len() < LEADING_MAX => {
                let growth = Growth {
                    pending: text,
                    began: false,
                };
                self.with_rope(self.rope.clone(), frame, Some(growth))
            }
            None => {
                let first = raws.first().copied();
                let block = first.map(|raw| raw.text(text.get(start..).unwrap_or_default()));
                frame.refused = block.and_then(|block| self.language.refuses(block));
                let began = self.with_rope(Rope::new(Vec::new(), 1, 1), frame, self.growth.clone());
                began.appended(text.split_off(start), false)
            }
        }
    }

    /// The program once its first block shows that it is none of plain language: whoever executes it learns why not.
    fn turned_out_din(&self, language: &'static dyn Bulk, text: Vec<u8>) -> Program {
        let first = RawBlock {
            start: 0,
            end: text.len(),
            line: 1,
            joined: false,
        };
        let frame = Frame {
            refused: language.refuses(first.text(&text)),
            ..Frame::default()
        };
        let rope = Rope::new(Vec::new(), 1, 1);
        let mut program = Program::of(self.name.clone(), language, rope, frame, self.line_end);
        program.growth.clone_from(&self.growth);
        program.appended(text, false)
    }

    /// DIN 66025 where name and text say so, else plain language.
    fn language_by(&self, text: &[u8]) -> &'static dyn Bulk {
        let language = bulk_language_of(&self.name, text);
        match language.dialect() {
            Some(_) => language,
            None => self.language,
        }
    }

    /// The program with text after its last known block.
    fn appended(&self, mut text: Vec<u8>, complete: bool) -> Program {
        blank_returns(&mut text);
        let body = self.rope.body();
        // The last piece is filled before another one is begun.
        let last = self
            .rope
            .pieces()
            .get(..body.end)
            .and_then(|pieces| pieces.last());
        let open = last.filter(|piece| piece.blocks < PIECE_BLOCKS);
        let from = body.end - usize::from(open.is_some());
        let mut region = open.map_or_else(Vec::new, |piece| piece.text().to_vec());
        region.append(&mut text);
        let raws = self.language.cut(&region, 1);
        let (_, end) = self.language.landmarks(&region, &raws);
        let end = end.map(|at| at as usize);
        // END ends the program as soon as its line does.
        let ends = |at: &usize| complete || raws.get(*at).is_some_and(|raw| raw.end < region.len());
        let (settled, ended) = match end.filter(ends) {
            Some(at) => (at + 1, true),
            None if complete => (raws.len(), true),
            None => (raws.len().saturating_sub(1), false),
        };
        let after = raws.get(settled);
        let end_line = after.map_or(u32::MAX, |raw| raw.line);
        let seam = after.map_or(region.len(), |raw| raw.start);
        let pending = region.split_off(seam);
        let raws = raws.get(..settled).unwrap_or_default();
        let (labels, _) = self.language.landmarks(&region, raws);
        let mut frame = self.frame.clone();
        frame.end = self.header_at(&region, raws, end.filter(|at| *at < settled));
        let growth = (!ended).then_some(Growth { pending, began: true });
        let line_end = line_end_of(&region);
        let rope = self
            .rope
            .splice(from..body.end, pieces(region, raws, &labels, end_line));
        let mut program = self.with_rope(rope, frame, growth);
        program.line_end = line_end;
        program
    }

    fn header_at(&self, text: &[u8], raws: &[crate::RawBlock], at: Option<usize>) -> Option<Header> {
        match self.language.landmark(raws.get(at?)?.text(text))? {
            Landmark::End(header) => Some(*header),
            _ => None,
        }
    }

    fn with_rope(&self, rope: Rope, frame: Frame, growth: Option<Growth>) -> Program {
        let mut program = Program::of(self.name.clone(), self.language, rope, frame, self.line_end);
        program.growth = growth;
        program
    }
}

/// Makes a blank of every CR that stands alone before other text, in text whose lines end with LF or CR LF.
fn blank_returns(text: &mut [u8]) {
    if line_end_of(text) == "\r" {
        return;
    }
    for at in 0..text.len() {
        if let Some([byte @ b'\r', next]) = text.get_mut(at..at + 2)
            && *next != b'\n'
        {
            *byte = b' ';
        }
    }
}
