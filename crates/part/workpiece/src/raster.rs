//! Rows of the height map as the inner loops see them: places in a row, borders between its columns.

use std::ops::Range;

use crate::grid::Grid;

/// Most rows that are swept in one go: enough to reckon them side by side, few enough that the work of
/// a batch can be shared out by bands of rows.
pub(crate) const BAND_ROWS: usize = 32;

/// Columns that are cut side by side: a register of AVX2.
pub(crate) const GROUP: usize = 8;

/// Columns farther from the tool than any map is wide.
const FAR: i64 = 1 << 29;

/// What the inner loops need of a track in one row, in the precision of the map.
pub(crate) struct Row {
    /// Centre of the first column, from the lower end.
    pub x: f32,
    pub dx: f32,
    pub ux: f32,
    pub uy: f32,
    /// Share of the row in the coordinate along and across the track.
    pub along: f32,
    pub across: f32,
    pub length: f32,
    pub slope: f32,
    pub low: f32,
}

impl Row {
    /// Place along and across the track of the column number `k`.
    #[inline(always)]
    pub fn place(&self, k: f32) -> [f32; 2] {
        let x = self.x + k * self.dx;
        [x * self.ux + self.along, x * self.uy - self.across]
    }
}

/// Some rows seen from the lower end of a track, reckoned side by side in the precision of the map, from a column near
/// it, so that no digits are lost in a great blank.
pub(crate) struct Raster {
    first_y: f32,
    dy: f32,
    offset: f32,
    per_mm: f32,
}

impl Raster {
    #[inline(always)]
    pub fn new([x, y]: [f64; 2], base: i64, grid: &Grid, rows: &Range<usize>) -> Raster {
        Raster {
            first_y: ((rows.start as f64 + 0.5) * grid.dy - y) as f32,
            dy: grid.dy as f32,
            offset: (x / grid.dx - base as f64) as f32,
            per_mm: (1.0 / grid.dx) as f32,
        }
    }

    /// Place of the row number `k` from the lower end of the track, mm.
    #[inline(always)]
    pub fn y(&self, k: usize) -> f32 {
        self.first_y + k as i32 as f32 * self.dy
    }

    /// The border between columns that is nearest to a place.
    #[inline(always)]
    pub fn column(&self, x: f32) -> i32 {
        nearest(x * self.per_mm + self.offset)
    }
}

/// Columns in some rows, as borders between columns relative to `base`.
#[derive(Clone, Copy)]
pub(crate) struct Borders {
    pub base: i64,
    /// Columns of the map.
    pub count: i64,
    pub start: [i32; BAND_ROWS],
    pub end: [i32; BAND_ROWS],
}

impl Borders {
    #[inline(always)]
    pub fn new(base: i64, grid: &Grid) -> Borders {
        Borders {
            base,
            count: grid.nx as i64,
            start: [0; BAND_ROWS],
            end: [0; BAND_ROWS],
        }
    }

    /// The columns in the row number `k`.
    #[inline(always)]
    pub fn row(&self, k: usize) -> Range<usize> {
        match (self.start.get(k), self.end.get(k)) {
            (Some(start), Some(end)) => self.columns(*start, *end),
            _ => 0..0,
        }
    }

    /// The columns between two borders.
    #[inline(always)]
    pub fn columns(&self, start: i32, end: i32) -> Range<usize> {
        let bound = |border: i32| (self.base + i64::from(border)).clamp(0, self.count) as usize;
        let start = bound(start);
        start..bound(end).max(start)
    }
}

/// Arithmetic of borders, all rows side by side.
impl Borders {
    #[inline(always)]
    pub fn nothing(&self) -> Borders {
        Borders {
            start: [0; BAND_ROWS],
            end: [0; BAND_ROWS],
            ..*self
        }
    }

    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        let mut is_empty = true;
        for k in 0..BAND_ROWS {
            is_empty &= self.start[k] >= self.end[k];
        }
        is_empty
    }

    /// Only the columns of the map.
    #[inline(always)]
    pub fn clip_to_map(&mut self) {
        let border = |of: i64| (of - self.base).clamp(-FAR, FAR) as i32;
        let (first, last) = (border(0), border(self.count));
        for (start, end) in self.start.iter_mut().zip(&mut self.end) {
            *start = (*start).max(first).min(last);
            *end = (*end).max(*start).min(last);
        }
    }

    /// Only the columns that are in `other` too, by `margin` within it.
    #[inline(always)]
    pub fn clip(&mut self, other: &Borders, margin: i32) {
        for k in 0..BAND_ROWS {
            self.start[k] = self.start[k].max(other.start[k] + margin);
            self.end[k] = self.end[k].min(other.end[k] - margin);
        }
    }

    /// Only whole groups of columns.
    #[inline(always)]
    pub fn cut_to_groups(&mut self) {
        for k in 0..BAND_ROWS {
            let length = (self.end[k] - self.start[k]).max(0);
            self.end[k] = self.start[k] + (length & !(GROUP as i32 - 1));
        }
    }

    #[inline(always)]
    pub fn widen(&mut self, margin: i32) {
        for k in 0..BAND_ROWS {
            let margin = if self.start[k] < self.end[k] { margin } else { 0 };
            self.start[k] -= margin;
            self.end[k] += margin;
        }
    }

    /// The columns of both, and those between them.
    #[inline(always)]
    pub fn join(&mut self, other: &Borders) {
        for k in 0..BAND_ROWS {
            let (start, end) = (self.start[k], self.end[k]);
            let (from, to) = (other.start[k], other.end[k]);
            let (is_empty, is_more) = (start >= end, from < to);
            self.start[k] = if is_empty || is_more && from < start {
                from
            } else {
                start
            };
            self.end[k] = if is_empty || is_more && to > end { to } else { end };
        }
    }

    /// What is left and right of the columns `but`; some columns of these as well, so that whole groups go
    /// without leftovers, which are slow. Nowhere under the tool, in `all`, does it harm to look at a column.
    #[inline(always)]
    pub fn without(&self, but: &Borders, all: &Borders) -> [Borders; 2] {
        let whole = |length: i32| (length.max(0) + GROUP as i32 - 1) & !(GROUP as i32 - 1);
        let (mut left, mut right) = (*self, *self);
        for k in 0..BAND_ROWS {
            let (start, end) = (self.start[k], self.end[k]);
            let (from, to) = (but.start[k].max(start), but.end[k].min(end));
            let before = (start + whole(from - start)).min(end);
            let after = (end - whole(end - to)).max(start);
            let is_one = from >= to || before > after;
            let last = (start + whole(end - start)).min(all.end[k]);
            let first = (last - whole(end - start)).max(all.start[k]);
            left.start[k] = if is_one { first.min(start) } else { start };
            left.end[k] = if is_one { last } else { before };
            right.start[k] = if is_one { end } else { after };
        }
        [left, right]
    }
}

/// The nearest whole number, where the base line of x86-64 has no instruction for it: added to such a
/// great number only the whole part is left.
#[inline(always)]
pub(crate) fn nearest(value: f32) -> i32 {
    const GREAT: f32 = 12_582_912.0; // 1.5 * 2^23
    const MOST: f32 = 4_000_000.0;
    let value = if value > -MOST { least(value, MOST) } else { -MOST };
    ((value + GREAT).to_bits() as i32).wrapping_sub(GREAT.to_bits() as i32)
}

// `f32::max` and `f32::min` look after NaN, which costs the inner loops a third of their speed.
#[inline(always)]
pub(crate) fn positive(value: f32) -> f32 {
    if value > 0.0 { value } else { 0.0 }
}

#[inline(always)]
pub(crate) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
