//! A ball that feels its way over the part, as a stylus that digitizes it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::part::Part;

/// Points at which the contact was not found yet.
const UNKNOWN: f32 = f32::NAN;
/// Steps that find the nearest place on a slope.
const STEPS: u32 = 6;
/// Farther than this a place outside of the material is not looked for, mm: no stylus is deflected as far.
const FARTHEST_MM: f64 = 6.0;

/// How high the tip of a ball stands when it touches the part: found at the corners of the columns as far as it is
/// asked for, and interpolated between them. What is found lies within a column of the truth.
#[derive(Debug)]
pub struct Feeler {
    part: Arc<Part>,
    radius: f64,
    /// Corners of columns, with a margin of the ball around the part.
    margin: [usize; 2],
    size: [usize; 2],
    /// As bits: who finds one first does not matter, all find the same.
    heights: Vec<AtomicU32>,
}

impl Feeler {
    /// A ball of this radius, mm, above a part.
    pub fn new(part: Arc<Part>, radius_mm: f64) -> Feeler {
        let radius = radius_mm.max(0.0);
        let [nx, ny] = part.columns();
        let [dx, dy] = part.resolution_mm();
        let margin = [dx, dy].map(|side| (radius / side).ceil() as usize + 2);
        let size = [nx + 1 + 2 * margin[0], ny + 1 + 2 * margin[1]];
        Feeler {
            part,
            radius,
            margin,
            size,
            heights: (0..size[0] * size[1])
                .map(|_| AtomicU32::new(UNKNOWN.to_bits()))
                .collect(),
        }
    }

    /// Whether the ball with its tip at a position in X, Y and Z, mm, is in contact.
    pub fn touches(&self, tip: &[f64; 3]) -> bool {
        let [x, y, z] = self.local(tip);
        self.height([x, y]).is_some_and(|height| z <= height)
    }

    /// The shortest displacement out of the material of a ball with its tip at a position in X, Y and Z, mm: how far a stylus is
    /// deflected whose probe stands there. 0 where it is in contact with nothing.
    pub fn deflection(&self, tip: &[f64; 3]) -> [f64; 3] {
        let at = self.local(tip);
        let Some(up) = self.height([at[0], at[1]]).map(|height| height - at[2]) else {
            return [0.0; 3];
        };
        if up < 0.0 || up.is_nan() {
            return [0.0; 3];
        }
        let slope = self.down_the_slope(at);
        let straight = [0.0, 0.0, up];
        let shorter = |a: [f64; 3], b: [f64; 3]| if length(a) < length(b) { a } else { b };
        let best = shorter(slope.unwrap_or(straight), straight);
        let delta = shorter(
            self.beside(at, length(best).min(FARTHEST_MM)).unwrap_or(best),
            best,
        );
        let mut along = [0.0; 3];
        for (axis, part) in self.part.setup.axes.iter().zip(delta) {
            if let Some(place) = along.get_mut(axis.index()) {
                *place = part;
            }
        }
        along
    }

    /// The displacement to the nearest place of a slope: along its normal, step by step.
    fn down_the_slope(&self, from: [f64; 3]) -> Option<[f64; 3]> {
        let [dx, dy] = self.part.resolution_mm();
        let mut at = from;
        for _ in 0..STEPS {
            let missing = self.height([at[0], at[1]])? - at[2];
            let rise = |step: [f64; 2]| {
                let ahead = self.height([at[0] + step[0], at[1] + step[1]])?;
                let back = self.height([at[0] - step[0], at[1] - step[1]])?;
                Some((ahead - back) / (2.0 * (step[0] + step[1])))
            };
            let (u, v) = (rise([dx, 0.0])?, rise([0.0, dy])?);
            let part = missing / (1.0 + u * u + v * v);
            at = [at[0] - u * part, at[1] - v * part, at[2] + part];
        }
        // Where it came to nothing the material ends otherwise.
        let missing = self.height([at[0], at[1]])? - at[2];
        (missing.abs() < dx.max(dy)).then(|| std::array::from_fn(|k| at[k] - from[k]))
    }

    /// The shortest displacement to a corner of columns at which the ball is free, shorter than a length.
    fn beside(&self, at: [f64; 3], within: f64) -> Option<[f64; 3]> {
        let [dx, dy] = self.part.resolution_mm();
        let range = |at: f64, side: f64, margin: usize, size: usize| {
            let place = |value: f64| (value / side).max(-(margin as f64)) + margin as f64;
            let (low, high) = (place(at - within).ceil(), place(at + within).floor());
            low as usize..(high as usize + 1).min(size)
        };
        let (mut best, mut shortest) = (None, within * within);
        for j in range(at[1], dy, self.margin[1], self.size[1]) {
            let y = (j as f64 - self.margin[1] as f64) * dy - at[1];
            for i in range(at[0], dx, self.margin[0], self.size[0]) {
                let x = (i as f64 - self.margin[0] as f64) * dx - at[0];
                let flat = x * x + y * y;
                if flat >= shortest {
                    continue;
                }
                let up = (f64::from(self.contact(i, j)) - at[2]).max(0.0);
                if flat + up * up < shortest {
                    shortest = flat + up * up;
                    best = Some([x, y, up]);
                }
            }
        }
        best
    }

    /// From the least corner of the blank, in the order of its axes.
    fn local(&self, tip: &[f64; 3]) -> [f64; 3] {
        let setup = &self.part.setup;
        [0, 1, 2].map(|k| {
            let place = setup.axes.get(k).map_or(0, |axis| axis.index());
            tip.get(place).copied().unwrap_or(f64::NAN) - setup.min.get(k).copied().unwrap_or(0.0)
        })
    }

    /// Height of the tip in contact; `None` where there is nothing to touch.
    fn height(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let [dx, dy] = self.part.resolution_mm();
        let (u, v) = (x / dx + self.margin[0] as f64, y / dy + self.margin[1] as f64);
        let inside = |at: f64, size: usize| at >= 0.0 && at < (size - 1) as f64;
        if !inside(u, self.size[0]) || !inside(v, self.size[1]) {
            return None;
        }
        let (i, j) = (u.floor() as usize, v.floor() as usize);
        let (s, t) = (u - u.floor(), v - v.floor());
        let height = |i, j| f64::from(self.contact(i, j));
        let near = height(i, j) * (1.0 - s) + height(i + 1, j) * s;
        let far = height(i, j + 1) * (1.0 - s) + height(i + 1, j + 1) * s;
        Some(near * (1.0 - t) + far * t)
    }

    /// Height of the tip over the lower face of the blank at a corner of columns. Beside the material it is so low that
    /// the wall between stands in the middle of a column.
    fn contact(&self, i: usize, j: usize) -> f32 {
        let place = j * self.size[0] + i;
        match self.heights.get(place) {
            Some(slot) => {
                let known = f32::from_bits(slot.load(Ordering::Relaxed));
                if !known.is_nan() {
                    return known;
                }
                let found = self.find(i, j);
                slot.store(found.to_bits(), Ordering::Relaxed);
                found
            }
            None => 0.0,
        }
    }

    fn find(&self, i: usize, j: usize) -> f32 {
        let [dx, dy] = self.part.resolution_mm();
        let [nx, ny] = self.part.columns();
        let reach = |at: usize, margin: usize, side: f64, count: usize| {
            // The corner stands between the columns at - margin - 1 and at - margin.
            let centre = at as f64 - margin as f64;
            let first = (centre - self.radius / side).floor().clamp(0.0, count as f64) as usize;
            let end = (centre + self.radius / side).ceil().clamp(0.0, count as f64) as usize;
            (centre, first..end)
        };
        let (u, columns) = reach(i, self.margin[0], dx, nx);
        let (v, rows) = reach(j, self.margin[1], dy, ny);
        // To the nearest edge of a column.
        let gap = |at: f64, column: usize, side: f64| {
            let low = column as f64;
            (low - at).max(at - low - 1.0).max(0.0) * side
        };
        let square = self.radius * self.radius;
        // The columns at the corner first: none that is not higher than what they give comes to anything.
        let nearest = |at: f64, count: usize| {
            let column = at.max(0.0) as usize;
            column.saturating_sub(1)..(column + 1).min(count)
        };
        let mut highest = 0.0_f64;
        for row in nearest(v, ny) {
            for height in self.row(row, nearest(u, nx)) {
                highest = highest.max(f64::from(*height));
            }
        }
        highest = match highest > 0.0 && (0.0..=nx as f64).contains(&u) && (0.0..=ny as f64).contains(&v) {
            true => highest,
            false => f64::NEG_INFINITY,
        };
        for row in rows {
            let across = gap(v, row, dy).powi(2);
            for (column, height) in columns.clone().zip(self.row(row, columns.clone())) {
                let height = f64::from(*height);
                if height > 0.0 && height > highest {
                    let beside = across + gap(u, column, dx).powi(2);
                    if beside <= square {
                        highest = highest.max(height + (square - beside).sqrt() - self.radius);
                    }
                }
            }
        }
        let below = -(self.part.max()[2] - self.part.min()[2]) - 2.0 * self.radius;
        highest.max(below) as f32
    }

    /// Heights of some columns of a row.
    fn row(&self, row: usize, columns: std::ops::Range<usize>) -> &[f32] {
        let start = row * self.part.grid.nx;
        self.part
            .heights
            .get(start + columns.start..start + columns.end)
            .unwrap_or_default()
    }
}

fn length(delta: [f64; 3]) -> f64 {
    delta.iter().map(|part| part * part).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    /// Above the blank the tip touches its upper face; beside it at an edge the ball of 3 mm touches 3 mm outside as long
    /// as its centre is below the face, 4 mm outside nowhere.
    #[test]
    fn a_blank_is_felt() {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0, 0.0, -20.0],
            max: [40.0, 30.0, 0.0],
        };
        let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.25)).unwrap();
        let part = workpiece.part().clone();
        let feeler = Feeler::new(Arc::new(part), 3.0);
        for (tip, touches) in [
            ([20.0, 15.0, 0.01], false),
            ([20.0, 15.0, 0.0], true),
            ([0.0, 0.0, -0.01], true),
            ([-2.7, 15.0, -5.0], true),
            ([-3.3, 15.0, -5.0], false),
            ([20.0, 34.0, -5.0], false),
            // The centre 1 mm above the face: the edge touches at the root of 8.
            ([-2.6, 15.0, -2.0], true),
            ([-3.1, 15.0, -2.0], false),
            ([500.0, 15.0, -2.0], false),
            ([f64::NAN, 15.0, -2.0], false),
        ] {
            assert_eq!(feeler.touches(&tip), touches, "{tip:?}");
        }
    }

    /// 1 mm deep in the upper face it is pushed up by 1 mm; 1 mm deep in a side, far below the edge, it is pushed off
    /// that side.
    #[test]
    fn a_ball_is_pushed_out_the_shortest_way() {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0, 0.0, -20.0],
            max: [40.0, 30.0, 0.0],
        };
        let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(0.25)).unwrap();
        let feeler = Feeler::new(Arc::new(workpiece.part().clone()), 3.0);
        for (tip, pushed) in [
            ([20.0, 15.0, -1.0], [0.0, 0.0, 1.0]),
            ([20.0, 15.0, 0.1], [0.0; 3]),
            // The ball of 3 mm radius touches the side at X 0 from X -3 on.
            ([-2.0, 15.0, -12.0], [-1.0, 0.0, 0.0]),
            ([42.0, 15.0, -12.0], [1.0, 0.0, 0.0]),
        ] {
            let found = feeler.deflection(&tip);
            for (a, b) in found.iter().zip(pushed) {
                assert!((a - b).abs() < 0.26, "{tip:?}: {found:?}");
            }
        }
    }
}
