//! Heights of whole chains of movements against the lowest height of the tool, column by column.

use crate::common::*;
use bahn_path::{Axis, Blank, Plane, ToolShape};
use bahn_workpiece::{Resolution, Workpiece};
use proptest::prelude::*;

type Point = [f64; 3];

const BOTTOM: f64 = -20.0;
/// Columns nearer to the rim of the tool may fall to either side, and the height changes too fast there, mm.
const RIM_MM: f64 = 0.02;

/// The lowest height of a tool that moves straight from `a` to `b` over a point; `None` where it is not, `Some(None)`
/// for the rim.
///
/// The bottom of the tool is convex, so over the piece of the line where the tool covers the point its height is so too,
/// and thirds of it can be thrown away.
fn lowest(a: Point, b: Point, point: [f64; 2], tool: &ToolShape) -> Option<Option<f64>> {
    let delta = [0, 1, 2].map(|k| b[k] - a[k]);
    let length = delta[0].hypot(delta[1]);
    let u = [delta[0] / length, delta[1] / length];
    let d = [point[0] - a[0], point[1] - a[1]];
    let (along, across) = (d[0] * u[0] + d[1] * u[1], d[0] * u[1] - d[1] * u[0]);
    let nearest = (along - along.clamp(0.0, length)).hypot(across);
    if (nearest - tool.radius).abs() < RIM_MM {
        return Some(None);
    }
    if nearest > tool.radius {
        return None;
    }
    let chord = (tool.radius * tool.radius - across * across).max(0.0).sqrt();
    let height = |s: f64| {
        let (flat, corner) = (tool.radius - tool.corner_radius, tool.corner_radius);
        let rise = ((along - s).hypot(across) - flat).clamp(0.0, corner);
        a[2] + delta[2] * s / length + corner - (corner * corner - rise * rise).sqrt()
    };
    let (mut from, mut to) = ((along - chord).max(0.0), (along + chord).min(length));
    for _ in 0..60 {
        let (s, t) = (from + (to - from) / 3.0, to - (to - from) / 3.0);
        if height(s) <= height(t) {
            to = t;
        } else {
            from = s;
        }
    }
    Some(Some(height(0.5 * (from + to))))
}

/// The greatest deviation of a column from what a chain of movements leaves there, and where.
fn deviation(chain: &[Point], tool: &ToolShape, mm: f64) -> (f64, [f64; 2]) {
    deviation_in([40.0, 40.0], chain, tool, mm)
}

/// The same in a blank of other sides.
fn deviation_in([x, y]: [f64; 2], chain: &[Point], tool: &ToolShape, mm: f64) -> (f64, [f64; 2]) {
    let blank = Blank {
        plane: Plane::XY,
        min: [0.0, 0.0, BOTTOM],
        max: [x, y, 0.0],
    };
    let mut workpiece = Workpiece::new(&blank, Resolution::Millimetres(mm)).unwrap();
    for pair in chain.windows(2) {
        let [from, to] = [pair[0], pair[1]].map(|p| at(p[0], p[1], p[2]));
        workpiece.cut(&line(from, to), tool, Axis::Z);
    }
    let part = workpiece.part();
    let [columns, rows] = part.columns();
    let mut worst = (0.0, [0.0; 2]);
    for j in 0..rows {
        for i in 0..columns {
            let point = [(i as f64 + 0.5) * mm, (j as f64 + 0.5) * mm];
            let heights: Option<Vec<f64>> = chain
                .windows(2)
                .filter_map(|pair| lowest(pair[0], pair[1], point, tool))
                .collect();
            let Some(heights) = heights else { continue };
            let expected = heights.into_iter().fold(0.0f64, f64::min).max(BOTTOM);
            let height = part.height_at(point).unwrap_or(BOTTOM);
            if (height - expected).abs() > worst.0 {
                worst = ((height - expected).abs(), point);
            }
        }
    }
    worst
}

/// Long tracks in all directions, steep and faint: to 5e-5 mm, a small corner on the faintest slope to 2e-4 mm,
/// since its flat ends between two places of the leads. Where the columns of a row lie close across the
/// track, heights go through four of them: the curvature jumps by `1 / corner` where the flat ends, and a cubic through
/// four values a step apart is off there by at most 0.0642 of half the jump times the square of the step.
#[test]
fn long_tracks_of_a_corner_radius_are_exact() {
    const ERROR_MM: f64 = 5e-4;
    const RADIUS: f64 = 4.0;
    const COLUMN_MM: f64 = 0.2;
    for (corner, table_mm) in [(0.5, 2e-4), (1.0, 5e-5), (3.0, 5e-5), (4.0, 5e-5)] {
        for slope in [0.0, 1e-4, 0.01, 0.3, 1.5] {
            for degrees in [0.0, 1.0, 30.0, 60.0, 90.0, 200.0, 315.0] {
                let (sin, cos) = f64::to_radians(degrees).sin_cos();
                let end = |s: f64| [20.0 + s * cos, 20.0 + s * sin, -9.0 + s * slope];
                let chain = [end(-9.7), end(9.7)];
                let step = COLUMN_MM * sin.abs();
                let is_close = step > 0.0 && step < RADIUS / 32.0 && slope > 0.0 && corner < RADIUS;
                let cubic_mm = if is_close {
                    0.0321 * step * step / corner
                } else {
                    0.0
                };
                let most = ERROR_MM.min(table_mm + cubic_mm);
                let (error, point) = deviation(&chain, &torus(RADIUS, corner), COLUMN_MM);
                assert!(
                    error <= most,
                    "{error} mm at {point:?}, not {most}: corner {corner}, slope {slope}, {degrees} degrees"
                );
            }
        }
    }
}

/// Places far from the lower end of a track lose no digits that count: 2 m along the rows, across them and oblique.
#[test]
fn tracks_through_a_great_blank_are_exact() {
    const ERROR_MM: f64 = 1e-3;
    let ramp = |to: [f64; 2]| [[10.0, 10.0, -19.0], [to[0], to[1], -1.0]];
    for (sides, chain) in [
        ([2000.0, 20.0], ramp([1990.0, 10.0])),
        ([2000.0, 100.0], ramp([1990.0, 90.0])),
        ([20.0, 2000.0], ramp([10.0, 1990.0])),
        ([1000.0, 1000.0], ramp([990.0, 700.0])),
    ] {
        let (error, point) = deviation_in(sides, &chain, &torus(4.0, 1.0), 0.5);
        assert!(error <= ERROR_MM, "{error} mm at {point:?} in {sides:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Movements that share what lies where they meet leave no column between them.
    #[test]
    fn chains_leave_the_lowest_height(
        corner in prop_oneof![0.1..1.0f64, Just(1.0)], falls in any::<bool>(), step in 0.1..6.0f64,
        fine in any::<bool>(),
        turns in prop::collection::vec((0.0..360.0f64, prop_oneof![Just(0.0), 0.0..0.02f64, 0.0..1.5f64]), 1..8),
    ) {
        const ERROR_MM: f64 = 1e-3;
        let mut chain = vec![[20.0, 20.0, if falls { -1.0 } else { -15.0 }]];
        let mut direction = 0.0;
        for (turn, slope) in &turns {
            direction += if step < 1.0 { 0.2 * (turn - 180.0) } else { *turn };
            let (sin, cos) = f64::to_radians(direction).sin_cos();
            let last = chain[chain.len() - 1];
            let rise = if falls { -slope * step } else { slope * step };
            chain.push([last[0] + step * cos, last[1] + step * sin, last[2] + rise]);
        }
        let (error, point) = deviation(&chain, &torus(4.0, 4.0 * corner), if fine { 0.1 } else { 0.2 });
        prop_assert!(error <= ERROR_MM, "{} mm at {:?} of {:?}", error, point, chain);
    }
}
