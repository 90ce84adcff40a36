//! Random paths and machines for the laws.

use bahn_motion::Limits;
use bahn_path::{Axis, FeedRate, PathElement, PerAxis, Position};
use proptest::prelude::*;

use super::Path;

/// One random block, turned into an element by the path that it continues.
#[derive(Clone, Debug)]
pub enum Block {
    /// Straight on in XY after a change of heading, with a part in Z and of the rotary axis C.
    Line {
        turn_deg: f64,
        length: f64,
        z: f64,
        c: f64,
    },
    /// An arc that starts after a change of heading; its radius may grow by a factor to the end.
    Arc {
        turn_deg: f64,
        radius: f64,
        growth: f64,
        sweep_deg: f64,
        z: f64,
    },
    /// A line, and an arc at its corner to another direction in space: `by` is X, Y and Z of that direction.
    Corner { radius: f64, by: [f64; 3] },
    /// Only the rotary axis.
    Rotary { c: f64 },
    /// To the same point.
    Nothing,
}

#[derive(Clone, Debug)]
pub struct Random {
    pub blocks: Vec<(Block, Option<f64>, bool)>,
    pub limits: Limits,
}

impl Random {
    pub fn elements(&self) -> Vec<PathElement> {
        let mut path = Path::new(1000.0);
        let mut heading = 0.0f64;
        for (block, feed, m90) in &self.blocks {
            path.feed(feed.map_or(FeedRate::Rapid, FeedRate::Programmed));
            match *block {
                Block::Line {
                    turn_deg,
                    length,
                    z,
                    c,
                } => {
                    heading += turn_deg;
                    let (sin, cos) = heading.to_radians().sin_cos();
                    path.by(&[
                        (Axis::X, length * cos),
                        (Axis::Y, length * sin),
                        (Axis::Z, length * z),
                        (Axis::C, length * c),
                    ]);
                }
                Block::Arc {
                    turn_deg,
                    radius,
                    growth,
                    sweep_deg,
                    z,
                } => {
                    let radii = [radius, radius * growth];
                    path.spiral(heading + turn_deg, radii, sweep_deg, radius * z);
                    heading += turn_deg + sweep_deg;
                }
                Block::Corner { radius, by } => {
                    let (sin, cos) = heading.to_radians().sin_cos();
                    path.corner([cos, sin, 0.0], by, radius);
                    heading = by[1].atan2(by[0]).to_degrees();
                }
                Block::Rotary { c } => {
                    path.by(&[(Axis::C, c)]);
                }
                Block::Nothing => {
                    path.by(&[]);
                }
            }
            path.last().constant_speed = *m90;
        }
        path.elements
    }
}

pub fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> + Clone {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

/// Mostly small changes of direction, as short lines on a surface make them, some large, some none.
pub fn turn() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        2 => Just(0.0),
        4 => -12.0..12.0f64,
        2 => decades(1e-6, 1.0),
        1 => -180.0..180.0f64,
    ]
}

pub fn block() -> impl Strategy<Value = Block> {
    let share = prop_oneof![3 => Just(0.0), 1 => -1.0..1.0f64];
    let rotary = prop_oneof![6 => Just(0.0), 1 => -20.0..20.0f64];
    let growth = prop_oneof![6 => Just(1.0), 1 => 0.99..1.01f64, 1 => 0.3..3.0f64];
    prop_oneof![
        8 => (turn(), decades(0.001, 20.0), share.clone(), rotary)
            .prop_map(|(turn_deg, length, z, c)| Block::Line { turn_deg, length, z, c }),
        4 => (turn(), decades(0.01, 20.0), growth, -400.0..400.0f64, share)
            .prop_map(|(turn_deg, radius, growth, sweep_deg, z)| Block::Arc { turn_deg, radius, growth, sweep_deg, z }),
        2 => (decades(0.01, 20.0), prop::array::uniform3(-1.0..1.0f64))
            .prop_map(|(radius, by)| Block::Corner { radius, by }),
        1 => (-90.0..90.0f64).prop_map(|c| Block::Rotary { c }),
        1 => Just(Block::Nothing),
    ]
}

fn per_axis(value: impl Strategy<Value = f64>) -> impl Strategy<Value = PerAxis<f64>> {
    prop::collection::vec(value, Axis::ALL.len())
        .prop_map(|values| PerAxis::from_fn(|axis| values[axis.index()]))
}

pub fn random_limits() -> impl Strategy<Value = Limits> {
    (
        per_axis(decades(500.0, 60_000.0)),
        per_axis(decades(0.05, 5.0)),
        decades(0.05, 5.0),
        prop_oneof![5.0..15.0f64, 0.0001..179.9f64],
        any::<bool>(),
        prop::sample::select(vec![0.003, 0.006]),
        prop_oneof![Just(100.0), 20.0..150.0f64],
    )
        .prop_map(
            |(max_feed_mm_min, acceleration_m_s2, radial, corner_angle_deg, servo_lag, cycle_s, percent)| {
                Limits {
                    max_feed_mm_min,
                    acceleration_m_s2,
                    radial_acceleration_m_s2: radial,
                    corner_angle_deg,
                    servo_lag,
                    cycle_s,
                    servo_window_s: bahn_motion::SERVO_WINDOW_S,
                    spindle: Default::default(),
                    feed_override_percent: percent,
                    rapid_override_percent: percent,
                }
            },
        )
}

impl Random {
    /// The same path with a stop at every corner. Beside a line no rotary axis moves, for it makes no corner.
    pub fn with_stops(&self) -> Random {
        let mut random = self.clone();
        for (block, ..) in &mut random.blocks {
            if let Block::Line { c, .. } = block {
                *c = 0.0;
            }
        }
        random.limits.corner_angle_deg = 0.0;
        random.limits.servo_lag = false;
        random
    }
}

/// Whether axes keep their bounds on positions of all contour cycles: the feed limits from cycle to cycle, and
/// `sqrt(MP1060² + MP1070²)` in second differences of `contour cycle` (1) or the servo's window (more).
pub fn check_axes(
    positions: &[Position],
    limits: &Limits,
    cycles: usize,
    times: f64,
) -> Result<(), TestCaseError> {
    let t = limits.cycle_s;
    for axis in Axis::ALL {
        let greatest = limits.max_feed_mm_min[axis] / 60.0;
        let bound = times * 1000.0 * limits.acceleration_m_s2[axis].hypot(limits.radial_acceleration_m_s2);
        for (k, two) in positions.windows(2).enumerate() {
            let speed = (two[1][axis] - two[0][axis]).abs() / t;
            prop_assert!(
                speed <= greatest * (1.0 + 1e-6) + 1e-11 / t,
                "{axis} {speed} over {greatest} at {k}"
            );
        }
        let w = t * cycles as f64;
        for (k, window) in positions.windows(2 * cycles + 1).enumerate() {
            let [a, b, c] = [window[0][axis], window[cycles][axis], window[2 * cycles][axis]];
            let acceleration = (c - 2.0 * b + a).abs() / (w * w);
            prop_assert!(
                acceleration <= bound * (1.0 + 1e-6) + 4e-11 / (w * w),
                "{axis}: {acceleration} mm/s² over {bound} at sample {k} of {}, {:?}",
                positions.len(),
                &positions[k.saturating_sub(1)..(k + 4).min(positions.len())],
            );
        }
    }
    Ok(())
}

/// Contour cycles of the servo's window.
pub fn window_cycles(limits: &Limits) -> usize {
    (limits.servo_window_s / limits.cycle_s).round() as usize
}

pub fn random_path(most: usize) -> impl Strategy<Value = Random> {
    let feed = prop_oneof![4 => decades(200.0, 60_000.0).prop_map(Some), 1 => Just(None)];
    let blocks = prop::collection::vec((block(), feed, prop::bool::weighted(0.2)), 1..most);
    (blocks, random_limits()).prop_map(|(blocks, limits)| Random { blocks, limits })
}

/// Many lines at one feed: a polyline on a curve, as programming systems write them.
pub fn polyline() -> impl Strategy<Value = Random> {
    let lines = prop::collection::vec(
        (decades(0.001, 2.0), prop_oneof![Just(0.0), -9.0..9.0f64]),
        10..200,
    );
    let bend = prop_oneof![Just(0.0), -5.0..5.0f64];
    (lines, bend, decades(200.0, 60_000.0), random_limits()).prop_map(|(lines, bend, feed, limits)| {
        let block = |(length, turn)| Block::Line {
            turn_deg: turn + bend,
            length,
            z: 0.0,
            c: 0.0,
        };
        let blocks = lines
            .into_iter()
            .map(|line| (block(line), Some(feed), false))
            .collect();
        Random { blocks, limits }
    })
}

/// The same corner again and again at a distance of u cycles: the worst for velocity steps that add up
/// in one cycle.
pub fn regular_corners() -> impl Strategy<Value = Random> {
    let turn = prop_oneof![-10.0..10.0f64, -90.0..90.0f64];
    (
        0.1..1.5f64,
        turn,
        decades(200.0, 20_000.0),
        10usize..60,
        random_limits(),
    )
        .prop_map(|(u, turn_deg, feed, count, limits)| {
            let length = (u * limits.cycle_s * feed / 60.0).max(0.001);
            let block = Block::Line {
                turn_deg,
                length,
                z: 0.0,
                c: 0.0,
            };
            Random {
                blocks: vec![(block, Some(feed), true); count],
                limits,
            }
        })
}
