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
use crate::sweep::{BAND_ROWS, Borders, End, Raster, Row, Sink, Track, least, positive};

/// Curves flatter than this part of the radius are taken for this flat: the tool is lower by less than the
/// precision of the map.
const FLATTEST: f64 = 1e-3;

/// Columns that are cut side by side: a register of the x86-64 base line.
const GROUP: i32 = 4;

/// Columns of a row whose heights are kept at once.
const AT_ONCE: usize = 64;

/// Columns farther from the tool than any map is wide.
const FAR: i64 = 1 << 29;

/// The half of an ellipse before a place on the track, and the strip behind it: `ahead` long, `beside` to
/// either side, mm.
#[derive(Clone, Copy, Debug)]
struct Cap {
    ahead: f64,
    beside: f64,
}

impl Track {
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

    pub(super) fn sweep_torus(
        &self,
        before: Option<&Track>,
        grid: &Grid,
        rows: Range<usize>,
        sink: &mut impl Sink,
    ) {
        let mut heights = [0.0; AT_ONCE];
        let wanted = self.wanted(before, grid, &rows);
        for (k, row) in rows.enumerate() {
            for columns in wanted.each_ref().map(|part| part.row(k)) {
                let middle = self.middle(grid, row, &columns);
                for (columns, is_middle) in [
                    (columns.start..middle.start, false),
                    (middle.clone(), true),
                    (middle.end..columns.end, false),
                ] {
                    for first in columns.clone().step_by(AT_ONCE) {
                        let columns = first..columns.end.min(first + AT_ONCE);
                        let heights = heights.get_mut(..columns.len()).unwrap_or_default();
                        let row_of = self.row(grid, first, row);
                        if is_middle {
                            self.middle_heights(&row_of, heights);
                        } else {
                            self.torus_heights(&row_of, heights);
                        }
                        sink.listed(row, columns, heights);
                    }
                }
            }
        }
    }

    /// The heights of neighbouring columns of a row.
    #[inline]
    fn torus_heights(&self, row: &Row, heights: &mut [f32]) {
        let [flat, corner] = [self.tool.flat(), self.tool.corner].map(|value| value as f32);
        match &self.leads {
            Some(leads) => leads.fill(row, heights),
            None => heights.fill(0.0),
        }
        let low = row.low + corner;
        // What is a lead becomes the height.
        for (k, height) in heights.iter_mut().enumerate() {
            let [a, b] = row.place(k as i32 as f32);
            let s = least(positive(a - *height), row.length);
            let e = a - s;
            let rise = positive((b * b + e * e).sqrt() - flat);
            *height = positive(low + row.slope * s - positive((corner - rise) * (corner + rise)).sqrt());
        }
    }

    /// The columns of a row that are touched surely between the ends of the track: there the height is that of
    /// the axis and a share that depends on the place across the track alone.
    fn middle(&self, grid: &Grid, row: usize, columns: &Range<usize>) -> Range<usize> {
        let Some(fan) = self.leads.as_ref().and_then(|leads| leads.fan.as_ref()) else {
            return columns.start..columns.start;
        };
        if fan.heights.is_empty() || columns.is_empty() {
            return columns.start..columns.start;
        }
        let Row { dx, ux, uy, .. } = self.row(grid, columns.start, row);
        let [a, b] = self.row(grid, columns.start, row).place(0.0);
        let along = between(a, dx * ux, self.outer().ahead as f32..self.length as f32);
        let across = between(b, dx * uy, -fan.beside..fan.beside);
        let first = along[0].max(across[0]).clamp(0.0, columns.len() as f32);
        let end = along[1].min(across[1]).clamp(first, columns.len() as f32);
        columns.start + first as usize..columns.start + end as usize
    }

    #[inline]
    fn middle_heights(&self, row: &Row, heights: &mut [f32]) {
        if let Some(fan) = self.leads.as_ref().and_then(|leads| leads.fan.as_ref()) {
            fan.fill_heights(row, heights);
        }
        for (k, height) in heights.iter_mut().enumerate() {
            let [a, _] = row.place(k as i32 as f32);
            *height = positive(row.low + row.slope * a + *height);
        }
    }

    /// Sine of the slope.
    fn sine(&self) -> f64 {
        self.slope / (self.slope * self.slope + 1.0).sqrt()
    }

    /// A cap that holds the curve of the columns that are touched.
    fn outer(&self) -> Cap {
        let radius = self.tool.radius;
        let share = match &self.leads {
            Some(leads) => f64::from(leads.most),
            None => self.sine() * self.tool.corner / radius,
        };
        Cap {
            ahead: share.max(FLATTEST) * radius,
            beside: radius,
        }
    }

    /// Caps within that curve: either of them.
    fn inner(&self) -> (Cap, Option<Cap>) {
        let radius = self.tool.radius;
        match &self.leads {
            Some(leads) => {
                let middle = self.tool.flat() + self.tool.corner * self.sine();
                let cap = Cap {
                    ahead: f64::from(leads.least).max(FLATTEST) * radius,
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
    fn behind(&self, place: f64, cap: Cap, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        let raster = Raster::new(self, base, grid, rows);
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
    fn behind_high(&self, base: i64, grid: &Grid, rows: &Range<usize>) -> Borders {
        self.behind(self.length, self.outer(), base, grid, rows)
    }

    /// The columns that the track has to look at, in two parts, in whole groups where there are so many.
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

/// Arithmetic of borders, all rows side by side.
impl Borders {
    fn nothing(&self) -> Borders {
        Borders {
            start: [0; BAND_ROWS],
            end: [0; BAND_ROWS],
            ..*self
        }
    }

    /// Only the columns of the map.
    fn clip_to_map(&mut self) {
        let border = |of: i64| (of - self.base).clamp(-FAR, FAR) as i32;
        let (first, last) = (border(0), border(self.columns));
        for (start, end) in self.start.iter_mut().zip(&mut self.end) {
            *start = (*start).max(first).min(last);
            *end = (*end).max(*start).min(last);
        }
    }

    /// Only the columns that are in `other` too, by `margin` within it.
    fn clip(&mut self, other: &Borders, margin: i32) {
        for k in 0..BAND_ROWS {
            self.start[k] = self.start[k].max(other.start[k] + margin);
            self.end[k] = self.end[k].min(other.end[k] - margin);
        }
    }

    fn widen(&mut self, margin: i32) {
        for k in 0..BAND_ROWS {
            let margin = if self.start[k] < self.end[k] { margin } else { 0 };
            self.start[k] -= margin;
            self.end[k] += margin;
        }
    }

    /// The columns of both, and those between them.
    fn join(&mut self, other: &Borders) {
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
    fn without(&self, but: &Borders, all: &Borders) -> [Borders; 2] {
        let whole = |length: i32| (length.max(0) + GROUP - 1) & !(GROUP - 1);
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

/// How far before its axis a tool with a corner radius touches what it leaves on a slope, by the
/// distance across the track.
///
/// The bottom of the moving tool is touched where its normal is perpendicular to the movement. At the
/// angle `p` from the track the point of the corner with the tangent `slope / cos p` is such a point:
/// `(flat + corner * sin) * cos p` before the axis and `(flat + corner * sin) * sin p` beside it. The
/// height that follows from the place has its minimum there, so a small error of the place does not
/// count.
#[derive(Clone, Debug)]
pub(crate) struct Leads {
    /// By equal steps of the half chord as part of the radius, which straightens the curve.
    leads: [f32; Leads::COUNT + 1],
    /// Bounds of the lead as part of the half chord.
    least: f32,
    most: f32,
    radius: f32,
    /// By the steps of a row from column to column.
    fan: Option<Fan>,
}

/// Leads across the whole track from one side to the other, as far apart as the columns of a row lie across the
/// track: in every row they are met one after the other, each row at another place between them.
#[derive(Clone, Debug)]
struct Fan {
    leads: Vec<f32>,
    /// What the height is over that of the axis between the ends of the track; nothing for a short one.
    heights: Vec<f32>,
    /// From column to column across the track, mm.
    step: f32,
    /// So far from the track the heights are sure, mm: at the sides they change too fast.
    beside: f32,
}

impl Fan {
    /// Columns beyond either side of the track.
    const BEYOND: usize = 16;
    /// Columns at either side whose heights are not sure.
    const SIDE: f32 = 6.0;
    /// Bounds of the step as part of the radius: a finer one takes too long to make, a coarser one loses the curve.
    const STEPS: Range<f32> = 1.0 / 256.0..1.0 / 32.0;

    /// Where the columns of a row from `b` on lie: the place before the first one, and how far behind it that is.
    #[inline]
    fn place(&self, radius: f32, row: &Row) -> (usize, f32) {
        let [_, b] = row.place(0.0);
        // What is to the right of the track is to the left as well.
        let b = if row.uy < 0.0 { -b } else { b };
        let place = positive((b + radius) / self.step + Fan::BEYOND as f32);
        let first = place as i32;
        (first as usize, place - first as f32)
    }

    /// Heights between four places of the fan (Lagrange): in a row all with the same shares.
    fn fill_heights(&self, row: &Row, heights: &mut [f32]) {
        let radius = self.beside + Fan::SIDE * self.step;
        let (first, t) = self.place(radius, row);
        let shares = [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ];
        let from = |k: usize| {
            self.heights
                .get((first + k).saturating_sub(1)..)
                .unwrap_or_default()
        };
        heights.fill(f32::INFINITY);
        let near = from(0).iter().zip(from(1)).zip(from(2)).zip(from(3));
        for (height, (((a, b), c), d)) in heights.iter_mut().zip(near) {
            *height = a * shares[0] + b * shares[1] + c * shares[2] + d * shares[3];
        }
    }
}

/// The first and the last number of steps from `start` that lie in a range.
fn between(start: f32, step: f32, range: Range<f32>) -> [f32; 2] {
    if step == 0.0 {
        let is_inside = range.contains(&start);
        return if is_inside {
            [0.0, f32::INFINITY]
        } else {
            [0.0, 0.0]
        };
    }
    let ends = [(range.start - start) / step, (range.end - start) / step];
    [ends[0].min(ends[1]).ceil(), ends[0].max(ends[1]).floor() + 1.0]
}

impl Leads {
    const COUNT: usize = 64;

    pub fn new([flat, corner]: [f32; 2], slope: f32, length: f32, step: f32) -> Leads {
        let radius = flat + corner;
        let points: [(f32, f32); Leads::COUNT + 1] = std::array::from_fn(|k| {
            let cos = 1.0 - k as i32 as f32 / Leads::COUNT as f32;
            let sine = slope / (slope * slope + cos * cos).sqrt();
            let r = flat + corner * sine;
            // radius² - (r sin p)², without its loss of digits at the rim.
            let chord = positive((radius - r) * (radius + r) + r * r * cos * cos).sqrt() / radius;
            (chord, r * cos)
        });
        let mut leads = Leads {
            leads: [0.0; Leads::COUNT + 1],
            least: f32::INFINITY,
            most: 0.0,
            radius,
            fan: None,
        };
        let mut next = 1;
        for (k, lead) in leads.leads.iter_mut().enumerate().rev() {
            let chord = k as i32 as f32 / Leads::COUNT as f32;
            while next < Leads::COUNT && points[next].0 > chord {
                next += 1;
            }
            let (near, far) = (points[next - 1], points[next]);
            let share = if near.0 > far.0 {
                (near.0 - chord) / (near.0 - far.0)
            } else {
                0.0
            };
            *lead = near.1 + (far.1 - near.1) * least(positive(share), 1.0);
            if k > 0 {
                let part = *lead / (chord * radius);
                leads.least = leads.least.min(part);
                leads.most = leads.most.max(part);
            }
        }
        let step = step.abs();
        if Fan::STEPS.contains(&(step / radius)) {
            let first = -radius - Fan::BEYOND as f32 * step;
            let mut fan = vec![0.0; (2.0 * radius / step) as usize + 2 * Fan::BEYOND];
            leads.look_up(first, step, &mut fan);
            let is_long = length > 2.0 * leads.most * radius;
            let height = |(k, lead): (usize, &f32)| {
                let b = first + k as i32 as f32 * step;
                let rise = positive((b * b + lead * lead).sqrt() - flat);
                corner - positive((corner - rise) * (corner + rise)).sqrt() - slope * lead
            };
            leads.fan = Some(Fan {
                heights: if is_long {
                    fan.iter().enumerate().map(height).collect()
                } else {
                    Vec::new()
                },
                leads: fan,
                step,
                beside: radius - Fan::SIDE * step,
            });
        }
        leads
    }

    /// The leads of neighbouring columns of a row.
    #[inline]
    fn fill(&self, row: &Row, leads: &mut [f32]) {
        let [_, b] = row.place(0.0);
        let step = row.dx * row.uy;
        let width = step.abs() * leads.len() as f32;
        if width <= FLATTEST as f32 * self.radius {
            let middle = b + 0.5 * step * leads.len() as f32;
            let chord = positive((self.radius - middle) * (self.radius + middle)).sqrt();
            leads.fill(self.at(chord / self.radius));
            return;
        }
        if let Some(fan) = &self.fan {
            let (first, share) = fan.place(self.radius, row);
            if let Some([_, next @ ..]) = fan.leads.get(first..first + leads.len() + 1) {
                let near = fan.leads.get(first..).unwrap_or_default();
                for ((lead, near), next) in leads.iter_mut().zip(near).zip(next) {
                    *lead = near + (next - near) * share;
                }
                return;
            }
        }
        self.look_up(b, step, leads);
    }

    /// As [`Leads::fill`], without a fan.
    fn look_up(&self, b: f32, step: f32, leads: &mut [f32]) {
        let per_radius = 1.0 / self.radius;
        for (k, lead) in leads.iter_mut().enumerate() {
            let b = b + k as i32 as f32 * step;
            *lead = positive((self.radius - b) * (self.radius + b)).sqrt() * per_radius;
        }
        for lead in leads {
            *lead = self.at(*lead);
        }
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
