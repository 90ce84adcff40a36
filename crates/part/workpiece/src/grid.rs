//! The grid of columns that tiles the blank.

use crate::setup::Local;

/// Most columns that a height map may have; each takes 4 bytes.
pub const MAX_CELLS: usize = 32_000_000;

/// How fine the height map is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Resolution {
    /// About a million columns, with a round side length: 0.1 mm for a blank of 100 x 100 mm.
    #[default]
    BySize,
    /// Greatest side length of a column, mm.
    Millimetres(f64),
}

/// Columns of equal size over the working plane, in rows along the first axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    /// Columns along the first and second axis.
    pub nx: usize,
    pub ny: usize,
    /// Sides of a column, mm.
    pub dx: f64,
    pub dy: f64,
}

impl Grid {
    /// `Err` with the finest possible resolution when there would be too many columns.
    pub fn new(size: &Local, resolution: Resolution) -> Result<Grid, f64> {
        let area = size[0] * size[1];
        let cell = match resolution {
            Resolution::BySize => round_down((area / 1e6).sqrt()),
            Resolution::Millimetres(mm) => mm,
        };
        let count = |side: f64| (side / cell - 1e-9).ceil().max(1.0);
        let (nx, ny) = (count(size[0]), count(size[1]));
        if nx * ny > MAX_CELLS as f64 {
            return Err(finest(size));
        }
        Ok(Grid {
            nx: nx as usize,
            ny: ny as usize,
            dx: size[0] / nx,
            dy: size[1] / ny,
        })
    }

    /// The longer side of a column, mm.
    pub fn cell(&self) -> f64 {
        self.dx.max(self.dy)
    }

    /// Half the diagonal of a column: a disc of this radius always holds a column's centre, mm.
    pub fn half_diagonal(&self) -> f64 {
        0.5 * self.dx.hypot(self.dy)
    }

    /// The column that holds a point; `None` outside.
    pub fn cell_at(&self, x: f64, y: f64) -> Option<(usize, usize)> {
        let (i, j) = (x / self.dx, y / self.dy);
        let inside = i >= 0.0 && j >= 0.0 && i < self.nx as f64 && j < self.ny as f64;
        inside.then_some((i as usize, j as usize))
    }
}

/// The next smaller of 1, 1.25, 2, 2.5, 4, 5 times a power of ten: these divide whole millimetres (or
/// tens of them), so that walls at round coordinates fall on borders of columns.
fn round_down(cell: f64) -> f64 {
    let decade = 10f64.powf(cell.log10().floor());
    let factor = [5.0, 4.0, 2.5, 2.0, 1.25]
        .into_iter()
        .find(|f| f * decade <= cell * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * decade
}

/// A resolution that surely keeps below [`MAX_CELLS`], mm.
fn finest(size: &Local) -> f64 {
    // Rounding up to whole columns adds less than one row and one column.
    let most = MAX_CELLS as f64;
    let by_area = (size[0] * size[1] / most).sqrt() * 1.001;
    by_area.max(size[0].max(size[1]) * 2.1 / most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_size_is_round_and_tiles_the_blank() {
        let grid = Grid::new(&[100.0, 100.0, 20.0], Resolution::BySize).unwrap();
        assert_eq!((grid.nx, grid.ny), (1000, 1000));
        // sqrt(150 * 100 / 1e6) = 0.1225: rounded down to 0.1.
        let grid = Grid::new(&[150.0, 100.0, 20.0], Resolution::BySize).unwrap();
        assert_eq!((grid.nx, grid.ny), (1500, 1000));
        // 10.05 mm are not a multiple of 0.1 mm: 101 columns that are slightly narrower.
        let grid = Grid::new(&[10.05, 1.0, 1.0], Resolution::Millimetres(0.1)).unwrap();
        assert_eq!(grid.nx, 101);
        assert!((grid.nx as f64 * grid.dx - 10.05).abs() < 1e-12);
    }

    #[test]
    fn too_fine_names_a_resolution_that_works() {
        for size in [[100.0, 100.0, 1.0], [1e5, 1e-4, 1.0], [30_000.0, 400.0, 1.0]] {
            let finest = Grid::new(&size, Resolution::Millimetres(1e-9)).unwrap_err();
            Grid::new(&size, Resolution::Millimetres(finest)).unwrap();
        }
    }
}
