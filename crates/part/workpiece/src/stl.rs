//! The part as a closed mesh.
//!
//! Equal neighbours are merged to rectangles: floors of one height, walls between the same two
//! heights, the lower face. Where rectangles of different size meet, the greater one gets the corners
//! of the smaller ones on its border, so that every edge has exactly the same ends on both sides.

use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use bahn_path::Direction;
use thiserror::Error;

use crate::part::Part;

/// Most triangles of a mesh; each takes 50 bytes.
pub const MAX_TRIANGLES: usize = 8_000_000;

/// Faces that are worked off between two looks at whether the work shall end.
const CHUNK: usize = 4096;

/// Why there is no mesh.
#[derive(Debug, Error)]
pub enum MeshError {
    /// Nobody could read so much.
    #[error(
        "the mesh would have {triangles} triangles, the most are {most}: a coarser resolution makes fewer"
    )]
    TooLarge {
        /// How many it would have.
        triangles: usize,
        /// How many it may have.
        most: usize,
    },
    /// The work was stopped.
    #[error("stopped")]
    Stopped,
    /// The STL file could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Whether the work goes on: the error ends it.
pub(crate) type GoOn<'a> = &'a dyn Fn() -> Result<(), MeshError>;

type Triangle = [[f32; 3]; 3];

/// A corner of the mesh: point of the lattice between the columns, height as it is in the map.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Corner {
    i: usize,
    j: usize,
    z: f32,
}

/// A merged rectangle. Its normal points along the axis that stands on it, out of the material.
#[derive(Clone, Debug)]
enum Face {
    /// Floor or lower face.
    Level {
        i: Range<usize>,
        j: Range<usize>,
        z: f32,
        normal: Direction,
    },
    /// Wall across the first axis at the lattice line `i`.
    First {
        i: usize,
        j: Range<usize>,
        z: [f32; 2],
        normal: Direction,
    },
    /// Wall across the second axis at the lattice line `j`.
    Second {
        j: usize,
        i: Range<usize>,
        z: [f32; 2],
        normal: Direction,
    },
}

impl Part {
    /// Writes the part as binary STL in workpiece coordinates, mm. The mesh is closed: every edge is
    /// met as often in one direction as in the other; its volume is that of the height map. On curved
    /// surfaces columns that differ by their side at most are one step.
    ///
    /// The work ends early once `stop` is set.
    ///
    /// # Errors
    /// For a mesh of more than [`MAX_TRIANGLES`], and when it was stopped.
    pub fn write_stl(&self, writer: impl Write, stop: &AtomicBool) -> Result<(), MeshError> {
        self.write_mesh(writer, stop, MAX_TRIANGLES)
    }

    fn write_mesh(&self, writer: impl Write, stop: &AtomicBool, most: usize) -> Result<(), MeshError> {
        let go_on = || {
            if stop.load(Ordering::Relaxed) {
                Err(MeshError::Stopped)
            } else {
                Ok(())
            }
        };
        let coarse = self.coarse(&go_on)?;
        let mesh = Mesh::new(&coarse, &go_on)?;
        let mut count = 0;
        for faces in mesh.faces.chunks(CHUNK) {
            go_on()?;
            count += faces.iter().map(|face| mesh.triangles(face).len()).sum::<usize>();
        }
        if count > most {
            return Err(MeshError::TooLarge {
                triangles: count,
                most,
            });
        }
        let mut writer = BufWriter::new(writer);
        let mut header = [0u8; 80];
        for (to, from) in header.iter_mut().zip(b"Bahn: finished part, mm") {
            *to = *from;
        }
        writer.write_all(&header)?;
        writer.write_all(&(count as u32).to_le_bytes())?;
        for faces in mesh.faces.chunks(CHUNK) {
            go_on()?;
            for triangle in faces.iter().flat_map(|face| mesh.triangles(face)) {
                write_triangle(&mut writer, &triangle)?;
            }
        }
        Ok(writer.flush()?)
    }
}

fn write_triangle(writer: &mut impl Write, triangle: &Triangle) -> io::Result<()> {
    let [a, b, c] = triangle.map(|p| p.map(f64::from));
    let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let normal = normal.map(|n| if length > 0.0 { (n / length) as f32 } else { 0.0 });
    let mut record = [0u8; 50];
    let values = normal.iter().chain(triangle.iter().flatten());
    for (bytes, value) in record.chunks_exact_mut(4).zip(values) {
        bytes.copy_from_slice(&value.to_le_bytes());
    }
    writer.write_all(&record)
}

struct Mesh<'a> {
    part: &'a Part,
    faces: Vec<Face>,
    /// Heights of the corners at each point of the lattice: `heights[starts[p]..starts[p + 1]]`.
    starts: Vec<u32>,
    heights: Vec<f32>,
}

impl<'a> Mesh<'a> {
    fn new(part: &'a Part, go_on: GoOn) -> Result<Mesh<'a>, MeshError> {
        let mut faces = Vec::new();
        let height = |i: usize, j: usize| part.height(i, j);
        merge_level(part, height, Direction::Plus, &mut faces, go_on)?;
        merge_level(
            part,
            |i, j| if part.height(i, j) > 0.0 { 1.0 } else { 0.0 },
            Direction::Minus,
            &mut faces,
            go_on,
        )?;
        merge_walls(part, &mut faces, go_on)?;
        let mut mesh = Mesh {
            part,
            faces,
            starts: Vec::new(),
            heights: Vec::new(),
        };
        go_on()?;
        mesh.collect_corners();
        Ok(mesh)
    }

    fn lattice(&self, i: usize, j: usize) -> usize {
        j * (self.part.grid.nx + 1) + i
    }

    fn collect_corners(&mut self) {
        // Heights are never negative, so their bits sort like they do.
        let mut keys: Vec<u64> = Vec::with_capacity(4 * self.faces.len());
        for face in &self.faces {
            let corners = rectangle(face);
            keys.extend(
                corners
                    .iter()
                    .map(|c| (self.lattice(c.i, c.j) as u64) << 32 | u64::from(c.z.to_bits())),
            );
        }
        keys.sort_unstable();
        keys.dedup();
        let points = (self.part.grid.nx + 1) * (self.part.grid.ny + 1);
        let mut starts = vec![0u32; points + 1];
        for key in &keys {
            if let Some(count) = starts.get_mut((key >> 32) as usize + 1) {
                *count += 1;
            }
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        self.starts = starts;
        self.heights = keys.into_iter().map(|key| f32::from_bits(key as u32)).collect();
    }

    /// Heights of the corners at a point of the lattice, rising.
    fn corners_at(&self, i: usize, j: usize) -> &[f32] {
        let p = self.lattice(i, j);
        let range = self.starts.get(p..=p + 1).and_then(|ends| match ends {
            [start, end] => self.heights.get(*start as usize..*end as usize),
            _ => None,
        });
        range.unwrap_or_default()
    }

    /// The corners on each side of a face, counter-clockwise as seen from outside; the end of a side
    /// is the start of the next.
    fn sides(&self, face: &Face) -> [Vec<Corner>; 4] {
        let [a, b, c, d] = rectangle(face);
        [(a, b), (b, c), (c, d), (d, a)].map(|(from, to)| {
            let mut side = Vec::with_capacity(4);
            self.side(from, to, &mut side);
            side.push(to);
            side
        })
    }

    /// Corners from one corner of a rectangle to the next, without the latter.
    fn side(&self, from: Corner, to: Corner, border: &mut Vec<Corner>) {
        let steps = from.i.abs_diff(to.i) + from.j.abs_diff(to.j);
        if steps == 0 {
            let between = |z: &f32| *z > from.z.min(to.z) && *z < from.z.max(to.z);
            let inner = self.corners_at(from.i, from.j).iter().copied().filter(between);
            border.push(from);
            if from.z < to.z {
                border.extend(inner.map(|z| Corner { z, ..from }));
            } else {
                border.extend(inner.rev().map(|z| Corner { z, ..from }));
            }
            return;
        }
        for step in 0..steps {
            let along = |a: usize, b: usize| {
                if a == b {
                    a
                } else if a < b {
                    a + step
                } else {
                    a - step
                }
            };
            let corner = Corner {
                i: along(from.i, to.i),
                j: along(from.j, to.j),
                z: from.z,
            };
            if step == 0 || self.corners_at(corner.i, corner.j).contains(&corner.z) {
                border.push(corner);
            }
        }
    }

    /// The triangles of a face: a strip between two opposite sides when only these have additional
    /// corners, else a fan about the middle, so that no triangle is flat. Triangles whose corners fall
    /// together in the precision of STL are left out: their edges cancel each other.
    fn triangles(&self, face: &Face) -> Vec<Triangle> {
        let mut triangles = Vec::with_capacity(4);
        let mut add = |triangle: Triangle| {
            let [a, b, c] = triangle;
            if a != b && b != c && c != a {
                triangles.push(triangle);
            }
        };
        let sides = self
            .sides(face)
            .map(|side| side.into_iter().map(|c| self.point(c)).collect::<Vec<_>>());
        match &sides {
            [a, b, c, d] if b.len() == 2 && d.len() == 2 => strip(a, c, &mut add),
            [a, b, c, d] if a.len() == 2 && c.len() == 2 => strip(b, d, &mut add),
            [a, _, c, _] => {
                let middle =
                    |k: usize| 0.5 * (a.first().map_or(0.0, |p| p[k]) + c.first().map_or(0.0, |p| p[k]));
                let middle = [0, 1, 2].map(middle);
                for pair in sides.iter().flat_map(|side| side.windows(2)) {
                    if let [from, to] = pair {
                        add([middle, *from, *to]);
                    }
                }
            }
        }
        triangles
    }

    /// A corner in workpiece coordinates X, Y, Z.
    fn point(&self, corner: Corner) -> [f32; 3] {
        let Part { setup, grid, .. } = self.part;
        let local = [
            corner.i as f64 * grid.dx,
            corner.j as f64 * grid.dy,
            f64::from(corner.z),
        ];
        let mut point = [0.0; 3];
        for (k, axis) in setup.axes.iter().enumerate() {
            if let Some(coordinate) = point.get_mut(axis.index()) {
                *coordinate = (setup.min[k] + local[k]) as f32;
            }
        }
        point
    }
}

/// Triangles between two opposite sides of a rectangle that go around it in one sense.
fn strip(side: &[[f32; 3]], opposite: &[[f32; 3]], add: &mut impl FnMut(Triangle)) {
    let mut near = side.windows(2).enumerate().peekable();
    let mut far = opposite.windows(2).rev().enumerate().peekable();
    let (Some(mut p), Some(mut q)) = (side.first(), opposite.last()) else {
        return;
    };
    loop {
        // Both sides are followed at the same pace.
        let ahead = |k: usize, count: usize| (k + 1) as f64 / count as f64;
        let near_first = match (near.peek(), far.peek()) {
            (None, None) => return,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (Some((k, _)), Some((l, _))) => ahead(*k, side.len()) <= ahead(*l, opposite.len()),
        };
        if near_first {
            if let Some((_, [_, next])) = near.next() {
                add([*p, *next, *q]);
                p = next;
            }
        } else if let Some((_, [next, _])) = far.next() {
            add([*p, *next, *q]);
            q = next;
        }
    }
}

/// The four corners of a face, counter-clockwise as seen from outside.
fn rectangle(face: &Face) -> [Corner; 4] {
    let corner = |i, j, z| Corner { i, j, z };
    let (corners, normal) = match face {
        Face::Level { i, j, z, normal } => (
            [
                corner(i.start, j.start, *z),
                corner(i.end, j.start, *z),
                corner(i.end, j.end, *z),
                corner(i.start, j.end, *z),
            ],
            *normal,
        ),
        Face::First {
            i,
            j,
            z: [low, high],
            normal,
        } => (
            [
                corner(*i, j.start, *low),
                corner(*i, j.end, *low),
                corner(*i, j.end, *high),
                corner(*i, j.start, *high),
            ],
            *normal,
        ),
        Face::Second {
            j,
            i,
            z: [low, high],
            normal,
        } => (
            [
                corner(i.end, *j, *low),
                corner(i.start, *j, *low),
                corner(i.start, *j, *high),
                corner(i.end, *j, *high),
            ],
            *normal,
        ),
    };
    let [a, b, c, d] = corners;
    match normal {
        Direction::Plus => corners,
        Direction::Minus => [d, c, b, a],
    }
}

/// Rectangles of columns with one height: each grows along the row first, then over rows.
fn merge_level(
    part: &Part,
    height: impl Fn(usize, usize) -> f32,
    normal: Direction,
    faces: &mut Vec<Face>,
    go_on: GoOn,
) -> Result<(), MeshError> {
    let (nx, ny) = (part.grid.nx, part.grid.ny);
    let mut done = vec![false; nx * ny];
    for j in 0..ny {
        go_on()?;
        let mut i = 0;
        while i < nx {
            let z = height(i, j);
            let free = |done: &[bool], i: usize, j: usize| {
                height(i, j) == z && done.get(j * nx + i).is_some_and(|done| !done)
            };
            if z <= 0.0 || !free(&done, i, j) {
                i += 1;
                continue;
            }
            let right = (i..nx).find(|k| !free(&done, *k, j)).unwrap_or(nx);
            let bottom = (j + 1..ny)
                .find(|row| !(i..right).all(|k| free(&done, k, *row)))
                .unwrap_or(ny);
            for row in j..bottom {
                if let Some(cells) = done.get_mut(row * nx + i..row * nx + right) {
                    cells.fill(true);
                }
            }
            let z = match normal {
                Direction::Plus => z,
                Direction::Minus => 0.0,
            };
            faces.push(Face::Level {
                i: i..right,
                j: j..bottom,
                z,
                normal,
            });
            i = right;
        }
    }
    Ok(())
}

/// Walls between columns of different height, merged along the lattice lines.
fn merge_walls(part: &Part, faces: &mut Vec<Face>, go_on: GoOn) -> Result<(), MeshError> {
    let (nx, ny) = (part.grid.nx, part.grid.ny);
    // Outside the blank there is nothing: index -1 wraps to one that is too great.
    let at = |i: usize, j: usize| if j < ny { part.height(i, j).max(0.0) } else { 0.0 };
    let mut runs = |line: usize, count: usize, pair: &dyn Fn(usize) -> [f32; 2], across: usize| {
        let mut start = 0;
        while start < count {
            let [before, after] = pair(start);
            let end = (start + 1..count)
                .find(|k| pair(*k) != [before, after])
                .unwrap_or(count);
            if before != after {
                let z = [before.min(after), before.max(after)];
                let normal = Direction::minus_if(before < after);
                faces.push(if across == 0 {
                    Face::First {
                        i: line,
                        j: start..end,
                        z,
                        normal,
                    }
                } else {
                    Face::Second {
                        j: line,
                        i: start..end,
                        z,
                        normal,
                    }
                });
            }
            start = end;
        }
    };
    for i in 0..=nx {
        go_on()?;
        runs(i, ny, &|j| [at(i.wrapping_sub(1), j), at(i, j)], 0);
    }
    for j in 0..=ny {
        go_on()?;
        runs(j, nx, &|i| [at(i, j.wrapping_sub(1)), at(i, j)], 1);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Resolution, Workpiece};
    use bahn_path::{Blank, Plane};

    #[test]
    fn a_mesh_too_large_is_refused() {
        let blank = Blank {
            plane: Plane::XY,
            min: [0.0; 3],
            max: [10.0; 3],
        };
        let part = Workpiece::new(&blank, Resolution::Millimetres(1.0))
            .unwrap()
            .finished();
        let (stop, mut file) = (AtomicBool::new(false), Vec::new());
        // A box: two triangles for each of six sides.
        let refused = part.write_mesh(&mut file, &stop, 11);
        assert!(matches!(
            refused,
            Err(MeshError::TooLarge {
                triangles: 12,
                most: 11
            })
        ));
        assert!(file.is_empty());
        part.write_mesh(&mut file, &stop, 12).unwrap();
        assert_eq!(file.len(), 84 + 12 * 50);
    }
}
