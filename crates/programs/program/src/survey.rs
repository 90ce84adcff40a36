//! Reads a file once: its pieces, and the blocks that frame the program.

use std::sync::Arc;

use crate::Header;
use crate::language::{Landmark, Language};
use crate::lines::Lines;
use crate::rope::{PIECE_BLOCKS, Piece, Rope};

/// What frames a program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// The BEGIN block; `None` if the file has none.
    pub(crate) begin: Option<Header>,
    /// The END block; `None` if the file has none.
    pub(crate) end: Option<Header>,
    /// Line of the first text before BEGIN.
    pub(crate) leading: Option<u32>,
    /// Whether there is text after END.
    pub(crate) trailing: bool,
    /// Why the program is certainly none of its language.
    pub(crate) refused: Option<String>,
}

/// Pieces that are being made.
struct Pieces<'a> {
    file: &'a Arc<Vec<u8>>,
    made: Vec<Arc<Piece>>,
    /// First byte and line of the piece.
    start: (usize, u32),
    blocks: u32,
    labels: Vec<(u16, u32)>,
}

impl Pieces<'_> {
    /// Ends a piece before a place; without text there is none.
    fn cut(&mut self, (byte, line): (usize, u32)) {
        let (start, first_line) = std::mem::replace(&mut self.start, (byte, line));
        let blocks = std::mem::take(&mut self.blocks);
        let labels = std::mem::take(&mut self.labels);
        if start < byte {
            let lines = line.saturating_sub(first_line);
            self.made
                .push(Piece::new(self.file, start..byte, blocks, lines, labels));
        }
    }
}

/// Cuts a file into pieces, and reads the blocks that frame the program. Its text begins at a byte.
pub(crate) fn survey<L: Language>(language: &L, file: &Arc<Vec<u8>>, start: usize) -> (Rope, Frame) {
    let mut frame = Frame::default();
    let mut pieces = Pieces {
        file,
        made: Vec::new(),
        start: (0, 1),
        blocks: 0,
        labels: Vec::new(),
    };
    let text = file.get(start..).unwrap_or_default();
    // Without BEGIN a BEGIN block is implied, so that the first block of the file is number 1.
    let mut number = 1_u32;
    let mut first = None;
    let mut after = None;
    let mut lines = Lines::new(text, 1);
    while let Some(raw) = language.next_block(&mut lines) {
        let place = (start + raw.start, raw.line);
        if frame.end.is_some() {
            frame.trailing = true;
            after = Some(place);
            break;
        }
        if first.is_none() {
            frame.refused = language.refuses(raw.text(text));
            // Blank lines before it, and a byte-order mark.
            pieces.cut(place);
        }
        let landmark = match language.landmark(raw.text(text)) {
            Some(Landmark::Frame(header)) if frame.begin.is_none() => Some(Landmark::Begin(header)),
            Some(Landmark::Frame(header)) => Some(Landmark::End(header)),
            landmark => landmark,
        };
        if number.is_multiple_of(PIECE_BLOCKS) {
            pieces.cut(place);
        }
        match landmark {
            Some(Landmark::Label(label)) if label > 0 => pieces.labels.push((label, pieces.blocks)),
            Some(Landmark::Begin(header)) if frame.begin.is_none() => {
                // What stands before BEGIN is no part of the program.
                frame = Frame {
                    begin: Some(*header),
                    leading: first,
                    ..Frame::default()
                };
                pieces.made.clear();
                pieces.start = (0, 1);
                pieces.blocks = 0;
                pieces.labels.clear();
                pieces.cut(place);
                number = 0;
            }
            Some(Landmark::End(header)) => frame.end = Some(*header),
            _ => {}
        }
        pieces.blocks += 1;
        number = number.saturating_add(1);
        first = first.or(Some(raw.line));
    }
    let end = (file.len(), lines.number());
    pieces.cut(after.unwrap_or(end));
    pieces.cut(end);
    let first_block = u32::from(frame.begin.is_none());
    (Rope::new(pieces.made, first_block, 1), frame)
}
