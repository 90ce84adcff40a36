//! The mesh of the finished part is closed and has the right volume.

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;

use crate::common::*;
use bahn_path::{Axis, Blank, Plane};
use bahn_workpiece::{MeshError, Part, Resolution, Workpiece};
use proptest::prelude::*;

type Triangle = [[f32; 3]; 3];

fn read_stl(part: &Part) -> Vec<Triangle> {
    let mut bytes = Vec::new();
    part.write_stl(&mut bytes, &AtomicBool::new(false)).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let float = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
    bytes[84..]
        .chunks(50)
        .map(|record| [0, 1, 2].map(|p| [0, 1, 2].map(|k| float(&record[12 + 12 * p + 4 * k..][..4]))))
        .collect()
}

/// Sum of the signed tetrahedra to the origin (divergence theorem).
fn volume(mesh: &[Triangle]) -> f64 {
    mesh.iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|p| p.map(f64::from));
            (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0
        })
        .sum()
}

/// Every edge is met as often in one direction as in the other. Returns the greatest number of
/// triangles at one edge.
fn assert_closed(mesh: &[Triangle]) -> usize {
    let key = |p: [f32; 3]| p.map(|v| (v + 0.0).to_bits());
    let mut edges: HashMap<_, (usize, usize)> = HashMap::new();
    for [a, b, c] in mesh {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (key(*from), key(*to));
            assert_ne!(from, to, "a triangle without area");
            if from < to {
                edges.entry((from, to)).or_default().0 += 1;
            } else {
                edges.entry((to, from)).or_default().1 += 1;
            }
        }
    }
    for (edge, (there, back)) in &edges {
        assert_eq!(there, back, "open edge {edge:?}");
    }
    edges
        .values()
        .map(|(there, back)| there + back)
        .max()
        .unwrap_or(0)
}

#[test]
fn a_blank_is_twelve_triangles() {
    let part = workpiece(0.5).finished();
    let mesh = read_stl(&part);
    assert_eq!(mesh.len(), 12);
    assert_eq!(assert_closed(&mesh), 2);
    assert!((volume(&mesh) - 100.0 * 80.0 * 20.0).abs() < 1e-6);
}

#[test]
fn pocket_hole_and_step() {
    let mut workpiece = workpiece(0.5);
    workpiece.cut(
        &line(at(30.0, 30.0, -7.3), at(70.0, 55.0, -7.3)),
        &flat(9.0),
        Axis::Z,
    );
    workpiece.cut(
        &line(at(50.0, 40.0, 5.0), at(50.0, 40.0, -25.0)),
        &flat(4.0),
        Axis::Z,
    );
    workpiece.cut(
        &line(at(0.0, 0.0, -3.1), at(0.0, 80.0, -12.0)),
        &ball(6.0),
        Axis::Z,
    );
    let part = workpiece.finished();
    let mesh = read_stl(&part);
    assert_closed(&mesh);
    let left = 100.0 * 80.0 * 20.0 - part.removed_mm3();
    assert!(
        (volume(&mesh) - left).abs() < 1e-5 * left,
        "{} {left}",
        volume(&mesh)
    );
}

#[test]
fn coordinates_are_those_of_the_workpiece() {
    let plane = Plane::of_tool_axis(Axis::X).unwrap();
    let blank = Blank {
        plane,
        min: [-5.0, 10.0, 20.0],
        max: [0.0, 40.0, 60.0],
    };
    let part = Workpiece::new(&blank, Resolution::Millimetres(1.0))
        .unwrap()
        .finished();
    let mesh = read_stl(&part);
    for k in 0..3 {
        let values = || mesh.iter().flatten().map(|p| p[k]);
        assert_eq!(values().fold(f32::INFINITY, f32::min), blank.min[k] as f32);
        assert_eq!(values().fold(f32::NEG_INFINITY, f32::max), blank.max[k] as f32);
    }
    // Outward orientation in this plane too: the volume is positive.
    assert!((volume(&mesh) - 5.0 * 30.0 * 40.0).abs() < 1e-6);
}

/// Diagonal waves with slopes of 0.35 at most: hardly two columns are equal.
fn waves(mm: f64, high: f64) -> Part {
    let mut workpiece = workpiece(mm);
    for row in 0..=160 {
        let y = 0.5 * f64::from(row);
        let point = |k: u32| {
            let x = f64::from(k);
            at(x, y, -3.0 - high * (0.25 * (x + y)).sin())
        };
        for k in 0..100 {
            workpiece.cut(&line(point(k), point(k + 1)), &ball(3.0), Axis::Z);
        }
    }
    workpiece.finished()
}

/// A step for each column takes at least two triangles for its floor and four for two walls. The mesh of waves has
/// a third of these at most, is closed, has the volume, and is nowhere off by more than a column's side.
#[test]
fn curved_surfaces_are_merged() {
    let part = waves(0.2, 1.0);
    let mesh = read_stl(&part);
    let columns: usize = part.columns().iter().product();
    assert!(
        mesh.len() < 2 * columns,
        "{} triangles, {columns} columns",
        mesh.len()
    );
    assert_closed(&mesh);
    let left = 100.0 * 80.0 * 20.0 - part.removed_mm3();
    assert!((volume(&mesh) - left).abs() < 1e-5 * left);
    // Middles of the upward triangles, which lie within columns of one step.
    for triangle in &mesh {
        let middle = [0, 1, 2].map(|k| triangle.iter().map(|p| f64::from(p[k])).sum::<f64>() / 3.0);
        let [a, b, c] = triangle;
        let is_level = a[2] == b[2] && b[2] == c[2] && a[2] > -20.0;
        if let Some(height) = part.height_at([middle[0], middle[1]]).filter(|_| is_level) {
            assert!((height - middle[2]).abs() <= 0.2 + 1e-5, "{height} {middle:?}");
        }
    }
}

/// A step as low as a hundredth of a column between two level floors stays.
#[test]
fn level_floors_stay() {
    let mut workpiece = workpiece(0.5);
    workpiece.cut(
        &line(at(-20.0, 40.0, -3.0), at(120.0, 40.0, -3.0)),
        &flat(10.0),
        Axis::Z,
    );
    workpiece.cut(
        &line(at(-20.0, 40.0, -3.005), at(120.0, 40.0, -3.005)),
        &flat(5.0),
        Axis::Z,
    );
    let mesh = read_stl(&workpiece.finished());
    for height in [-3.0f32, -3.005] {
        let on = |p: &[f32; 3]| (p[2] - height).abs() < 1e-5;
        assert!(mesh.iter().any(|triangle| triangle.iter().all(on)), "{height}");
    }
}

/// Sets the flag when the first bytes arrive, and counts them.
struct Stopper<'a>(&'a AtomicBool, usize);

impl std::io::Write for Stopper<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.store(true, std::sync::atomic::Ordering::Relaxed);
        self.1 += bytes.len();
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_mesh_is_stopped_before_and_while_it_is_written() {
    let part = waves(0.4, 1.0);
    let whole = 84 + 50 * read_stl(&part).len();
    let stop = AtomicBool::new(false);
    let mut writer = Stopper(&stop, 0);
    assert!(matches!(
        part.write_stl(&mut writer, &stop),
        Err(MeshError::Stopped)
    ));
    assert!(writer.1 > 0 && writer.1 < whole, "{} of {whole}", writer.1);
    let mut untouched = Stopper(&stop, 0);
    assert!(matches!(
        part.write_stl(&mut untouched, &stop),
        Err(MeshError::Stopped)
    ));
    assert_eq!(untouched.1, 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_part_is_closed(
        cuts in proptest::collection::vec(
            ([0.0..100.0f64, 0.0..80.0f64, -25.0..0.0f64], [0.0..100.0f64, 0.0..80.0f64, -25.0..0.0f64], 1.0..20.0f64, 0..3),
            1..8,
        ),
    ) {
        let mut workpiece = workpiece(1.0);
        for (a, b, r, kind) in cuts {
            let tool = match kind { 0 => flat(r), 1 => ball(r), _ => torus(r, 0.4 * r) };
            workpiece.cut(&line(at(a[0], a[1], a[2]), at(b[0], b[1], b[2])), &tool, Axis::Z);
        }
        let part = workpiece.finished();
        let mesh = read_stl(&part);
        assert_closed(&mesh);
        let left = 100.0 * 80.0 * 20.0 - part.removed_mm3();
        prop_assert!((volume(&mesh) - left).abs() < 1e-4 * 160_000.0, "{} {}", volume(&mesh), left);
    }
}
