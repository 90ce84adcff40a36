//! Which columns a round tool looks at on a track.
//!
//! On a slope such a tool touches what it leaves before its axis: the track of the columns over which it is
//! lowest at one place of the tool is a curve before the axis, and while the tool travels from one end
//! to the other the curve sweeps the columns that belong to the track alone. What lies behind the curve at
//! the lower end, or before the one at the higher end, belongs to an end; where another track starts
//! or ends there it is lower still over all of it but a wedge. So of a chain of short tracks each
//! looks at no more than a strip as long as itself.

use std::ops::Range;

use crate::grid::Grid;
use crate::leads::FLATTEST;
use crate::raster::{BAND_ROWS, Borders, Raster};
use crate::track::{End, Track};

/// The half of an ellipse before a place on the track, and the strip behind it: `ahead` long, `beside` to
/// either side, mm.
#[derive(Clone, Copy, Debug)]
struct Cap {
    ahead: f64,
    beside: f64,
}

impl Track {
    /// Sine of the slope.
    #[inline(always)]
    pub(crate) fn sine(&self) -> f64 {
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
    fn up_to(&self, place: f64, cap: Cap, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
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

    /// The columns that the cap at the lower end holds: at least these.
    #[inline(always)]
    fn low_cap(&self, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        let (first, second) = self.inner();
        let mut borders = self.up_to(0.0, first, base, grid, rows);
        if let Some(cap) = second {
            let other = self.up_to(0.0, cap, base, grid, rows);
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

    /// The columns up to the cap at the higher end: at most these.
    #[inline(always)]
    fn high_cap(&self, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        self.up_to(self.length, self.outer(), base, grid, rows)
    }

    /// The columns that the track has to look at, in two parts, in whole groups where there are so many; and all under
    /// the tool.
    #[inline(always)]
    pub(crate) fn wanted(
        &self,
        before: Option<&Track>,
        grid: &Grid,
        rows: &Range<usize>,
    ) -> ([Borders; 2], Borders) {
        let mut all = self.spans(grid, rows).all;
        all.clip_to_map();
        let base = all.base;
        let (mut outer, mut but) = (all, all.nothing());
        if self.length > 0.0 {
            // What two tracks share is rounded by each of them: a column more on either side.
            if self.high_end != End::Own {
                outer.clip(&self.high_cap(base, grid, rows), 0);
            }
            if let (End::Shared, Some(before)) = (self.high_end, before) {
                let mut also = before.low_cap(base, grid, rows);
                also.widen(1);
                also.clip(&all, 0);
                outer.join(&also);
            }
            if self.low_end != End::Own {
                but = self.low_cap(base, grid, rows);
            }
            if let (End::Shared, Some(before)) = (self.low_end, before) {
                but.clip(&before.high_cap(base, grid, rows), 1);
            }
        }
        (outer.without(&but, &all), all)
    }
}
