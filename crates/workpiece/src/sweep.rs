//! The swept volume of a tool along a straight line, row by row of the height map.
//!
//! Seen from the tool axis the tool covers a capsule: the track between two end discs. What counts in
//! every column of it is the lowest point of the tool while the tool is over the column. For a flat
//! and a ball end this has a closed form; a corner radius on a slope needs a short bisection.
//!
//! A line swept backward leaves the same material, so everything is reckoned from the lower end.

use std::ops::Range;

use crate::grid::Grid;
use crate::setup::Local;
use crate::tool::{Bottom, Tool};

/// A straight movement of the tool tip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub from: Local,
    pub to: Local,
    pub tool: Tool,
    /// The previous segment left the tool at `from`: what it covers there is cut already.
    pub start_is_cut: bool,
}

/// What is done with the columns under the tool.
pub(crate) trait Sink {
    /// The tool covers the columns `columns` of row `row`; its lowest point over each of them is
    /// `height`, reckoned from the lower face of the blank and never negative.
    fn level(&mut self, row: usize, columns: Range<usize>, height: f32);
    /// As [`Sink::level`] with a height for each column, by its distance from `columns.start`.
    fn shaped(&mut self, row: usize, columns: Range<usize>, height: impl Fn(f32) -> f32);
}

impl Segment {
    /// Rows of the map that the tool covers.
    pub fn rows(&self, grid: &Grid) -> Range<usize> {
        let r = self.tool.radius;
        let low = self.from[1].min(self.to[1]) - r;
        let high = self.from[1].max(self.to[1]) + r;
        centres_between(low, high, grid.dy, grid.ny)
    }

    /// Presents all columns under the tool in the given rows.
    pub fn sweep(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let covered = self.rows(grid);
        let rows = covered.start.max(rows.start)..covered.end.min(rows.end);
        let track = Track::new(self);
        match self.tool.bottom() {
            Bottom::Flat => track.sweep_flat(grid, rows, sink),
            Bottom::Ball => track.sweep_ball(grid, rows, sink),
            Bottom::Torus => track.sweep_torus(grid, rows, sink),
        }
    }
}

/// Indices of the columns (or rows) whose centres lie between two coordinates.
#[inline]
fn centres_between(low: f64, high: f64, step: f64, count: usize) -> Range<usize> {
    let start = first_at_or_above(low / step - 0.5, count);
    let end = count_at_or_below(high / step - 0.5, count);
    start..end.max(start)
}

/// `ceil` as a bounded index. (`f64::ceil` is a library call on the x86-64 base line.)
#[inline]
fn first_at_or_above(value: f64, count: usize) -> usize {
    if value >= count as f64 {
        count
    } else if value > 0.0 {
        let whole = value as i32;
        whole as usize + usize::from(f64::from(whole) < value)
    } else {
        0
    }
}

#[inline]
fn count_at_or_below(value: f64, count: usize) -> usize {
    if value >= count as f64 {
        count
    } else if value >= 0.0 {
        value as i32 as usize + 1
    } else {
        0
    }
}

/// A segment reckoned from its lower end: `u` is the direction to the higher end in the plane.
struct Track {
    low: Local,
    u: [f64; 2],
    length: f64,
    /// Rise along `u`, never negative.
    slope: f64,
    radius: f64,
    corner: f64,
    /// What the tool covers at the lower end is cut already.
    low_is_cut: bool,
    /// Normal of the track's edge with the greater first coordinate.
    right: [f64; 2],
    inverse_u1: f64,
}

/// Tracks shorter than this in the plane are plunges, mm.
const PLUNGE_MM: f64 = 1e-9;

impl Track {
    fn new(segment: &Segment) -> Track {
        let rises = segment.to[2] >= segment.from[2];
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
        let right = if u[1] > 0.0 { [u[1], -u[0]] } else { [-u[1], u[0]] };
        Track {
            low,
            u,
            length,
            slope,
            radius: segment.tool.radius,
            corner: segment.tool.corner,
            low_is_cut: segment.start_is_cut && rises,
            right,
            inverse_u1: 1.0 / u[1],
        }
    }

    /// First and last coordinate of the capsule in the row at `y` (both from the lower end).
    ///
    /// The outermost disc of a side is the one whose edge point has the track's normal there, or the
    /// end disc next to it.
    #[inline]
    fn capsule(&self, y: f64) -> (f64, f64) {
        let (mut at_left, mut at_right) = if self.u[0] > 0.0 {
            (0.0, self.length)
        } else {
            (self.length, 0.0)
        };
        if self.u[1].abs() > 1e-12 {
            let edge = self.radius * self.right[1];
            at_left = ((y + edge) * self.inverse_u1).max(0.0).min(self.length);
            at_right = ((y - edge) * self.inverse_u1).max(0.0).min(self.length);
        }
        let left = at_left * self.u[0] - half_chord(self.radius, y - at_left * self.u[1]);
        let right = at_right * self.u[0] + half_chord(self.radius, y - at_right * self.u[1]);
        (left, right)
    }

    /// Columns between two coordinates that count from the lower end.
    #[inline]
    fn columns(&self, grid: &Grid, left: f64, right: f64) -> Range<usize> {
        centres_between(self.low[0] + left, self.low[0] + right, grid.dx, grid.nx)
    }

    /// A flat end is at the height of the lower end where its disc there covers the column. Elsewhere
    /// it is lowest when it enters the column.
    fn sweep_flat(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let floor = self.low[2].max(0.0) as f32;
        for row in rows {
            let y = (row as f64 + 0.5) * grid.dy - self.low[1];
            let (left, right) = self.capsule(y);
            let all = self.columns(grid, left, right);
            if self.slope == 0.0 && !self.low_is_cut {
                sink.level(row, all, floor);
                continue;
            }
            let mut disc = all.start..all.start;
            if y.abs() < self.radius {
                let half = half_chord(self.radius, y);
                disc = self.columns(grid, -half, half);
                disc = disc.start.clamp(all.start, all.end)..disc.end.clamp(all.start, all.end);
            }
            if !self.low_is_cut {
                sink.level(row, disc.clone(), floor);
            }
            for rest in [all.start..disc.start, disc.end..all.end] {
                if rest.is_empty() {
                    continue;
                }
                if self.slope == 0.0 {
                    sink.level(row, rest, floor);
                } else {
                    let height = self.flat_height(grid, rest.start, y);
                    sink.shaped(row, rest, height);
                }
            }
        }
    }

    fn flat_height(&self, grid: &Grid, first: usize, y: f64) -> impl Fn(f32) -> f32 + use<> {
        let Row {
            x,
            dx,
            ux,
            uy,
            along,
            across,
            length,
            slope,
            low,
        } = self.row(grid, first, y);
        let square = (self.radius * self.radius) as f32;
        move |k| {
            let x = x + k * dx;
            let b = x * uy - across;
            let half = positive(square - b * b).sqrt();
            let s = least(positive(x * ux + along - half), length);
            positive(low + slope * s)
        }
    }

    fn sweep_ball(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let radius = self.radius as f32;
        let square = radius * radius;
        // Sine of the slope: so far behind the axis lies the lowest point of the moving ball.
        let lag = (self.slope / self.slope.hypot(1.0)) as f32;
        for row in rows {
            let y = (row as f64 + 0.5) * grid.dy - self.low[1];
            let columns = self.uncut_columns(grid, y);
            if columns.is_empty() {
                continue;
            }
            let Row {
                x,
                dx,
                ux,
                uy,
                along,
                across,
                length,
                slope,
                low,
            } = self.row(grid, columns.start, y);
            let low = low + radius;
            sink.shaped(row, columns, move |k| {
                let x = x + k * dx;
                let b = x * uy - across;
                let chord = positive(square - b * b);
                let a = x * ux + along;
                let s = least(positive(a - lag * chord.sqrt()), length);
                let e = a - s;
                positive(low + slope * s - positive(chord - e * e).sqrt())
            });
        }
    }

    fn sweep_torus(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let flat = (self.radius - self.corner) as f32;
        let corner = self.corner as f32;
        let square = (self.radius * self.radius) as f32;
        let is_level = self.slope == 0.0;
        for row in rows {
            let y = (row as f64 + 0.5) * grid.dy - self.low[1];
            let columns = self.uncut_columns(grid, y);
            if columns.is_empty() {
                continue;
            }
            let Row {
                x,
                dx,
                ux,
                uy,
                along,
                across,
                length,
                slope,
                low,
            } = self.row(grid, columns.start, y);
            let height = move |b: f32, a: f32, s: f32| {
                let e = a - s;
                let rise = positive((b * b + e * e).sqrt() - flat);
                positive(low + slope * s + corner - positive(corner * corner - rise * rise).sqrt())
            };
            if is_level {
                sink.shaped(row, columns, move |k| {
                    let x = x + k * dx;
                    let a = x * ux + along;
                    height(x * uy - across, a, least(positive(a), length))
                });
            } else {
                sink.shaped(row, columns, move |k| {
                    let x = x + k * dx;
                    let (a, b) = (x * ux + along, x * uy - across);
                    let half = positive(square - b * b).sqrt();
                    let s = lowest_of_torus(a, b, [flat, corner], slope, [a - half, a + half], length);
                    height(b, a, s)
                });
            }
        }
    }

    /// Columns of the row that the tool covers, without those that are nearest to a lower end that is
    /// cut already.
    #[inline]
    fn uncut_columns(&self, grid: &Grid, y: f64) -> Range<usize> {
        let (mut left, mut right) = self.capsule(y);
        if self.low_is_cut {
            let behind = -y * self.u[1];
            if self.u[0] > 0.0 {
                left = left.max(behind / self.u[0]);
            } else if self.u[0] < 0.0 {
                right = right.min(behind / self.u[0]);
            } else if behind >= 0.0 {
                return 0..0;
            }
        }
        self.columns(grid, left, right)
    }

    #[inline]
    fn row(&self, grid: &Grid, first: usize, y: f64) -> Row {
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
struct Row {
    /// Centre of the first column, from the lower end.
    x: f32,
    dx: f32,
    ux: f32,
    uy: f32,
    /// Share of the row in the coordinate along and across the track.
    along: f32,
    across: f32,
    length: f32,
    slope: f32,
    low: f32,
}

/// Where on the track a tool with flat radius and corner radius is lowest over the point (a, b): its
/// height is convex along the track, so the sign of the derivative leads there.
fn lowest_of_torus(a: f32, b: f32, [flat, corner]: [f32; 2], slope: f32, over: [f32; 2], length: f32) -> f32 {
    // Halves 2 * radius to less than a thousandth of a column.
    const STEPS: usize = 20;
    let mut from = least(positive(over[0]), length);
    let mut to = least(positive(over[1]), length);
    for _ in 0..STEPS {
        let s = 0.5 * (from + to);
        let e = a - s;
        let distance = (b * b + e * e).sqrt();
        let rise = distance - flat;
        let rises =
            rise <= 0.0 || slope * distance * positive(corner * corner - rise * rise).sqrt() > rise * e;
        if rises {
            to = s;
        } else {
            from = s;
        }
    }
    0.5 * (from + to)
}

#[inline]
fn half_chord(radius: f64, distance: f64) -> f64 {
    (radius * radius - distance * distance).max(0.0).sqrt()
}

// `f32::max` and `f32::min` look after NaN, which costs the inner loops a third of their speed.
#[inline(always)]
fn positive(value: f32) -> f32 {
    if value > 0.0 { value } else { 0.0 }
}

#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
