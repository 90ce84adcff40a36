//! Laws that hold for every path.

mod common;

use bahn_motion::{Identity, Limits, Planned, Sample, Sampler};
use bahn_path::{Axis, Curve, FeedRate, PathElement, Position};
use common::{Path, plan, planner_of, reversed, time_s};
use proptest::prelude::*;

/// One random block, turned into an element by the path that it continues.
#[derive(Clone, Debug)]
enum Block {
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
    /// Only the rotary axis.
    Rotary { c: f64 },
    /// To the same point.
    Nothing,
}

#[derive(Clone, Debug)]
struct Random {
    blocks: Vec<(Block, Option<f64>, bool)>,
    limits: Limits,
}

impl Random {
    fn elements(&self) -> Vec<PathElement> {
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

fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> + Clone {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

/// Mostly small changes of direction, as short lines on a surface make them, some large, some none.
fn turn() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        2 => Just(0.0),
        4 => -12.0..12.0f64,
        2 => decades(1e-6, 1.0),
        1 => -180.0..180.0f64,
    ]
}

fn block() -> impl Strategy<Value = Block> {
    let share = prop_oneof![3 => Just(0.0), 1 => -1.0..1.0f64];
    let rotary = prop_oneof![6 => Just(0.0), 1 => -20.0..20.0f64];
    let growth = prop_oneof![6 => Just(1.0), 1 => 0.99..1.01f64, 1 => 0.3..3.0f64];
    prop_oneof![
        8 => (turn(), decades(0.001, 20.0), share.clone(), rotary)
            .prop_map(|(turn_deg, length, z, c)| Block::Line { turn_deg, length, z, c }),
        4 => (turn(), decades(0.01, 20.0), growth, -400.0..400.0f64, share)
            .prop_map(|(turn_deg, radius, growth, sweep_deg, z)| Block::Arc { turn_deg, radius, growth, sweep_deg, z }),
        1 => (-90.0..90.0f64).prop_map(|c| Block::Rotary { c }),
        1 => Just(Block::Nothing),
    ]
}

fn random_limits() -> impl Strategy<Value = Limits> {
    (
        prop::array::uniform9(decades(500.0, 60_000.0)),
        prop::array::uniform9(decades(0.05, 5.0)),
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
                    feed_override_percent: percent,
                    rapid_override_percent: percent,
                }
            },
        )
}

fn random_path(most: usize) -> impl Strategy<Value = Random> {
    let feed = prop_oneof![4 => decades(200.0, 60_000.0).prop_map(Some), 1 => Just(None)];
    let blocks = prop::collection::vec((block(), feed, prop::bool::weighted(0.2)), 1..most);
    (blocks, random_limits()).prop_map(|(blocks, limits)| Random { blocks, limits })
}

/// Many lines at one feed: a polyline on a curve, as programming systems write them.
fn polyline() -> impl Strategy<Value = Random> {
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
fn regular_corners() -> impl Strategy<Value = Random> {
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

/// Samples at every contour cycle; long runs are cut off.
fn samples(elements: &[PathElement], limits: &Limits) -> Vec<Position> {
    const MOST: usize = 20_000;
    let mut sampler = Sampler::new(planner_of(elements, limits), Identity, limits.cycle_s);
    let mut positions = Vec::new();
    while let Sample::Axes(position) = sampler.next() {
        positions.push(position);
        if positions.len() == MOST {
            break;
        }
    }
    positions
}

/// No axis exceeds MP1010, nor `sqrt(MP1060² + MP1070²)`, seen in contour cycles.
///
/// The tolerance is for positions only: each is right to some parts in 1e15 of its size, 1e-12 mm here,
/// which is four times that over cycle² in the second difference; a part in 1e6 of the bound for the
/// rounding of speeds.
fn check_samples(random: &Random) -> Result<(), TestCaseError> {
    let limits = &random.limits;
    let positions = samples(&random.elements(), limits);
    let t = limits.cycle_s;
    for axis in Axis::ALL {
        let i = axis.index();
        let greatest = limits.max_feed_mm_min[i] / 60.0;
        let bound = 1000.0 * limits.acceleration_m_s2[i].hypot(limits.radial_acceleration_m_s2);
        for (k, three) in positions.windows(3).enumerate() {
            let [a, b, c] = [three[0][axis], three[1][axis], three[2][axis]];
            let speed = (b - a).abs() / t;
            prop_assert!(
                speed <= greatest * (1.0 + 1e-6) + 1e-11 / t,
                "{axis} {speed} over {greatest} at {k}"
            );
            let acceleration = (c - 2.0 * b + a).abs() / (t * t);
            prop_assert!(
                acceleration <= bound * (1.0 + 1e-6) + 4e-11 / (t * t),
                "{axis}: {acceleration} mm/s² over {bound} at sample {k} of {}, {:?}",
                positions.len(),
                &positions[k.saturating_sub(1)..(k + 4).min(positions.len())],
            );
        }
    }
    Ok(())
}

/// Path speeds go on from element to element, start and end at rest, and keep the feed.
fn check_continuity(planned: &[Planned], limits: &Limits) -> Result<(), TestCaseError> {
    let mut speed = 0.0;
    for p in planned {
        let profile = &p.profile;
        prop_assert_eq!(profile.entry_mm_s, speed);
        prop_assert!(profile.peak_mm_s >= profile.entry_mm_s && profile.peak_mm_s >= profile.exit_mm_s);
        prop_assert!(profile.duration_s >= 0.0);
        if let (FeedRate::Programmed(feed), true) = (p.element.feed, profile.length_mm > 0.0) {
            let feed = feed / 60.0 * limits.feed_override_percent / 100.0;
            prop_assert!(profile.peak_mm_s <= feed * (1.0 + 1e-12));
            prop_assert!(profile.duration_s * feed >= profile.length_mm * (1.0 - 1e-9));
        }
        // The speed can be reached: |v1² - v0²| <= 2·a·s.
        let change = (profile.exit_mm_s.powi(2) - profile.entry_mm_s.powi(2)).abs();
        let possible = 2.0 * profile.acceleration_mm_s2 * profile.length_mm;
        prop_assert!(
            change <= possible + 1e-9 * (1.0 + profile.peak_mm_s.powi(2)),
            "{change} > {possible}"
        );
        // The slopes and the cruise between them cover the length.
        let end = profile.distance(profile.duration_s * (1.0 - 1e-12));
        prop_assert!((end - profile.length_mm).abs() <= 1e-6 * profile.length_mm + 1e-9);
        speed = profile.exit_mm_s;
    }
    prop_assert_eq!(speed, 0.0);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn no_axis_exceeds_its_feed_and_acceleration(random in random_path(30)) {
        check_samples(&random)?;
    }

    #[test]
    fn no_axis_exceeds_them_on_polylines(random in polyline()) {
        check_samples(&random)?;
    }

    #[test]
    fn no_axis_exceeds_them_on_regular_corners(random in regular_corners()) {
        check_samples(&random)?;
    }

    #[test]
    fn speed_is_continuous_and_keeps_the_caps(random in random_path(60)) {
        check_continuity(&plan(&random.elements(), &random.limits), &random.limits)?;
    }

    #[test]
    fn elements_come_in_order_and_none_is_lost(random in random_path(60)) {
        let elements = random.elements();
        let planned: Vec<_> = plan(&elements, &random.limits).into_iter().map(|p| p.element).collect();
        prop_assert_eq!(planned, elements);
    }

    #[test]
    fn reversed_path_takes_the_same_time(random in random_path(40)) {
        let elements = random.elements();
        let there = time_s(&plan(&elements, &random.limits));
        let back = time_s(&plan(&reversed(&elements), &random.limits));
        prop_assert!((there - back).abs() <= 1e-9 * there, "{} s there, {} s back", there, back);
    }

    #[test]
    fn splitting_changes_nothing(random in random_path(15), at in prop::collection::vec(0.05..0.95f64, 15), n in 1u32..10) {
        // Every element in two parts at any place, the first of them in n equal pieces. Only circles: where
        // the radius grows the path speed of the whole is that of the mean radius, not of the place.
        let mut random = random;
        for (block, ..) in &mut random.blocks {
            if let Block::Arc { growth, .. } = block {
                *growth = 1.0;
            }
        }
        let elements = random.elements();
        let mut pieces = Vec::new();
        for (element, at) in elements.iter().zip(&at) {
            let cuts: Vec<f64> = (0..=n).map(|i| at * f64::from(i) / f64::from(n)).chain([1.0]).collect();
            for cut in cuts.windows(2) {
                let (curve, start, end) = element.curve.part(&element.start, &element.end, cut[0], cut[1]);
                let constant_speed = element.constant_speed && cut[1] == 1.0;
                pieces.push(PathElement { curve, start, end, constant_speed, ..element.clone() });
            }
        }
        let whole = time_s(&plan(&elements, &random.limits));
        let split = time_s(&plan(&pieces, &random.limits));
        // A piece of an arc may be faster than the whole, whose direction goes through more angles of
        // which one is the worst for the axes.
        let arcs = elements.iter().any(|e| matches!(e.curve, Curve::Arc(_)));
        let slower = split - whole;
        prop_assert!(slower <= 1e-9 * whole, "{} s whole, {} s in pieces", whole, split);
        prop_assert!(arcs || slower >= -1e-9 * whole, "{} s whole, {} s in pieces", whole, split);
    }
}
