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

/// Most rows that are swept in one go: enough to reckon them side by side, few enough that the work of
/// a batch can be shared out by bands of rows.
pub(crate) const BAND_ROWS: usize = 32;

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

    /// Presents all columns under the tool in the given rows, at most [`BAND_ROWS`] of them.
    pub fn sweep(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let covered = self.rows(grid);
        let rows = covered.start.max(rows.start)..covered.end.min(rows.end);
        if rows.is_empty() {
            return;
        }
        let track = Track::new(self);
        match self.tool.bottom() {
            Bottom::Flat => track.sweep_flat(grid, rows, sink),
            Bottom::Ball => track.sweep_ball(grid, rows, sink),
            Bottom::Torus => track.sweep_torus(grid, rows, sink),
            Bottom::Cone => track.sweep_cone(grid, rows, sink, self.tool.cone as f32),
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
    /// The same at the higher end.
    high_is_cut: bool,
}

/// Columns that are cut side by side: two registers of the x86-64 base line.
const GROUP: usize = 8;

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
        Track {
            low,
            u,
            length,
            slope,
            radius: segment.tool.radius,
            corner: segment.tool.corner,
            low_is_cut: segment.start_is_cut && rises,
            high_is_cut: segment.start_is_cut && !rises,
        }
    }

    /// The columns that the tool covers in each of the rows.
    ///
    /// At either side of the capsule the outermost disc is the one whose edge point has the track's
    /// normal there, or the end disc next to it. All rows are reckoned side by side in the precision of
    /// the map, from a column near the lower end, so that no digits are lost in a great blank.
    fn spans(&self, grid: &Grid, rows: &Range<usize>) -> Spans {
        let base = (self.low[0] / grid.dx).floor();
        let offset = (self.low[0] / grid.dx - base) as f32;
        let base = base as i64;
        let per_mm = (1.0 / grid.dx) as f32;
        let (first_y, dy) = (
            ((rows.start as f64 + 0.5) * grid.dy - self.low[1]) as f32,
            grid.dy as f32,
        );
        let [ux, uy] = self.u.map(|u| u as f32);
        let (length, radius) = (self.length as f32, self.radius as f32);
        // Where on the track the outermost disc of the row at y is: y * per_y + left or right.
        let (per_y, at_left, at_right) = if self.u[1].abs() > 1e-9 {
            // Second component of the normal at the right edge.
            let normal = if self.u[1] > 0.0 { -self.u[0] } else { self.u[0] };
            let edge = self.radius * normal / self.u[1];
            ((1.0 / self.u[1]) as f32, edge as f32, -edge as f32)
        } else if self.u[0] > 0.0 {
            (0.0, 0.0, length)
        } else {
            (0.0, length, 0.0)
        };
        let column = |x: f32| nearest(x * per_mm + offset);
        let mut spans = Spans {
            base,
            columns: grid.nx as i64,
            all: [[0; 2]; BAND_ROWS],
            low: [[0; 2]; BAND_ROWS],
        };
        for (k, (all, low)) in spans.all.iter_mut().zip(&mut spans.low).enumerate() {
            let y = first_y + k as i32 as f32 * dy;
            let half_chord = |y: f32| positive((radius - y) * (radius + y)).sqrt();
            let s = least(positive(y * per_y + at_left), length);
            let t = least(positive(y * per_y + at_right), length);
            *all = [
                column(s * ux - half_chord(y - s * uy)),
                column(t * ux + half_chord(y - t * uy)),
            ];
            let half = half_chord(y);
            *low = [column(-half), column(half)];
        }
        spans
    }

    /// A flat end is at the height of the lower end where its disc there covers the column. Elsewhere
    /// it is lowest when it enters the column.
    fn sweep_flat(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let floor = self.low[2].max(0.0) as f32;
        let spans = self.spans(grid, &rows);
        for (k, row) in rows.enumerate() {
            let all = spans.all(k);
            if self.slope == 0.0 && !self.low_is_cut {
                sink.level(row, all, floor);
                continue;
            }
            let low = spans.low(k);
            let low = low.start.clamp(all.start, all.end)..low.end.clamp(all.start, all.end);
            // Some columns more under the disc do no harm, and whole groups go without leftovers.
            let before = (low.start - all.start).next_multiple_of(GROUP);
            let behind = (all.end - low.end).next_multiple_of(GROUP);
            let rest = [
                all.start..(all.start + before).min(low.end),
                all.end.saturating_sub(behind).max(low.start)..all.end,
            ];
            if !self.low_is_cut {
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
        } = row;
        let radius = self.radius as f32;
        move |k| {
            let x = x + k * dx;
            let b = x * uy - across;
            let half = positive((radius - b) * (radius + b)).sqrt();
            let s = least(positive(x * ux + along - half), length);
            positive(low + slope * s)
        }
    }

    fn sweep_ball(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink) {
        let radius = self.radius as f32;
        // Sine of the slope: so far behind the axis lies the lowest point of the moving ball.
        let lag = (self.slope / self.slope.hypot(1.0)) as f32;
        let spans = self.spans(grid, &rows);
        for (k, row) in rows.enumerate() {
            let columns = self.uncut(grid, spans.all(k), row);
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
            } = self.row(grid, columns.start, row);
            let low = low + radius;
            sink.shaped(row, columns, move |k| {
                let x = x + k * dx;
                let b = x * uy - across;
                let chord = positive((radius - b) * (radius + b));
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
        let radius = self.radius as f32;
        let leads = (self.slope > 0.0).then(|| Leads::new(flat, corner, self.slope as f32));
        let spans = self.spans(grid, &rows);
        for (k, row) in rows.enumerate() {
            let columns = self.uncut(grid, spans.all(k), row);
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
            } = self.row(grid, columns.start, row);
            let height = move |a: f32, b: f32, lead: f32| {
                let s = least(positive(a - lead), length);
                let e = a - s;
                let rise = positive((b * b + e * e).sqrt() - flat);
                positive(low + slope * s + corner - positive((corner - rise) * (corner + rise)).sqrt())
            };
            match &leads {
                None => sink.shaped(row, columns, move |k| {
                    let x = x + k * dx;
                    height(x * ux + along, x * uy - across, 0.0)
                }),
                Some(leads) => sink.shaped(row, columns, move |k| {
                    let x = x + k * dx;
                    let b = x * uy - across;
                    let chord = positive((radius - b) * (radius + b)).sqrt();
                    height(x * ux + along, b, leads.at(chord / radius))
                }),
            }
        }
    }

    /// The point of a drill rises by `rise` for each mm from its axis. On a slope it is touched before its axis,
    /// where the cone rises along the track as the slope does; on a steeper slope at its edge.
    fn sweep_cone(&self, grid: &Grid, rows: Range<usize>, sink: &mut impl Sink, rise: f32) {
        let radius = self.radius as f32;
        let sine = self.slope as f32 / rise;
        let lead = (sine < 1.0).then(|| sine / ((1.0 - sine) * (1.0 + sine)).sqrt());
        let spans = self.spans(grid, &rows);
        for (k, row) in rows.enumerate() {
            let columns = spans.all(k);
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
            } = self.row(grid, columns.start, row);
            sink.shaped(row, columns, move |k| {
                let x = x + k * dx;
                let b = x * uy - across;
                let a = x * ux + along;
                let chord = positive((radius - b) * (radius + b)).sqrt();
                let ahead = lead.map_or(chord, |lead| least(lead * b.abs(), chord));
                let s = least(positive(a - ahead), length);
                let e = a - s;
                positive(low + slope * s + rise * (b * b + e * e).sqrt())
            });
        }
    }

    /// Without the columns over which a round tool was lowest at an end that is cut already: those
    /// behind the lower end, and those so far behind the higher end that the tool, which touches a
    /// slope before its axis, leads no more.
    fn uncut(&self, grid: &Grid, columns: Range<usize>, row: usize) -> Range<usize> {
        let Range { mut start, mut end } = columns;
        let [ux, uy] = self.u;
        if ux.abs() > 1e-6 {
            let y = (row as f64 + 0.5) * grid.dy - self.low[1];
            // The column in which the coordinate along the track has a value.
            let column = |along: f64| (((along - y * uy) / ux + self.low[0]) / grid.dx) as usize;
            let after = |along: f64| column(along).saturating_add(1);
            if self.low_is_cut {
                (start, end) = if ux > 0.0 {
                    (start.max(column(0.0)), end)
                } else {
                    (start, end.min(after(0.0)))
                };
            }
            if self.high_is_cut {
                let sine = self.slope / self.slope.hypot(1.0);
                let lead = self.length + self.radius - self.corner + self.corner * sine;
                (start, end) = if ux > 0.0 {
                    (start, end.min(after(lead)))
                } else {
                    (start.max(column(lead)), end)
                };
            }
        }
        start..end.max(start)
    }

    #[inline]
    fn row(&self, grid: &Grid, first: usize, row: usize) -> Row {
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

/// How far before its axis a tool with a corner radius touches what it leaves on a slope, by the
/// distance across the track.
///
/// The bottom of the moving tool is touched where its normal is perpendicular to the movement. At the
/// angle `p` from the track the point of the corner with the tangent `slope / cos p` is such a point:
/// `(flat + corner * sin) * cos p` before the axis and `(flat + corner * sin) * sin p` beside it. The
/// height that follows from the place has its minimum there, so a small error of the place does not
/// count.
struct Leads {
    /// By equal steps of the half chord as part of the radius, which straightens the curve.
    leads: [f32; Leads::COUNT + 1],
}

impl Leads {
    const COUNT: usize = 64;

    fn new(flat: f32, corner: f32, slope: f32) -> Leads {
        let radius = flat + corner;
        let point = |k: usize| {
            let cos = 1.0 - k as f32 / Leads::COUNT as f32;
            let sine = slope / (slope * slope + cos * cos).sqrt();
            let r = flat + corner * sine;
            let beside = r * (1.0 - cos * cos).sqrt();
            let chord = positive((radius - beside) * (radius + beside)).sqrt() / radius;
            (chord, r * cos)
        };
        let mut leads = [0.0; Leads::COUNT + 1];
        let (mut near, mut far, mut next) = (point(0), point(1), 1);
        for (k, lead) in leads.iter_mut().enumerate().rev() {
            let chord = k as f32 / Leads::COUNT as f32;
            while far.0 > chord && next < Leads::COUNT {
                next += 1;
                (near, far) = (far, point(next));
            }
            let share = if near.0 > far.0 {
                (near.0 - chord) / (near.0 - far.0)
            } else {
                0.0
            };
            *lead = near.1 + (far.1 - near.1) * least(positive(share), 1.0);
        }
        Leads { leads }
    }

    #[inline]
    fn at(&self, chord: f32) -> f32 {
        let place = chord * Leads::COUNT as f32;
        // A cast that needs no care for what does not fit; the place is between 0 and COUNT.
        let k = (place as i32 as usize).min(Leads::COUNT - 1);
        let (a, b) = (self.leads[k], self.leads[k + 1]);
        a + (b - a) * (place - k as f32)
    }
}

/// The columns under the tool in some rows, as borders between columns relative to `base`.
struct Spans {
    base: i64,
    /// Columns of the map.
    columns: i64,
    /// Under the whole capsule.
    all: [[i32; 2]; BAND_ROWS],
    /// Under the disc at the lower end.
    low: [[i32; 2]; BAND_ROWS],
}

impl Spans {
    fn all(&self, k: usize) -> Range<usize> {
        self.range(self.all.get(k))
    }

    fn low(&self, k: usize) -> Range<usize> {
        self.range(self.low.get(k))
    }

    #[inline]
    fn range(&self, span: Option<&[i32; 2]>) -> Range<usize> {
        let Some([start, end]) = span else { return 0..0 };
        let bound = |border: &i32| (self.base + i64::from(*border)).clamp(0, self.columns) as usize;
        let start = bound(start);
        start..bound(end).max(start)
    }
}

/// The nearest whole number, where the base line of x86-64 has no instruction for it: added to such a
/// great number only the whole part is left.
#[inline(always)]
fn nearest(value: f32) -> i32 {
    const GREAT: f32 = 12_582_912.0; // 1.5 * 2^23
    const MOST: f32 = 4_000_000.0;
    let value = if value > -MOST { least(value, MOST) } else { -MOST };
    ((value + GREAT).to_bits() as i32).wrapping_sub(GREAT.to_bits() as i32)
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
