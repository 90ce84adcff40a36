//! The text of a program in pieces that its versions share.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::lines::RawBlock;

/// Blocks in a piece of a file that was read; pieces that were edited may have up to twice as many.
pub(crate) const PIECE_BLOCKS: u32 = 256;

/// Some blocks that follow each other, or text that is no part of the program.
pub(crate) struct Piece {
    source: Arc<Vec<u8>>,
    range: Range<usize>,
    /// Number of blocks; none in the text before BEGIN and after END.
    pub(crate) blocks: u32,
    /// Number of line ends.
    pub(crate) lines: u32,
    /// Labels but 0 with the block in the piece that sets them.
    pub(crate) labels: Box<[(u16, u32)]>,
}

impl Piece {
    /// A range of a source.
    pub(crate) fn new(
        source: &Arc<Vec<u8>>,
        range: Range<usize>,
        blocks: u32,
        lines: u32,
        labels: Vec<(u16, u32)>,
    ) -> Arc<Piece> {
        Arc::new(Piece {
            source: Arc::clone(source),
            range,
            blocks,
            lines,
            labels: labels.into_boxed_slice(),
        })
    }

    /// The same blocks written otherwise.
    pub(crate) fn with_text(&self, text: Vec<u8>) -> Arc<Piece> {
        let (range, labels) = (0..text.len(), self.labels.to_vec());
        Piece::new(&Arc::new(text), range, self.blocks, self.lines, labels)
    }

    pub(crate) fn text(&self) -> &[u8] {
        self.source.get(self.range.clone()).unwrap_or_default()
    }
}

impl fmt::Debug for Piece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} blocks in {} bytes", self.blocks, self.range.len())
    }
}

/// Makes pieces of a text that was cut into blocks; `end_line` is the line after it.
pub(crate) fn pieces(
    text: Vec<u8>,
    blocks: &[RawBlock],
    labels: &[(u16, u32)],
    end_line: u32,
) -> Vec<Arc<Piece>> {
    let source = Arc::new(text);
    // One piece for a little more than usual, so that insertions do not leave small ones behind.
    let size = match blocks.len() {
        count if count <= 3 * PIECE_BLOCKS as usize / 2 => count.max(1),
        _ => PIECE_BLOCKS as usize,
    };
    let starts = blocks.iter().step_by(size);
    let after = starts
        .clone()
        .skip(1)
        .map(|raw| (raw.start, raw.line))
        .chain([(source.len(), end_line)]);
    let mut labels = labels.iter().peekable();
    let mut made = Vec::new();
    let mut before = (0, 1);
    for (index, ((end, line), chunk)) in after.zip(blocks.chunks(size)).enumerate() {
        let first = (index * size) as u32;
        let mut own = Vec::new();
        while let Some(&(label, block)) = labels.next_if(|(_, block)| *block < first + chunk.len() as u32) {
            own.push((label, block - first));
        }
        let lines = line.saturating_sub(before.1);
        made.push(Piece::new(&source, before.0..end, chunk.len() as u32, lines, own));
        before = (end, line);
    }
    made
}

/// Block and line that a piece begins with.
#[derive(Clone, Copy, Debug)]
struct Start {
    block: u32,
    line: u32,
}

/// The pieces in order, with their places.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rope {
    pieces: Vec<Arc<Piece>>,
    starts: Vec<Start>,
    /// Number of the first block.
    first: u32,
    /// Line that the first piece begins with.
    line: u32,
    /// Number after the last block.
    end: u32,
    bytes: u64,
}

impl Rope {
    /// Pieces whose first block and first line have numbers.
    pub(crate) fn new(pieces: Vec<Arc<Piece>>, first: u32, first_line: u32) -> Rope {
        let mut rope = Rope {
            starts: Vec::with_capacity(pieces.len()),
            pieces,
            first,
            line: first_line,
            end: first,
            bytes: 0,
        };
        let mut line = first_line;
        for piece in &rope.pieces {
            rope.starts.push(Start {
                block: rope.end,
                line,
            });
            rope.end = rope.end.saturating_add(piece.blocks);
            rope.bytes += piece.text().len() as u64;
            line = line.saturating_add(piece.lines);
        }
        rope
    }

    /// The rope with other pieces in place of some.
    pub(crate) fn splice(&self, range: Range<usize>, new: Vec<Arc<Piece>>) -> Rope {
        let mut pieces = Vec::with_capacity(self.pieces.len() + new.len());
        pieces.extend_from_slice(self.pieces.get(..range.start).unwrap_or_default());
        pieces.extend(new);
        pieces.extend_from_slice(self.pieces.get(range.end..).unwrap_or_default());
        self.with_pieces(pieces)
    }

    pub(crate) fn pieces(&self) -> &[Arc<Piece>] {
        &self.pieces
    }

    /// Number of the first block that stands in the file.
    pub(crate) fn first(&self) -> u32 {
        self.first
    }

    /// The same places with the pieces written otherwise.
    pub(crate) fn with_pieces(&self, pieces: Vec<Arc<Piece>>) -> Rope {
        Rope::new(pieces, self.first, self.line)
    }

    /// Bytes of all pieces.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Number after the last block.
    pub(crate) fn end(&self) -> u32 {
        self.end
    }

    /// The pieces that hold blocks.
    pub(crate) fn body(&self) -> Range<usize> {
        let holds = |piece: &Arc<Piece>| piece.blocks > 0;
        let first = self.pieces.iter().position(holds).unwrap_or(self.pieces.len());
        let end = self.pieces.iter().rposition(holds).map_or(first, |last| last + 1);
        first..end
    }

    /// Number of the first block and line of a piece.
    pub(crate) fn start(&self, piece: usize) -> (u32, u32) {
        self.starts
            .get(piece)
            .map_or((self.end, 1), |start| (start.block, start.line))
    }

    /// The piece that holds a block.
    pub(crate) fn of_block(&self, block: u32) -> Option<usize> {
        if block >= self.end {
            return None;
        }
        self.starts
            .partition_point(|start| start.block <= block)
            .checked_sub(1)
    }

    /// The piece that holds a line, or the last one.
    pub(crate) fn of_line(&self, line: u32) -> Option<usize> {
        self.starts
            .partition_point(|start| start.line <= line)
            .checked_sub(1)
    }
}
