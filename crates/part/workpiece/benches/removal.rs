//! Material removal: a million moves of 1 mm with a 10 mm tool in a blank of 100 x 100 mm at 0.1 mm.

#![expect(clippy::expect_used, reason = "a benchmark may stop")]

use bahn_path::{
    Axis, Blank, BlockRef, Curve, FeedRate, OverrideLaw, PathElement, Plane, Position, ToolShape,
};
use bahn_workpiece::{Resolution, Workpiece};

fn main() {
    divan::main();
}

const MOVES: usize = 1_000_000;

const BLANK: Blank = Blank {
    plane: Plane::XY,
    min: [0.0, 0.0, -50.0],
    max: [100.0, 100.0, 0.0],
};

/// Meander over the blank, 1 mm moves, 0.25 mm apart; each pass over the blank lies deeper. `wave`
/// makes every move a slope.
fn meander(wave: f64) -> Vec<[f64; 3]> {
    let lines = 401;
    (0..=MOVES)
        .map(|k| {
            let (line, step) = (k / 101, k % 101);
            let x = if line % 2 == 0 { step } else { 100 - step } as f64;
            let row = line % lines;
            let y = if (line / lines) % 2 == 0 {
                row
            } else {
                lines - 1 - row
            } as f64
                * 0.25;
            let z = -0.5 * (line / lines + 1) as f64 - wave * ((x * 0.3).sin() + (y * 0.2).cos());
            [x, y, z]
        })
        .collect()
}

/// A walk in random directions, 1 mm moves, always at slightly changing depth.
fn random_walk() -> Vec<[f64; 3]> {
    let mut state = 1u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut p = [50.0, 50.0, -1.0];
    (0..=MOVES)
        .map(|_| {
            let angle = std::f64::consts::TAU * random();
            p[0] = (p[0] + angle.cos()).clamp(0.0, 100.0);
            p[1] = (p[1] + angle.sin()).clamp(0.0, 100.0);
            p[2] = (p[2] + 0.2 * (random() - 0.5)).clamp(-40.0, -1.0);
            p
        })
        .collect()
}

fn run(points: &[[f64; 3]], corner_radius: f64) -> f64 {
    let tool = ToolShape {
        length: 0.0,
        radius: 5.0,
        corner_radius,
        ..ToolShape::default()
    };
    let mut workpiece = Workpiece::new(&BLANK, Resolution::Millimetres(0.1)).expect("a valid blank");
    let at = |p: &[f64; 3]| {
        let mut position = Position::UNKNOWN;
        position[Axis::X] = p[0];
        position[Axis::Y] = p[1];
        position[Axis::Z] = p[2];
        position
    };
    for (sequence, pair) in points.windows(2).enumerate() {
        let element = PathElement {
            block: BlockRef {
                program: 0,
                block: sequence as u32,
            },
            sequence: sequence as u64,
            curve: Curve::Line,
            start: at(&pair[0]),
            end: at(&pair[1]),
            feed: FeedRate::Programmed(1000.0),
            override_law: OverrideLaw::Free,
            constant_speed: false,
            tangential_end: false,
            end_feed: None,
            dwell_s: 0.0,
            placement: None,
            functions: None,
        };
        workpiece.cut(&element, &tool, Axis::Z);
    }
    workpiece.part().removed_mm3()
}

#[divan::bench(sample_count = 3)]
fn level_flat_end(bencher: divan::Bencher) {
    let points = meander(0.0);
    bencher.bench_local(|| run(&points, 0.0));
}

#[divan::bench(sample_count = 3)]
fn slopes_flat_end(bencher: divan::Bencher) {
    let points = meander(1.0);
    bencher.bench_local(|| run(&points, 0.0));
}

#[divan::bench(sample_count = 3)]
fn random_walk_flat_end(bencher: divan::Bencher) {
    let points = random_walk();
    bencher.bench_local(|| run(&points, 0.0));
}

#[divan::bench(sample_count = 3)]
fn slopes_ball_end(bencher: divan::Bencher) {
    let points = meander(1.0);
    bencher.bench_local(|| run(&points, 5.0));
}

#[divan::bench(sample_count = 3)]
fn slopes_corner_radius(bencher: divan::Bencher) {
    let points = meander(1.0);
    bencher.bench_local(|| run(&points[..MOVES / 10], 1.0));
}
