//! The light index of a program: where every chunk of blocks begins, and the labels.

use crate::lines::RawBlocks;
use crate::parse::{is_din_iso, parse_block};
use crate::{Header, Operation};

/// Blocks in a chunk.
pub(crate) const CHUNK_SIZE: u32 = 256;
/// Most repeated labels that are kept to be reported.
const MAX_REPEATED_LABELS: usize = 1000;

/// Where a chunk begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChunkStart {
    /// Byte of its first block that stands in the file.
    pub(crate) byte: u32,
    /// Number of the line that begins there.
    pub(crate) line: u32,
}

/// The index.
#[derive(Debug, Default)]
pub(crate) struct Index {
    pub(crate) chunks: Vec<ChunkStart>,
    pub(crate) block_count: u32,
    /// The BEGIN block; `None` if the file has none.
    pub(crate) begin: Option<Header>,
    /// The END block; `None` if the file has none.
    pub(crate) end: Option<Header>,
    /// Block of the first LBL of each number, [`NO_BLOCK`] where there is none.
    labels: Vec<u32>,
    /// Further LBL blocks of a number that is set already: label and block.
    pub(crate) repeated_labels: Vec<(u16, u32)>,
    /// The program is DIN/ISO.
    pub(crate) din_iso: bool,
    /// First byte and line of the text that is no part of the program: before BEGIN PGM.
    pub(crate) leading: Option<(u32, u32)>,
    /// First byte and line of the text behind END PGM.
    pub(crate) trailing: Option<(u32, u32)>,
}

const NO_BLOCK: u32 = u32::MAX;

impl Index {
    /// Reads the file once. Only LBL, BEGIN and END blocks are parsed.
    pub(crate) fn new(file: &[u8], start: usize) -> Index {
        let mut index = Index::default();
        // Without BEGIN PGM a BEGIN block is implied, so that the first block of the file is number 1.
        let mut next = 1;
        let mut first = None;
        let mut chunks = Vec::new();
        for raw in RawBlocks::from(file, start, 1) {
            let place = (byte(raw.start), raw.line);
            if index.end.is_some() {
                index.trailing = Some(place);
                break;
            }
            if next == 1 && index.begin.is_none() {
                index.din_iso = is_din_iso(raw.bytes(file));
            }
            let number = next;
            next += 1;
            if raw.joined || has_keyword(raw.bytes(file)) {
                match parse_block(file, raw, true).operation {
                    Operation::Label(label) if label > 0 => index.set_label(label, number),
                    Operation::Begin(header) if index.begin.is_none() => {
                        // What stands before BEGIN PGM is no part of the program.
                        index = Index {
                            begin: Some(*header),
                            leading: first,
                            ..Index::default()
                        };
                        chunks.clear();
                        chunks.push(ChunkStart {
                            byte: place.0,
                            line: place.1,
                        });
                        next = 1;
                        continue;
                    }
                    Operation::End(header) => index.end = Some(*header),
                    _ => {}
                }
            }
            if number.is_multiple_of(CHUNK_SIZE) || chunks.is_empty() {
                chunks.push(ChunkStart {
                    byte: place.0,
                    line: place.1,
                });
            }
            first = first.or(Some(place));
        }
        let implied_end = u32::from(index.end.is_none());
        index.block_count = next.saturating_add(implied_end);
        // A chunk may hold nothing but the implied END.
        while chunks.len() < index.block_count.div_ceil(CHUNK_SIZE) as usize {
            chunks.push(ChunkStart {
                byte: byte(file.len()),
                line: 1,
            });
        }
        chunks.shrink_to_fit();
        index.chunks = chunks;
        index
    }

    fn set_label(&mut self, label: u16, block: u32) {
        let slot = usize::from(label);
        if self.labels.len() <= slot {
            self.labels.resize(slot + 1, NO_BLOCK);
        }
        match self.labels.get_mut(slot) {
            Some(first) if *first == NO_BLOCK => *first = block,
            _ if self.repeated_labels.len() < MAX_REPEATED_LABELS => {
                self.repeated_labels.push((label, block))
            }
            _ => {}
        }
    }

    /// The block of a label.
    pub(crate) fn label(&self, label: u16) -> Option<u32> {
        self.labels
            .get(usize::from(label))
            .copied()
            .filter(|&block| block != NO_BLOCK)
    }

    /// All labels with their blocks, in ascending order.
    pub(crate) fn labels(&self) -> impl Iterator<Item = (u16, u32)> {
        (0..=u16::MAX)
            .zip(self.labels.iter().copied())
            .filter(|&(_, block)| block != NO_BLOCK)
    }
}

fn byte(offset: usize) -> u32 {
    u32::try_from(offset).unwrap_or(u32::MAX)
}

/// Whether a line may be LBL, BEGIN or END by its first letters.
#[inline]
fn has_keyword(line: &[u8]) -> bool {
    let letter_from = |start: usize| {
        let rest = line.get(start..).unwrap_or_default();
        let found = rest.iter().position(|b| b.is_ascii_alphabetic());
        found.map_or(line.len(), |found| start + found)
    };
    let mut first = letter_from(0);
    if matches!(line.get(first..), Some([b'N' | b'n', b'0'..=b'9', ..])) {
        first = letter_from(first + 1);
    }
    let at = |offset: usize| line.get(first + offset).map_or(b' ', u8::to_ascii_uppercase);
    match at(0) {
        b'L' => at(1) == b'B' && at(2) == b'L',
        b'B' => at(1) == b'E',
        b'E' => at(1) == b'N',
        _ => false,
    }
}
