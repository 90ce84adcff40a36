//! Editing: a new version of a program, which shares with the old one all text but that around the edit.
//!
//! Decision: An edit changes the text of a program only around its place; blocks around it stay what they are, but
//! for the `~` of a comment that would join the new text. BEGIN and END are the control's

use std::ops::Range;
use std::sync::Arc;

use bahn_parameters::MessageId;
use bahn_text::{MARK, MARK_BYTES};

use crate::language::{Landmark, WordKind};
use crate::lines::{RawBlock, lines};
use crate::rope::{Rope, pieces};
use crate::text::{is_blank, trim};
use crate::{Block, FormatOptions, Operation, Program};

/// A change of a program. Numbers are those of the normalised listing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edit<'a> {
    /// Puts blocks before a block.
    Insert {
        /// The block that then follows them; the number of the END block puts them at the end.
        before: u32,
        /// Text of one block or more.
        text: &'a str,
    },
    /// Puts other text in the place of a block.
    Replace {
        /// Number of the block whose text goes.
        block: u32,
        /// Text of one block or more.
        text: &'a str,
    },
    /// Takes blocks out, one or more.
    Delete {
        /// Their numbers; BEGIN and END are refused.
        blocks: Range<u32>,
    },
    /// Writes the number of the normalised listing before every block.
    Renumber {
        /// What the numbers grow by in languages whose blocks have numbers of their own: MP7220, 0 for none
        /// [000:6885].
        step: u32,
    },
    /// Protects the program against erasing and editing: a `P` after its first and its last block [003:1019].
    Protect,
    /// Takes the protection away. The control asks for code number 86357 before [003:7028].
    Unprotect,
}

/// Why an edit is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditError {
    /// The program is protected.
    Protected,
    /// BEGIN and END blocks are the control's: they are neither written nor taken out; without them a program
    /// cannot be protected.
    Frame,
    /// There is no such block.
    NoBlock,
    /// The program is still being transferred.
    Growing,
    /// The text holds no block.
    Empty,
    /// The program would be larger than [`Program::MAX_BYTES`].
    TooLarge,
}

impl EditError {
    /// What the control shows.
    pub fn message(self) -> MessageId {
        match self {
            EditError::Protected => MessageId::ProtectedPgm,
            EditError::TooLarge => MessageId::FurtherProgramEntryImpossible,
            EditError::Frame | EditError::NoBlock | EditError::Growing | EditError::Empty => {
                MessageId::EntryValueIncorrect
            }
        }
    }
}

impl Program {
    /// The program after an edit. This version stays as it is; whoever runs it keeps it. The time an edit takes
    /// depends little on the size of the program, but for [`Edit::Renumber`], which writes all of it.
    ///
    /// ```
    /// use bahn_program::{Edit, EditError, Program};
    ///
    /// let text = "BEGIN PGM 1 MM\nLBL 7\nEND PGM 1 MM\n";
    /// let old = Program::from_bytes("1.H", text.into());
    /// let new = old.edit(&Edit::Insert { before: 1, text: "L X+5 R0 FMAX" })?;
    /// assert_eq!((old.label(7), new.label(7)), (Some(1), Some(2)));
    /// assert_eq!(new.to_bytes(), b"BEGIN PGM 1 MM\nL X+5 R0 FMAX\nLBL 7\nEND PGM 1 MM\n");
    ///
    /// let protected = new.edit(&Edit::Protect)?;
    /// assert_eq!(protected.edit(&Edit::Renumber { step: 1 }).err(), Some(EditError::Protected));
    /// # Ok::<(), EditError>(())
    /// ```
    pub fn edit(&self, edit: &Edit<'_>) -> Result<Program, EditError> {
        if self.is_protected() && *edit != Edit::Unprotect {
            return Err(EditError::Protected);
        }
        if self.is_growing() {
            return Err(EditError::Growing);
        }
        match edit {
            Edit::Insert { before, text } => self.replaced(*before..*before, &self.own_blocks(text)?),
            Edit::Replace { block, text } => {
                self.replaced(*block..block.saturating_add(1), &self.own_blocks(text)?)
            }
            Edit::Delete { blocks } => self.replaced(blocks.clone(), ""),
            Edit::Renumber { step } => Ok(self.renumbered(*step)),
            Edit::Protect => self.with_protection(true),
            Edit::Unprotect => self.with_protection(false),
        }
    }

    /// Whether the program is protected against erasing and editing.
    pub fn is_protected(&self) -> bool {
        self.begin().is_some_and(|header| header.protected)
    }

    /// Text that is entered, with the line ends of the file; it joins nothing after it.
    fn own_blocks(&self, text: &str) -> Result<String, EditError> {
        let mut own = String::with_capacity(text.len() + self.line_end.len());
        for line in lines(text.as_bytes()) {
            let line = String::from_utf8_lossy(line);
            // A byte order mark is no text wherever it stands.
            own.extend(line.chars().filter(|&c| c != MARK));
            own.push_str(self.line_end);
        }
        let mut own = own.into_bytes();
        self.unjoin(&mut own, b"L");
        let own = String::from_utf8(own).unwrap_or_default();
        let blocks = self.language.cut(own.as_bytes(), 1);
        let frames = |raw: &RawBlock| {
            let landmark = self.language.landmark(raw.text(own.as_bytes()));
            matches!(
                landmark,
                Some(Landmark::Begin(_) | Landmark::Frame(_) | Landmark::End(_))
            )
        };
        match blocks.is_empty() {
            true => Err(EditError::Empty),
            false if blocks.iter().any(frames) => Err(EditError::Frame),
            false => Ok(own),
        }
    }

    /// Takes from the end of whole lines what would join the text after them.
    fn unjoin(&self, text: &mut Vec<u8>, after: &[u8]) {
        let Some(next) = lines(after).find(|line| !trim(line).is_empty()) else {
            return;
        };
        let length = text.len();
        text.extend_from_slice(next);
        let last = self.language.cut(text, 1).last().copied();
        text.truncate(length);
        let Some(last) = last.filter(|last| last.start < length) else {
            return;
        };
        while text.len() > last.start && text.last().is_some_and(|&byte| is_blank(byte) || byte == b'~') {
            text.pop();
        }
        if text.len() == last.start {
            // Nothing but the mark: an empty comment.
            self.write_empty(text);
        }
        text.extend_from_slice(self.line_end.as_bytes());
    }

    /// Other text in the place of blocks between BEGIN and END.
    fn replaced(&self, blocks: Range<u32>, text: &str) -> Result<Program, EditError> {
        let last = self.block_count().saturating_sub(1);
        match blocks {
            Range { start, end } if start > end || end > last.saturating_add(1) => Err(EditError::NoBlock),
            Range { start: 0, .. } => Err(EditError::Frame),
            Range { end, .. } if end > last => Err(EditError::Frame),
            blocks => self.with_text(blocks, text),
        }
    }

    /// Other text in the place of blocks; only the pieces around it are made anew.
    fn with_text(&self, blocks: Range<u32>, text: &str) -> Result<Program, EditError> {
        let body = self.rope.body();
        let before = self.rope.of_block(blocks.start.saturating_sub(1));
        let first = before.unwrap_or(body.start);
        let after = self.rope.of_block(blocks.end).map_or(body.end, |last| last + 1);
        if self.rope.bytes() + text.len() as u64 > Program::MAX_BYTES {
            return Err(EditError::TooLarge);
        }
        let mut region = self.region(first..after, &blocks, text);
        if first == 0 && region.starts_with(MARK_BYTES) {
            // At the front of a file it would be none of the text.
            region.splice(0..0, self.line_end.bytes());
        }
        // A numbered line shows which line comes next; no block joins it.
        let end = region.len();
        region.extend_from_slice(b"1 L");
        let mut raws = self.language.cut(&region, 1);
        region.truncate(end);
        let end_line = match raws.pop_if(|last| last.start >= end) {
            Some(next) => next.line,
            None => {
                raws = self.language.cut(&region, 1);
                raws.len() as u32
            }
        };
        let (labels, end) = self.language.landmarks(&region, &raws);
        let has_end = self.end().is_some() && after == body.end;
        if end.map(|at| at as usize + 1) != has_end.then_some(raws.len()) {
            return Err(EditError::Frame);
        }
        let rope = self
            .rope
            .splice(first..after, pieces(region, &raws, &labels, end_line));
        let mut frame = self.frame.clone();
        if frame.begin.is_none() {
            frame.refused = self.refusal(&rope);
        }
        Ok(Program::of(
            self.name.clone(),
            self.language,
            rope,
            frame,
            self.line_end,
        ))
    }

    /// The text of pieces with other text in the place of blocks.
    fn region(&self, range: Range<usize>, blocks: &Range<u32>, text: &str) -> Vec<u8> {
        let pieces = self.rope.pieces();
        let old: Vec<&[u8]> = pieces
            .get(range.clone())
            .unwrap_or_default()
            .iter()
            .map(|piece| piece.text())
            .collect();
        let old = old.concat();
        let raws = self.language.cut(&old, 1);
        let (first, _) = self.rope.start(range.start);
        let byte_of = |block: u32| {
            let raw = raws.get(block.saturating_sub(first) as usize);
            raw.map_or(old.len(), |raw| raw.start)
        };
        let (front, back) = (byte_of(blocks.start), byte_of(blocks.end));
        let mut new = old.get(..front).unwrap_or_default().to_vec();
        let rest = old.get(back..).unwrap_or_default();
        let next = pieces.get(range.end).map_or(&[][..], |piece| piece.text());
        let after = [text.as_bytes(), rest, next]
            .into_iter()
            .find(|text| !text.is_empty());
        if let Some(after) = after.filter(|_| !new.is_empty()) {
            if !matches!(new.last(), Some(b'\n' | b'\r' | b'\x0c')) {
                new.extend_from_slice(self.line_end.as_bytes());
            }
            self.unjoin(&mut new, after);
        }
        new.extend_from_slice(text.as_bytes());
        new.extend_from_slice(rest);
        new
    }

    /// Writes an empty comment.
    fn write_empty(&self, text: &mut Vec<u8>) {
        let block = Block {
            operation: Operation::Comment("".into()),
            ..Block::EMPTY
        };
        let mut empty = String::new();
        self.language.write(&block, FormatOptions::default(), &mut empty);
        text.extend_from_slice(empty.as_bytes());
    }

    /// Why the program is none of its language, by its first block.
    fn refusal(&self, rope: &Rope) -> Option<String> {
        let first = rope.pieces().get(rope.body().start)?;
        let raw = *self.language.cut(first.text(), 1).first()?;
        self.language.refuses(raw.text(first.text()))
    }

    fn renumbered(&self, step: u32) -> Program {
        let mut made = Vec::with_capacity(self.rope.pieces().len());
        for (index, piece) in self.rope.pieces().iter().enumerate() {
            if piece.blocks == 0 {
                made.push(Arc::clone(piece));
                continue;
            }
            let (first, _) = self.rope.start(index);
            made.push(piece.with_text(self.language.renumber(piece.text(), first, step)));
        }
        let rope = self.rope.with_pieces(made);
        let frame = self.frame.clone();
        Program::of(self.name.clone(), self.language, rope, frame, self.line_end)
    }

    /// BEGIN and END with or without protection.
    fn with_protection(&self, protected: bool) -> Result<Program, EditError> {
        let mut frame = self.frame.clone();
        let (Some(begin), Some(end)) = (&mut frame.begin, &mut frame.end) else {
            return Err(EditError::Frame);
        };
        let unit = self.unit();
        for header in [&mut *begin, &mut *end] {
            header.protected = protected;
            if protected {
                // After a name alone the P would be part of it.
                header.unit = Some(header.unit.unwrap_or(unit));
            }
        }
        let last = self.rope.end().saturating_sub(1);
        let (begin, end) = (Box::new(begin.clone()), Box::new(end.clone()));
        let program = self.with_header(0, Operation::Begin(begin))?;
        let mut program = program.with_header(last, Operation::End(end))?;
        program.frame = frame;
        Ok(program)
    }

    /// Another header in a block, whose number, `/` and comment stay.
    fn with_header(&self, number: u32, operation: Operation) -> Result<Program, EditError> {
        let (piece, raw) = self.place(number).ok_or(EditError::Frame)?;
        let old = raw.text(piece.text());
        let mut block = Block::EMPTY;
        self.language.read(old, number == 0, &mut block);
        block.operation = operation;
        let mut text = String::new();
        let words = self.language.words(old);
        if let Some(word) = words.iter().find(|word| word.kind == WordKind::Number) {
            let number = old.bytes.get(word.span.clone()).unwrap_or_default();
            text.push_str(&String::from_utf8_lossy(number));
            text.push(' ');
        }
        self.language.write(&block, FormatOptions::default(), &mut text);
        text.push_str(self.line_end);
        self.with_text(number..number + 1, &text)
    }
}
