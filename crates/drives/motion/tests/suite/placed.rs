//! Paths that do not stand upright: the limits of the axes hold with cycle 19 and M114.

use std::sync::Arc;

use crate::common::*;
use bahn_motion::{Drive, Interpolator, Limits, Prepared};
use bahn_path::{Axis, Cylinder, FeedRate, Link, PathElement, PerAxis, Placement, Position, Step, Swivels};
use proptest::prelude::*;

const MAIN: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

/// A fork head: B swivels 250 mm above the tool datum, about it C in a bracket of 80 mm.
fn swivels() -> Arc<Swivels> {
    let head = |axis, dimension| Link {
        axis,
        table: false,
        absolute: false,
        dimension,
    };
    Arc::new(Swivels::new([
        head(Axis::Z, 250.0),
        head(Axis::B, 0.0),
        head(Axis::X, 80.0),
        head(Axis::C, 0.0),
    ]))
}

fn tilted(b: f64, c: f64) -> Arc<Placement> {
    let mut angles = Position::ZERO;
    (angles[Axis::B], angles[Axis::C]) = (b, c);
    Arc::new(Placement::tilted(
        &swivels(),
        &angles,
        [&Position::ZERO; 2],
        (Axis::Z, 100.0),
    ))
}

fn compensated() -> Arc<Placement> {
    Arc::new(Placement::compensated(
        swivels(),
        &Position::ZERO,
        (Axis::Z, 100.0),
    ))
}

fn placed(mut path: Path, placement: &Arc<Placement>) -> Vec<PathElement> {
    for element in &mut path.elements {
        element.placement = Some(Arc::clone(placement));
    }
    path.elements
}

/// The nominal positions of the axes, contour cycle by contour cycle.
fn axes(elements: &[PathElement], limits: &Limits) -> Vec<Position> {
    let steps = elements.iter().cloned().map(Step::Element).collect();
    let mut source = list(steps);
    let mut path = Interpolator::new(limits, 200);
    path.set_position(elements[0].start);
    path.set_placement(elements[0].placement.clone());
    let mut positions = Vec::new();
    for _ in 0..200_000 {
        let prepared = path.prepare(&mut source, 100);
        let cycle = path.cycle(&Drive::default());
        let placement = path.element().and_then(|element| element.placement.as_ref());
        let nose = match placement {
            Some(placement) => placement.to_nose(&cycle.position),
            None => {
                let mut nose = cycle.position;
                nose[Axis::Z] += 100.0;
                nose
            }
        };
        positions.push(nose);
        if path.take_stop().is_some() && !matches!(prepared, Prepared::Budget) {
            break;
        }
    }
    positions
}

/// A rapid movement along X of a plane that B+30 has tilted: X of the machine has cos 30° of the distance and Z sin 30°. Z is
/// the slow one here: it takes sin 30° of it at 3 m/min, so the path runs at 6 m/min.
#[test]
fn the_slowest_real_axis_of_a_tilted_plane_decides() {
    let mut slow = limits();
    slow.max_feed_mm_min[Axis::Z] = 3000.0;
    let mut path = Path::new(0.0);
    path.feed(FeedRate::Rapid).line(&[(Axis::X, 500.0)]);
    let planned = plan(&placed(path.clone(), &tilted(30.0, 0.0)), &slow);
    let speed = planned[0].profile.peak_mm_s * 60.0;
    assert!((speed - 6000.0).abs() < 1e-6, "{speed}");
    // Upright Z does not move.
    let planned = plan(&path.elements, &slow);
    let speed = planned[0].profile.peak_mm_s * 60.0;
    assert!((speed - 15_000.0).abs() < 1e-6, "{speed}");
}

/// What no machine axis does twice as fast is driven as if nothing were tilted.
#[test]
fn a_path_in_a_quarter_turn_takes_the_same_time() {
    let mut path = Path::new(4000.0);
    path.line(&[(Axis::X, 50.0)])
        .turn(0.0, 20.0, 180.0, 5.0)
        .line(&[(Axis::Z, 40.0), (Axis::Y, 3.0)]);
    let upright = time_s(&plan(&path.elements, &limits()));
    let turned = time_s(&plan(&placed(path, &tilted(90.0, 0.0)), &limits()));
    assert!((upright - turned).abs() < 1e-9, "{upright} {turned}");
}

/// At the change of placement no axis jumps, be it that the path goes on at once.
#[test]
fn nothing_jumps_where_the_plane_tilts() {
    let mut path = Path::new(3000.0);
    path.line(&[(Axis::X, 60.0)]);
    let mut elements = path.elements;
    for placement in [tilted(30.0, 10.0), tilted(-20.0, 0.0)] {
        let last = elements.last().expect("an element");
        let mut path = Path::new(3000.0);
        path.at = Placement::change(last.placement.as_deref(), Some(&placement), &last.end);
        path.by(&[(Axis::X, 40.0), (Axis::Z, 7.0)]).by(&[(Axis::Y, 30.0)]);
        elements.extend(placed(path, &placement));
    }
    for pair in axes(&elements, &limits()).windows(2) {
        for axis in MAIN {
            // 3 m/min are 0.15 mm in a cycle.
            assert!((pair[1][axis] - pair[0][axis]).abs() < 0.151, "{axis}: {pair:?}");
        }
    }
}

/// B stops where the path goes straight on: the axes that have carried the head around the tip must stop for it, so the path
/// does; while B goes on as before it does not.
#[test]
fn the_path_stops_where_the_head_stops_swivelling() {
    let run = |b: f64| {
        let mut path = Path::new(3000.0);
        path.by(&[(Axis::X, 20.0), (Axis::B, 10.0)]);
        path.by(&[(Axis::X, 20.0), (Axis::B, b)]);
        plan(&placed(path, &compensated()), &limits())[0]
            .profile
            .exit_mm_s
    };
    assert_eq!(run(0.0), 0.0);
    assert!(run(10.0) > 5.0, "{}", run(10.0));
}

fn blocks() -> impl Strategy<Value = Path> {
    let block = (
        -60.0..60.0f64,
        -60.0..60.0f64,
        -60.0..60.0f64,
        -40.0..40.0f64,
        -40.0..40.0f64,
        any::<bool>(),
    );
    (prop::collection::vec(block, 1..8), 500.0..20_000.0f64).prop_map(|(blocks, feed)| {
        let mut path = Path::new(feed);
        for (x, y, z, b, c, arc) in blocks {
            if arc {
                path.turn(x, 5.0 + y.abs(), 3.0 * z, b);
                path.corner([x, y, z], [z, b + 0.1, x], 5.0 + y.abs());
            } else {
                path.by(&[
                    (Axis::X, x),
                    (Axis::Y, y),
                    (Axis::Z, z),
                    (Axis::B, b),
                    (Axis::C, c),
                ]);
            }
        }
        path
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// However the path lies and whatever swivels meanwhile: no axis exceeds MP1010, nor `sqrt(MP1060² + MP1070²)` over
    /// the window in which the servo spreads the steps of corners; and of one element not even cycle by cycle.
    #[test]
    fn the_axes_keep_their_limits(path in blocks(), b in -90.0..90.0f64, c in -180.0..180.0f64, compensates: bool) {
        let placement = if compensates { compensated() } else { tilted(b, c) };
        let limits = limits();
        let bound = 1000.0 * 1f64.hypot(0.5);
        for element in placed(path, &placement) {
            let positions = axes(std::slice::from_ref(&element), &limits);
            for axis in MAIN {
                for three in positions.windows(3) {
                    let [p, q, r] = [three[0][axis], three[1][axis], three[2][axis]];
                    let speed = (r - q) / limits.cycle_s;
                    prop_assert!(speed.abs() <= 250.0 * (1.0 + 1e-6) + 1e-6, "{axis} {speed} mm/s");
                    let acceleration = (r - 2.0 * q + p) / limits.cycle_s.powi(2);
                    prop_assert!(acceleration.abs() <= bound * 1.001 + 1e-3, "{axis} {acceleration} mm/s²");
                }
            }
        }
    }
}

/// X of the path is the distance around a cylinder of R20 about C.
fn rolled() -> Arc<Placement> {
    let cylinder = Cylinder {
        rotary: Axis::C,
        around: Axis::X,
        deg_per_mm: -1.0 / 20f64.to_radians(),
        zero_deg: 15.0,
        centre_mm: 100.0,
    };
    Arc::new(Placement::rolled(cylinder, (Axis::Y, 100.0)))
}

/// On a cylinder a rapid movement around is as fast as C turns: at 5000 degrees/min on R20 that are 20 · 5000 · π/180 mm/min.
/// A corner of two lines is what it is on the surface: one of 5° is passed within MP7460 = 10°, one of 20° stops.
#[test]
fn on_a_cylinder() {
    let mut limits = limits();
    limits.max_feed_mm_min[Axis::C] = 5000.0;
    let mut path = Path::new(0.0);
    path.feed(FeedRate::Rapid).line(&[(Axis::X, 500.0)]);
    let planned = plan(&placed(path, &rolled()), &limits);
    let speed = planned[0].profile.peak_mm_s * 60.0;
    assert!((speed - 5000f64.to_radians() * 20.0).abs() < 1e-6, "{speed}");
    let passed = |turn_deg: f64, from_deg: f64| {
        let mut path = Path::new(600.0);
        for direction in [from_deg, from_deg + turn_deg] {
            let (sin, cos) = direction.to_radians().sin_cos();
            path.by(&[(Axis::X, 50.0 * cos), (Axis::Z, 50.0 * sin)]);
        }
        let planned = plan(&placed(path, &rolled()), &limits);
        planned[0].profile.exit_mm_s > 0.0
    };
    for from_deg in [0.0, 45.0, 88.0] {
        assert!(passed(5.0, from_deg), "{from_deg}");
        assert!(!passed(20.0, from_deg), "{from_deg}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// On a cylinder no axis exceeds its limits either, be it C in degrees; lines and circles of the surface.
    #[test]
    fn a_cylinder_keeps_the_limits(path in blocks()) {
        let limits = limits();
        for element in placed(path, &rolled()) {
            let positions = axes(std::slice::from_ref(&element), &limits);
            for axis in [Axis::X, Axis::Y, Axis::Z, Axis::C] {
                let of = |list: &PerAxis<f64>| list[axis];
                let fastest = of(&limits.max_feed_mm_min) / 60.0;
                let bound = 1000.0 * of(&limits.acceleration_m_s2).hypot(limits.radial_acceleration_m_s2);
                for three in positions.windows(3) {
                    let [p, q, r] = [three[0][axis], three[1][axis], three[2][axis]];
                    let speed = (r - q) / limits.cycle_s;
                    prop_assert!(speed.abs() <= fastest * (1.0 + 1e-6) + 1e-6, "{axis} {speed} of {fastest}");
                    let acceleration = (r - 2.0 * q + p) / limits.cycle_s.powi(2);
                    prop_assert!(acceleration.abs() <= bound * 1.001 + 1e-3, "{axis} {acceleration} of {bound}");
                }
            }
        }
    }
}
