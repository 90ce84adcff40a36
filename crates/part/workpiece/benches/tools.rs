//! What material removal with a ball and with corner radii costs beside a flat end on the same path: CPU time of
//! all cores, so that the ratio holds on a busy computer too.
//!
//! A tool of 10 mm in a blank of 100 x 100 mm at 0.1 mm.

#![expect(clippy::expect_used, reason = "a benchmark may stop")]

use std::hint::black_box;
use std::time::Duration;

use bahn_path::{
    Arc, Axis, Blank, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Plane, Position, ToolShape,
};
use bahn_workpiece::{Resolution, Workpiece};
use rustix::time::{ClockId, clock_gettime};

const BLANK: Blank = Blank {
    plane: Plane::XY,
    min: [0.0, 0.0, -50.0],
    max: [100.0, 100.0, 0.0],
};
const RADIUS: f64 = 5.0;
/// Corner radii: flat end, ball, and between.
const CORNERS: [f64; 5] = [0.0, RADIUS, 0.2, 1.0, 4.0];
/// The fastest of so many runs counts.
const RUNS: usize = 5;

fn main() {
    // Run as a test it only shows that it runs.
    let (runs, share) = if std::env::args().any(|argument| argument == "--bench") {
        (RUNS, 1.0)
    } else {
        (1, 0.01)
    };
    print!("{:28}{:>12}", "CPU time against", "flat end");
    for corner in &CORNERS[1..] {
        print!(
            "{:>10}",
            if *corner == RADIUS {
                "ball".to_owned()
            } else {
                format!("R2 {corner}")
            }
        );
    }
    println!();
    let wanted: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with('-'))
        .collect();
    for (name, path) in paths() {
        if !wanted.iter().all(|word| name.contains(word.as_str())) {
            continue;
        }
        let path = &path[..((path.len() as f64 * share) as usize).max(1)];
        let mut fastest = [Duration::MAX; CORNERS.len()];
        for _ in 0..runs {
            for (fastest, corner_radius) in fastest.iter_mut().zip(CORNERS) {
                *fastest = cut(path, corner_radius).min(*fastest);
            }
        }
        let [flat, rest @ ..] = fastest.map(|time| time.as_secs_f64());
        print!("{name:28}{:>9.1} ms", 1e3 * flat);
        for time in rest {
            print!("{:>10.2}", time / flat);
        }
        println!();
    }
}

/// CPU time that cutting a path takes.
fn cut(path: &[PathElement], corner_radius: f64) -> Duration {
    let tool = ToolShape {
        radius: RADIUS,
        corner_radius,
        ..ToolShape::default()
    };
    let mut workpiece = Workpiece::new(&BLANK, Resolution::Millimetres(0.1)).expect("a valid blank");
    let spent = || {
        let time = clock_gettime(ClockId::ProcessCPUTime);
        Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
    };
    let before = spent();
    for element in path {
        workpiece.cut(element, &tool, Axis::Z);
    }
    black_box(workpiece.part());
    spent() - before
}

fn paths() -> Vec<(&'static str, Vec<PathElement>)> {
    vec![
        ("level, 1 mm", lines(1.0, 0.0, |_, _| -1.0)),
        ("level, oblique, 1 mm", lines(1.0, 30.0, |_, _| -1.0)),
        ("waves, 0.2 mm", lines(0.2, 0.0, wave)),
        ("waves, 1 mm", lines(1.0, 0.0, wave)),
        ("waves, 5 mm", lines(5.0, 0.0, wave)),
        ("waves, along Y, 1 mm", lines(1.0, 90.0, wave)),
        ("waves, oblique, 0.2 mm", lines(0.2, 30.0, wave)),
        ("waves, oblique, 1 mm", lines(1.0, 30.0, wave)),
        ("waves, oblique, 5 mm", lines(5.0, 60.0, wave)),
        ("ramps, 100 mm", lines(100.0, 0.0, ramp)),
        ("ramps, oblique, 100 mm", lines(100.0, 30.0, ramp)),
        ("to 76 degrees, 1 mm", lines(1.0, 0.0, steep)),
        ("to 76 deg., oblique, 1 mm", lines(1.0, 30.0, steep)),
        ("70 deg., oblique, 10 mm", lines(10.0, 30.0, teeth)),
        ("to 0.7 degrees, 1 mm", lines(1.0, 0.0, |u, v| 0.04 * wave(u, v))),
        (
            "to 0.7 deg., oblique, 1 mm",
            lines(1.0, 30.0, |u, v| 0.04 * wave(u, v)),
        ),
        (
            "0.1 deg., oblique, 5 mm",
            lines(5.0, 60.0, |u, _| -3.0 - 0.0017 * u),
        ),
        (
            "1 deg., oblique, 100 mm",
            lines(100.0, 30.0, |u, _| -3.0 - 0.0175 * u),
        ),
        ("helices", helices()),
        ("random walk, 1 mm", random_walk()),
    ]
}

fn wave(u: f64, v: f64) -> f64 {
    -3.0 - (0.3 * u).sin() - (0.2 * v).cos()
}

fn ramp(u: f64, v: f64) -> f64 {
    -12.0 - 0.2 * u - 0.05 * v
}

/// Slopes up to 4, 76 degrees.
fn steep(u: f64, v: f64) -> f64 {
    -25.0 - 10.0 * (0.4 * u).sin() - (0.2 * v).cos()
}

/// Up and down in moves of 10 mm, at 70 degrees.
fn teeth(u: f64, _: f64) -> f64 {
    let is_up = (u / 10.0).rem_euclid(2.0) < 1.0;
    -2.5 - if is_up { 0.0 } else { 27.5 }
}

fn at([x, y, z]: [f64; 3]) -> Position {
    let mut position = Position::UNKNOWN;
    position[Axis::X] = x;
    position[Axis::Y] = y;
    position[Axis::Z] = z;
    position
}

fn element(curve: Curve, start: [f64; 3], end: [f64; 3]) -> PathElement {
    PathElement {
        block: BlockRef::default(),
        sequence: 0,
        curve,
        start: at(start),
        end: at(end),
        feed: FeedRate::Programmed(1000.0),
        override_law: OverrideLaw::Free,
        constant_speed: false,
        tangential_end: false,
        end_feed: None,
        dwell_s: 0.0,
        placement: None,
        functions: None,
    }
}

fn chain(points: &[[f64; 3]]) -> Vec<PathElement> {
    points
        .windows(2)
        .map(|pair| element(Curve::Line, pair[0], pair[1]))
        .collect()
}

/// A meander about the middle of the blank, in moves of a length, 0.25 mm apart, turned.
fn lines(step: f64, turned_deg: f64, height: impl Fn(f64, f64) -> f64) -> Vec<PathElement> {
    const MOST: usize = 40_000;
    let (sin, cos) = turned_deg.to_radians().sin_cos();
    let count = (80.0 / step).round().max(1.0) as usize;
    let mut points = Vec::new();
    for line in 0..320 {
        for k in 0..=count {
            let k = if line % 2 == 0 { k } else { count - k };
            let (u, v) = (
                step * (k as f64 - 0.5 * count as f64),
                0.25 * f64::from(line - 160),
            );
            points.push([50.0 + u * cos - v * sin, 50.0 + u * sin + v * cos, height(u, v)]);
        }
    }
    points.truncate(MOST);
    chain(&points)
}

/// Turns of 2 mm pitch, down and up again, about many centres.
fn helices() -> Vec<PathElement> {
    let mut path = Vec::new();
    for k in 0..60 {
        let k = f64::from(k);
        let centre = [30.0 + 0.5 * k, 50.0 + 0.3 * k];
        let radius = 6.0 + 0.3 * k;
        let place = |z: f64| [centre[0] + radius, centre[1], z];
        for turn in 0..4 {
            let turn = f64::from(turn);
            let fall = if turn < 2.0 { 2.0 } else { -2.0 };
            let from = -1.0 - 0.1 * k - if turn < 2.0 { 2.0 * turn } else { 8.0 - 2.0 * turn };
            let arc = Arc {
                plane: Plane::XY,
                centre,
                sweep_deg: 360.0,
            };
            path.push(element(Curve::Arc(arc), place(from), place(from - fall)));
        }
    }
    path
}

/// Random directions, at slightly changing depth.
fn random_walk() -> Vec<PathElement> {
    let mut state = 1u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut p = [50.0, 50.0, -1.0];
    let points: Vec<_> = (0..=20_000)
        .map(|_| {
            let (sin, cos) = (std::f64::consts::TAU * random()).sin_cos();
            p = [
                (p[0] + cos).clamp(0.0, 100.0),
                (p[1] + sin).clamp(0.0, 100.0),
                (p[2] + 0.2 * (random() - 0.5)).clamp(-40.0, -1.0),
            ];
            p
        })
        .collect();
    chain(&points)
}
