//! Laws of the interpolator, for every path and whatever is done to it.

use crate::common::random::{
    Random, check_axes, decades, polyline, random_path, regular_corners, window_cycles,
};
use crate::common::{List, list, plan, planner_of, time_s};
use bahn_motion::{Drive, Identity, Interpolator, Limits, Sample, Sampler, State};
use bahn_path::{Axis, PathElement, Position, Step};
use proptest::prelude::*;

/// Cycles after which a run is cut off.
const MOST: usize = 20_000;

/// How to drive for a number of cycles.
type Part = (Drive, usize);

struct Run {
    source: List,
    path: Interpolator<&'static str>,
}

/// What one cycle has shown.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    position: Position,
    speed: f64,
    state: State,
    /// Element and distance to its end.
    sequence: u64,
    rest: f64,
}

impl Run {
    fn new(elements: &[PathElement], limits: &Limits, capacity: usize) -> Run {
        let mut path = Interpolator::new(limits, capacity);
        path.set_position(Position::ZERO);
        Run {
            source: list(elements.iter().cloned().map(Step::Element).collect()),
            path,
        }
    }

    fn cycle(&mut self, drive: &Drive, budget: usize) -> Seen {
        self.path.prepare(&mut self.source, budget);
        let cycle = self.path.cycle(drive);
        if cycle.state == State::BlockEnd {
            self.path.go_on();
        }
        Seen {
            position: cycle.position,
            speed: cycle.speed_mm_s,
            state: cycle.state,
            sequence: self.path.element().map_or(0, |element| element.sequence),
            rest: self.path.rest_mm(),
        }
    }

    /// Drives through the parts, then on as at first, to the end of the path.
    fn all(&mut self, parts: &[Part], then: &Drive, budget: usize) -> Vec<Seen> {
        let parts = parts
            .iter()
            .flat_map(|(drive, count)| std::iter::repeat_n(drive, *count))
            .chain(std::iter::repeat(then));
        let mut seen = Vec::new();
        for drive in parts.take(MOST) {
            seen.push(self.cycle(drive, budget));
            if seen.last().is_some_and(|seen| seen.state == State::Stopped) {
                break;
            }
        }
        seen
    }
}

fn constant(limits: &Limits) -> Drive {
    Drive {
        feed_override_percent: limits.feed_override_percent,
        rapid_override_percent: limits.rapid_override_percent,
        ..Drive::default()
    }
}

fn parts() -> impl Strategy<Value = Vec<Part>> {
    let percent = || prop_oneof![Just(0.0), Just(100.0), 0.0..150.0f64];
    let drive = (
        percent(),
        percent(),
        prop::bool::weighted(0.2),
        prop::bool::weighted(0.2),
    )
        .prop_map(
            |(feed_override_percent, rapid_override_percent, hold, single_block)| Drive {
                feed_override_percent,
                rapid_override_percent,
                hold,
                single_block,
                ..Drive::default()
            },
        );
    prop::collection::vec((drive, 1usize..60), 0..40)
}

/// As the laws of planning, and beside them the speed along the path. `cycles` and `times` as in `check_axes`.
fn check_limits(
    seen: &[Seen],
    elements: &[PathElement],
    limits: &Limits,
    (cycles, times): (usize, f64),
) -> Result<(), TestCaseError> {
    let t = limits.cycle_s;
    let mut positions = vec![Position::ZERO; 2 * cycles];
    positions.extend(seen.iter().map(|seen| seen.position));
    check_axes(&positions, limits, cycles, times)?;
    let planned = plan(elements, limits);
    let greatest = planned
        .iter()
        .map(|p| p.profile.acceleration_mm_s2)
        .fold(0.0, f64::max);
    let mut before = 0.0;
    for seen in seen {
        let change = (seen.speed - before).abs();
        prop_assert!(
            change <= greatest * t * (1.0 + 1e-9) + 1e-6,
            "{before} to {} mm/s",
            seen.speed
        );
        before = seen.speed;
    }
    Ok(())
}

/// Every position lies on its element, and none before the one a cycle earlier.
fn check_order(seen: &[Seen]) -> Result<(), TestCaseError> {
    for two in seen.windows(2) {
        let [a, b] = [two[0], two[1]];
        prop_assert!(
            b.sequence > a.sequence || b.sequence == a.sequence && b.rest <= a.rest,
            "{a:?} then {b:?}"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn at_a_constant_override_it_runs_as_planned(
        random in prop_oneof![random_path(40), polyline()], budget in prop_oneof![Just(usize::MAX), Just(50usize)],
    ) {
        let Random { limits, .. } = &random;
        let elements = random.elements();
        let planned = time_s(&plan(&elements, limits));
        let seen = Run::new(&elements, limits, 1024).all(&[], &constant(limits), budget);
        if seen.len() < MOST {
            let time = seen.len() as f64 * limits.cycle_s;
            prop_assert!(
                time >= planned - 1e-6 && time <= planned + limits.cycle_s + 1e-6,
                "{time} s for {planned} s"
            );
        }
        // With few elements at a time the path may not see far enough at first.
        if budget == usize::MAX {
            let mut sampler = Sampler::new(planner_of(&elements, limits), Identity, limits.cycle_s);
            sampler.next();
            for seen in &seen {
                let Sample::Axes(planned) = sampler.next() else { break };
                for axis in Axis::ALL {
                    prop_assert!((seen.position[axis] - planned[axis]).abs() <= 1e-6, "{axis} at {seen:?}");
                }
            }
        }
        check_limits(&seen, &elements, limits, (window_cycles(limits), 2.0))?;
        check_order(&seen)?;
    }

    #[test]
    fn whatever_is_done_no_limit_is_exceeded(
        random in prop_oneof![random_path(40), polyline(), regular_corners()], parts in parts(),
        capacity in prop_oneof![Just(1024usize), 0..20usize], budget in prop_oneof![Just(usize::MAX), 1..5usize],
    ) {
        let Random { limits, .. } = &random;
        let stops = random.with_stops();
        let elements = stops.elements();
        let seen = Run::new(&elements, &stops.limits, capacity).all(&parts, &constant(limits), budget);
        check_limits(&seen, &elements, &stops.limits, (1, 1.0))?;
        let elements = random.elements();
        let seen = Run::new(&elements, limits, capacity).all(&parts, &constant(limits), budget);
        check_limits(&seen, &elements, limits, (window_cycles(limits), 2.5))?;
        check_order(&seen)?;
        if seen.len() < MOST {
            prop_assert_eq!(seen.last().map(|seen| seen.position), elements.last().map(|last| last.end));
        } else {
            // Slow it may be, but it does not stand still for ever.
            let [before, after] = [MOST / 2, MOST - 1].map(|k| (seen[k].sequence, -seen[k].rest));
            prop_assert!(after > before, "{before:?} {after:?}");
        }
    }

    /// A machine that is twice as fast in everything passes the same positions.
    #[test]
    fn time_can_be_scaled(random in random_path(30), parts in parts()) {
        let Random { limits, .. } = &random;
        let mut fast = limits.clone();
        fast.max_feed_mm_min = fast.max_feed_mm_min.map(|feed| 2.0 * feed);
        fast.acceleration_m_s2 = fast.acceleration_m_s2.map(|a| 4.0 * a);
        fast.radial_acceleration_m_s2 *= 4.0;
        fast.cycle_s *= 0.5;
        fast.servo_window_s *= 0.5;
        let elements = random.elements();
        let faster: Vec<_> = elements
            .iter()
            .cloned()
            .map(|mut element| {
                if let bahn_path::FeedRate::Programmed(feed) = &mut element.feed {
                    *feed *= 2.0;
                }
                element
            })
            .collect();
        let slow = Run::new(&elements, limits, 100).all(&parts, &constant(limits), usize::MAX);
        let fast = Run::new(&faster, &fast, 100).all(&parts, &constant(limits), usize::MAX);
        prop_assert_eq!(slow.len(), fast.len());
        for (slow, fast) in slow.iter().zip(&fast) {
            prop_assert!((slow.rest - fast.rest).abs() <= 1e-9, "{slow:?} and {fast:?}");
        }
    }

    /// After any stops the path is the same: what is left takes as long as from a start in standstill.
    #[test]
    fn a_held_path_stands_and_is_not_lost(random in random_path(30), at in 1usize..500, feed in decades(1.0, 150.0)) {
        let Random { limits, .. } = &random;
        let elements = random.elements();
        let drive = Drive { feed_override_percent: feed, ..Drive::default() };
        let hold = Drive { hold: true, ..drive };
        let mut run = Run::new(&elements, limits, 1024);
        for _ in 0..at {
            run.cycle(&drive, usize::MAX);
        }
        // The slowest acceleration is 50 mm/s², the greatest feed 1000 mm/s along each of some axes.
        let mut held = run.cycle(&hold, usize::MAX);
        for _ in 0..20_000 {
            if held.speed == 0.0 {
                break;
            }
            held = run.cycle(&hold, usize::MAX);
        }
        prop_assert_eq!(held.speed, 0.0);
        for _ in 0..10 {
            let still = run.cycle(&hold, usize::MAX);
            prop_assert_eq!(still.position, held.position);
        }
        prop_assert!(matches!(held.state, State::Held | State::Stopped | State::Moving));
    }
}
