//! The stylus on ideal surfaces [000:7722-7880].

#![allow(clippy::panic, clippy::type_complexity, reason = "a test may fail")]

use bahn_motion::{Scan, ScanStep, Sense};
use bahn_path::{Axis, ScanFault, ScanJob, ScanName, ScanPattern, ScanPoint, ScanRules, Scanned};

const CYCLE_S: f64 = 3e-3;
/// MP1060
const ACCELERATION_M_S2: f64 = 1.0;

/// The example of the manual [000:7842-7855] on a range of 20 by 4 mm: X, TRAVEL 0.5, L.SPAC 1, P.P.INT 1.
fn job() -> ScanJob {
    ScanJob {
        tool_axis: Axis::Z,
        min: [0.0, 0.0, -10.0],
        max: [20.0, 4.0, 10.0],
        shift: [0.0; 3],
        clearance_mm: 25.0,
        pattern: ScanPattern::Meander { line: Axis::X },
        travel_mm: 0.5,
        spacing_mm: 1.0,
        interval_mm: 1.0,
        stylus_radius_mm: 0.0,
        beside: [0.0; 3],
        inch: false,
        program: ScanName::default(),
        rules: ScanRules::default(),
    }
}

/// Scans a surface that the tip touches where its height is not greater than this, and holds the stylus to the acceleration of
/// the axes, which no cycle exceeds.
fn scan(job: ScanJob, height: impl Fn(f64, f64) -> f64) -> (Vec<ScanPoint>, Scanned, f64) {
    let mut scan = Scan::new(job, ACCELERATION_M_S2);
    let (mut points, mut sense) = (Vec::new(), Sense::default());
    sense.at = scan.position();
    let mut before = [0.0; 3];
    for cycle in 1..10_000_000 {
        match scan.cycle(CYCLE_S, &sense, 1.0) {
            ScanStep::Moves => {}
            ScanStep::Point(point) => points.push(point),
            ScanStep::Over(scanned) => return (points, scanned, f64::from(cycle) * CYCLE_S),
        }
        let at = scan.position();
        let speed = (0..3)
            .map(|k| ((at[k] - sense.at[k]) / CYCLE_S).powi(2))
            .sum::<f64>()
            .sqrt()
            * 60.0;
        assert!(speed <= job.rules.rapid_mm_min * 1.5, "{speed} mm/min");
        let velocity: ScanPoint = std::array::from_fn(|k| (at[k] - sense.at[k]) / CYCLE_S);
        let change = (0..3)
            .map(|k| (velocity[k] - before[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(
            change <= ACCELERATION_M_S2 * 1e3 * CYCLE_S + 1e-6,
            "{before:?} {velocity:?} at {at:?}"
        );
        before = velocity;
        let deflected = at[2] <= height(at[0], at[1]);
        sense = Sense {
            touch: (deflected && !sense.deflected).then_some(at),
            deflected,
            at,
            deflection: [0.0; 3],
        };
    }
    panic!("it never ends: {} points, at {:?}", points.len(), scan.position());
}

/// Every point lies on the surface within what the stylus goes in a cycle, and no farther than P.P.INT from the one before;
/// each of the five lines begins and ends at the range.
fn assert_scanned(points: &[ScanPoint], scanned: &Scanned, tolerance: f64, height: impl Fn(f64, f64) -> f64) {
    assert_eq!(scanned.fault, None);
    assert_eq!(scanned.at[2], 25.0);
    for point in points {
        let around = [-tolerance, 0.0, tolerance].map(|by| height(point[0] + by, point[1]));
        let low = around.iter().copied().fold(f64::INFINITY, f64::min) - tolerance;
        let high = around.iter().copied().fold(f64::NEG_INFINITY, f64::max) + tolerance;
        assert!(low <= point[2] && point[2] <= high, "{point:?}");
    }
    for pair in points.windows(2) {
        let distance = (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]);
        assert!(distance <= 1.05, "{pair:?}");
    }
    for line in 0..5 {
        for end in [0.0, 20.0] {
            let there = |point: &&ScanPoint| {
                (point[0] - end).abs() < 0.02 && (point[1] - f64::from(line)).abs() < 0.02
            };
            assert!(
                points.iter().any(|point| there(&point)),
                "line {line} does not reach {end}"
            );
        }
    }
}

/// Flat: five oscillations a second, four fifths of P.P.INT from point to point.
#[test]
fn a_flat_surface() {
    let (points, scanned, _) = scan(job(), |_, _| 1.0);
    assert_scanned(&points, &scanned, 0.02, |_, _| 1.0);
    let spaced = points
        .windows(2)
        .filter(|pair| (0.7..=1.0).contains(&(pair[0][0] - pair[1][0]).abs()))
        .count();
    assert!(spaced > 5 * 20, "{spaced} of {}", points.len());
}

/// Slopes of 30° up and down, a wave, a step of 3 mm up and down: outside and inside corners.
#[test]
fn slopes_and_steps() {
    let slope = |x: f64, _: f64| 5.0 - (x - 10.0).abs() * 30f64.to_radians().tan();
    let wave = |x: f64, y: f64| (x * 0.6).sin() * 2.0 + y * 0.2;
    let step = |x: f64, _: f64| if (7.0..=13.0).contains(&x) { 3.0 } else { 0.0 };
    let surfaces: [&dyn Fn(f64, f64) -> f64; 3] = [&slope, &wave, &step];
    for surface in surfaces {
        let (points, scanned, _) = scan(job(), surface);
        assert_scanned(&points, &scanned, 0.05, surface);
    }
}

/// Nothing within the range, something above it, a hole deeper than the range, a wall higher than the clearance height.
#[test]
fn what_cannot_be_scanned_says_why() {
    let surfaces: [(&dyn Fn(f64, f64) -> f64, ScanFault); 4] = [
        (&|_, _| -20.0, ScanFault::Inaccessible),
        (&|_, _| 12.0, ScanFault::Inaccessible),
        (
            &|x, _| if x > 10.0 { -20.0 } else { 0.0 },
            ScanFault::RangeExceeded,
        ),
        (
            &|x, _| if x > 10.0 { 30.0 } else { 0.0 },
            ScanFault::RangeExceeded,
        ),
    ];
    for (surface, fault) in surfaces {
        let (_, scanned, _) = scan(job(), surface);
        assert_eq!(scanned.fault, Some(fault));
    }
}

/// The stylus says that it is deflected, wherever it is, for two seconds and at many times: it goes back to get clear by up to
/// MP6240 = 5 mm [000:7825], but not out of the range; there it lifts at once. Beyond the edge it needs what it takes to stop and
/// three cycles: that in which it passes the edge, that in which this is seen, and what is left of one at the end of the ramp.
/// Where it taps on something steep there, it leaves it by 0.43 P.P.INT at most. What was felt in the air may end the scan.
#[test]
fn a_stylus_that_does_not_get_clear_stays_in_the_range() {
    let job = ScanJob {
        rules: ScanRules {
            deflection_mm: 5.0,
            ..ScanRules::default()
        },
        ..job()
    };
    let feed = job.feed_mm_min() / 60.0;
    let stop = feed * feed / (2.0 * ACCELERATION_M_S2 * 1e3) + 3.0 * feed * CYCLE_S + 0.43 * job.interval_mm;
    for from_s in [1.0, 1.3, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.5, 8.0] {
        let mut scan = Scan::new(job, ACCELERATION_M_S2);
        let mut sense = Sense {
            at: scan.position(),
            ..Sense::default()
        };
        let (mut time, mut touched, mut over) = (0.0, None, None);
        while over.is_none() {
            match scan.cycle(CYCLE_S, &sense, 1.0) {
                ScanStep::Over(scanned) => over = Some(scanned),
                ScanStep::Point(point) => {
                    touched = touched.or(Some(time));
                    assert!((-stop..=20.0 + stop).contains(&point[0]), "{from_s}: {point:?}");
                }
                ScanStep::Moves => {}
            }
            time += CYCLE_S;
            let at = scan.position();
            assert!(
                (-stop..=20.0 + stop).contains(&at[0]),
                "{from_s}: {at:?} of {stop}"
            );
            let since = touched.map_or(0.0, |first| time - first);
            let deflected = at[2] <= 1.0 || (from_s..from_s + 2.0).contains(&since);
            sense = Sense {
                touch: (deflected && !sense.deflected).then_some(at),
                deflected,
                at,
                deflection: [0.0; 3],
            };
            assert!(time < 2000.0);
        }
    }
}

/// Override 0 holds the stylus, half the override takes about twice the time.
#[test]
fn the_override_slows_the_stylus() {
    let mut held = Scan::new(job(), 1.0);
    let sense = Sense {
        at: held.position(),
        ..Sense::default()
    };
    for _ in 0..1000 {
        assert_eq!(held.cycle(CYCLE_S, &sense, 0.0), ScanStep::Moves);
    }
    assert_eq!(held.position(), job().begin());
}

/// Contour lines around a round boss of radius 4 [003:6716-6766]: plunge, approach, orbits, levels and the return keep
/// the acceleration, and the scan ends at the starting point to the bit.
#[test]
fn levels_of_a_boss_end_at_the_starting_point() {
    let levels = ScanJob {
        min: [0.0, 0.0, -3.0],
        max: [20.0, 20.0, -1.0],
        pattern: ScanPattern::ContourLines {
            start: [10.0, 1.0, 0.0],
            approach: (Axis::Y, 1.0),
            direction: (Axis::X, 1.0),
            time_limit_s: 0.0,
        },
        ..job()
    };
    let boss = |x: f64, y: f64| {
        if (x - 10.0).hypot(y - 10.0) <= 4.0 {
            0.0
        } else {
            -20.0
        }
    };
    let (points, scanned, _) = scan(levels, boss);
    assert_eq!(
        scanned,
        Scanned {
            at: levels.begin(),
            fault: None
        }
    );
    assert!(points.len() > 3 * 20, "{}", points.len());
}

/// No point is farther from the one before than P.P.INT, mm.
fn assert_no_farther(points: &[ScanPoint], interval_mm: f64, case: &str) {
    for pair in points.windows(2) {
        let [a, b] = pair else { panic!() };
        let distance = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        assert!(distance <= interval_mm * 1.001, "{case}: {distance} mm, {pair:?}");
    }
}

/// P.P.INT is the greatest distance of two points [003:6655-6671], on walls up and down, upright or nearly so, too; a pocket
/// whose floor lies within the range is scanned to its end [003:6596-6599]: the stylus that is pressed on leaves no range.
#[test]
fn points_on_walls_are_no_farther_than_the_interval() {
    let (at, wide) = (7.0..=13.0, 0.5);
    for top in [3.0, 8.0, -8.0] {
        for slanting in [false, true] {
            let surface = |x: f64, _: f64| match at.contains(&x) {
                true if slanting => top * ((x - 7.0).min(13.0 - x) / wide).min(1.0),
                true => top,
                false => 0.0,
            };
            for (interval_mm, travel_mm) in [
                (0.2, 0.1),
                (0.5, 0.5),
                (1.0, 0.5),
                (3.0, 0.5),
                (3.0, 1.0),
                (3.0, 3.0),
                (5.0, 0.5),
                (5.0, 1.0),
                (5.0, 3.0),
                (5.0, 5.0),
            ] {
                let case =
                    format!("{top} mm, slanting {slanting}, P.P.INT {interval_mm}, TRAVEL {travel_mm}");
                let job = ScanJob {
                    interval_mm,
                    travel_mm,
                    ..job()
                };
                let (points, scanned, _) = scan(job, surface);
                assert_eq!(scanned.fault, None, "{case}");
                assert_no_farther(&points, interval_mm, &case);
                for b in points.iter().skip(1) {
                    // The stylus goes no more than 25 mm/s * 3 ms in a cycle.
                    let beside = [-0.1, 0.0, 0.1].map(|by| surface(b[0] + by, b[1]));
                    let low = beside.iter().copied().fold(f64::INFINITY, f64::min) - 0.1;
                    let high = beside.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 0.1;
                    assert!(low <= b[2] && b[2] <= high, "{case}: {b:?}");
                    assert!((-0.001..=20.001).contains(&b[0]), "{case}: {b:?}");
                }
                // Top and foot of the walls are there, to P.P.INT.
                for line in 0..5 {
                    let on = points
                        .iter()
                        .filter(|point| (point[1] - f64::from(line)).abs() < 0.02);
                    let inside = on
                        .clone()
                        .filter(|point| (point[2] - top).abs() < 0.1 && at.contains(&point[0]));
                    assert!(inside.count() > 0, "{case}: line {line} has no point at {top}");
                    for end in [0.0, 20.0] {
                        let there = |point: &ScanPoint| (point[0] - end).abs() < 0.02;
                        assert!(on.clone().any(there), "{case}: line {line} does not reach {end}");
                    }
                }
            }
        }
    }
}

/// Stairs of any heights, no narrower than P.P.INT: every line comes to its end, every point lies on them,
/// none is farther than P.P.INT from the one before.
#[test]
fn any_stairs() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    for round in 0..200 {
        let interval_mm = 0.3 + random() * 4.7;
        let travel_mm = 0.1 + random() * 3.0;
        let mut stairs = vec![(0.0, random() * 18.0 - 9.0)];
        while let Some((at, _)) = stairs.last().copied().filter(|(at, _)| *at < 20.0) {
            stairs.push((at + interval_mm + random() * 6.0, random() * 18.0 - 9.0));
        }
        // A wall at the very end of a line is touched at its end or not.
        stairs.retain(|(at, _)| (at - 20.0).abs() > 0.1);
        let surface = |x: f64, _: f64| {
            let on = stairs.iter().rev().find(|(at, _)| x >= *at);
            on.unwrap_or(&stairs[0]).1
        };
        let job = ScanJob {
            interval_mm,
            travel_mm,
            max: [20.0, 1.0, 10.0],
            ..job()
        };
        let case = format!("{round}: P.P.INT {interval_mm:.2}, TRAVEL {travel_mm:.2}, {stairs:.2?}");
        let (points, scanned, _) = scan(job, surface);
        assert_eq!(scanned.fault, None, "{case}");
        assert_no_farther(&points, interval_mm, &case);
    }
}
