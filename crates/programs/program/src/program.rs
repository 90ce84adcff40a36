//! A part program as a file: its text in pieces, and blocks decoded on demand.

use std::sync::{Arc, OnceLock};

use bahn_text::as_utf8;

use crate::bulk::Bulk;
use crate::dialect::DinLanguage;
use crate::file_types::bulk_language_of;
use crate::grow::Growth;
use crate::labels::Labels;
use crate::language::Language;
use crate::lines::{RawBlock, line_at};
use crate::rope::{PIECE_BLOCKS, Piece, Rope};
use crate::survey::Frame;
use crate::text::{settle_line_ends, text_start, to_text};
use crate::{Block, Header, Operation, Unit};

/// A version of a part program.
///
/// It holds the bytes of its file in pieces of 256 blocks, about a hundred bytes for each, which the versions
/// that [`Program::edit`] makes share; blocks are decoded a chunk at a time. A block's number is its number in the normalised listing: `BEGIN PGM` is 0 and every
/// line with text is one block, lines joined by `~` together. Where the file lacks `BEGIN PGM` or
/// `END PGM`, the block is implied. Text before the first `BEGIN PGM` and after `END PGM` is no part of
/// the program.
///
/// ```
/// use bahn_program::{Operation, Program};
///
/// let program = Program::from_bytes("1.H", b"BEGIN PGM 1 MM\nLBL 7\nL X+5 R0 FMAX\nEND PGM 1 MM".to_vec());
/// assert_eq!(program.block_count(), 4);
/// assert_eq!(program.label(7), Some(1));
/// assert!(matches!(program.decode(0).blocks[2].operation, Operation::Motion(_)));
/// ```
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) name: Box<str>,
    pub(crate) language: &'static dyn Bulk,
    pub(crate) rope: Rope,
    pub(crate) frame: Frame,
    /// What ends the lines of the file.
    pub(crate) line_end: &'static str,
    /// What is known of a program that is still coming.
    pub(crate) growth: Option<Growth>,
    labels: OnceLock<Labels>,
}

/// Some blocks of a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chunk {
    /// Number of the first block.
    pub first_block: u32,
    /// The blocks, at most [`Program::CHUNK_SIZE`].
    pub blocks: Vec<Block>,
}

/// A block with its number and the line where it begins.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberedBlock {
    /// Block number in the normalised listing.
    pub number: u32,
    /// Line in the file, from 1.
    pub line: u32,
    /// What it does, with its comment.
    pub block: Block,
}

impl Program {
    /// Blocks in a chunk; the last one may have fewer.
    pub const CHUNK_SIZE: u32 = PIECE_BLOCKS;
    /// Largest file that can be indexed. Callers refuse larger ones.
    pub const MAX_BYTES: u64 = u32::MAX as u64 - 1;

    /// Takes a file of any bytes in the language of its name: ISO where that ends with `.I`, DIN 66025 with `.nc` unless
    /// the file begins with BEGIN PGM, and with `.900`, plain language else. What cannot be read becomes [`Operation::Invalid`] when it is
    /// decoded; bytes beyond [`Program::MAX_BYTES`] are cut off.
    pub fn from_bytes(name: impl Into<Box<str>>, bytes: Vec<u8>) -> Program {
        let name = name.into();
        let file = as_utf8(bytes);
        let language = bulk_language_of(&name, &file);
        Program::of_file(name, file, language)
    }

    /// Takes a file of DIN 66025 as a TF5200 reads it, whatever its name: subroutines have other endings, or none.
    pub fn of_din(name: impl Into<Box<str>>, bytes: Vec<u8>) -> Program {
        Program::of_file(name.into(), as_utf8(bytes), &DinLanguage::Tf5200)
    }

    pub(crate) fn of_file(name: Box<str>, mut file: Vec<u8>, language: &'static dyn Bulk) -> Program {
        file.truncate(usize::try_from(Program::MAX_BYTES).unwrap_or(usize::MAX));
        let line_end = settle_line_ends(&mut file);
        let file = Arc::new(file);
        let (rope, frame) = language.survey(&file, text_start(&file));
        Program::of(name, language, rope, frame, line_end)
    }

    pub(crate) fn of(
        name: Box<str>,
        language: &'static dyn Bulk,
        rope: Rope,
        frame: Frame,
        line_end: &'static str,
    ) -> Program {
        Program {
            name,
            language,
            rope,
            frame,
            line_end,
            growth: None,
            labels: OnceLock::new(),
        }
    }

    /// The language that it is written in.
    pub fn language(&self) -> &'static dyn Language {
        self.language
    }

    /// The dialect of DIN 66025 that it is written in, whose blocks no language of the control reads.
    pub fn dialect(&self) -> Option<DinLanguage> {
        self.language.dialect()
    }

    /// The name that the program was opened by.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit of the BEGIN PGM block, millimetres where it does not say.
    pub fn unit(&self) -> Unit {
        self.begin().and_then(|header| header.unit).unwrap_or(Unit::Mm)
    }

    /// The BEGIN PGM block, if the file has one.
    pub fn begin(&self) -> Option<&Header> {
        self.frame.begin.as_ref()
    }

    /// Whether the file begins with BEGIN PGM, comments apart: that of a file which is no program does not,
    /// even if it quotes one.
    pub fn begins_with_header(&self) -> bool {
        let in_front = self.rope.pieces().get(..self.rope.body().start);
        let front = in_front.unwrap_or_default().first();
        let front = front.map_or(&[][..], |piece| piece.text());
        let text = front.get(text_start(front)..).unwrap_or_default();
        let alone = |raw: RawBlock| self.language.stands_alone(raw.text(text));
        self.begin().is_some() && self.language.cut(text, 1).into_iter().all(alone)
    }

    /// The END PGM block, if the file has one.
    pub fn end(&self) -> Option<&Header> {
        self.frame.end.as_ref()
    }

    /// Why the program is none of its language, such as one in DIN/ISO in a file of plain language: every block
    /// is invalid.
    pub fn refused(&self) -> Option<&str> {
        self.frame.refused.as_deref()
    }

    /// Number of blocks, BEGIN and END included.
    pub fn block_count(&self) -> u32 {
        self.rope.end().saturating_add(u32::from(self.implies_end()))
    }

    /// Whether the END block is not in the file, and will not come.
    fn implies_end(&self) -> bool {
        self.end().is_none() && self.growth.is_none()
    }

    /// How many chunks of [`Program::CHUNK_SIZE`] its blocks fill.
    pub fn chunk_count(&self) -> u32 {
        self.block_count().div_ceil(Program::CHUNK_SIZE)
    }

    /// Block that sets a label, the first one if several do.
    #[inline]
    pub fn label(&self, label: u16) -> Option<u32> {
        self.label_list().block(label)
    }

    /// All labels but 0 in ascending order, with the block that first sets them.
    pub fn labels(&self) -> impl Iterator<Item = (u16, u32)> {
        self.label_list().all()
    }

    /// Blocks that set a label which an earlier block has set: label and block. At most a thousand are
    /// kept.
    pub fn repeated_labels(&self) -> &[(u16, u32)] {
        self.label_list().repeated()
    }

    /// The blocks of a chunk; none beyond the last.
    pub fn decode(&self, chunk: u32) -> Chunk {
        let mut decoded = Chunk::default();
        self.decode_into(chunk, &mut decoded);
        decoded
    }

    /// [`Program::decode`] into a chunk whose memory is used again.
    pub fn decode_into(&self, chunk: u32, decoded: &mut Chunk) {
        let blocks = &mut decoded.blocks;
        blocks.clear();
        decoded.first_block = chunk.saturating_mul(Program::CHUNK_SIZE);
        let count = self.blocks_in(chunk) as usize;
        blocks.reserve(count);
        if chunk == 0 && self.begin().is_none() {
            blocks.push(implied(Operation::Begin));
        }
        while blocks.len() < count {
            let number = decoded.first_block + blocks.len() as u32;
            if number < self.rope.first() {
                blocks.push(forgotten());
                continue;
            }
            let Some((piece, index)) = self.piece_of(number) else {
                blocks.push(implied(Operation::End));
                break;
            };
            let skip = number - self.rope.start(index).0;
            let wanted = count - blocks.len();
            self.language
                .read_all(piece.text(), skip as usize, wanted, number == 0, blocks);
        }
    }

    /// All blocks in order.
    pub fn blocks(&self) -> impl Iterator<Item = NumberedBlock> {
        let begin = NumberedBlock {
            number: 0,
            line: 1,
            block: implied(Operation::Begin),
        };
        let end = || NumberedBlock {
            number: self.rope.end(),
            line: self.last_line(),
            block: implied(Operation::End),
        };
        let in_file = self.rope.pieces().iter().enumerate().flat_map(|(index, piece)| {
            let (first, line) = self.rope.start(index);
            let count = piece.blocks as usize;
            (first..)
                .zip(self.places(piece, line).into_iter().take(count))
                .map(|(number, raw)| {
                    let mut block = Block::EMPTY;
                    self.language
                        .read(raw.text(piece.text()), number == 0, &mut block);
                    NumberedBlock {
                        number,
                        line: raw.line,
                        block,
                    }
                })
        });
        let begin = self.begin().is_none().then_some(begin);
        let end = std::iter::repeat_with(end).take(usize::from(self.implies_end()));
        begin.into_iter().chain(in_file).chain(end)
    }

    /// What reports call a block: the number that it is programmed with, where its language has such numbers and it
    /// has one, else its number in the normalised listing.
    pub fn number_of(&self, block: u32) -> u32 {
        self.own_number(block).unwrap_or(block)
    }

    /// The number that a block is programmed with, in a language whose blocks have numbers of their own.
    pub fn own_number(&self, block: u32) -> Option<u32> {
        if !self.language.has_numbers() {
            return None;
        }
        let (piece, raw) = self.place(block)?;
        self.language.number(raw.text(piece.text()))
    }

    /// The first block that reports call so: [`Program::number_of`] backwards. A block that is programmed with the number
    /// is before one that is only called by its place, and one with which a run may begin before one of a subroutine.
    ///
    /// ```
    /// use bahn_program::Program;
    ///
    /// let text = "%7 G71 *\nN10 G00 X+1 *\nM3 *\nN40 M5 *\nN99999 %7 G71 *\n";
    /// let program = Program::from_bytes("7.I", text.into());
    /// assert_eq!((program.block_of(40), program.block_of(2), program.block_of(3)), (Some(3), Some(2), None));
    /// ```
    pub fn block_of(&self, number: u32) -> Option<u32> {
        let own = match self.language.has_numbers() {
            true => self.programmed_with(number),
            false => None,
        };
        own.or_else(|| (number < self.block_count() && self.own_number(number).is_none()).then_some(number))
    }

    /// The first block that is programmed with a number; one of a subroutine in which no run begins only where no other is.
    fn programmed_with(&self, number: u32) -> Option<u32> {
        let (mut is_subroutine, mut in_subroutine) = (false, None);
        let pieces = self.rope.pieces().iter().enumerate();
        for (index, piece) in pieces.filter(|(_, piece)| piece.blocks > 0) {
            let (first, line) = self.rope.start(index);
            for (block, raw) in (first..).zip(self.places(piece, line)) {
                let text = raw.text(piece.text());
                is_subroutine = self.language.begins_subroutine(text).unwrap_or(is_subroutine);
                if self.language.number(text) == Some(number) {
                    match is_subroutine {
                        true => in_subroutine = in_subroutine.or(Some(block)),
                        false => return Some(block),
                    }
                }
            }
        }
        in_subroutine
    }

    /// What stands before a block on a screen: `12`, or in a language whose blocks have numbers of their own `N120`, and
    /// nothing where it has none.
    pub fn shown_number(&self, block: u32) -> String {
        match self.language.has_numbers() {
            true => self
                .own_number(block)
                .map_or_else(String::new, |number| format!("N{number}")),
            false => block.to_string(),
        }
    }

    /// Line in the file where a block begins, from 1.
    pub fn line_of(&self, block: u32) -> u32 {
        match self.place(block) {
            Some((_, raw)) => raw.line,
            None if block > 0 && block < self.block_count() => self.last_line(),
            None => 1,
        }
    }

    /// The block as it stands in the file, its lines trimmed at their ends; empty for an implied block.
    pub fn text_of(&self, block: u32) -> String {
        self.place(block)
            .map_or_else(String::new, |(piece, raw)| to_text(raw.text(piece.text()).bytes))
    }

    /// The text of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let texts: Vec<&[u8]> = self.rope.pieces().iter().map(|piece| piece.text()).collect();
        texts.concat()
    }

    /// A line of the file without its line end, numbered from 1.
    pub fn text_of_line(&self, line: u32) -> String {
        let found = self.rope.of_line(line);
        let Some((index, piece)) = found.and_then(|index| Some((index, self.rope.pieces().get(index)?)))
        else {
            return String::new();
        };
        let mut text = piece.text();
        if index == 0 {
            text = text.get(text_start(text)..).unwrap_or_default();
        }
        line_at(text, line.saturating_sub(self.rope.start(index).1))
    }

    /// The text before BEGIN and after END.
    pub(crate) fn around(&self) -> (&[u8], &[u8]) {
        let pieces = self.rope.pieces();
        let leading = self.frame.leading.and(pieces.first());
        let after = pieces.get(self.rope.body().end);
        let trailing = after.filter(|_| self.frame.trailing);
        (
            leading.map_or(&[], |piece| piece.text()),
            trailing.map_or(&[], |piece| piece.text()),
        )
    }

    /// Line of the text after END.
    pub(crate) fn trailing_line(&self) -> Option<u32> {
        self.frame
            .trailing
            .then(|| self.rope.start(self.rope.body().end).1)
    }

    fn label_list(&self) -> &Labels {
        self.labels.get_or_init(|| Labels::of(&self.rope))
    }

    fn blocks_in(&self, chunk: u32) -> u32 {
        self.block_count()
            .saturating_sub(chunk.saturating_mul(Program::CHUNK_SIZE))
            .min(Program::CHUNK_SIZE)
    }

    /// The piece that holds a block, and its index.
    pub(crate) fn piece_of(&self, block: u32) -> Option<(&Arc<Piece>, usize)> {
        let index = self.rope.of_block(block)?;
        Some((self.rope.pieces().get(index)?, index))
    }

    /// The place of a block that stands in the file.
    pub(crate) fn place(&self, block: u32) -> Option<(&Arc<Piece>, RawBlock)> {
        let places = self.places_of(block)?;
        Some((places.piece, places.of(block)?))
    }

    /// The places of all blocks of the piece in which a block stands: to cut a piece costs as much for one as for all.
    pub(crate) fn places_of(&self, block: u32) -> Option<Places<'_>> {
        let (piece, index) = self.piece_of(block)?;
        let (first, line) = self.rope.start(index);
        Some(Places {
            piece,
            first,
            blocks: self.places(piece, line),
        })
    }

    /// The places of the blocks of a piece that begins with a line.
    fn places(&self, piece: &Piece, line: u32) -> Vec<RawBlock> {
        self.language.cut(piece.text(), line)
    }

    /// Line of the last block that stands in the file.
    fn last_line(&self) -> u32 {
        let last = self.rope.end().checked_sub(1);
        let place = last.and_then(|last| self.place(last));
        place.map_or(1, |(_, raw)| raw.line)
    }
}

/// Where the blocks of a piece stand.
#[derive(Debug)]
pub(crate) struct Places<'a> {
    pub(crate) piece: &'a Arc<Piece>,
    first: u32,
    blocks: Vec<RawBlock>,
}

impl Places<'_> {
    /// The place of a block, if it is of this piece.
    pub(crate) fn of(&self, block: u32) -> Option<RawBlock> {
        self.blocks.get(block.checked_sub(self.first)? as usize).copied()
    }
}

/// A BEGIN or END block that the file lacks.
fn implied(kind: fn(Box<Header>) -> Operation) -> Block {
    let header = Header {
        name: "".into(),
        unit: None,
        protected: false,
    };
    Block {
        skip: false,
        operation: kind(Box::new(header)),
        comment: None,
    }
}

/// In the place of a block whose text is forgotten.
fn forgotten() -> Block {
    Block {
        operation: Operation::Comment("".into()),
        ..Block::EMPTY
    }
}
