//! How far before its axis a tool with a corner radius is lowest.

use std::ops::Range;

use crate::raster::{GROUP, Row, least, positive};

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
/// count.
#[derive(Clone, Debug)]
pub(crate) struct Leads {
    /// By equal steps of the half chord as part of the radius, which straightens the curve.
    leads: [f32; Leads::COUNT + 1],
    /// Bounds of the lead as part of the half chord.
    pub least: f32,
    pub most: f32,
    radius: f32,
    flat: f32,
    slope: f32,
    /// Whether some columns are surely touched between the ends of the track.
    pub is_long: bool,
    /// By the steps of a row from column to column.
    pub fan: Option<Fan>,
}

/// Leads across the whole track from one side to the other, as far apart as the columns of a row lie across the
/// track: in every row they are met one after the other, each row at another place between them.
#[derive(Clone, Debug)]
pub(crate) struct Fan {
    leads: Vec<f32>,
    /// What the height is over that of the axis between the ends of the track; nothing for a short one.
    heights: Vec<f32>,
    /// From column to column across the track, mm.
    step: f32,
    /// So far from the track the heights are sure, mm: at the sides they change too fast.
    pub beside: f32,
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
    pub fn heights_of(&self, row: &Row) -> Curved<'_> {
        let radius = self.beside + Fan::SIDE * self.step;
        let (first, t) = self.place(radius, row);
        let shares = [
            -t * (t - 1.0) * (t - 2.0) / 6.0,
            (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
            -(t + 1.0) * t * (t - 2.0) / 2.0,
            (t + 1.0) * t * (t - 1.0) / 6.0,
        ];
        let near = self.heights.get(first.saturating_sub(1)..).unwrap_or_default();
        Curved { near, shares }
    }
}

/// Values of the fan for the columns of a row, between four neighbours each.
pub(crate) struct Curved<'a> {
    near: &'a [f32],
    shares: [f32; 4],
}

impl Curved<'_> {
    #[inline(always)]
    pub fn group(&self, k: usize) -> [f32; GROUP] {
        let Some(near) = self.near.get(k..k + GROUP + 3) else {
            return [f32::INFINITY; GROUP];
        };
        let s = self.shares;
        std::array::from_fn(|n| near[n] * s[0] + near[n + 1] * s[1] + near[n + 2] * s[2] + near[n + 3] * s[3])
    }
}

/// The first and the last number of steps from `start` that lie in a range.
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
            flat,
            slope,
            is_long: false,
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
        leads.is_long = length > 2.0 * leads.longest();
        let step = step.abs();
        if Fan::STEPS.contains(&(step / radius)) {
            let count = (2.0 * radius / step) as usize + 2 * Fan::BEYOND;
            let first = -radius - Fan::BEYOND as f32 * step;
            let mut fan = vec![0.0; count];
            leads.look_up(first, step, &mut fan);
            let heights = (0..if leads.is_long { count } else { 0 }).zip(&fan);
            leads.fan = Some(Fan {
                heights: heights
                    .map(|(k, lead)| leads.height(first + k as i32 as f32 * step, *lead))
                    .collect(),
                leads: fan,
                step,
                beside: radius - Fan::SIDE * step,
            });
        }
        leads
    }

    /// The leads of neighbouring columns of a row.
    #[inline]
    pub fn fill(&self, row: &Row, leads: &mut [f32]) {
        let [_, b] = row.place(0.0);
        let step = row.dx * row.uy;
        let width = step.abs() * leads.len() as f32;
        if width <= FLATTEST * self.radius {
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
                // At the rim the leads change too fast for a straight line between places of the fan.
                let count = leads.len();
                let inside = between(b, step, -fan.beside..fan.beside);
                let [start, end] = inside.map(|k| (k.max(0.0) as usize).min(count));
                let (before, rest) = leads.split_at_mut(start);
                self.look_up(b, step, before);
                let behind = rest.get_mut(end.max(start) - start..).unwrap_or_default();
                self.look_up(b + end.max(start) as f32 * step, step, behind);
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

    /// The lead at a place across the track.
    #[inline]
    fn beside(&self, b: f32) -> f32 {
        self.at(positive((self.radius - b) * (self.radius + b)).sqrt() / self.radius)
    }

    /// The greatest lead, mm.
    pub fn longest(&self) -> f32 {
        self.most.max(FLATTEST) * self.radius
    }

    /// As [`Leads::height`] without a lead at hand.
    pub fn height_at(&self, b: f32) -> f32 {
        self.height(b, self.beside(b))
    }

    /// What the height between the ends of the track is over that of the axis at a place across the track.
    fn height(&self, b: f32, lead: f32) -> f32 {
        let rise = positive((b * b + lead * lead).sqrt() - self.flat);
        let corner = self.radius - self.flat;
        corner - positive((corner - rise) * (corner + rise)).sqrt() - self.slope * lead
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
