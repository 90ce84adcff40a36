//! How far before its axis a tool with a corner radius is lowest.

use std::ops::Range;

use pulp::Simd;

use crate::raster::{BAND_ROWS, GROUP, least, nearest, positive};

/// Curves flatter than this part of the radius are taken for this flat: the tool is lower by less than the
/// precision of the map.
pub(crate) const FLATTEST: f32 = 1e-3;

/// How far before its axis a tool with a corner radius touches what it leaves on a slope, by the
/// distance across the track.
///
/// The bottom of the moving tool is touched where its normal is perpendicular to the movement. At the
/// angle `p` from the track the point of the corner with the tangent `slope / cos p` is such a point:
/// `(flat + corner * sin) * cos p` before the axis and `(flat + corner * sin) * sin p` beside it. The
/// height that follows from the place has its minimum there, so a small error of the place does not
/// count: heights are too high by less than 1e-4 of the radius, most of it where a flat ends on a faint slope.
///
/// The lead as part of the half chord of the tool has no steep place, up to the rim where both end. So these
/// parts are kept at places across the track, as far apart as the columns of a row lie across it: in every row
/// they are met one after the other, each row at another share between them.
#[derive(Clone, Debug)]
pub(crate) struct Leads {
    /// From one side of the track to the other, and beyond.
    parts: Vec<f32>,
    /// What the height is over that of the axis between the ends of the track, at the same places; nothing for a
    /// short one, nor where columns lie otherwise.
    heights: Vec<f32>,
    /// From place to place, and of the first one, mm across the track.
    step: f32,
    first: f32,
    /// Places on a millimetre.
    per_mm: f32,
    pub spacing: Spacing,
    /// Bounds of the parts.
    pub least: f32,
    pub most: f32,
    bottom: [f32; 2],
    slope: f32,
    /// Whether some columns are surely touched between the ends of the track.
    pub is_long: bool,
}

/// How far apart the columns of a row lie across the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Spacing {
    /// So little that parts lie on a straight line over a group of columns.
    Fine,
    /// As far apart as the places.
    Equal,
    /// So many places apart.
    Coarse(usize),
}

impl Spacing {
    /// Steps as part of the radius at which places are as far apart as columns: finer ones take too long to reckon,
    /// coarser ones lose the curve.
    const EQUAL: Range<f32> = 1.0 / 256.0..1.0 / 32.0;
    /// Steps at which a straight line is no worse than the places are.
    const STRAIGHT: f32 = 1.0 / 64.0;

    /// By the step from column to column as part of the radius.
    fn of(step: f32) -> Spacing {
        if step < Spacing::EQUAL.start {
            Spacing::Fine
        } else if step < Spacing::EQUAL.end {
            Spacing::Equal
        } else {
            Spacing::Coarse((step / Spacing::EQUAL.end).ceil() as usize)
        }
    }
}

/// How far ahead of its axis the tool touches the columns of a group.
pub(crate) trait Ahead {
    type Near: Near;
    /// For the group in the row number `k` that begins with a column, at `b` across the track.
    fn near(&self, k: usize, column: i32, b: f32) -> Self::Near;
}

/// The leads of one group.
pub(crate) trait Near {
    /// Of the columns in the register number `n`, from their places across the track beyond the first column and the
    /// squares of their half chords.
    fn lead<S: Simd>(&self, simd: S, n: usize, across: S::f32s, square: S::f32s) -> S::f32s;
}

#[inline(always)]
fn lead_of_parts<S: Simd>(simd: S, parts: S::f32s, square: S::f32s) -> S::f32s {
    let half_chord = simd.sqrt_f32s(simd.max_f32s(square, simd.splat_f32s(0.0)));
    simd.mul_f32s(parts, half_chord)
}

/// The values of the register number `n` from `first` on.
#[inline(always)]
fn register<S: Simd>(simd: S, values: &[f32], first: usize, n: usize) -> S::f32s {
    let (registers, _) = S::as_simd_f32s(values.get(first..).unwrap_or_default());
    registers.get(n).copied().unwrap_or_else(|| simd.splat_f32s(0.0))
}

/// A level track has none.
pub(crate) struct Level;

impl Ahead for Level {
    type Near = Level;
    #[inline(always)]
    fn near(&self, _: usize, _: i32, _: f32) -> Level {
        Level
    }
}

impl Near for Level {
    #[inline(always)]
    fn lead<S: Simd>(&self, simd: S, _: usize, _: S::f32s, _: S::f32s) -> S::f32s {
        simd.splat_f32s(0.0)
    }
}

/// The leads of [`Spacing::Fine`].
pub(crate) struct Fine<'a> {
    leads: &'a Leads,
    /// From the first column of a group to that of the next one, and its share of a millimetre; 0 for none.
    span: f32,
    per_span: f32,
}

/// A part and its change for each millimetre.
pub(crate) struct Line {
    part: f32,
    change: f32,
}

impl Ahead for Fine<'_> {
    type Near = Line;
    #[inline(always)]
    fn near(&self, _: usize, _: i32, b: f32) -> Line {
        let part = self.leads.part(b);
        let change = (self.leads.part(b + self.span) - part) * self.per_span;
        Line { part, change }
    }
}

impl Near for Line {
    #[inline(always)]
    fn lead<S: Simd>(&self, simd: S, _: usize, across: S::f32s, square: S::f32s) -> S::f32s {
        let change = simd.mul_f32s(simd.splat_f32s(self.change), across);
        let parts = simd.add_f32s(simd.splat_f32s(self.part), change);
        lead_of_parts(simd, parts, square)
    }
}

/// Columns of a row all at one place across the track.
pub(crate) struct Constant {
    parts: [f32; BAND_ROWS],
}

impl Ahead for Constant {
    type Near = f32;
    #[inline(always)]
    fn near(&self, k: usize, _: i32, _: f32) -> f32 {
        self.parts[k & (BAND_ROWS - 1)]
    }
}

impl Near for f32 {
    #[inline(always)]
    fn lead<S: Simd>(&self, simd: S, _: usize, _: S::f32s, square: S::f32s) -> S::f32s {
        lead_of_parts(simd, simd.splat_f32s(*self), square)
    }
}

/// The leads of [`Spacing::Equal`].
pub(crate) struct Equal<'a> {
    parts: &'a [f32],
    /// The place before the first column of each row, and how far behind a place the columns lie.
    firsts: [i32; BAND_ROWS],
    shares: [f32; BAND_ROWS],
}

/// The places about the columns of a group, and how far behind a place each column lies.
pub(crate) struct Between<'a> {
    values: &'a [f32; GROUP + 1],
    share: f32,
}

impl<'a> Ahead for Equal<'a> {
    type Near = Between<'a>;
    #[inline(always)]
    fn near(&self, k: usize, column: i32, _: f32) -> Between<'a> {
        let k = k & (BAND_ROWS - 1);
        let first = (self.firsts[k] + column) as usize;
        let values = self.parts.get(first..).and_then(<[f32]>::first_chunk);
        Between {
            values: values.unwrap_or(&[0.0; GROUP + 1]),
            share: self.shares[k],
        }
    }
}

impl Near for Between<'_> {
    #[inline(always)]
    fn lead<S: Simd>(&self, simd: S, n: usize, _: S::f32s, square: S::f32s) -> S::f32s {
        let (near, next) = (
            register(simd, self.values, 0, n),
            register(simd, self.values, 1, n),
        );
        let change = simd.mul_f32s(simd.sub_f32s(next, near), simd.splat_f32s(self.share));
        lead_of_parts(simd, simd.add_f32s(near, change), square)
    }
}

/// The leads of [`Spacing::Coarse`].
pub(crate) struct Coarse<'a> {
    leads: &'a Leads,
    step: f32,
    places: usize,
}

impl Ahead for Coarse<'_> {
    type Near = [f32; GROUP];
    #[inline(always)]
    fn near(&self, _: usize, _: i32, b: f32) -> [f32; GROUP] {
        let (first, share) = self.leads.start(b, self.step);
        let mut parts = [0.0; GROUP];
        for (n, part) in parts.iter_mut().enumerate() {
            if let Some([near, next, ..]) = self.leads.parts.get(first + n * self.places..) {
                *part = near + (next - near) * share;
            }
        }
        parts
    }
}

impl Near for [f32; GROUP] {
    #[inline(always)]
    fn lead<S: Simd>(&self, simd: S, n: usize, _: S::f32s, square: S::f32s) -> S::f32s {
        lead_of_parts(simd, register(simd, self, 0, n), square)
    }
}

/// Values at places for the columns of a row, each between two or four of them.
pub(crate) struct Heights<'a> {
    values: &'a [f32],
    /// How far behind a place each column lies.
    share: f32,
}

impl Heights<'_> {
    /// What each of four places counts for a column between the middle ones (Lagrange): in a row all have the same.
    #[inline(always)]
    pub fn weights(&self) -> [f32; 4] {
        let t = self.share;
        [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ]
    }

    /// As [`Near::equal`] between four places. Where the flat ends the curvature jumps by `1 / corner`, which leaves
    /// up to a thirtieth of that times the square of the step.
    #[inline(always)]
    pub fn curved(&self, k: usize, weights: &[f32; 4]) -> [f32; GROUP] {
        let mut found = [f32::INFINITY; GROUP];
        if let Some(near) = self.values.get(k..k + GROUP + 3) {
            for n in 0..GROUP {
                let outer = near[n] * weights[0] + near[n + 3] * weights[3];
                found[n] = outer + (near[n + 1] * weights[1] + near[n + 2] * weights[2]);
            }
        }
        found
    }
}

/// The first and the last number of steps from `start` that lie in a range.
#[inline(always)]
pub(crate) fn between(start: f32, step: f32, range: Range<f32>) -> [f32; 2] {
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
    /// Columns beyond either side of the track.
    const BEYOND: usize = 16;
    /// So many columns between the ends of a track make it worth while to look for them.
    const LONG: f32 = 64.0;
    /// Columns at either side whose heights between places are not sure: they change too fast there.
    const SIDE: f32 = 6.0;

    pub fn new(bottom: [f32; 2], slope: f32, length: f32, [step, column]: [f32; 2]) -> Leads {
        let radius = bottom[0] + bottom[1];
        let spacing = Spacing::of(step.abs() / radius);
        let (step, places) = match spacing {
            Spacing::Fine => (Spacing::STRAIGHT * radius, 1),
            Spacing::Equal => (step.abs(), 1),
            Spacing::Coarse(places) => (step.abs() / places as f32, places),
        };
        let aside = (radius / step) as usize + Leads::BEYOND * places;
        let curve = Curve::new(bottom, slope);
        let (mut parts, [least, most]) = (vec![0.0; 2 * aside + 1], curve.bounds());
        curve.fill(step, parts.get_mut(aside..).unwrap_or_default());
        // What is to the right of the track is to the left as well.
        for k in 0..aside {
            parts[k] = parts[2 * aside - k];
        }
        let mut leads = Leads {
            parts,
            heights: Vec::new(),
            step,
            first: -(aside as f32) * step,
            per_mm: 1.0 / step,
            spacing,
            least,
            most,
            bottom,
            slope,
            is_long: length - most.max(FLATTEST) * radius > Leads::LONG * column,
        };
        if leads.is_long && spacing == Spacing::Equal {
            let heights = (0..leads.parts.len()).zip(&leads.parts);
            leads.heights = heights
                .map(|(k, part)| leads.height(leads.first + k as i32 as f32 * step, *part))
                .collect();
        }
        leads
    }

    fn radius(&self) -> f32 {
        self.bottom[0] + self.bottom[1]
    }

    /// The greatest lead, mm.
    pub fn longest(&self) -> f32 {
        self.most.max(FLATTEST) * self.radius()
    }

    /// Distance from the track up to which heights between places are exact, mm; `None` without heights.
    pub fn beside(&self) -> Option<f32> {
        (!self.heights.is_empty()).then(|| self.radius() - Leads::SIDE * self.step)
    }

    /// The place before one across the track, and how far behind it that is.
    #[inline(always)]
    fn place(&self, b: f32) -> (usize, f32) {
        let place = positive((b - self.first) * self.per_mm - 0.5);
        let first = nearest(place);
        (first as usize, place + 0.5 - first as f32)
    }

    #[inline(always)]
    pub fn fine(&self, step: f32) -> Fine<'_> {
        let span = step * GROUP as f32;
        let per_span = if span == 0.0 { 0.0 } else { 1.0 / span };
        Fine {
            leads: self,
            span,
            per_span,
        }
    }

    /// For rows that begin at some places across the track.
    #[inline(always)]
    pub fn constant(&self, across: &[f32; BAND_ROWS]) -> Constant {
        let mut parts = [0.0; BAND_ROWS];
        for (part, b) in parts.iter_mut().zip(across) {
            *part = self.part(*b);
        }
        Constant { parts }
    }

    #[inline(always)]
    pub fn equal(&self, across: &[f32; BAND_ROWS], step: f32) -> Equal<'_> {
        let (mut firsts, mut shares) = ([0; BAND_ROWS], [0.0; BAND_ROWS]);
        let side = if step < 0.0 { -self.per_mm } else { self.per_mm };
        let beyond = self.first * self.per_mm + 0.5;
        for k in 0..BAND_ROWS {
            let place = across[k] * side - beyond;
            firsts[k] = nearest(place);
            shares[k] = place + 0.5 - firsts[k] as f32;
        }
        Equal {
            parts: &self.parts,
            firsts,
            shares,
        }
    }

    #[inline(always)]
    pub fn coarse(&self, step: f32, places: usize) -> Coarse<'_> {
        Coarse {
            leads: self,
            step,
            places,
        }
    }

    /// The place of a column, seen from the side from which the columns come.
    #[inline(always)]
    fn start(&self, b: f32, step: f32) -> (usize, f32) {
        self.place(if step < 0.0 { -b } else { b })
    }

    /// The heights near the columns of a row: from the place before the first one on.
    #[inline(always)]
    pub fn heights_of(&self, b: f32, step: f32) -> Heights<'_> {
        let (first, share) = self.start(b, step);
        let values = self.heights.get(first.saturating_sub(1)..).unwrap_or_default();
        Heights { values, share }
    }

    #[inline(always)]
    fn part(&self, b: f32) -> f32 {
        let (first, share) = self.place(b);
        match self.parts.get(first..) {
            Some([near, next, ..]) => near + (next - near) * share,
            _ => 0.0,
        }
    }

    /// What the height between the ends of the track is over that of the axis at a place across the track.
    pub fn height_at(&self, b: f32) -> f32 {
        self.height(b, self.part(b))
    }

    fn height(&self, b: f32, part: f32) -> f32 {
        let [flat, corner] = self.bottom;
        let lead = part * half_chord(self.radius(), b);
        let rise = positive((b * b + lead * lead).sqrt() - flat);
        corner - positive((corner - rise) * (corner + rise)).sqrt() - self.slope * lead
    }
}

#[inline(always)]
pub(crate) fn half_chord(radius: f32, b: f32) -> f32 {
    positive((radius - b) * (radius + b)).sqrt()
}

/// Points of the curve of the leads, from the track to its side. All of them are reckoned side by side.
struct Curve {
    /// Square of the distance from the track, mm².
    squares: [f32; Curve::POINTS],
    /// Lead as part of the half chord.
    parts: [f32; Curve::POINTS],
    /// Its change from here to the next point for each mm².
    rises: [f32; Curve::POINTS],
}

impl Curve {
    const POINTS: usize = 65;

    fn new([flat, corner]: [f32; 2], slope: f32) -> Curve {
        let radius = flat + corner;
        let (mut squares, mut parts) = ([0.0; Curve::POINTS], [0.0; Curve::POINTS]);
        for ((cos, square), part) in Curve::cosines(slope).iter().zip(&mut squares).zip(&mut parts) {
            let tilt = (slope * slope + cos * cos).sqrt();
            let r = flat + corner * slope / tilt;
            *square = r * r * (1.0 - cos) * (1.0 + cos);
            // r cos p by the root of radius² - (r sin p)², where radius - r = corner * (1 - sin) is so taken that
            // no digits are lost at the rim, and both shortened by cos p.
            let rest = corner * (radius + r) / (tilt * (tilt + slope));
            *part = r / (r * r + rest).sqrt();
        }
        let mut rises = [0.0; Curve::POINTS];
        for k in 1..Curve::POINTS {
            let run = squares[k] - squares[k - 1];
            let rise = (parts[k] - parts[k - 1]) / run;
            rises[k - 1] = if run > 0.0 { rise } else { 0.0 };
        }
        Curve {
            squares,
            parts,
            rises,
        }
    }

    /// Cosines of the angles from the track, falling from 1 to 0.
    ///
    /// On a faint slope the tangent `slope / cos` rises in the last cosines alone. So half of the points go in equal
    /// steps of the cosine, and the others, from the square root of the slope on, as that of the cotangent falls.
    fn cosines(slope: f32) -> [f32; Curve::POINTS] {
        const HALF: usize = Curve::POINTS / 2;
        let border = least(slope.sqrt(), 1.0);
        let mut cosines = [0.0; Curve::POINTS];
        for k in 0..=HALF {
            let share = k as i32 as f32 / HALF as f32;
            cosines[HALF + k] = border * border * (1.0 - share) / (border + share);
        }
        for (k, cosine) in cosines.iter_mut().enumerate().take(HALF) {
            *cosine = 1.0 - k as i32 as f32 / HALF as f32 * (1.0 - border);
        }
        cosines
    }

    fn bounds(&self) -> [f32; 2] {
        let (mut low, mut high) = ([f32::INFINITY; GROUP], [0.0; GROUP]);
        for parts in self.parts.chunks(GROUP) {
            for ((part, low), high) in parts.iter().zip(&mut low).zip(&mut high) {
                *low = least(*part, *low);
                *high = if *part > *high { *part } else { *high };
            }
        }
        [
            low.into_iter().fold(f32::INFINITY, least),
            high.into_iter().fold(0.0, f32::max),
        ]
    }

    /// The parts at places from the track on.
    fn fill(&self, step: f32, parts: &mut [f32]) {
        let mut next = 0;
        for (k, part) in parts.iter_mut().enumerate() {
            let b = k as i32 as f32 * step;
            let square = b * b;
            while self.squares.get(next).is_some_and(|end| *end <= square) {
                next += 1;
            }
            let last = next.saturating_sub(1);
            *part = self.parts[last] + self.rises[last] * (square - self.squares[last]);
        }
    }
}
