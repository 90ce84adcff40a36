//! A part program as a file: its bytes, a light index, and blocks decoded on demand.

use crate::index::{CHUNK_SIZE, ChunkStart, Index};
use crate::lines::{RawBlock, RawBlocks, stands_alone};
use crate::parse::{EMPTY_BLOCK, parse_block, parse_block_into};
use crate::text::{BYTE_ORDER_MARK, blank_lone_returns, to_text, without_utf16};
use crate::{Block, Header, Operation, Unit};

/// A part program in plain language.
///
/// It holds the bytes of its file and an index of some ten bytes for every 256 blocks; blocks are decoded
/// a chunk at a time. A block's number is its number in the normalised listing: `BEGIN PGM` is 0 and every
/// line with text is one block, lines joined by `~` together. Where the file lacks `BEGIN PGM` or
/// `END PGM`, the block is implied. Text before the first `BEGIN PGM` and behind `END PGM` is no part of
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
#[derive(Debug)]
pub struct Program {
    name: Box<str>,
    file: Vec<u8>,
    index: Index,
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
    /// The block.
    pub block: Block,
}

impl Program {
    /// Blocks in a chunk; the last one may have fewer.
    pub const CHUNK_SIZE: u32 = CHUNK_SIZE;
    /// Largest file that can be indexed. Callers refuse larger ones.
    pub const MAX_BYTES: u64 = u32::MAX as u64 - 1;

    /// Takes a file of any bytes. What cannot be read becomes [`Operation::Invalid`] when it is decoded;
    /// bytes beyond [`Program::MAX_BYTES`] are cut off.
    pub fn from_bytes(name: impl Into<Box<str>>, bytes: Vec<u8>) -> Program {
        let mut file = without_utf16(bytes);
        file.truncate(usize::try_from(Program::MAX_BYTES).unwrap_or(usize::MAX));
        blank_lone_returns(&mut file);
        let index = Index::new(&file, text_start(&file));
        Program {
            name: name.into(),
            file,
            index,
        }
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
        self.index.begin.as_ref()
    }

    /// Whether the file begins with BEGIN PGM, comments apart: that of a file which is no program does not,
    /// even if it quotes one.
    pub fn begins_with_header(&self) -> bool {
        let Some(begin) = self.index.chunks.first().filter(|_| self.begin().is_some()) else {
            return false;
        };
        RawBlocks::from(&self.file, text_start(&self.file), 1)
            .take_while(|raw| raw.start < begin.byte as usize)
            .all(|raw| stands_alone(raw.bytes(&self.file)))
    }

    /// The END PGM block, if the file has one.
    pub fn end(&self) -> Option<&Header> {
        self.index.end.as_ref()
    }

    /// Whether the program is written in DIN/ISO, which is not read here yet: every block is invalid.
    pub fn is_din_iso(&self) -> bool {
        self.index.din_iso
    }

    /// Number of blocks, BEGIN and END included.
    pub fn block_count(&self) -> u32 {
        self.index.block_count
    }

    /// Number of chunks.
    pub fn chunk_count(&self) -> u32 {
        self.block_count().div_ceil(CHUNK_SIZE)
    }

    /// Block that sets a label, the first one if several do.
    #[inline]
    pub fn label(&self, label: u16) -> Option<u32> {
        self.index.label(label)
    }

    /// All labels but 0 in ascending order, with the block that first sets them.
    pub fn labels(&self) -> impl Iterator<Item = (u16, u32)> {
        self.index.labels()
    }

    /// Blocks that set a label which an earlier block has set: label and block. At most a thousand are
    /// kept.
    pub fn repeated_labels(&self) -> &[(u16, u32)] {
        &self.index.repeated_labels
    }

    /// The blocks of a chunk; none beyond the last.
    pub fn decode(&self, chunk: u32) -> Chunk {
        let mut decoded = Chunk::default();
        self.decode_into(chunk, &mut decoded);
        decoded
    }

    /// [`Program::decode`] into a chunk whose memory is used again.
    pub fn decode_into(&self, chunk: u32, decoded: &mut Chunk) {
        decoded.blocks.clear();
        decoded.first_block = chunk.saturating_mul(CHUNK_SIZE);
        let count = self.blocks_in(chunk);
        decoded.blocks.reserve(count as usize);
        if chunk == 0 && self.begin().is_none() {
            decoded.blocks.push(implied(Operation::Begin));
        }
        let remaining = (count as usize).saturating_sub(decoded.blocks.len());
        for raw in self.raw_blocks(chunk).take(remaining) {
            let number = decoded.first_block + decoded.blocks.len() as u32;
            decoded.blocks.push(EMPTY_BLOCK);
            if let Some(block) = decoded.blocks.last_mut() {
                parse_block_into(&self.file, raw, number == 0, block);
            }
        }
        if decoded.blocks.len() < count as usize {
            decoded.blocks.push(implied(Operation::End));
        }
    }

    /// All blocks in order.
    pub fn blocks(&self) -> impl Iterator<Item = NumberedBlock> {
        self.places().map(|(number, line, raw)| NumberedBlock {
            number,
            line,
            block: match raw {
                Some(raw) => parse_block(&self.file, raw, number == 0),
                None if number == 0 => implied(Operation::Begin),
                None => implied(Operation::End),
            },
        })
    }

    /// Line in the file where a block begins, from 1.
    pub fn line_of(&self, block: u32) -> u32 {
        self.place(block).map_or(1, |(line, _)| line)
    }

    /// The block as it stands in the file, its lines trimmed at their ends; empty for an implied block.
    pub fn text_of(&self, block: u32) -> String {
        let raw = self.place(block).and_then(|(_, raw)| raw);
        raw.map_or_else(String::new, |raw| to_text(raw.bytes(&self.file)))
    }

    /// Bytes of the file.
    pub(crate) fn file(&self) -> &[u8] {
        &self.file
    }

    pub(crate) fn index(&self) -> &Index {
        &self.index
    }

    fn blocks_in(&self, chunk: u32) -> u32 {
        self.block_count()
            .saturating_sub(chunk.saturating_mul(CHUNK_SIZE))
            .min(CHUNK_SIZE)
    }

    /// The blocks in the file from the start of a chunk on.
    fn raw_blocks(&self, chunk: u32) -> RawBlocks<'_> {
        let end = ChunkStart {
            byte: u32::MAX,
            line: 1,
        };
        let start = self.index.chunks.get(chunk as usize).copied().unwrap_or(end);
        RawBlocks::from(&self.file, start.byte as usize, start.line)
    }

    /// Number, line and place in the file of all blocks; implied ones have none.
    fn places(&self) -> impl Iterator<Item = (u32, u32, Option<RawBlock>)> {
        let implied_begin = self.begin().is_none().then_some((1, None));
        let in_file = self.raw_blocks(0).map(|raw| (raw.line, Some(raw)));
        let behind = std::iter::repeat_with(|| (self.last_line(), None));
        (0..self.block_count())
            .zip(implied_begin.into_iter().chain(in_file).chain(behind))
            .map(|(number, (line, raw))| (number, line, raw))
    }

    /// Line and place in the file of a block.
    fn place(&self, block: u32) -> Option<(u32, Option<RawBlock>)> {
        if block >= self.block_count() {
            return None;
        }
        let mut offset = block % CHUNK_SIZE;
        if block < CHUNK_SIZE && self.begin().is_none() {
            if block == 0 {
                return Some((1, None));
            }
            offset -= 1;
        }
        match self.raw_blocks(block / CHUNK_SIZE).nth(offset as usize) {
            Some(raw) => Some((raw.line, Some(raw))),
            None => Some((self.last_line(), None)),
        }
    }

    /// Line of the last block that stands in the file.
    fn last_line(&self) -> u32 {
        let last_chunks = (0..self.chunk_count()).rev();
        last_chunks
            .filter_map(|chunk| self.raw_blocks(chunk).last())
            .map(|raw| raw.line)
            .next()
            .unwrap_or(1)
    }
}

/// Where the text begins, behind a byte-order mark.
pub(crate) fn text_start(file: &[u8]) -> usize {
    if file.starts_with(BYTE_ORDER_MARK) {
        BYTE_ORDER_MARK.len()
    } else {
        0
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
