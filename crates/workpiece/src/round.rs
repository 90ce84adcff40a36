//! The swept volume of tools with a corner radius.
//!
//! On a slope such a tool touches what it leaves before its axis: the track of the columns over which it is
//! lowest at one place of the tool is a curve before the axis, and while the tool travels from one end
//! to the other the curve sweeps the columns that belong to the track alone. What lies behind the curve at
//! the lower end, or before the one at the higher end, belongs to an end; where another track starts
//! or ends there it is lower still over all of it but a wedge. So of a chain of short tracks each
//! looks at no more than a strip as long as itself.

use std::ops::Range;

use crate::grid::Grid;
use crate::leads::{FLATTEST, Spacing, between, half_chord};
use crate::raster::{BAND_ROWS, Borders, GROUP, Raster, Row, least, positive};
use crate::track::{End, Sink, Track};

/// The half of an ellipse before a place on the track, and the strip behind it: `ahead` long, `beside` to
/// either side, mm.
#[derive(Clone, Copy, Debug)]
struct Cap {
    ahead: f64,
    beside: f64,
}

impl Track {
    #[inline(always)]
    pub(super) fn sweep_ball(
        &self,
        before: Option<&Track>,
        grid: &Grid,
        rows: Range<usize>,
        sink: &mut impl Sink,
    ) {
        let radius = self.tool.radius as f32;
        // Sine of the slope: so far before the axis lies the lowest point of the moving ball.
        let lag = self.sine() as f32;
        let wanted = self.wanted(before, grid, &rows);
        self.present(&wanted, grid, rows, sink, |row| {
            move |k| {
                let [a, b] = row.place(k);
                let chord = positive((radius - b) * (radius + b));
                let s = least(positive(a - lag * chord.sqrt()), row.length);
                let e = a - s;
                positive(row.low + radius + row.slope * s - positive(chord - e * e).sqrt())
            }
        });
    }

    #[inline(always)]
    pub(super) fn sweep_torus(
        &self,
        before: Option<&Track>,
        grid: &Grid,
        rows: Range<usize>,
        sink: &mut impl Sink,
    ) {
        let wanted = self.wanted(before, grid, &rows);
        for (k, row) in rows.enumerate() {
            for columns in wanted.iter().map(|part| part.row(k)) {
                if columns.is_empty() {
                    continue;
                }
                let middle = self.middle(grid, row, &columns);
                let middle = middle.unwrap_or(columns.end..columns.end);
                for ends in [columns.start..middle.start, middle.end..columns.end] {
                    self.sweep_ends(grid, row, ends, sink);
                }
                self.sweep_middle(grid, row, middle, sink);
            }
        }
    }

    /// Columns of a row that may be touched anywhere on the track.
    #[inline(always)]
    fn sweep_ends(&self, grid: &Grid, at: usize, columns: Range<usize>, sink: &mut impl Sink) {
        if columns.is_empty() {
            return;
        }
        let row = &self.row(grid, columns.start, at);
        let bottom = [self.tool.flat(), self.tool.corner].map(|value| value as f32);
        let Some(leads) = &self.leads else {
            return sink.grouped(at, columns, |k| end_group(row, bottom, k, [0.0; GROUP]));
        };
        match leads.spacing {
            Spacing::Fine(most) => {
                for first in columns.clone().step_by(most) {
                    let columns = first..columns.end.min(first + most);
                    let row = &self.row(grid, first, at);
                    let [part, change] = leads.line(row, columns.len());
                    sink.grouped(at, columns, |k| {
                        let mut parts = [0.0; GROUP];
                        for (n, part_here) in parts.iter_mut().enumerate() {
                            *part_here = part + change * (k as i32 as f32 + n as i32 as f32);
                        }
                        end_group(row, bottom, k, parts)
                    });
                }
            }
            Spacing::Equal => {
                let near = leads.parts_of(row);
                sink.grouped(at, columns, |k| end_group(row, bottom, k, near.equal(k)));
            }
            Spacing::Coarse(places) => {
                let near = leads.parts_of(row);
                sink.grouped(at, columns, |k| end_group(row, bottom, k, near.coarse(k, places)));
            }
        }
    }

    /// The columns of a row that are touched surely between the ends of the track: there the height is that of
    /// the axis and a share that depends on the place across the track alone.
    #[inline(always)]
    fn middle(&self, grid: &Grid, row: usize, columns: &Range<usize>) -> Option<Range<usize>> {
        let leads = self.leads.as_ref().filter(|leads| leads.is_long)?;
        let Row { dx, ux, uy, .. } = self.row(grid, columns.start, row);
        let [a, b] = self.row(grid, columns.start, row).place(0.0);
        let beside = if uy == 0.0 {
            self.tool.radius as f32
        } else {
            leads.beside()?
        };
        let along = between(a, dx * ux, leads.longest()..self.length as f32);
        let across = between(b, dx * uy, -beside..beside);
        let first = along[0].max(across[0]).clamp(0.0, columns.len() as f32);
        let end = along[1].min(across[1]).clamp(first, columns.len() as f32);
        // Whole groups before and behind it, since leftovers are slow.
        let start = columns.start + (first as usize).next_multiple_of(GROUP);
        let behind = (columns.len() - end as usize).next_multiple_of(GROUP);
        let end = columns.end.saturating_sub(behind);
        (end >= start + GROUP).then_some(start..end)
    }

    #[inline(always)]
    fn sweep_middle(&self, grid: &Grid, at: usize, columns: Range<usize>, sink: &mut impl Sink) {
        let Some(leads) = self.leads.as_ref().filter(|_| !columns.is_empty()) else {
            return;
        };
        let row = &self.row(grid, columns.start, at);
        if row.uy == 0.0 {
            let share = leads.height_at(row.place(0.0)[1]);
            sink.grouped(at, columns, |k| middle_group(row, k, [share; GROUP]));
        } else {
            let near = leads.heights_of(row);
            let weights = near.weights();
            sink.grouped(at, columns, |k| middle_group(row, k, near.curved(k, &weights)));
        }
    }

    /// Sine of the slope.
    #[inline(always)]
    fn sine(&self) -> f64 {
        self.slope / (self.slope * self.slope + 1.0).sqrt()
    }

    /// A cap that holds the curve of the columns that are touched.
    #[inline(always)]
    fn outer(&self) -> Cap {
        let radius = self.tool.radius;
        let share = match &self.leads {
            Some(leads) => f64::from(leads.most),
            None => self.sine() * self.tool.corner / radius,
        };
        Cap {
            ahead: share.max(f64::from(FLATTEST)) * radius,
            beside: radius,
        }
    }

    /// Caps within that curve: either of them.
    #[inline(always)]
    fn inner(&self) -> (Cap, Option<Cap>) {
        let radius = self.tool.radius;
        match &self.leads {
            Some(leads) => {
                let middle = self.tool.flat() + self.tool.corner * self.sine();
                let cap = Cap {
                    ahead: f64::from(leads.least).max(f64::from(FLATTEST)) * radius,
                    beside: radius,
                };
                let disc = Cap {
                    ahead: middle,
                    beside: middle,
                };
                (cap, Some(disc))
            }
            None => (self.outer(), None),
        }
    }

    /// The columns that the cap at a place of the track holds, in each of the rows, side by side as in
    /// [`Track::spans`].
    #[inline(always)]
    fn behind(&self, place: f64, cap: Cap, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        let raster = Raster::new([self.low[0], self.low[1]], base, grid, rows);
        let [ux, uy] = self.u.map(|u| u as f32);
        let (place, beside) = (place as f32, cap.beside as f32);
        // The ellipse as a circle: lengths along the track are stretched.
        let stretch = (cap.beside / cap.ahead) as f32;
        let step = [ux * stretch, uy];
        let per_step = 1.0 / (step[0] * step[0] + step[1] * step[1]);
        // The sides of the strip: x = y * per_y -+ side.
        const PARALLEL: f32 = 1e-6;
        let steep = if uy.abs() > PARALLEL {
            uy
        } else {
            PARALLEL.copysign(uy)
        };
        let (per_y, side) = (ux / steep, beside / steep.abs());
        const NOWHERE: f32 = 1e6;
        let mut borders = Borders::new(base, grid);
        for (k, (start, end)) in borders.start.iter_mut().zip(&mut borders.end).enumerate() {
            let y = raster.y(k);
            let (p, q) = ((y * uy - place) * stretch, -y * ux);
            let cross = step[0] * q - step[1] * p;
            let inside = beside * beside / per_step - cross * cross;
            let middle = -(step[0] * p + step[1] * q) * per_step;
            let half = if inside > 0.0 {
                inside.sqrt() * per_step
            } else {
                -NOWHERE
            };
            let (left, right) = (y * per_y - side, y * per_y + side);
            let is_strip = |x: f32| x * ux + y * uy <= place;
            *start = raster.column(if is_strip(left) { left } else { middle - half });
            *end = raster.column(if is_strip(right) { right } else { middle + half });
        }
        borders
    }

    /// The columns that are lowest behind the lower end: at least these.
    #[inline(always)]
    fn behind_low(&self, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        let (first, second) = self.inner();
        let mut borders = self.behind(0.0, first, base, grid, rows);
        if let Some(cap) = second {
            let other = self.behind(0.0, cap, base, grid, rows);
            for k in 0..BAND_ROWS {
                let is_longer = other.end[k] - other.start[k] > borders.end[k] - borders.start[k];
                borders.start[k] = if is_longer {
                    other.start[k]
                } else {
                    borders.start[k]
                };
                borders.end[k] = if is_longer { other.end[k] } else { borders.end[k] };
            }
        }
        borders
    }

    /// The columns that are lowest behind the higher end: at most these.
    #[inline(always)]
    fn behind_high(&self, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        self.behind(self.length, self.outer(), base, grid, rows)
    }

    /// The columns that the track has to look at, in two parts, in whole groups where there are so many.
    #[inline(always)]
    fn wanted(&self, before: Option<&Track>, grid: &Grid, rows: &Range<usize>) -> [Borders; 2] {
        let mut all = self.spans(grid, rows).all;
        all.clip_to_map();
        let base = all.base;
        let (mut outer, mut but) = (all, all.nothing());
        if self.length > 0.0 {
            // What two tracks share is rounded by each of them: a column more on either side.
            if self.high_end != End::Own {
                outer.clip(&self.behind_high(base, grid, rows), 0);
            }
            if let (End::Shared, Some(before)) = (self.high_end, before) {
                let mut also = before.behind_low(base, grid, rows);
                also.widen(1);
                also.clip(&all, 0);
                outer.join(&also);
            }
            if self.low_end != End::Own {
                but = self.behind_low(base, grid, rows);
            }
            if let (End::Shared, Some(before)) = (self.low_end, before) {
                but.clip(&before.behind_high(base, grid, rows), 1);
            }
        }
        outer.without(&but, &all)
    }
}

/// Heights of neighbouring columns of a row under a corner radius, with the leads as parts of the half chord.
#[inline(always)]
fn end_group(row: &Row, [flat, corner]: [f32; 2], k: usize, parts: [f32; GROUP]) -> [f32; GROUP] {
    let mut heights = [0.0; GROUP];
    for n in 0..GROUP {
        let [a, b] = row.place(k as i32 as f32 + n as i32 as f32);
        let s = least(positive(a - parts[n] * half_chord(flat + corner, b)), row.length);
        let e = a - s;
        let rise = positive((b * b + e * e).sqrt() - flat);
        let up = corner - positive((corner - rise) * (corner + rise)).sqrt();
        heights[n] = positive(row.low + row.slope * s + up);
    }
    heights
}

/// Heights of neighbouring columns by what they are over the axis.
#[inline(always)]
fn middle_group(row: &Row, k: usize, shares: [f32; GROUP]) -> [f32; GROUP] {
    let mut heights = [0.0; GROUP];
    for n in 0..GROUP {
        let [a, _] = row.place(k as i32 as f32 + n as i32 as f32);
        heights[n] = positive(row.low + row.slope * a + shares[n]);
    }
    heights
}
