//! A ball that feels its way over the part, as a stylus that digitizes it.

use crate::part::Part;

/// Points at which the contact was not found yet.
const UNKNOWN: f32 = f32::NAN;

/// How high the tip of a ball stands when it touches the part: found at the corners of the columns as far as it is
/// asked for, and interpolated between them. What is found lies within a column of the truth.
#[derive(Clone, Debug)]
pub struct Feeler<'p> {
    part: &'p Part,
    radius: f64,
    /// Corners of columns, with a margin of the ball around the part.
    margin: [usize; 2],
    size: [usize; 2],
    heights: Vec<f32>,
}

impl<'p> Feeler<'p> {
    /// A ball of this radius, mm, above a part.
    pub fn new(part: &'p Part, radius_mm: f64) -> Feeler<'p> {
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
            heights: vec![UNKNOWN; size[0] * size[1]],
        }
    }

    /// Whether the ball with its tip at a position in X, Y and Z, mm, is in contact.
    pub fn touches(&mut self, tip: &[f64; 3]) -> bool {
        let setup = &self.part.setup;
        let local = |k: usize| {
            let place = setup.axes.get(k).map_or(0, |axis| axis.index());
            tip.get(place).copied().unwrap_or(f64::NAN) - setup.min.get(k).copied().unwrap_or(0.0)
        };
        let [x, y, z] = [0, 1, 2].map(local);
        let [dx, dy] = self.part.resolution_mm();
        let (u, v) = (x / dx + self.margin[0] as f64, y / dy + self.margin[1] as f64);
        let inside = |at: f64, size: usize| at >= 0.0 && at < (size - 1) as f64;
        if !inside(u, self.size[0]) || !inside(v, self.size[1]) {
            return false;
        }
        let (i, j) = (u.floor() as usize, v.floor() as usize);
        let (s, t) = (u - u.floor(), v - v.floor());
        let mut height = |i, j| f64::from(self.contact(i, j));
        let near = height(i, j) * (1.0 - s) + height(i + 1, j) * s;
        let far = height(i, j + 1) * (1.0 - s) + height(i + 1, j + 1) * s;
        z <= near * (1.0 - t) + far * t
    }

    /// Height of the tip over the lower face of the blank at a corner of columns. Beside the material it is so low that
    /// the wall between stands in the middle of a column.
    fn contact(&mut self, i: usize, j: usize) -> f32 {
        let place = j * self.size[0] + i;
        match self.heights.get(place) {
            Some(known) if !known.is_nan() => return *known,
            None => return 0.0,
            _ => {}
        }
        let found = self.find(i, j);
        if let Some(slot) = self.heights.get_mut(place) {
            *slot = found;
        }
        found
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
        let mut feeler = Feeler::new(&part, 3.0);
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
}
