//! The swept volume of a tool along a straight line, row by row of the height map.
//!
//! What counts in every column of the track is the lowest point of the tool while the tool is over the column. For a
//! flat end and a cone this has a closed form; `round` reckons the tools with a corner radius.
//!
//! Decision: Ball and corner radius are cut in the widest registers of the processor; nothing is summed across
//! columns and no product and sum are made one, so the bits are the same on all

use std::ops::Range;

use pulp::{Arch, Scalar256b, Simd, WithSimd};

use crate::grid::Grid;
use crate::raster::{Row, least, positive};
use crate::round::List;
use crate::tool::Bottom;
use crate::track::{End, Sink, Track};

/// Columns that are cut side by side: two registers of the x86-64 base line.
const GROUP: usize = 8;

/// The sweep of a round tool with the widest registers of the processor. Neither their width nor the processor
/// changes a bit: nothing is summed across columns, and no product and sum are made one.
struct Round<'a, S> {
    track: &'a Track,
    before: Option<&'a Track>,
    grid: &'a Grid,
    rows: Range<usize>,
    list: &'a mut List,
    sink: &'a mut S,
}

impl<S: Sink> WithSimd for Round<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<Registers: Simd>(self, simd: Registers) {
        match self.track.tool.bottom() {
            Bottom::Ball => self
                .track
                .sweep_ball(self.before, self.grid, self.rows, self.sink),
            _ => self
                .track
                .sweep_torus(simd, self.before, self.grid, self.rows, self.list, self.sink),
        }
    }
}

impl Track {
    /// Presents all columns under the tool in the given rows, at most [`BAND_ROWS`](crate::raster::BAND_ROWS) of them. Where the track
    /// shares an end with the one before it, that is wanted too.
    pub fn sweep(
        &self,
        before: Option<&Track>,
        grid: &Grid,
        rows: Range<usize>,
        list: &mut List,
        sink: &mut impl Sink,
    ) {
        if rows.is_empty() {
            return;
        }
        match self.tool.bottom() {
            Bottom::Flat => self.sweep_flat(grid, rows, sink),
            Bottom::Ball | Bottom::Torus => {
                let round = Round {
                    track: self,
                    before,
                    grid,
                    rows,
                    list,
                    sink,
                };
                match Arch::new() {
                    // Groups as the other processors have them, which the compiler then parts.
                    Arch::Scalar => round.with_simd(Scalar256b),
                    registers => registers.dispatch(round),
                }
            }
            Bottom::Cone => self.sweep_cone(grid, rows, sink, self.tool.cone as f32),
        }
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
            let after = (all.end - low.end).next_multiple_of(GROUP);
            let rest = [
                all.start..(all.start + before).min(low.end),
                all.end.saturating_sub(after).max(low.start)..all.end,
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::Tool;
    use crate::track::{ColumnByColumn, Segment, Start};

    const GRID: Grid = Grid {
        nx: 200,
        ny: 32,
        dx: 0.1,
        dy: 0.1,
    };

    /// The lowest height of every column.
    struct Lowest(Vec<f32>);

    impl ColumnByColumn for Lowest {
        fn each(&mut self, row: usize, columns: Range<usize>, heights: impl Iterator<Item = f32>) {
            let cells = &mut self.0[row * GRID.nx..][columns];
            for (cell, height) in cells.iter_mut().zip(heights) {
                *cell = least(height, *cell);
            }
        }
    }

    /// Tools with a corner radius, level and on slopes, along the rows and across them, short and long.
    #[test]
    fn the_registers_change_no_bit() {
        let mut cut = 0;
        for corner in [0.3, 2.0, 4.0] {
            for degrees in [0.0, 3.0, 40.0, 90.0, 200.0, 357.0] {
                for (length, slope) in [(0.3, 0.0), (0.3, 0.5), (3.0, 0.01), (12.0, 0.4), (12.0, 3.0)] {
                    let (sin, cos) = f64::to_radians(degrees).sin_cos();
                    let end = |s: f64| [10.0 + s * cos, 1.6 + s * sin, 5.0 + s * slope];
                    let segment = Segment {
                        from: end(0.0),
                        to: end(length),
                        tool: Tool {
                            radius: 4.0,
                            corner,
                            cone: 0.0,
                        },
                        start: Start::Uncut,
                        followed: false,
                    };
                    let track = Track::new(&segment, &GRID);
                    let [mut here, mut plain] = [0, 1].map(|_| Lowest(vec![20.0; GRID.nx * GRID.ny]));
                    track.sweep(None, &GRID, 0..GRID.ny, &mut List::default(), &mut here);
                    let round = Round {
                        track: &track,
                        before: None,
                        grid: &GRID,
                        rows: 0..GRID.ny,
                        list: &mut List::default(),
                        sink: &mut plain,
                    };
                    round.with_simd(pulp::Scalar);
                    let bits = |lowest: Lowest| lowest.0.into_iter().map(f32::to_bits).collect::<Vec<_>>();
                    cut += here.0.iter().filter(|height| **height < 20.0).count();
                    assert_eq!(
                        bits(here),
                        bits(plain),
                        "corner {corner}, {degrees} degrees, {length} mm, slope {slope}"
                    );
                }
            }
        }
        assert!(cut > 100_000, "{cut}");
    }
}
