//! Tracks that follow one another share the work at their ends, and leave what each of them leaves alone.

use crate::common::*;
use bahn_path::{Axis, PathElement, Position, ToolShape};
use bahn_workpiece::{Part, Resolution, Workpiece};
use proptest::prelude::*;

const MM: f64 = 0.2;

fn cut(tool: ToolShape, elements: &[PathElement]) -> Part {
    let mut workpiece = Workpiece::new(&BLANK, Resolution::Millimetres(MM)).unwrap();
    for element in elements {
        workpiece.cut(element, &tool, Axis::Z);
    }
    workpiece.finished()
}

/// The greatest difference of two parts over the columns that both or none have at the rim, and the difference
/// in volume.
fn difference(a: &Part, b: &Part) -> (f64, f64) {
    let [nx, ny] = a.columns();
    let mut greatest: f64 = 0.0;
    let mut volume = 0.0;
    for j in 0..ny {
        for i in 0..nx {
            let centre = [(i as f64 + 0.5) * MM, (j as f64 + 0.5) * MM];
            let height = |part: &Part| part.height_at(centre).unwrap_or(BLANK.min[2]);
            let apart = (height(a) - height(b)).abs();
            greatest = greatest.max(apart);
            volume += apart * MM * MM;
        }
    }
    (greatest, volume)
}

/// A chain and its links, each cut by itself: the other way round, so that none follows another.
fn chain_and_links(points: &[Position]) -> [Vec<PathElement>; 2] {
    let links = points.windows(2);
    [
        links.clone().map(|pair| line(pair[0], pair[1])).collect(),
        links.rev().map(|pair| line(pair[0], pair[1])).collect(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// In any direction, up and down, level and plunging, with short and long links.
    #[test]
    fn a_chain_is_the_sum_of_its_links(
        start in [30.0..70.0f64, 25.0..55.0f64, -10.0..-4.0f64],
        heading in 0.0..360.0f64,
        links in proptest::collection::vec((0.05..4.0f64, -60.0..60.0f64, -0.6..0.6f64, 0..8), 2..40),
        r in 0.5..8.0f64, corner in 0.05..1.0f64, kind in 0..2,
    ) {
        let tool = if kind == 0 { ball(r) } else { torus(r, corner * r) };
        let (mut p, mut heading) = (start, heading);
        let mut points = vec![at(p[0], p[1], p[2])];
        for (length, turn, slope, special) in links {
            heading += if special == 1 { 3.0 * turn } else { turn };
            let (sin, cos) = if special == 2 { (0.0, 1.0) } else { heading.to_radians().sin_cos() };
            let fall = match special { 0 => 0.0, 3 => 4.0 * slope * length, _ => slope * length };
            let distance = if special == 4 { 0.0 } else { length };
            p = [p[0] + distance * cos, p[1] + distance * sin, (p[2] + fall).clamp(-19.0, -0.5)];
            points.push(at(p[0], p[1], p[2]));
        }
        let [chain, links] = chain_and_links(&points).map(|elements| cut(tool, &elements));
        // A column exactly on the rim of a tool may fall to either side: none here differs by more than what the
        // tool rises over a column's share, and all together by next to nothing.
        let (greatest, volume) = difference(&chain, &links);
        prop_assert!(volume < 2e-5 * chain.removed_mm3(), "{} mm³ of {}", volume, chain.removed_mm3());
        prop_assert!(greatest < 0.01 || volume < 4.0 * MM * MM * r, "{} mm", greatest);
    }
}

/// A finishing path over waves, in lines that turn back at the side of the blank.
#[test]
fn waves_are_cut_as_line_by_line() {
    let height = |x: f64, y: f64| -4.0 - (0.3 * x).sin() - (0.2 * y).cos();
    let mut points = Vec::new();
    for line in 0..12 {
        let y = 30.0 + 0.5 * f64::from(line);
        for step in 0..=60 {
            let x = f64::from(if line % 2 == 0 { step } else { 60 - step }) + 20.0;
            points.push(at(x, y, height(x, y)));
        }
    }
    // Radii for which no column lies on the rim.
    for tool in [ball(4.973), torus(4.973, 1.0), torus(4.973, 4.0)] {
        let [chain, links] = chain_and_links(&points).map(|elements| cut(tool, &elements));
        let (greatest, _) = difference(&chain, &links);
        assert!(greatest < 1e-3, "{greatest} mm, {tool:?}");
    }
}
