//! Rays against the height map: where a line of sight first meets the part.
//!
//! A pyramid of maxima over 2 x 2 columns lets a ray leap over everything that lies below it.

use crate::part::Part;

pub(super) type Vector = [f64; 3];

/// Which side of a column a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Face {
    Top,
    /// Side whose normal is along the first (0) or second (1) axis.
    Side(usize),
    Bottom,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// Length along the ray in units of its direction.
    pub t: f64,
    pub face: Face,
    /// Column of the height map that is hit; `j` is its row.
    pub i: usize,
    pub j: usize,
}

struct Level {
    width: usize,
    heights: Vec<f32>,
}

/// A part made ready for rays. Points are in mm from the least corner of the blank.
pub(super) struct Caster<'a> {
    pub part: &'a Part,
    /// Maxima over squares of 2, 4, 8, ... columns.
    levels: Vec<Level>,
}

impl<'a> Caster<'a> {
    pub fn new(part: &'a Part) -> Caster<'a> {
        let mut levels: Vec<Level> = Vec::new();
        let (mut nx, mut ny) = (part.grid.nx, part.grid.ny);
        while nx > 1 || ny > 1 {
            let below: &[f32] = levels.last().map_or(&part.heights, |level| &level.heights);
            let (width, height) = (nx.div_ceil(2), ny.div_ceil(2));
            let mut heights = vec![0.0f32; width * height];
            for (row, cells) in below.chunks(nx).enumerate() {
                let start = row / 2 * width;
                for (pair, highest) in cells.chunks(2).zip(heights.iter_mut().skip(start)) {
                    *highest = pair.iter().copied().fold(*highest, f32::max);
                }
            }
            levels.push(Level { width, heights });
            (nx, ny) = (width, height);
        }
        Caster { part, levels }
    }

    /// Greatest height in a square of `2^level` columns.
    #[inline]
    fn highest(&self, level: usize, i: usize, j: usize) -> f64 {
        let height = match level.checked_sub(1).and_then(|k| self.levels.get(k)) {
            Some(level) => level.heights.get(j * level.width + i).copied().unwrap_or(0.0),
            None => self.part.height(i, j),
        };
        f64::from(height)
    }

    /// The first column that the ray from `origin` meets.
    pub fn cast(&self, origin: Vector, direction: Vector) -> Option<Hit> {
        let grid = &self.part.grid;
        // In units of columns, so that borders are whole numbers.
        let o = [origin[0] / grid.dx, origin[1] / grid.dy, origin[2]];
        let d = [direction[0] / grid.dx, direction[1] / grid.dy, direction[2]];
        let size = [grid.nx as f64, grid.ny as f64, f64::from(self.part.top())];
        let (mut t, end, mut entered) = enter_box(o, d, size)?;
        let counts = [grid.nx as i64, grid.ny as i64];
        let mut cell = [0i64; 2];
        for k in 0..2 {
            let start = (o[k] + d[k] * t).floor() as i64;
            cell[k] = start.clamp(0, counts[k] - 1);
        }
        let inverse = [1.0 / d[0], 1.0 / d[1]];
        let top_level = self.levels.len();
        let mut level = top_level;
        loop {
            let square = [cell[0] >> level, cell[1] >> level];
            // Where the ray leaves the square.
            let mut exit = end;
            let mut axis = 2;
            for k in 0..2 {
                if d[k] != 0.0 {
                    let border = (square[k] + i64::from(d[k] > 0.0)) << level;
                    let t_border = (border as f64 - o[k]) * inverse[k];
                    if t_border < exit {
                        exit = t_border;
                        axis = k;
                    }
                }
            }
            let exit = exit.max(t);
            let (z0, z1) = (o[2] + d[2] * t, o[2] + d[2] * exit);
            let height = self.highest(level, square[0] as usize, square[1] as usize);
            if z0.min(z1) <= height && height > 0.0 {
                if level > 0 {
                    level -= 1;
                    continue;
                }
                let (i, j) = (cell[0] as usize, cell[1] as usize);
                if z0 <= height {
                    let face = match entered {
                        2 if d[2] > 0.0 => Face::Bottom,
                        2 => Face::Top,
                        side => Face::Side(side),
                    };
                    return Some(Hit { t, face, i, j });
                }
                return Some(Hit {
                    t: (height - o[2]) / d[2],
                    face: Face::Top,
                    i,
                    j,
                });
            }
            if axis == 2 {
                return None;
            }
            t = exit;
            entered = axis;
            let other = 1 - axis;
            let next = square[axis] + if d[axis] > 0.0 { 1 } else { -1 };
            let within = (o[other] + d[other] * t).floor() as i64;
            let low = square[other] << level;
            cell[other] = within.clamp(low, low + (1 << level) - 1).min(counts[other] - 1);
            cell[axis] = if d[axis] > 0.0 {
                next << level
            } else {
                ((next + 1) << level) - 1
            };
            if cell[axis] < 0 || cell[axis] >= counts[axis] {
                return None;
            }
            level = (level + 1).min(top_level);
        }
    }
}

/// Where a ray enters and leaves the box from the origin to `size`, and through the side of which axis
/// it enters. Rays that start inside enter at 0 as if from above.
fn enter_box(o: Vector, d: Vector, size: Vector) -> Option<(f64, f64, usize)> {
    let (mut start, mut end, mut axis) = (0.0f64, f64::INFINITY, 2);
    for k in 0..3 {
        if d[k] == 0.0 {
            if o[k] < 0.0 || o[k] > size[k] {
                return None;
            }
            continue;
        }
        let (a, b) = (-o[k] / d[k], (size[k] - o[k]) / d[k]);
        if a.min(b) > start {
            start = a.min(b);
            axis = k;
        }
        end = end.min(a.max(b));
    }
    (start < end).then_some((start, end, axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};
    use proptest::prelude::*;

    /// A part of 23 x 17 columns of 1 mm with pseudo-random heights from 0 to 8 mm.
    fn rough_part() -> Part {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [23.0, 17.0, 8.0],
        };
        let mut part = Workpiece::new(&blank, Resolution::Millimetres(1.0))
            .unwrap()
            .finished();
        for (k, height) in part.heights.iter_mut().enumerate() {
            *height = ((k * 7919) % 9) as f32;
        }
        part
    }

    proptest! {
        /// The hit lies on the surface, and nothing before it is inside material.
        #[test]
        fn the_first_material_is_hit(
            from in [-30.0..60.0f64, -30.0..60.0f64, -20.0..30.0f64],
            to in [0.5..22.5f64, 0.5..16.5f64, 0.1..7.9f64],
        ) {
            let part = rough_part();
            let caster = Caster::new(&part);
            let d = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
            let inside = |t: f64| {
                let p = [0, 1, 2].map(|k| from[k] + d[k] * t);
                p[2] > 0.0 && part.grid.cell_at(p[0], p[1]).is_some_and(|(i, j)| p[2] < f64::from(part.height(i, j)))
            };
            prop_assume!(!inside(0.0));
            let hit = caster.cast(from, d);
            let last = hit.map_or(3.0, |hit| hit.t) - 1e-9;
            for k in 0..4000 {
                let t = f64::from(k) / 4000.0 * 3.0;
                prop_assert!(t > last || !inside(t), "material at {} before {:?}", t, hit);
            }
            if let Some(hit) = hit {
                prop_assert!(inside(hit.t + 1e-7) || inside(hit.t + 1e-6));
            }
        }
    }
}
