//! The height map as the browser has it: 16 bits a cell, in tiles.

use bahn_workpiece::Part;

use crate::bytes::varint;

/// Cells along a side of a tile; those at the far borders are smaller.
pub const TILE: usize = 64;
/// Height of an untouched cell; 0 is a hole through the blank. A step is 1/65535 of the thickness of the blank.
pub const WHOLE: u16 = u16::MAX;
/// Cells that are sent of a part at most: finer ones are left out, every other one or more.
const MOST_CELLS: usize = 2_000_000;
/// Cells along a side at most: textures of graphics cards are no longer.
const MOST_ALONG: usize = 8192;

/// How a tile is written.
const ALL_ALIKE: u8 = 0;
const ALL_CELLS: u8 = 1;
const SOME_CELLS: u8 = 2;

/// Heights and marks of all cells, in rows along the first axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Sheet {
    pub columns: [usize; 2],
    /// Columns of the part from one cell to the next.
    pub stride: usize,
    pub heights: Vec<u16>,
    pub marks: Vec<u8>,
}

/// What is new in a tile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Change {
    pub tile: usize,
    /// One bit for each cell of the tile, in rows.
    pub mask: Vec<u64>,
    /// Heights and marks of the cells whose bit is set, in their order.
    pub cells: Vec<(u16, u8)>,
}

/// The cells of a tile.
#[derive(Clone, Copy, Debug)]
struct Place {
    corner: [usize; 2],
    size: [usize; 2],
}

impl Sheet {
    /// The untouched blank of a part.
    pub fn blank_of(part: &Part) -> Sheet {
        let [nx, ny] = part.columns();
        let with = |stride: usize| [nx.div_ceil(stride), ny.div_ceil(stride)];
        let fits = |[x, y]: [usize; 2]| x * y <= MOST_CELLS && x.max(y) <= MOST_ALONG;
        let mut stride = 1;
        while !fits(with(stride)) {
            stride += 1;
        }
        let columns = with(stride);
        let count = columns[0] * columns[1];
        Sheet {
            columns,
            stride,
            heights: vec![WHOLE; count],
            marks: vec![0; count],
        }
    }

    pub fn tiles(&self) -> [usize; 2] {
        self.columns.map(|count| count.div_ceil(TILE))
    }

    fn place(&self, tile: usize) -> Place {
        let across = self.tiles()[0];
        let corner = [tile % across * TILE, tile / across * TILE];
        let side = |k: usize| TILE.min(self.columns[k].saturating_sub(corner[k]));
        Place {
            corner,
            size: [side(0), side(1)],
        }
    }

    /// Takes the part as it is; what is new.
    pub fn take(&mut self, part: &Part) -> Vec<Change> {
        let [across, along] = self.tiles();
        let tiles = 0..across * along;
        tiles.filter_map(|tile| self.take_tile(tile, part)).collect()
    }

    fn take_tile(&mut self, tile: usize, part: &Part) -> Option<Change> {
        let Place { corner, size } = self.place(tile);
        let [nx, ny] = part.columns();
        let top = part.max()[2] - part.min()[2];
        let scale = f64::from(WHOLE) / top;
        let (heights, marks) = (part.heights_mm(), part.marks());
        let mut change = None;
        for j in 0..size[1] {
            // The column in the middle of those that make a cell stands for all.
            let middle = |k: usize, count: usize| (k * self.stride + self.stride / 2).min(count - 1);
            let row = middle(corner[1] + j, ny) * nx;
            let own = (corner[1] + j) * self.columns[0] + corner[0];
            for i in 0..size[0] {
                let from = row + middle(corner[0] + i, nx);
                let height = quantized(heights.get(from).copied().unwrap_or_default(), top as f32, scale);
                let mark = marks
                    .and_then(|marks| marks.get(from).copied())
                    .unwrap_or_default();
                let (Some(h), Some(m)) = (self.heights.get_mut(own + i), self.marks.get_mut(own + i)) else {
                    continue;
                };
                if (*h, *m) != (height, mark) {
                    (*h, *m) = (height, mark);
                    change
                        .get_or_insert_with(|| Change::none(tile))
                        .add(j * size[0] + i, (height, mark));
                }
            }
        }
        change
    }

    /// Takes what is new from a sheet that had it before.
    pub fn apply(&mut self, change: &Change) {
        let Place { corner, size } = self.place(change.tile);
        for (cell, (height, mark)) in change.places().zip(&change.cells) {
            let at = (corner[1] + cell / size[0]) * self.columns[0] + corner[0] + cell % size[0];
            if let (Some(h), Some(m)) = (self.heights.get_mut(at), self.marks.get_mut(at)) {
                (*h, *m) = (*height, *mark);
            }
        }
    }

    /// All tiles that are not untouched, as they are.
    pub fn whole(&self) -> Vec<Change> {
        let mut changes = self.as_they_are(|_| true);
        changes.retain(|change| change.cells.iter().any(|cell| *cell != (WHOLE, 0)));
        changes
    }

    /// Some tiles with all their cells.
    pub fn as_they_are(&self, wanted: impl Fn(usize) -> bool) -> Vec<Change> {
        let [across, along] = self.tiles();
        let tiles = (0..across * along).filter(|tile| wanted(*tile));
        let changes = tiles.map(|tile| {
            let mut change = Change::none(tile);
            let Place { size, .. } = self.place(tile);
            for cell in 0..size[0] * size[1] {
                change.add(cell, self.cell(tile, cell));
            }
            change
        });
        changes.collect()
    }

    fn cell(&self, tile: usize, cell: usize) -> (u16, u8) {
        let Place { corner, size } = self.place(tile);
        let at = (corner[1] + cell / size[0]) * self.columns[0] + corner[0] + cell % size[0];
        (
            self.heights.get(at).copied().unwrap_or_default(),
            self.marks.get(at).copied().unwrap_or_default(),
        )
    }

    /// Writes what is new in tiles; it has been applied.
    ///
    /// Count of tiles; for each the count of tiles that are passed over since the one before, the length of what
    /// follows, and that.
    pub fn write(&self, changes: &[Change], out: &mut Vec<u8>) {
        varint(out, changes.len() as u64);
        let mut next = 0;
        for change in changes {
            varint(out, change.tile.saturating_sub(next) as u64);
            next = change.tile + 1;
            let written = self.written(change);
            varint(out, written.len() as u64);
            out.extend_from_slice(&written);
        }
    }

    /// A tile whose cells are all alike: their height and mark. Otherwise which cells are new, unless all are; then the
    /// difference of each height from what its neighbours let expect: low bytes of all, high bytes; and the marks.
    fn written(&self, change: &Change) -> Vec<u8> {
        let Place { corner, size } = self.place(change.tile);
        let count = size[0] * size[1];
        let first = self.cell(change.tile, 0);
        if (1..count).all(|cell| self.cell(change.tile, cell) == first) {
            let [low, high] = first.0.to_le_bytes();
            return vec![ALL_ALIKE, low, high, first.1];
        }
        let mut out = Vec::with_capacity(change.cells.len() * 2 + count / 8 + 1);
        let all = change.cells.len() * 8 > count * 7;
        out.push(if all { ALL_CELLS } else { SOME_CELLS });
        let cells: Vec<usize> = if all {
            (0..count).collect()
        } else {
            let mask = change.mask.iter().flat_map(|bits| bits.to_le_bytes());
            out.extend(mask.chain(std::iter::repeat(0)).take(count.div_ceil(8)));
            change.places().collect()
        };
        let height = |i: usize, j: usize| {
            let at = (corner[1] + j) * self.columns[0] + corner[0] + i;
            i32::from(self.heights.get(at).copied().unwrap_or_default())
        };
        let folded: Vec<u16> = cells
            .iter()
            .map(|cell| {
                let (i, j) = (cell % size[0], cell / size[0]);
                let expected = match (i, j) {
                    (0, 0) => i32::from(WHOLE),
                    (_, 0) => height(i - 1, 0),
                    (0, _) => height(0, j - 1),
                    _ => expected(height(i - 1, j), height(i, j - 1), height(i - 1, j - 1)),
                };
                fold((height(i, j) - expected) as i16)
            })
            .collect();
        out.extend(folded.iter().map(|value| *value as u8));
        out.extend(folded.iter().map(|value| (*value >> 8) as u8));
        out.extend(cells.iter().map(|cell| self.cell(change.tile, *cell).1));
        out
    }
}

impl Change {
    fn none(tile: usize) -> Change {
        Change {
            tile,
            mask: vec![0; TILE * TILE / 64],
            cells: Vec::new(),
        }
    }

    fn add(&mut self, cell: usize, value: (u16, u8)) {
        if let Some(bits) = self.mask.get_mut(cell / 64) {
            *bits |= 1 << (cell % 64);
            self.cells.push(value);
        }
    }

    /// The cells that are new, in their order.
    fn places(&self) -> impl Iterator<Item = usize> {
        (0..).step_by(64).zip(&self.mask).flat_map(|(base, bits)| {
            let mut left = *bits;
            std::iter::from_fn(move || {
                let bit = left.trailing_zeros() as usize;
                left &= left.checked_sub(1)?;
                Some(base + bit)
            })
        })
    }

    /// The same tile with what came later.
    pub fn followed_by(&self, later: &Change) -> Change {
        let mut both = Change::none(self.tile);
        let mut old = self.places().zip(&self.cells).peekable();
        let mut new = later.places().zip(&later.cells).peekable();
        loop {
            let (cell, value) = match (old.peek(), new.peek()) {
                (Some((a, value)), Some((b, _))) if a < b => (*a, **value),
                (Some((a, value)), None) => (*a, **value),
                (_, Some((b, value))) => (*b, **value),
                (None, None) => return both,
            };
            both.add(cell, value);
            old.next_if(|(at, _)| *at == cell);
            new.next_if(|(at, _)| *at == cell);
        }
    }
}

/// What is left is never a hole, what was cut never untouched, however little it is.
fn quantized(height: f32, top: f32, scale: f64) -> u16 {
    if height <= 0.0 {
        0
    } else if height >= top {
        WHOLE
    } else {
        (f64::from(height) * scale)
            .round()
            .clamp(1.0, f64::from(WHOLE) - 1.0) as u16
    }
}

/// What a height is likely to be: on a plane with its neighbours on the left, above and between both, or like one of
/// them where there is a wall.
fn expected(left: i32, above: i32, between: i32) -> i32 {
    if between >= left.max(above) {
        left.min(above)
    } else if between <= left.min(above) {
        left.max(above)
    } else {
        left + above - between
    }
}

fn fold(difference: i16) -> u16 {
    (difference << 1 ^ difference >> 15) as u16
}
