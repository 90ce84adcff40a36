//! A solid from a mesh (STL): what of it can be seen from above.

use bahn_path::{Blank, Plane};
use thiserror::Error;

use crate::grid::Resolution;
use crate::part::Part;
use crate::workpiece::{Workpiece, WorkpieceError};

/// Most triangles of a mesh that is read: twice what is written.
const MAX_TRIANGLES: usize = 16_000_000;
/// The lower face of the solid lies so far below its lowest point, mm: a column of height 0 is no material.
const FLOOR_MM: f64 = 1.0;
/// A point on the border of two triangles belongs to both.
const ON_BORDER: f64 = 1e-9;

/// Why a mesh is no solid.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolidError {
    /// Neither binary nor text.
    #[error("the file is no STL mesh")]
    NoMesh,
    /// A line of a text cannot be read.
    #[error("line {0}: a vertex has three coordinates")]
    Vertex(usize),
    /// A coordinate is no number.
    #[error("triangle {0} has a coordinate that is no number")]
    Coordinate(usize),
    /// There are too many.
    #[error("the mesh has {0} triangles, the most are {MAX_TRIANGLES}")]
    TooLarge(usize),
    /// The height map cannot be made.
    #[error(transparent)]
    Workpiece(#[from] WorkpieceError),
}

type Triangle = [[f64; 3]; 3];

impl Part {
    /// The solid of a mesh, binary or text, whose coordinates are mm in workpiece coordinates and whose tool axis is Z:
    /// undercuts are filled, as a stylus from above finds them.
    ///
    /// # Errors
    /// When the file is no mesh, or its height map would be too large.
    pub fn from_stl(bytes: &[u8], resolution: Resolution) -> Result<Part, SolidError> {
        let triangles = match binary(bytes)? {
            Some(triangles) => triangles,
            None => text(bytes)?,
        };
        let mut blank = Blank {
            plane: Plane::XY,
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        };
        for (number, triangle) in triangles.iter().enumerate() {
            for point in triangle {
                if !point.iter().all(|value| value.is_finite()) {
                    return Err(SolidError::Coordinate(number + 1));
                }
                let corners = blank.min.iter_mut().zip(&mut blank.max);
                for ((min, max), value) in corners.zip(point) {
                    *min = min.min(*value);
                    *max = max.max(*value);
                }
            }
        }
        blank.min[2] -= FLOOR_MM;
        let mut part = Workpiece::new(&blank, resolution)?.finished();
        part.heights.fill(0.0);
        for triangle in &triangles {
            part.cover(triangle);
        }
        Ok(part)
    }

    /// Raises the columns whose middle lies below a triangle.
    fn cover(&mut self, triangle: &Triangle) {
        let min = self.setup.min;
        let [a, b, c] = triangle.map(|point| [0, 1, 2].map(|k| point[k] - min[k]));
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let area = u[0] * v[1] - u[1] * v[0];
        if area == 0.0 {
            return;
        }
        let sides = self.resolution_mm();
        let columns = self.columns();
        // Columns whose middle may lie below it.
        let range = |k: usize| {
            let (low, high) = (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
            let first = (low / sides[k] - 0.5 - ON_BORDER).ceil().max(0.0) as usize;
            let end = ((high / sides[k] - 0.5 + ON_BORDER).floor() + 1.0).max(0.0) as usize;
            first..end.min(columns[k])
        };
        for j in range(1) {
            for i in range(0) {
                let p = [
                    (i as f64 + 0.5) * sides[0] - a[0],
                    (j as f64 + 0.5) * sides[1] - a[1],
                ];
                let s = (p[0] * v[1] - p[1] * v[0]) / area;
                let t = (u[0] * p[1] - u[1] * p[0]) / area;
                if s < -ON_BORDER || t < -ON_BORDER || s + t > 1.0 + ON_BORDER {
                    continue;
                }
                let height = (a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2])) as f32;
                if let Some(column) = self.heights.get_mut(j * columns[0] + i) {
                    *column = column.max(height);
                }
            }
        }
    }
}

/// A binary mesh: a header of 80 bytes, the count, 50 bytes for each triangle. `None` for anything else.
fn binary(bytes: &[u8]) -> Result<Option<Vec<Triangle>>, SolidError> {
    let Some(count) = bytes.get(80..84).and_then(|count| count.try_into().ok()) else {
        return Ok(None);
    };
    let count = u32::from_le_bytes(count) as usize;
    let body = bytes.get(84..).unwrap_or_default();
    if Some(body.len()) != count.checked_mul(50) || count == 0 {
        return Ok(None);
    }
    if count > MAX_TRIANGLES {
        return Err(SolidError::TooLarge(count));
    }
    let value = |record: &[u8], at: usize| {
        let four = record.get(at..at + 4).and_then(|four| four.try_into().ok());
        four.map_or(f64::NAN, |four| f64::from(f32::from_le_bytes(four)))
    };
    let triangle = |record: &[u8]| [12, 24, 36].map(|corner| [0, 4, 8].map(|k| value(record, corner + k)));
    Ok(Some(body.chunks_exact(50).map(triangle).collect()))
}

/// A mesh as text: three lines `vertex X Y Z` for each triangle.
fn text(bytes: &[u8]) -> Result<Vec<Triangle>, SolidError> {
    let text = std::str::from_utf8(bytes).map_err(|_| SolidError::NoMesh)?;
    if !text.trim_start().starts_with("solid") {
        return Err(SolidError::NoMesh);
    }
    let mut points: Vec<[f64; 3]> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let Some(rest) = line.trim_start().strip_prefix("vertex") else {
            continue;
        };
        let mut values = rest.split_whitespace().map(str::parse::<f64>);
        let mut next = || values.next().and_then(Result::ok);
        let (Some(x), Some(y), Some(z)) = (next(), next(), next()) else {
            return Err(SolidError::Vertex(number + 1));
        };
        points.push([x, y, z]);
        if points.len() > 3 * MAX_TRIANGLES {
            return Err(SolidError::TooLarge(points.len() / 3));
        }
    }
    let (triangles, rest) = points.as_chunks::<3>();
    match !triangles.is_empty() && rest.is_empty() {
        true => Ok(triangles.to_vec()),
        false => Err(SolidError::NoMesh),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use std::sync::atomic::AtomicBool;

    /// A roof of 10 by 10 mm whose ridge at X 5 is 4 mm high: at X 2.5 it is 2 mm high. As text, with a hole in the
    /// floor.
    const ROOF: &str = "solid roof\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 5 0 4\nvertex 5 10 4\nendloop\n\
        endfacet\nfacet\nouter loop\nvertex 0 0 0\nvertex 5 10 4\nvertex 0 10 0\nendloop\nendfacet\nfacet\nouter loop\n\
        vertex 5 0 4\nvertex 10 0 0\nvertex 5 10 4\nendloop\nendfacet\nfacet\nouter loop\nvertex 5 10 4\nvertex 10 0 0\n\
        vertex 10 10 0\nendloop\nendfacet\nendsolid\n";

    #[test]
    fn a_mesh_becomes_a_height_map() {
        let part = Part::from_stl(ROOF.as_bytes(), Resolution::Millimetres(0.1)).unwrap();
        for (point, height) in [([2.5, 5.0], 2.0), ([7.5, 1.0], 2.0), ([5.0, 9.0], 4.0)] {
            let found = part.height_at(point).unwrap();
            assert!((found - height).abs() <= 0.05, "{point:?}: {found}");
        }
        // Written as a binary mesh and read again it is the same.
        let mut bytes = Vec::new();
        part.write_stl(&mut bytes, &AtomicBool::new(false)).unwrap();
        let again = Part::from_stl(&bytes, Resolution::Millimetres(0.1)).unwrap();
        for point in [[2.5, 5.0], [7.5, 1.0], [5.05, 9.0]] {
            let (a, b) = (part.height_at(point).unwrap(), again.height_at(point).unwrap());
            assert!((a - b).abs() < 1e-4, "{point:?}: {a} {b}");
        }
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let read = |bytes: &[u8]| Part::from_stl(bytes, Resolution::BySize).err();
        assert_eq!(read(b"BEGIN PGM 1 MM"), Some(SolidError::NoMesh));
        assert_eq!(read(b""), Some(SolidError::NoMesh));
        assert_eq!(read(b"solid\nvertex 1 2"), Some(SolidError::Vertex(2)));
        assert_eq!(
            read(b"solid\nvertex 1 2 nan\nvertex 0 0 0\nvertex 1 1 1"),
            Some(SolidError::Coordinate(1))
        );
    }
}
