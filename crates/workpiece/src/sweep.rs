//! The swept volume of a tool along a straight line, row by row of the height map.
//!
//! Seen from the tool axis the tool covers a capsule: the track between two end discs. What counts in
//! every column of it is the lowest point of the tool while the tool is over the column. For a flat
//! end and a cone this has a closed form; [`crate::round`] reckons the tools with a corner radius.
//!
//! A line swept backward leaves the same material, so everything is reckoned from the lower end.

use std::ops::Range;

use crate::grid::Grid;
use crate::round::Leads;
use crate::setup::Local;
use crate::tool::{Bottom, Tool};

/// Most rows that are swept in one go: enough to reckon them side by side, few enough that the work of
/// a batch can be shared out by bands of rows.
pub(crate) const BAND_ROWS: usize = 32;

/// A straight movement of the tool tip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub from: Local,
    pub to: Local,
    pub tool: Tool,
    pub start: Start,
    /// The next segment sees to what the tool covers at `to` and this one covers nowhere lower.
    pub followed: bool,
}

/// What the previous segment did where this one starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// Nothing.
    Uncut,
    /// It left the tool there: what the tool covers is cut.
    Cut,
    /// It left the tool there and is followed: it cut what it covers before its end.
    Shared,
}

/// What is done with the columns under the tool.
pub(crate) trait Sink {
    /// The tool covers the columns `columns` of row `row`; its lowest point over each of them is
    /// `height`, reckoned from the lower face of the blank and never negative.
    fn level(&mut self, row: usize, columns: Range<usize>, height: f32);
    /// As [`Sink::level`] with a height for each column, by its distance from `columns.start`.
    fn shaped(&mut self, row: usize, columns: Range<usize>, height: impl Fn(f32) -> f32);
    /// As [`Sink::level`] with a list of heights.
    fn listed(&mut self, row: usize, columns: Range<usize>, heights: &[f32]);
}

impl Segment {
    /// Rows of the map that the tool covers.
    pub fn rows(&self, grid: &Grid) -> Range<usize> {
        let r = self.tool.radius;
        let low = self.from[1].min(self.to[1]) - r;
        let high = self.from[1].max(self.to[1]) + r;
        centres_between(low, high, grid.dy, grid.ny)
    }

    /// As [`Segment::rows`], of some rows.
    pub fn rows_in(&self, grid: &Grid, rows: &Range<usize>) -> Range<usize> {
        let covered = self.rows(grid);
        let start = covered.start.max(rows.start);
        start..covered.end.min(rows.end).max(start)
    }

    /// Whether the tool rises; a level movement does so as well.
    fn rises(&self) -> bool {
        self.to[2] >= self.from[2]
    }

    /// Shares what the tool covers where this segment ends and the next one starts between the two, so that
    /// neither looks at what the other one cuts lower: for round tools that go on upward or downward.
    pub fn share_end(&mut self, next: &mut Segment) {
        let travels = |of: &Segment| (of.to[0] - of.from[0]).hypot(of.to[1] - of.from[1]) > PLUNGE_MM;
        let is_round = matches!(self.tool.bottom(), Bottom::Ball | Bottom::Torus);
        if is_round
            && self.tool == next.tool
            && self.to == next.from
            && self.rises() == next.rises()
            && travels(self)
            && travels(next)
        {
            self.followed = true;
            next.start = Start::Shared;
        }
    }
}

/// Indices of the rows whose centres lie between two coordinates.
fn centres_between(low: f64, high: f64, step: f64, count: usize) -> Range<usize> {
    // Casts of floating point numbers saturate, also for what is not a number.
    let start = ((low / step - 0.5).ceil() as usize).min(count);
    let end = ((high / step + 0.5).floor() as usize).min(count);
    start..end.max(start)
}

/// A segment reckoned from its lower end: `u` is the direction to the higher end in the plane.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    pub(super) low: Local,
    pub(super) u: [f64; 2],
    pub(super) length: f64,
    /// Rise along `u`, never negative.
    pub(super) slope: f64,
    pub(super) tool: Tool,
    pub(super) low_end: End,
    pub(super) high_end: End,
    /// Where a corner radius touches the slope.
    pub(super) leads: Option<Box<Leads>>,
}

/// Who cuts what is under the tool at an end of a track and nowhere lower on the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// The track itself.
    Own,
    /// The track before or behind it.
    Other,
    /// The track before it, up to where that one ends.
    Shared,
}

/// Columns that are cut side by side: two registers of the x86-64 base line.
const GROUP: usize = 8;

/// Tracks shorter than this in the plane are plunges, mm.
const PLUNGE_MM: f64 = 1e-9;

impl Track {
    pub fn new(segment: &Segment, grid: &Grid) -> Track {
        let rises = segment.rises();
        let (low, high) = if rises {
            (segment.from, segment.to)
        } else {
            (segment.to, segment.from)
        };
        let delta = [high[0] - low[0], high[1] - low[1]];
        let length = delta[0].hypot(delta[1]);
        let (u, length, slope) = if length > PLUNGE_MM {
            (
                [delta[0] / length, delta[1] / length],
                length,
                (high[2] - low[2]) / length,
            )
        } else {
            ([1.0, 0.0], 0.0, 0.0)
        };
        let tool = segment.tool;
        let start = match segment.start {
            Start::Uncut => End::Own,
            Start::Cut => End::Other,
            Start::Shared => End::Shared,
        };
        let end = if segment.followed { End::Other } else { End::Own };
        let (low_end, high_end) = if rises { (start, end) } else { (end, start) };
        let leads = (tool.bottom() == Bottom::Torus && slope > 0.0).then(|| {
            let bottom = [tool.flat(), tool.corner].map(|value| value as f32);
            let step = u[1] * grid.dx;
            Box::new(Leads::new(bottom, slope as f32, length as f32, step as f32))
        });
        Track {
            low,
            u,
            length,
            slope,
            tool,
            low_end,
            high_end,
            leads,
        }
    }

    /// Presents all columns under the tool in the given rows, at most [`BAND_ROWS`] of them. Where the track
    /// shares an end with the one before it, that is wanted too.
    pub fn sweep(&self, before: Option<&Track>, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        if rows.is_empty() {
            return;
        }
        match self.tool.bottom() {
            Bottom::Flat => self.sweep_flat(grid, rows, sink),
            Bottom::Ball => self.sweep_ball(before, grid, rows, sink),
            Bottom::Torus => self.sweep_torus(before, grid, rows, sink),
            Bottom::Cone => self.sweep_cone(grid, rows, sink, self.tool.cone as f32),
        }
    }

    /// The columns that the tool covers in each of the rows.
    ///
    /// At either side of the capsule the outermost disc is the one whose edge point has the track's
    /// normal there, or the end disc next to it.
    pub(super) fn spans(&self, grid: &Grid, rows: &Range<usize>) -> Spans {
        let base = (self.low[0] / grid.dx).floor() as i64;
        let raster = Raster::new(self, base, grid, rows);
        let [ux, uy] = self.u.map(|u| u as f32);
        let (length, radius) = (self.length as f32, self.tool.radius as f32);
        // Where on the track the outermost disc of the row at y is: y * per_y + left or right.
        let (per_y, at_left, at_right) = if self.u[1].abs() > 1e-9 {
            // Second component of the normal at the right edge.
            let normal = if self.u[1] > 0.0 { -self.u[0] } else { self.u[0] };
            let edge = self.tool.radius * normal / self.u[1];
            ((1.0 / self.u[1]) as f32, edge as f32, -edge as f32)
        } else if self.u[0] > 0.0 {
            (0.0, 0.0, length)
        } else {
            (0.0, length, 0.0)
        };
        let mut spans = Spans {
            all: Borders::new(base, grid),
            low: Borders::new(base, grid),
        };
        for k in 0..BAND_ROWS {
            let y = raster.y(k);
            let half_chord = |y: f32| positive((radius - y) * (radius + y)).sqrt();
            let s = least(positive(y * per_y + at_left), length);
            let t = least(positive(y * per_y + at_right), length);
            spans.all.start[k] = raster.column(s * ux - half_chord(y - s * uy));
            spans.all.end[k] = raster.column(t * ux + half_chord(y - t * uy));
            let half = half_chord(y);
            spans.low.start[k] = raster.column(-half);
            spans.low.end[k] = raster.column(half);
        }
        spans
    }

    /// A flat end is at the height of the lower end where its disc there covers the column. Elsewhere
    /// it is lowest when it enters the column.
    fn sweep_flat(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let floor = self.low[2].max(0.0) as f32;
        let low_is_cut = self.low_end != End::Own;
        let spans = self.spans(grid, &rows);
        for (k, row) in rows.enumerate() {
            let all = spans.all.row(k);
            if self.slope == 0.0 && !low_is_cut {
                sink.level(row, all, floor);
                continue;
            }
            let low = spans.low.row(k);
            let low = low.start.clamp(all.start, all.end)..low.end.clamp(all.start, all.end);
            // Some columns more under the disc do no harm, and whole groups go without leftovers.
            let before = (low.start - all.start).next_multiple_of(GROUP);
            let behind = (all.end - low.end).next_multiple_of(GROUP);
            let rest = [
                all.start..(all.start + before).min(low.end),
                all.end.saturating_sub(behind).max(low.start)..all.end,
            ];
            if !low_is_cut {
                sink.level(row, low, floor);
            }
            for columns in rest {
                if self.slope == 0.0 {
                    sink.level(row, columns, floor);
                } else if !columns.is_empty() {
                    let height = self.flat_height(self.row(grid, columns.start, row));
                    sink.shaped(row, columns, height);
                }
            }
        }
    }

    fn flat_height(&self, row: Row) -> impl Fn(f32) -> f32 + use<> {
        let radius = self.tool.radius as f32;
        move |k| {
            let [a, b] = row.place(k);
            let half = positive((radius - b) * (radius + b)).sqrt();
            let s = least(positive(a - half), row.length);
            positive(row.low + row.slope * s)
        }
    }

    /// The point of a drill rises by `rise` for each mm from its axis. On a slope it is touched before its axis,
    /// where the cone rises along the track as the slope does; on a steeper slope at its edge.
    fn sweep_cone(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink, rise: f32) {
        let radius = self.tool.radius as f32;
        let sine = self.slope as f32 / rise;
        let lead = (sine < 1.0).then(|| sine / ((1.0 - sine) * (1.0 + sine)).sqrt());
        let spans = self.spans(grid, &rows);
        self.present(&[spans.all], grid, rows, sink, |row| {
            move |k| {
                let [a, b] = row.place(k);
                let chord = positive((radius - b) * (radius + b)).sqrt();
                let ahead = lead.map_or(chord, |lead| least(lead * b.abs(), chord));
                let s = least(positive(a - ahead), row.length);
                let e = a - s;
                positive(row.low + row.slope * s + rise * (b * b + e * e).sqrt())
            }
        });
    }

    /// Presents the columns of some parts of the rows with the heights that `shape` gives a row.
    #[inline(always)]
    pub(super) fn present<Height: Fn(f32) -> f32>(
        &self,
        parts: &[Borders],
        grid: &Grid,
        rows: Range<usize>,
        sink: &mut impl Sink,
        shape: impl Fn(Row) -> Height,
    ) {
        for (k, row) in rows.enumerate() {
            for columns in parts.iter().map(|part| part.row(k)) {
                if !columns.is_empty() {
                    let height = shape(self.row(grid, columns.start, row));
                    sink.shaped(row, columns, height);
                }
            }
        }
    }

    #[inline]
    pub(super) fn row(&self, grid: &Grid, first: usize, row: usize) -> Row {
        let y = (row as f64 + 0.5) * grid.dy - self.low[1];
        Row {
            x: ((first as f64 + 0.5) * grid.dx - self.low[0]) as f32,
            dx: grid.dx as f32,
            ux: self.u[0] as f32,
            uy: self.u[1] as f32,
            along: (y * self.u[1]) as f32,
            across: (y * self.u[0]) as f32,
            length: self.length as f32,
            slope: self.slope as f32,
            low: self.low[2] as f32,
        }
    }
}

/// What the inner loops need of a track in one row, in the precision of the map.
pub(super) struct Row {
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

/// Some rows seen from a track, reckoned side by side in the precision of the map, from a column near its lower end,
/// so that no digits are lost in a great blank.
pub(super) struct Raster {
    first_y: f32,
    dy: f32,
    offset: f32,
    per_mm: f32,
}

impl Raster {
    pub fn new(track: &Track, base: i64, grid: &Grid, rows: &Range<usize>) -> Raster {
        Raster {
            first_y: ((rows.start as f64 + 0.5) * grid.dy - track.low[1]) as f32,
            dy: grid.dy as f32,
            offset: (track.low[0] / grid.dx - base as f64) as f32,
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

/// The columns under the tool in some rows.
pub(super) struct Spans {
    /// Under the whole capsule.
    pub all: Borders,
    /// Under the disc at the lower end.
    low: Borders,
}

/// Columns in some rows, as borders between columns relative to `base`.
#[derive(Clone, Copy)]
pub(super) struct Borders {
    pub base: i64,
    /// Columns of the map.
    pub columns: i64,
    pub start: [i32; BAND_ROWS],
    pub end: [i32; BAND_ROWS],
}

impl Borders {
    pub fn new(base: i64, grid: &Grid) -> Borders {
        Borders {
            base,
            columns: grid.nx as i64,
            start: [0; BAND_ROWS],
            end: [0; BAND_ROWS],
        }
    }

    /// The columns in the row number `k`.
    #[inline]
    pub fn row(&self, k: usize) -> Range<usize> {
        let (Some(start), Some(end)) = (self.start.get(k), self.end.get(k)) else {
            return 0..0;
        };
        let bound = |border: &i32| (self.base + i64::from(*border)).clamp(0, self.columns) as usize;
        let start = bound(start);
        start..bound(end).max(start)
    }
}

/// The nearest whole number, where the base line of x86-64 has no instruction for it: added to such a
/// great number only the whole part is left.
#[inline(always)]
pub(super) fn nearest(value: f32) -> i32 {
    const GREAT: f32 = 12_582_912.0; // 1.5 * 2^23
    const MOST: f32 = 4_000_000.0;
    let value = if value > -MOST { least(value, MOST) } else { -MOST };
    ((value + GREAT).to_bits() as i32).wrapping_sub(GREAT.to_bits() as i32)
}

// `f32::max` and `f32::min` look after NaN, which costs the inner loops a third of their speed.
#[inline(always)]
pub(super) fn positive(value: f32) -> f32 {
    if value > 0.0 { value } else { 0.0 }
}

#[inline(always)]
pub(super) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
