//! The other side of the encoding, as `codec.js` has it.
#![allow(dead_code, reason = "each test uses its own part of this")]

use bahn_viewer::{TILE, WHOLE};

/// Numbers from bytes.
pub struct Reader<'a> {
    pub bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    pub fn take(&mut self, count: usize) -> &'a [u8] {
        let (taken, rest) = self.bytes.split_at(count);
        self.bytes = rest;
        taken
    }

    pub fn varint(&mut self) -> usize {
        let mut value = 0;
        for shift in (0..).step_by(7) {
            let byte = self.take(1)[0];
            value |= usize::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                break;
            }
        }
        value
    }

    pub fn signed(&mut self) -> i64 {
        let value = self.varint() as i64;
        value >> 1 ^ -(value & 1)
    }
}

/// What a browser has of a part.
pub struct Screen {
    columns: [usize; 2],
    pub heights: Vec<u16>,
    pub marks: Vec<u8>,
}

impl Screen {
    /// The untouched blank.
    pub fn new(columns: [usize; 2]) -> Screen {
        Screen {
            columns,
            heights: vec![WHOLE; columns[0] * columns[1]],
            marks: vec![0; columns[0] * columns[1]],
        }
    }

    /// Takes the tiles of a message; which they are.
    pub fn take(&mut self, message: &[u8]) -> Vec<usize> {
        let mut reader = Reader { bytes: message };
        let (mut tiles, mut next) = (Vec::new(), 0);
        for _ in 0..reader.varint() {
            let tile = next + reader.varint();
            next = tile + 1;
            let length = reader.varint();
            self.tile(tile, reader.take(length));
            tiles.push(tile);
        }
        assert!(reader.bytes.is_empty());
        tiles
    }

    fn tile(&mut self, tile: usize, bytes: &[u8]) {
        let across = self.columns[0].div_ceil(TILE);
        let (x, y) = (tile % across * TILE, tile / across * TILE);
        let (w, h) = (TILE.min(self.columns[0] - x), TILE.min(self.columns[1] - y));
        let at = |cell: usize| (y + cell / w) * self.columns[0] + x + cell % w;
        let mut reader = Reader { bytes };
        let kind = reader.take(1)[0];
        if kind == 0 {
            let [low, high, mark] = reader.take(3) else {
                unreachable!()
            };
            for cell in 0..w * h {
                (self.heights[at(cell)], self.marks[at(cell)]) = (u16::from_le_bytes([*low, *high]), *mark);
            }
            return;
        }
        let cells: Vec<usize> = if kind == 1 {
            (0..w * h).collect()
        } else {
            let mask = reader.take((w * h).div_ceil(8));
            (0..w * h)
                .filter(|cell| mask[cell / 8] >> (cell % 8) & 1 == 1)
                .collect()
        };
        let [low, high, marks] = [0; 3].map(|_| reader.take(cells.len()));
        assert!(reader.bytes.is_empty());
        for (k, cell) in cells.into_iter().enumerate() {
            let height = |i: usize, j: usize| i32::from(self.heights[at(j * w + i)]);
            let (i, j) = (cell % w, cell / w);
            let expected = match (i, j) {
                (0, 0) => i32::from(WHOLE),
                (_, 0) => height(i - 1, 0),
                (0, _) => height(0, j - 1),
                _ => {
                    // The middle one of left, above, and left + above - between.
                    let mut three = [height(i - 1, j), height(i, j - 1), 0];
                    three[2] = three[0] + three[1] - height(i - 1, j - 1);
                    three.sort_unstable();
                    three[1]
                }
            };
            let folded = i32::from(u16::from_le_bytes([low[k], high[k]]));
            let difference = folded >> 1 ^ -(folded & 1);
            self.heights[at(cell)] = (expected + difference) as u16;
            self.marks[at(cell)] = marks[k];
        }
    }
}
