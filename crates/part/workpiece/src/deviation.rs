//! How far a part is from another one: what was machined, and what it was to be.

use rayon::prelude::*;

use crate::part::Part;

/// A place that is so near on the other surface is looked for beside a column: steep walls stand within a column of
/// the map, columns.
const BESIDE: isize = 4;

/// How far each column of a part is from the surface of another one.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Signed, mm: positive where material is left, negative where too much was removed; not a number where one of the
    /// parts has nothing.
    pub(crate) columns: Vec<f32>,
}

impl Deviation {
    /// The greatest material that is left, and the greatest that is missing, mm; both 0 or greater.
    pub fn greatest_mm(&self) -> [f64; 2] {
        let known = self.columns.iter().filter(|value| !value.is_nan());
        known.fold([0.0; 2], |[left, missing], value| {
            let value = f64::from(*value);
            [f64::max(left, value), f64::max(missing, -value)]
        })
    }

    /// The mean of what all columns are off, mm; without a column that can be compared `None`.
    pub fn mean_mm(&self) -> Option<f64> {
        let known = self.columns.iter().filter(|value| !value.is_nan());
        let (count, sum) = known.fold((0u64, 0.0), |(count, sum), value| {
            (count + 1, sum + f64::from(value.abs()))
        });
        (count > 0).then(|| sum / count as f64)
    }

    /// The part of the columns that are off by no more than this, 0 to 1.
    pub fn share_within(&self, mm: f64) -> f64 {
        let known = self.columns.iter().filter(|value| !value.is_nan());
        let (count, good) = known.fold((0u64, 0u64), |(count, good), value| {
            (count + 1, good + u64::from(f64::from(value.abs()) <= mm))
        });
        if count == 0 {
            0.0
        } else {
            good as f64 / count as f64
        }
    }
}

impl Part {
    /// How far the surface is from that of another part in the same workpiece coordinates: to the nearest column of it.
    pub fn deviation(&self, from: &Part) -> Deviation {
        let [nx, ny] = self.columns();
        let [dx, dy] = self.resolution_mm();
        let min = self.min();
        let other: Vec<f64> = (0..nx * ny)
            .into_par_iter()
            .map(|place| {
                let (i, j) = (place % nx, place / nx);
                let point = [min[0] + (i as f64 + 0.5) * dx, min[1] + (j as f64 + 0.5) * dy];
                from.height_at(point).unwrap_or(f64::NAN)
            })
            .collect();
        let column = |place: usize| {
            let (i, j) = ((place % nx) as isize, (place / nx) as isize);
            let over = self.heights.get(place).copied().unwrap_or(0.0);
            let straight = other.get(place).copied().unwrap_or(f64::NAN);
            if over <= 0.0 || straight.is_nan() {
                return f32::NAN;
            }
            let height = min[2] + f64::from(over);
            let off = height - straight;
            let mut nearest = off * off;
            for l in -BESIDE..=BESIDE {
                for k in -BESIDE..=BESIDE {
                    let (at, row) = (i + k, j + l);
                    if at < 0 || row < 0 || at >= nx as isize || row >= ny as isize {
                        continue;
                    }
                    let there = other
                        .get(row as usize * nx + at as usize)
                        .copied()
                        .unwrap_or(f64::NAN);
                    let flat = (k as f64 * dx).powi(2) + (l as f64 * dy).powi(2);
                    // The surface between this column and that one lies between their heights.
                    let low = there.min(straight);
                    let high = there.max(straight);
                    let up = height - height.clamp(low, high);
                    let square = flat + up * up;
                    if square < nearest {
                        nearest = square;
                    }
                }
            }
            (nearest.sqrt() * off.signum()) as f32
        };
        Deviation {
            columns: (0..nx * ny).into_par_iter().map(column).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    fn block(top: f64) -> Part {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0, 0.0, -20.0],
            max: [10.0, 10.0, top],
        };
        Workpiece::new(&blank, Resolution::Millimetres(0.5))
            .unwrap()
            .finished()
    }

    /// A block that is 0.1 mm too high has so much left everywhere; one that is too low misses it.
    #[test]
    fn what_is_left_and_what_is_missing() {
        let (model, high, low) = (block(0.0), block(0.1), block(-0.2));
        let left = high.deviation(&model);
        assert!((left.greatest_mm()[0] - 0.1).abs() < 1e-5 && left.greatest_mm()[1] == 0.0);
        assert!((left.mean_mm().unwrap() - 0.1).abs() < 1e-5);
        assert_eq!((left.share_within(0.09), left.share_within(0.11)), (0.0, 1.0));
        let missing = low.deviation(&model);
        assert!(missing.greatest_mm()[0] == 0.0 && (missing.greatest_mm()[1] - 0.2).abs() < 1e-5);
    }
}
