//! Fewer, greater columns for the mesh.
//!
//! On a curved surface no two columns are equal, and each would be a step of its own. Rectangles of columns whose
//! heights differ by no more than a column's side become one step at their mean height, so
//! that the volume stays. Level floors stay as they are.

use crate::part::Part;
use crate::stl::{GoOn, MeshError};

/// How much the heights of columns that become one step differ at most, as part of a column's side
/// *(inferred)*: so the mesh errs upward by no more than a map does sideways.
const STEP: f64 = 1.0;

impl Part {
    /// The part with such rectangles made level.
    pub(crate) fn coarse(&self, go_on: GoOn) -> Result<Part, MeshError> {
        let mut merging = Merging {
            part: self,
            step: (STEP * self.grid.cell()) as f32,
            heights: self.heights.clone(),
        };
        for j in 0..self.grid.ny {
            go_on()?;
            for i in 0..self.grid.nx {
                if merging.is_free(i, j) {
                    merging.merge(i, j);
                }
            }
        }
        let mut heights = merging.heights;
        for height in &mut heights {
            *height = height.abs();
        }
        // A mesh has no colours and no path.
        Ok(Part {
            setup: self.setup,
            grid: self.grid,
            heights,
            cutters: None,
            trail: None,
        })
    }
}

struct Merging<'a> {
    part: &'a Part,
    step: f32,
    /// The new heights; less than 0 where a column belongs to a rectangle.
    heights: Vec<f32>,
}

impl Merging<'_> {
    /// Whether a column can become part of a rectangle: it is no hole, nor part of a level floor.
    fn is_free(&self, i: usize, j: usize) -> bool {
        let (nx, ny) = (self.part.grid.nx, self.part.grid.ny);
        if i >= nx || j >= ny || self.heights.get(j * nx + i).is_none_or(|height| *height < 0.0) {
            return false;
        }
        let height = self.part.height(i, j);
        let equal = |i: usize, j: usize| i < nx && j < ny && self.part.height(i, j) == height;
        let is_level =
            equal(i.wrapping_sub(1), j) || equal(i + 1, j) || equal(i, j.wrapping_sub(1)) || equal(i, j + 1);
        height > 0.0 && !is_level
    }

    /// Grows a rectangle from a column to both sides in turn, and makes it level.
    fn merge(&mut self, i: usize, j: usize) {
        let nx = self.part.grid.nx;
        let (mut right, mut bottom) = (i + 1, j + 1);
        let first = self.part.height(i, j);
        let mut bounds = [first, first];
        loop {
            let column = self.widened(bounds, (j..bottom).map(|j| (right, j)));
            if let Some(wider) = column {
                (bounds, right) = (wider, right + 1);
            }
            let row = self.widened(bounds, (i..right).map(|i| (i, bottom)));
            if let Some(wider) = row {
                (bounds, bottom) = (wider, bottom + 1);
            }
            if column.is_none() && row.is_none() {
                break;
            }
        }
        let columns = || (j..bottom).flat_map(|j| (i..right).map(move |i| (i, j)));
        let sum: f64 = columns().map(|(i, j)| f64::from(self.part.height(i, j))).sum();
        let mean = (sum / ((right - i) * (bottom - j)) as f64) as f32;
        for (i, j) in columns() {
            if let Some(height) = self.heights.get_mut(j * nx + i) {
                *height = -mean;
            }
        }
    }

    /// Least and greatest height with some more columns, when these are free and no step too great.
    fn widened(
        &self,
        bounds: [f32; 2],
        mut columns: impl Iterator<Item = (usize, usize)>,
    ) -> Option<[f32; 2]> {
        columns.try_fold(bounds, |[low, high], (i, j)| {
            let height = self.part.height(i, j);
            let [low, high] = [low.min(height), high.max(height)];
            (self.is_free(i, j) && high - low <= self.step).then_some([low, high])
        })
    }
}
