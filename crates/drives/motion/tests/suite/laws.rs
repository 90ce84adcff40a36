//! Laws that hold for every path.

use crate::common::random::{
    Block, Random, check_axes, polyline, random_path, regular_corners, window_cycles,
};
use crate::common::{plan, planner_of, reversed, time_s};
use bahn_motion::{Identity, Limits, Planned, Sample, Sampler};
use bahn_path::{Axis, Curve, FeedRate, PathElement, PerAxis, Position};
use proptest::prelude::*;

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

/// No axis exceeds MP1010. Where the path stops at corners none exceeds `sqrt(MP1060² + MP1070²)`, seen in
/// contour cycles. Corners that are passed add no more than as much again, seen in the servo's window.
///
/// The tolerance is for positions only: each is right to some parts in 1e15 of its size, 1e-12 mm here,
/// which is four times that over cycle² in the second difference; a part in 1e6 of the bound for the
/// rounding of speeds.
fn check_samples(random: &Random) -> Result<(), TestCaseError> {
    let stops = random.with_stops();
    check_axes(&samples(&stops.elements(), &stops.limits), &stops.limits, 1, 1.0)?;
    let limits = &random.limits;
    let positions = samples(&random.elements(), limits);
    check_axes(&positions, limits, window_cycles(limits), 2.0)
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

/// An arc at its radial acceleration, then a corner of 5.8 degrees; a line of 1 µm between them.
#[test]
fn an_arc_and_a_corner_within_one_cycle() {
    let line = |turn_deg, length| Block::Line {
        turn_deg,
        length,
        z: 0.0,
        c: 0.0,
    };
    let arc = Block::Arc {
        turn_deg: 0.0,
        radius: 0.048,
        growth: 1.0,
        sweep_deg: -194.0,
        z: 0.0,
    };
    let mut acceleration_m_s2 = PerAxis::splat(1.0);
    acceleration_m_s2[Axis::Y] = 0.0875;
    let random = Random {
        blocks: vec![
            (arc, None, false),
            (line(0.0, 0.001), None, false),
            (line(-5.8, 1.0), None, false),
        ],
        limits: Limits {
            max_feed_mm_min: PerAxis::splat(500.0),
            acceleration_m_s2,
            radial_acceleration_m_s2: 0.304,
            ..crate::common::limits()
        },
    };
    // Wherever the samples fall: each line before the arc shifts them by some of a cycle.
    for shift in 0..50 {
        let mut random = random.clone();
        random
            .blocks
            .insert(0, (line(0.0, 0.002 * f64::from(shift)), None, false));
        check_samples(&random).unwrap();
    }
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
        let arcs = elements.iter().any(|e| matches!(e.curve, Curve::Arc(_) | Curve::Corner(_)));
        let slower = split - whole;
        prop_assert!(slower <= 1e-9 * whole, "{} s whole, {} s in pieces", whole, split);
        prop_assert!(arcs || slower >= -1e-9 * whole, "{} s whole, {} s in pieces", whole, split);
    }
}
