//! The swept volume of tools with a corner radius, over the columns that `strip` gives a track.

use std::ops::Range;

use pulp::Simd;

use crate::grid::Grid;
use crate::leads::{Ahead, Leads, Level, Near, Spacing, between};
use crate::raster::{BAND_ROWS, Borders, GROUP, least, positive};
use crate::track::{Sink, Track};

/// Groups of columns that are found before they are reckoned. To find how many a row has takes branches that no
/// processor foresees; to reckon them takes long chains of arithmetic, many of which go side by side while nothing branches.
const LISTED: usize = 64;
/// Groups of a row that are listed in one turn, whether it has as many or not.
const TURN: usize = 4;

/// A tool with a corner radius on a track, in the precision of the map, as the inner loops need it.
struct Torus<'a> {
    length: f32,
    slope: f32,
    low: f32,
    flat: f32,
    corner: f32,
    leads: Option<&'a Leads>,
    lanes: &'a [[f32; GROUP]; 2],
    /// From column to column, along and across the track.
    da: f32,
    db: f32,
    /// Places of the first column of the base in each row.
    along: [f32; BAND_ROWS],
    across: [f32; BAND_ROWS],
}

/// Groups on the way to their heights, in steps: a step at a time for many of them keeps more of them going than all steps
/// at a time, since the processor looks only so many instructions ahead.
pub(crate) struct List {
    /// Row, and first column from the base.
    places: [(u32, i32); LISTED],
    lifts: [[f32; GROUP]; LISTED],
    squares: [[f32; GROUP]; LISTED],
}

impl Default for List {
    fn default() -> List {
        List {
            places: [(0, 0); LISTED],
            lifts: [[0.0; GROUP]; LISTED],
            squares: [[0.0; GROUP]; LISTED],
        }
    }
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
        let (wanted, _) = self.wanted(before, grid, &rows);
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
    pub(super) fn sweep_torus<S: Simd>(
        &self,
        simd: S,
        before: Option<&Track>,
        grid: &Grid,
        rows: Range<usize>,
        list: &mut List,
        sink: &mut impl Sink,
    ) {
        let (wanted, all) = self.wanted(before, grid, &rows);
        let torus = Torus::new(self, &all, grid, rows.start);
        let Some(middle) = torus.middle(&all, rows.len()) else {
            for part in &wanted {
                torus.sweep_ends(simd, part, &rows, list, sink);
            }
            return;
        };
        for part in &wanted {
            let mut middle = middle;
            middle.clip(part, 0);
            middle.cut_to_groups();
            torus.sweep_middle(simd, &middle, &rows, sink);
            for ends in part.without(&middle, &all) {
                torus.sweep_ends(simd, &ends, &rows, list, sink);
            }
        }
    }
}

impl Torus<'_> {
    #[inline(always)]
    fn new<'a>(track: &'a Track, all: &Borders, grid: &Grid, first_row: usize) -> Torus<'a> {
        let mut torus = Torus {
            length: track.length as f32,
            slope: track.slope as f32,
            low: track.low[2] as f32,
            flat: track.tool.flat() as f32,
            corner: track.tool.corner as f32,
            leads: track.leads.as_deref(),
            lanes: &track.lanes,
            da: track.lanes[0][1],
            db: track.lanes[1][1],
            along: [0.0; BAND_ROWS],
            across: [0.0; BAND_ROWS],
        };
        let [ux, uy] = track.u;
        let x = (all.base as f64 + 0.5) * grid.dx - track.low[0];
        let first_y = (first_row as f64 + 0.5) * grid.dy - track.low[1];
        for (k, (along, across)) in torus.along.iter_mut().zip(&mut torus.across).enumerate() {
            let y = first_y + k as i32 as f64 * grid.dy;
            *along = (x * ux + y * uy) as f32;
            *across = (x * uy - y * ux) as f32;
        }
        torus
    }

    /// Place along and across the track of a column of the row number `k`.
    #[inline(always)]
    fn place(&self, k: usize, column: i32) -> [f32; 2] {
        let k = k & (BAND_ROWS - 1);
        [
            self.along[k] + column as f32 * self.da,
            self.across[k] + column as f32 * self.db,
        ]
    }

    /// Columns that may be touched anywhere on the track.
    #[inline(always)]
    fn sweep_ends<S: Simd>(
        &self,
        simd: S,
        part: &Borders,
        rows: &Range<usize>,
        list: &mut List,
        sink: &mut impl Sink,
    ) {
        if part.is_empty() {
            return;
        }
        let Some(leads) = self.leads else {
            return self.sweep_groups(simd, part, rows, &Level, list, sink);
        };
        match leads.spacing {
            Spacing::Fine if self.db == 0.0 => {
                self.sweep_groups(simd, part, rows, &leads.constant(&self.across), list, sink);
            }
            Spacing::Fine => self.sweep_groups(simd, part, rows, &leads.fine(self.db), list, sink),
            Spacing::Equal => {
                self.sweep_groups(simd, part, rows, &leads.equal(&self.across, self.db), list, sink);
            }
            Spacing::Coarse(places) => {
                self.sweep_groups(simd, part, rows, &leads.coarse(self.db, places), list, sink);
            }
        }
    }

    #[inline(always)]
    fn sweep_groups<S: Simd>(
        &self,
        simd: S,
        part: &Borders,
        rows: &Range<usize>,
        leads: &impl Ahead,
        list: &mut List,
        sink: &mut impl Sink,
    ) {
        let count = rows.len().min(BAND_ROWS);
        let (mut k, mut skipped) = (0, 0);
        while k < count {
            let mut listed = 0;
            while k < count && listed + TURN <= LISTED {
                let start = part.start[k] + skipped;
                for n in 0..TURN {
                    list.places[listed + n] = (k as u32, start + (GROUP * n) as i32);
                }
                let groups = (part.end[k] - start + GROUP as i32 - 1) >> GROUP.ilog2();
                listed += groups.clamp(0, TURN as i32) as usize;
                if groups > TURN as i32 {
                    skipped += (GROUP * TURN) as i32;
                } else {
                    skipped = 0;
                    k += 1;
                }
            }
            let listed = list.places.get(..listed).unwrap_or_default();
            for ((place, lifts), squares) in listed.iter().zip(&mut list.lifts).zip(&mut list.squares) {
                let (k, start) = (place.0 as usize & (BAND_ROWS - 1), place.1);
                let place = self.place(k, start);
                let near = leads.near(k, start, place[1]);
                self.nearest(simd, place, &near, lifts, squares);
            }
            let profile = [self.flat, self.corner];
            for ((place, lifts), squares) in listed.iter().zip(&list.lifts).zip(&list.squares) {
                let (k, start) = (place.0 as usize & (BAND_ROWS - 1), place.1);
                let first = (part.base + i64::from(start)) as usize;
                let columns = first..first + (part.end[k] - start).min(GROUP as i32) as usize;
                sink.group(
                    simd,
                    rows.start + k,
                    columns,
                    heights(simd, profile, lifts, squares),
                );
            }
        }
    }

    /// Where neighbouring columns are touched: how high the tip is there, and the squares of their distances from the axis.
    #[inline(always)]
    fn nearest<S: Simd>(
        &self,
        simd: S,
        [a, b]: [f32; 2],
        near: &impl Near,
        lifts: &mut [f32; GROUP],
        squares: &mut [f32; GROUP],
    ) {
        let radius = self.flat + self.corner;
        let (a, b) = (simd.splat_f32s(a), simd.splat_f32s(b));
        let (zero, radius_square) = (simd.splat_f32s(0.0), simd.splat_f32s(radius * radius));
        let (low, slope, length) = (
            simd.splat_f32s(self.low),
            simd.splat_f32s(self.slope),
            simd.splat_f32s(self.length),
        );
        let ((along, _), (across, _)) = (S::as_simd_f32s(&self.lanes[0]), S::as_simd_f32s(&self.lanes[1]));
        let ((lifts, _), (squares, _)) = (S::as_mut_simd_f32s(lifts), S::as_mut_simd_f32s(squares));
        for (n, (lift, square)) in lifts.iter_mut().zip(squares).enumerate() {
            let (a, b) = (simd.add_f32s(a, along[n]), simd.add_f32s(b, across[n]));
            let b_square = simd.mul_f32s(b, b);
            let lead = near.lead(simd, n, across[n], simd.sub_f32s(radius_square, b_square));
            let s = simd.min_f32s(simd.max_f32s(simd.sub_f32s(a, lead), zero), length);
            let e = simd.sub_f32s(a, s);
            *lift = simd.add_f32s(low, simd.mul_f32s(slope, s));
            *square = simd.add_f32s(b_square, simd.mul_f32s(e, e));
        }
    }

    /// The columns that are touched surely between the ends of the track: there the height is that of
    /// the axis and a share that depends on the place across the track alone. `None` where they are not worth it.
    #[inline(always)]
    fn middle(&self, all: &Borders, rows: usize) -> Option<Borders> {
        let leads = self.leads.filter(|leads| leads.is_long)?;
        let beside = if self.db == 0.0 {
            self.flat + self.corner
        } else {
            leads.beside()?
        };
        let mut middle = all.nothing();
        for k in 0..rows.min(BAND_ROWS) {
            let (start, end) = (all.start[k], all.end[k]);
            let [a, b] = self.place(k, start);
            let along = between(a, self.da, leads.longest()..self.length);
            let across = between(b, self.db, -beside..beside);
            let columns = (end - start).max(0) as f32;
            let first = along[0].max(across[0]).clamp(0.0, columns);
            middle.start[k] = start + first as i32;
            middle.end[k] = start + along[1].min(across[1]).clamp(first, columns) as i32;
        }
        Some(middle)
    }

    #[inline(always)]
    fn sweep_middle<S: Simd>(&self, simd: S, middle: &Borders, rows: &Range<usize>, sink: &mut impl Sink) {
        let Some(leads) = self.leads else { return };
        for (k, row) in rows.clone().enumerate() {
            let (start, end) = (middle.start[k], middle.end[k]);
            if start >= end {
                continue;
            }
            let [a, b] = self.place(k, start);
            let columns = middle.columns(start, end);
            let group = |n: usize, shares: [f32; GROUP]| {
                let mut heights = [0.0; GROUP];
                for (m, height) in heights.iter_mut().enumerate() {
                    let a = a + (n + m) as i32 as f32 * self.da;
                    *height = positive(self.low + self.slope * a + shares[m]);
                }
                let first = columns.start + n;
                (first..first + GROUP, heights)
            };
            if self.db == 0.0 {
                let share = leads.height_at(b);
                for n in (0..columns.len()).step_by(GROUP) {
                    let (columns, heights) = group(n, [share; GROUP]);
                    sink.group(simd, row, columns, heights);
                }
            } else {
                let near = leads.heights_of(b, self.db);
                let weights = near.weights();
                for n in (0..columns.len()).step_by(GROUP) {
                    let (columns, heights) = group(n, near.curved(n, &weights));
                    sink.group(simd, row, columns, heights);
                }
            }
        }
    }
}

/// The heights of columns that are touched by a profile, flat and then round, at some distances from its axis.
#[inline(always)]
fn heights<S: Simd>(
    simd: S,
    [flat, corner]: [f32; 2],
    lifts: &[f32; GROUP],
    squares: &[f32; GROUP],
) -> [f32; GROUP] {
    let corner_square = simd.splat_f32s(corner * corner);
    let (zero, flat, corner) = (
        simd.splat_f32s(0.0),
        simd.splat_f32s(flat),
        simd.splat_f32s(corner),
    );
    let mut heights = [0.0; GROUP];
    let ((lifts, _), (squares, _)) = (S::as_simd_f32s(lifts), S::as_simd_f32s(squares));
    let (found, _) = S::as_mut_simd_f32s(&mut heights);
    for ((lift, square), height) in lifts.iter().zip(squares).zip(found) {
        let rise = simd.max_f32s(simd.sub_f32s(simd.sqrt_f32s(*square), flat), zero);
        let rest = simd.max_f32s(simd.sub_f32s(corner_square, simd.mul_f32s(rise, rise)), zero);
        let up = simd.sub_f32s(corner, simd.sqrt_f32s(rest));
        *height = simd.max_f32s(simd.add_f32s(*lift, up), zero);
    }
    heights
}
