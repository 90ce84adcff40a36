//! A straight movement of the tool as the height map sees it.
//!
//! Seen from the tool axis the tool covers a capsule: the track between two end discs. A line swept backward leaves
//! the same material, so everything is reckoned from the lower end.

use std::ops::Range;

use pulp::Simd;

use crate::grid::Grid;
use crate::leads::Leads;
use crate::raster::{BAND_ROWS, Borders, GROUP, Raster, Row, least, positive};
use crate::setup::Local;
use crate::tool::{Bottom, Tool};

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
    /// It did not cut there.
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
    /// As [`Sink::shaped`] for at most [`GROUP`] columns; what is beyond the last column is not used.
    fn group<S: Simd>(&mut self, simd: S, row: usize, columns: Range<usize>, heights: [f32; GROUP]);
}

/// A sink that looks at one column after the other, however their heights come.
pub(crate) trait ColumnByColumn {
    /// The columns `columns` of row `row` with their heights, which may be more than there are columns.
    fn each(&mut self, row: usize, columns: Range<usize>, heights: impl Iterator<Item = f32>);
}

impl<T: ColumnByColumn> Sink for T {
    fn level(&mut self, row: usize, columns: Range<usize>, height: f32) {
        self.each(row, columns, std::iter::repeat(height));
    }

    fn shaped(&mut self, row: usize, columns: Range<usize>, height: impl Fn(f32) -> f32) {
        self.each(row, columns, (0..).map(|k| height(k as f32)));
    }

    fn group<S: Simd>(&mut self, _: S, row: usize, columns: Range<usize>, heights: [f32; GROUP]) {
        self.each(row, columns, heights.into_iter());
    }
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
    pub(crate) low: Local,
    pub(crate) u: [f64; 2],
    pub(crate) length: f64,
    /// Rise along `u`, never negative.
    pub(crate) slope: f64,
    pub(crate) tool: Tool,
    pub(crate) low_end: End,
    pub(crate) high_end: End,
    /// Where a corner radius touches the slope.
    pub(crate) leads: Option<Box<Leads>>,
    /// How far the columns of a group lie along and across the track from the first one. Kept here, so that the inner
    /// loops load them: values known there are folded column by column, which spoils the groups.
    pub(crate) lanes: [[f32; GROUP]; 2],
}

/// Who cuts what is under the tool at an end of a track and nowhere lower on the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The track whose end it is.
    Own,
    /// The track before or after it.
    Other,
    /// The track before it, up to where that one ends.
    Shared,
}

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
            let columns = [u[1] * grid.dx, grid.dx].map(|value| value as f32);
            Box::new(Leads::new(bottom, slope as f32, length as f32, columns))
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
            lanes: u.map(|u| std::array::from_fn(|n| n as i32 as f32 * (u * grid.dx) as f32)),
        }
    }

    /// The columns that the tool covers in each of the rows.
    ///
    /// At either side of the capsule the outermost disc is the one whose edge point has the track's
    /// normal there, or the end disc next to it.
    #[inline(always)]
    pub(crate) fn spans(&self, grid: &Grid, rows: &Range<usize>) -> Spans {
        let base = (self.low[0] / grid.dx).floor() as i64;
        let raster = Raster::new([self.low[0], self.low[1]], base, grid, rows);
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

    /// Presents the columns of some parts of the rows with the heights that `shape` gives a row.
    #[inline(always)]
    pub(crate) fn present<Height: Fn(f32) -> f32>(
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

    #[inline(always)]
    pub(crate) fn row(&self, grid: &Grid, first: usize, row: usize) -> Row {
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

/// The columns under the tool in some rows.
pub(crate) struct Spans {
    /// Under the whole capsule.
    pub all: Borders,
    /// Under the disc at the lower end.
    pub low: Borders,
}
