//! The material that is left.

use std::ops::Range;

use bahn_path::Axis;
use rayon::prelude::*;

use crate::cutters::Cutters;
use crate::grid::Grid;
use crate::setup::Setup;
use crate::trail::Trail;

/// What is left of the blank: one height for every column over the working plane.
#[derive(Clone, Debug)]
pub struct Part {
    pub(crate) setup: Setup,
    pub(crate) grid: Grid,
    /// Height of every column over the lower face of the blank, mm; 0 where nothing is left. Rows run
    /// along the first axis of the plane.
    pub(crate) heights: Vec<f32>,
    /// Who cut the columns, and the tool path: when they are remembered.
    pub(crate) cutters: Option<Cutters>,
    pub(crate) trail: Option<Trail>,
}

impl Part {
    pub(crate) fn new(setup: Setup, grid: Grid) -> Part {
        Part {
            setup,
            grid,
            heights: vec![setup.size[2] as f32; grid.nx * grid.ny],
            cutters: None,
            trail: None,
        }
    }

    /// The main axes of the blank: first and second of the working plane, tool axis.
    pub fn axes(&self) -> [Axis; 3] {
        self.setup.axes
    }

    /// Least coordinates of the blank in the order of [`Part::axes`], mm.
    pub fn min(&self) -> [f64; 3] {
        self.setup.min
    }

    /// Greatest coordinates of the blank in the order of [`Part::axes`], mm.
    pub fn max(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.setup.min[k] + self.setup.size[k])
    }

    /// Side lengths of the columns along the first and second axis, mm.
    pub fn resolution_mm(&self) -> [f64; 2] {
        [self.grid.dx, self.grid.dy]
    }

    /// Number of columns along the first and second axis.
    pub fn columns(&self) -> [usize; 2] {
        [self.grid.nx, self.grid.ny]
    }

    /// Heights of all columns over the lower face of the blank, mm; 0 where nothing is left. Rows run along the first
    /// axis.
    pub fn heights_mm(&self) -> &[f32] {
        &self.heights
    }

    /// Who cut each column last, as a mark; 0 where nothing was cut. `None` unless
    /// [`Workpiece::remember_tools`](crate::Workpiece::remember_tools) was called; [`Part::cutters`] says what
    /// the marks mean.
    pub fn marks(&self) -> Option<&[u8]> {
        self.cutters.as_ref().map(|cutters| cutters.marks.as_slice())
    }

    /// Volume of the removed material, mm³.
    pub fn removed_mm3(&self) -> f64 {
        let full = self.setup.size[2] as f32;
        let missing = |row: &[f32]| row.iter().map(|height| f64::from(full - height)).sum::<f64>();
        // Summed by rows and then in order, so that the last digit does not depend on the cores.
        let rows: Vec<f64> = self.heights.par_chunks(self.grid.nx).map(missing).collect();
        rows.iter().sum::<f64>() * self.grid.dx * self.grid.dy
    }

    /// Least and greatest coordinates of the material that is left, in the order of [`Part::axes`], mm; `None`
    /// when nothing is left.
    pub fn extent(&self) -> Option<[[f64; 3]; 2]> {
        let Grid { nx, dx, dy, .. } = self.grid;
        let (mut columns, mut rows, mut top) = ([usize::MAX, 0], [usize::MAX, 0], 0.0_f32);
        for (j, row) in self.heights.chunks(nx).enumerate() {
            let Some(first) = row.iter().position(|height| *height > 0.0) else {
                continue;
            };
            let last = row.iter().rposition(|height| *height > 0.0).unwrap_or(first);
            columns = [columns[0].min(first), columns[1].max(last + 1)];
            rows = [rows[0].min(j), j + 1];
            top = row.iter().copied().fold(top, f32::max);
        }
        let min = self.setup.min;
        (top > 0.0).then(|| {
            [
                [
                    min[0] + columns[0] as f64 * dx,
                    min[1] + rows[0] as f64 * dy,
                    min[2],
                ],
                [
                    min[0] + columns[1] as f64 * dx,
                    min[1] + rows[1] as f64 * dy,
                    min[2] + f64::from(top),
                ],
            ]
        })
    }

    /// Coordinate of the surface in the tool axis at a point of the working plane, mm. `None` outside
    /// the blank and where nothing is left.
    pub fn height_at(&self, point: [f64; 2]) -> Option<f64> {
        let (i, j) = self
            .grid
            .cell_at(point[0] - self.setup.min[0], point[1] - self.setup.min[1])?;
        let height = self.height(i, j);
        (height > 0.0).then(|| self.setup.min[2] + f64::from(height))
    }

    /// A detail for magnified views (MAGN [003:940-945]): the columns that a rectangle of the working
    /// plane touches, in the full height of the blank. `None` when it touches none.
    pub fn detail(&self, min: [f64; 2], max: [f64; 2]) -> Option<Part> {
        let columns = |k: usize, step: f64, count: usize| {
            // Borders that fall on the rectangle's side do not count as touched.
            const ON_BORDER: f64 = 1e-6;
            let first = ((min[k] - self.setup.min[k]) / step + ON_BORDER).floor().max(0.0) as usize;
            let end = (((max[k] - self.setup.min[k]) / step - ON_BORDER).ceil().max(0.0) as usize).min(count);
            (first < end).then_some(first..end)
        };
        let Grid { nx, ny, dx, dy } = self.grid;
        let (i, j) = (columns(0, dx, nx)?, columns(1, dy, ny)?);
        let heights = section(&self.heights, nx, &i, &j)?;
        let cutters = match &self.cutters {
            Some(cutters) => Some(cutters.with_marks(section(&cutters.marks, nx, &i, &j)?)),
            None => None,
        };
        let corner = [i.start as f64 * dx, j.start as f64 * dy];
        let mut setup = self.setup;
        setup.min[0] += corner[0];
        setup.min[1] += corner[1];
        setup.size[0] = i.len() as f64 * dx;
        setup.size[1] = j.len() as f64 * dy;
        Some(Part {
            setup,
            grid: Grid {
                nx: i.len(),
                ny: j.len(),
                dx,
                dy,
            },
            heights,
            cutters,
            trail: self.trail.as_ref().map(|trail| trail.seen_from(corner)),
        })
    }

    /// The part with the coordinate system turned by +90 degrees in the working plane, to be drawn: the first axis points up,
    /// the second one to the left [000:6386-6396]. It has no tool path.
    pub fn turned(&self) -> Part {
        let Grid { nx, ny, dx, dy } = self.grid;
        let [first, second, tool] = self.setup.axes;
        let ([x, y, z], [a, b, c]) = (self.setup.min, self.setup.size);
        Part {
            setup: Setup {
                axes: [second, first, tool],
                min: [-(y + b), x, z],
                size: [b, a, c],
                leftwards: true,
            },
            grid: Grid {
                nx: ny,
                ny: nx,
                dx: dy,
                dy: dx,
            },
            heights: turned(&self.heights, nx),
            cutters: self
                .cutters
                .as_ref()
                .map(|cutters| cutters.with_marks(turned(&cutters.marks, nx))),
            trail: None,
        }
    }

    /// Coordinates of the left and the right side of the blank, mm.
    pub(crate) fn left_and_right(&self) -> [f64; 2] {
        [self.min()[0], self.max()[0]].map(|side| self.across(side))
    }

    /// The coordinate that is shown for a place along the first axis, mm.
    pub(crate) fn across(&self, place: f64) -> f64 {
        if self.setup.leftwards { -place } else { place }
    }

    /// Height of a column over the lower face; 0 outside.
    #[inline]
    pub(crate) fn height(&self, i: usize, j: usize) -> f32 {
        if i >= self.grid.nx {
            return 0.0;
        }
        self.heights.get(j * self.grid.nx + i).copied().unwrap_or(0.0)
    }

    /// Height of an untouched column.
    pub(crate) fn top(&self) -> f32 {
        self.setup.size[2] as f32
    }
}

/// The values of some columns of some rows.
fn section<T: Copy>(values: &[T], width: usize, i: &Range<usize>, j: &Range<usize>) -> Option<Vec<T>> {
    let mut kept = Vec::with_capacity(i.len() * j.len());
    for row in values.chunks(width).take(j.end).skip(j.start) {
        kept.extend_from_slice(row.get(i.clone())?);
    }
    Some(kept)
}

/// Rows of `nx` values that are turned to the left by 90 degrees.
fn turned<T: Copy>(values: &[T], nx: usize) -> Vec<T> {
    let columns = 0..nx;
    columns
        .flat_map(|i| values.chunks(nx).rev().filter_map(move |row| row.get(i).copied()))
        .collect()
}
