//! Examples with values computed by hand beside them.

use crate::common::{Path, limits, plan, time_s};
use bahn_motion::Limits;
use bahn_path::{Arc, Axis, Curve, FeedRate, OverrideLaw, PerAxis, Plane, Position, Sense};

const X: Axis = Axis::X;
const Y: Axis = Axis::Y;
const Z: Axis = Axis::Z;
const C: Axis = Axis::C;

fn close(actual: f64, expected: f64) {
    assert!(
        (actual - expected).abs() <= 1e-9 * expected.abs().max(1e-3),
        "{actual} is not {expected}"
    );
}

fn time(path: &Path, limits: &Limits) -> f64 {
    time_s(&plan(&path.elements, limits))
}

/// From rest to rest over s mm at v mm/s with a mm/s², where v is reached: s / v and one ramp v / a.
fn rest_to_rest(s: f64, v: f64, a: f64) -> f64 {
    s / v + v / a
}

/// 100 mm at 100 mm/s, ramps of 0.1 s.
#[test]
fn single_line() {
    let mut path = Path::new(6000.0);
    path.line(&[(X, 100.0)]);
    let planned = plan(&path.elements, &limits());
    close(planned[0].profile.peak_mm_s, 100.0);
    close(time_s(&planned), 1.1);
    close(planned[0].position_at(0.1)[X], 5.0);
    close(planned[0].position_at(0.55)[X], 50.0);
    assert_eq!(planned[0].position_at(9.0)[X], 100.0);
}

/// The smallest acceleration of the moving axes is effective [000:4749].
#[test]
fn path_acceleration_is_the_smallest_of_the_moving_axes() {
    let mut l = limits();
    l.acceleration_m_s2[Z] = 0.25;
    let mut path = Path::new(6000.0);
    path.line(&[(X, 30.0), (Y, 40.0)]);
    close(time(&path, &l), rest_to_rest(50.0, 100.0, 1000.0));
    let mut path = Path::new(6000.0);
    path.line(&[(X, 30.0), (Z, 40.0)]);
    close(time(&path, &l), rest_to_rest(50.0, 100.0, 250.0));
}

/// Rapid traverse is as fast as the axes allow: Z makes 4/5 of the path and 6000 mm/min, so the path
/// makes 7500 mm/min; X with its 3/5 could make 25 000.
#[test]
fn rapid_traverse_goes_by_the_slowest_axis_for_its_part() {
    let mut l = limits();
    l.max_feed_mm_min[Z] = 6000.0;
    let mut path = Path::new(100.0);
    path.feed(FeedRate::Rapid).line(&[(X, 30.0), (Z, 40.0)]);
    close(plan(&path.elements, &l)[0].profile.peak_mm_s, 125.0);
    l.rapid_override_percent = 50.0;
    close(plan(&path.elements, &l)[0].profile.peak_mm_s, 62.5);
    l.rapid_override_percent = 150.0;
    close(plan(&path.elements, &l)[0].profile.peak_mm_s, 125.0);
}

/// A programmed feed is limited likewise, and the override acts before.
#[test]
fn programmed_feed_keeps_the_axis_limits() {
    let mut l = limits();
    l.max_feed_mm_min[Z] = 6000.0;
    let mut path = Path::new(6000.0);
    path.line(&[(X, 30.0), (Z, 40.0)]);
    let peak = |l: &Limits| plan(&path.elements, l)[0].profile.peak_mm_s;
    close(peak(&l), 100.0);
    l.feed_override_percent = 120.0;
    close(peak(&l), 120.0);
    l.feed_override_percent = 150.0;
    close(peak(&l), 125.0);
}

/// Radius 10 mm with MP1070 0.5 m/s²: sqrt(10 · 500) mm/s = 4243 mm/min [000:5084].
#[test]
fn radial_acceleration_limits_the_feed_on_circles() {
    let mut path = Path::new(10_000.0);
    path.line(&[(X, 10.0)])
        .arc([0.0, 0.0], [10.0, 0.0], Sense::CounterClockwise);
    let planned = plan(&path.elements, &limits());
    close(planned[1].profile.peak_mm_s, 5000f64.sqrt());
    assert_eq!((planned[1].profile.peak_mm_s * 60.0).round(), 4243.0);
    close(planned[1].profile.length_mm, 20.0 * std::f64::consts::PI);
    // A slower feed stays.
    path.elements[1].feed = FeedRate::Programmed(4000.0);
    close(
        plan(&path.elements, &limits())[1].profile.peak_mm_s,
        4000.0 / 60.0,
    );
}

/// On a helix the radial acceleration is that of the circle: with as much height as arc the path speed
/// is sqrt(2) times the speed on the circle.
#[test]
fn helix_turns_as_fast_as_the_circle() {
    let mut path = Path::new(20_000.0);
    path.turn(0.0, 10.0, 720.0, 40.0 * std::f64::consts::PI);
    close(
        plan(&path.elements, &limits())[0].profile.peak_mm_s,
        10_000f64.sqrt(),
    );
}

/// An arc in rapid traverse goes by the axis that is slowest at its fastest place: X at the top of a
/// half circle, but on the 60 degrees at its side only cos 60° = 1/2 of the path speed.
#[test]
fn rapid_traverse_on_an_arc() {
    let mut l = limits();
    l.radial_acceleration_m_s2 = 5.0;
    l.max_feed_mm_min[X] = 3000.0;
    let peak = |heading: f64, sweep: f64| {
        let mut path = Path::new(1.0);
        path.feed(FeedRate::Rapid).turn(heading, 1000.0, sweep, 0.0);
        plan(&path.elements, &l)[0].profile.peak_mm_s
    };
    close(peak(90.0, -180.0), 50.0);
    close(peak(90.0, 30.0), 50.0 / 30f64.to_radians().sin());
    close(peak(60.0, 60.0), 50.0 / 0.5);
}

/// A sharp corner stops the path: two lines take as long as one after the other.
#[test]
fn corners_stop() {
    let mut path = Path::new(6000.0);
    path.line(&[(X, 50.0)]).line(&[(Y, 50.0)]);
    close(time(&path, &limits()), 2.0 * rest_to_rest(50.0, 100.0, 1000.0));
}

/// Straight on there is no stop, nor where an arc continues a line.
#[test]
fn tangential_transitions_pass() {
    let mut path = Path::new(3000.0);
    path.line(&[(X, 25.0)]).line(&[(X, 50.0)]);
    close(time(&path, &limits()), rest_to_rest(50.0, 50.0, 1000.0));
    let mut path = Path::new(3000.0);
    path.line(&[(X, 50.0)])
        .turn(0.0, 10.0, 90.0, 0.0)
        .by(&[(Y, 50.0)]);
    close(
        time(&path, &limits()),
        rest_to_rest(100.0 + 5.0 * std::f64::consts::PI, 50.0, 1000.0),
    );
    assert!(plan(&path.elements, &limits())[0].profile.exit_mm_s > 49.999);
}

/// An arc whose end is a little off its circle (MP7431) has its tangent as direction, however long the
/// step of its radius makes that: 0.0005 mm on a quarter of a circle of 1 mm are 0.0003 rad, 0.018 degrees.
#[test]
fn arcs_with_rounded_end_points_pass() {
    let mut path = Path::new(1000.0);
    path.line(&[(X, 20.0)])
        .spiral(0.0, [1.0, 1.0005], 90.0, 0.0)
        .by(&[(Y, 20.0)]);
    let exits = |corner_angle_deg: f64| {
        let planned = plan(
            &path.elements,
            &Limits {
                corner_angle_deg,
                ..limits()
            },
        );
        [planned[0].profile.exit_mm_s, planned[1].profile.exit_mm_s]
    };
    assert_eq!(exits(0.017), [0.0, 0.0]);
    assert!(exits(0.019).iter().all(|exit| *exit > 16.6));
}

/// The greatest speed at which a corner of `deg` from the direction of X between long lines is passed, mm/s.
/// By the law of corners, for MP1060 = 1 and MP1070 = 0.5 m/s²: a step of velocity takes 4/5 of
/// sqrt(1000² + 500²) over the servo's window of 0.15 s.
fn corner_speed(deg: f64) -> f64 {
    let (sin, cos) = deg.to_radians().sin_cos();
    0.8 * 1000f64.hypot(500.0) * 0.15 / sin.max(1.0 - cos)
}

fn corner(feed: f64, deg: f64, m90: bool, limits: &Limits) -> f64 {
    let (sin, cos) = f64::to_radians(deg).sin_cos();
    let mut path = Path::new(feed);
    path.line(&[(X, 150.0)]);
    path.last().constant_speed = m90;
    path.by(&[(X, 150.0 * cos), (Y, 150.0 * sin)]);
    plan(&path.elements, limits)[0].profile.exit_mm_s
}

/// MP7460: changes of direction up to its angle pass at the feed [000:5096-5108], also that of 18.8 degrees
/// at F8000; above the path stops.
#[test]
fn corners_up_to_mp7460_pass_at_the_feed() {
    for deg in [1.0, 5.0, 9.999] {
        close(corner(6000.0, deg, false, &limits()), 100.0);
    }
    assert_eq!(corner(6000.0, 10.001, false, &limits()), 0.0);
    for servo_lag in [false, true] {
        let wide = Limits {
            corner_angle_deg: 60.001,
            servo_lag,
            ..limits()
        };
        close(corner(8000.0, 18.8, false, &wide), 8000.0 / 60.0);
        // 15 m/min, 60 degrees: the step of Y would be 217 mm/s; the servo follows 134.2 mm/s.
        close(corner(15_000.0, 60.0, false, &wide), corner_speed(60.0));
        assert_eq!(corner_speed(60.0).round(), 155.0);
    }
}

/// M90 passes any corner, but only with servo lag [000:5112-5114]: from 5 to 90 degrees at the feed.
#[test]
fn m90_passes_with_servo_lag() {
    for deg in [5.0, 15.0, 30.0, 60.0, 90.0] {
        close(corner(8000.0, deg, true, &limits()), 8000.0 / 60.0);
    }
    // Backwards X makes a step of twice the speed.
    close(corner(8000.0, 180.0, true, &limits()), corner_speed(180.0));
    let feedforward = Limits {
        servo_lag: false,
        ..limits()
    };
    assert_eq!(corner(8000.0, 60.0, true, &feedforward), 0.0);
    close(corner(8000.0, 5.0, true, &feedforward), 8000.0 / 60.0);
}

/// Two corners 2 mm apart share the window. Each owns half the distance between them, and half a window beside:
/// v · change <= limit · (W/2 + 1 mm / v).
#[test]
fn corners_close_together_share_the_window() {
    let (sin, cos) = 45f64.to_radians().sin_cos();
    let mut path = Path::new(30_000.0);
    path.line(&[(X, 150.0)]).last().constant_speed = true;
    path.by(&[(X, 2.0 * cos), (Y, 2.0 * sin)]).last().constant_speed = true;
    path.by(&[(Y, 150.0)]);
    let fast = Limits {
        max_feed_mm_min: PerAxis::splat(30_000.0),
        ..limits()
    };
    let planned = plan(&path.elements, &fast);
    let v = planned[0].profile.exit_mm_s;
    let limit = 0.8 * 1000f64.hypot(500.0) / sin;
    close(v, limit * (0.075 + 1.0 / v));
    close(planned[1].profile.exit_mm_s, v);
    assert!(v < corner(30_000.0, 45.0, true, &fast), "alone it is faster");
}

/// Short lines along a circle of radius 20 mm, 0.1 mm each: the corners share the time, and the law
/// v · change <= 0.8 · bound · length / v gives v² <= 0.8 · bound · radius for an axis across the path, like
/// a circle with that radial acceleration; where both axes share the change it is up to sqrt(2) of that.
#[test]
fn short_lines_on_a_circle_run_like_on_a_circle() {
    let mut path = Path::new(30_000.0);
    // 2 · 20 · pi / 0.1 = 1257 lines.
    let count = 1257u32;
    for i in 1..=count {
        let (sin, cos) = (f64::from(i) / f64::from(count))
            .mul_add(360.0, 0.0)
            .to_radians()
            .sin_cos();
        path.line(&[(X, 20.0 * cos - 20.0), (Y, 20.0 * sin)]);
    }
    let planned = plan(&path.elements, &limits());
    let middle = &planned[planned.len() / 4..3 * planned.len() / 4];
    let least = middle
        .iter()
        .map(|p| p.profile.exit_mm_s)
        .fold(f64::INFINITY, f64::min);
    let greatest = middle.iter().map(|p| p.profile.exit_mm_s).fold(0.0, f64::max);
    let across = (0.8f64 * 1118.0 * 20.0).sqrt();
    assert!(least > across * 0.98, "{least}");
    assert!(greatest < across * 2f64.powf(0.25) * 1.02, "{greatest}");
}

/// When only rotary axes move the feed is degrees/min: 90° at 50 °/s, 1000 °/s².
#[test]
fn rotary_axis_alone() {
    let mut path = Path::new(3000.0);
    path.line(&[(C, 90.0)]);
    close(time(&path, &limits()), rest_to_rest(90.0, 50.0, 1000.0));
}

/// With a linear axis the feed belongs to the linear path, and the rotary axis keeps its limits: 90° on
/// 10 mm are 9° each mm, at 15 000 °/min 1666.7 mm/min and with 1000 °/s² 111.1 mm/s² of path.
#[test]
fn rotary_axis_beside_a_short_line() {
    let mut path = Path::new(3000.0);
    path.line(&[(X, 10.0), (C, 90.0)]);
    let planned = plan(&path.elements, &limits());
    close(planned[0].profile.length_mm, 10.0);
    close(planned[0].profile.acceleration_mm_s2, 1000.0 / 9.0);
    close(planned[0].profile.peak_mm_s, 15_000.0 / 60.0 / 9.0);
    // From a line to a rotary axis and back there is always a stop.
    path.line(&[(C, 180.0)]);
    path.last().constant_speed = true;
    path.line(&[(X, 20.0)]);
    let planned = plan(&path.elements, &limits());
    assert_eq!(
        (planned[0].profile.exit_mm_s, planned[1].profile.exit_mm_s),
        (0.0, 0.0)
    );
}

/// Tapping with a floating holder takes the override between MP7110's limits, rigid tapping none
/// [000:6094-6098] [003:5106].
#[test]
fn override_laws() {
    let peak = |percent: f64, law: OverrideLaw| {
        let mut path = Path::new(6000.0);
        path.line(&[(Z, 100.0)]);
        path.last().override_law = law;
        plan(
            &path.elements,
            &Limits {
                feed_override_percent: percent,
                ..limits()
            },
        )[0]
        .profile
        .peak_mm_s
    };
    let limited = OverrideLaw::Tapping {
        from_percent: 90.0,
        to_percent: 110.0,
    };
    close(peak(70.0, OverrideLaw::Free), 70.0);
    close(peak(70.0, limited), 90.0);
    close(peak(100.0, limited), 100.0);
    close(peak(150.0, limited), 110.0);
    close(peak(70.0, OverrideLaw::Disabled), 100.0);
    close(peak(200.0, OverrideLaw::Free), 150.0);
}

/// What cannot move takes for ever; nothing panics and nothing becomes NaN.
#[test]
fn without_feed_nothing_moves() {
    let mut path = Path::new(6000.0);
    path.line(&[(X, 10.0)]).line(&[(X, 20.0)]).line(&[(X, 30.0)]);
    let with = |feed: f64, l: &Limits| {
        let mut path = path.clone();
        path.elements[1].feed = FeedRate::Programmed(feed);
        plan(&path.elements, l)
    };
    for feed in [0.0, -5.0, f64::NAN, f64::NEG_INFINITY, 1e-300] {
        let planned = with(feed, &limits());
        assert_eq!(planned[1].profile.duration_s, f64::INFINITY, "{feed}");
        assert_eq!(planned[1].position_at(1e6)[X], 10.0);
        // The others stop before and start after it.
        close(planned[0].profile.duration_s, 0.2);
        close(planned[2].profile.duration_s, 0.2);
    }
    close(
        with(f64::INFINITY, &limits())[1].profile.peak_mm_s,
        20_000f64.sqrt(),
    );
    let stopped = Limits {
        feed_override_percent: 0.0,
        ..limits()
    };
    assert!(
        with(6000.0, &stopped)
            .iter()
            .all(|p| p.profile.duration_s == f64::INFINITY)
    );
    let mut no_axis = limits();
    no_axis.max_feed_mm_min[X] = 0.0;
    assert!(
        with(6000.0, &no_axis)
            .iter()
            .all(|p| p.profile.duration_s == f64::INFINITY)
    );
}

/// Limits that no machine has.
#[test]
fn senseless_limits_are_survived() {
    for value in [
        f64::NAN,
        -1.0,
        0.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MIN_POSITIVE,
        f64::MAX,
    ] {
        let l = Limits {
            max_feed_mm_min: PerAxis::splat(value),
            acceleration_m_s2: PerAxis::splat(value),
            radial_acceleration_m_s2: value,
            corner_angle_deg: value,
            servo_lag: true,
            cycle_s: value,
            servo_window_s: bahn_motion::SERVO_WINDOW_S,
            spindle: Default::default(),
            feed_override_percent: value,
            rapid_override_percent: value,
        };
        let mut path = Path::new(6000.0);
        path.line(&[(X, 10.0)])
            .turn(1.0, 5.0, 90.0, 1.0)
            .feed(FeedRate::Rapid)
            .by(&[(X, 1.0), (C, 2.0)]);
        for l in [
            l.clone(),
            Limits {
                max_feed_mm_min: PerAxis::splat(1000.0),
                feed_override_percent: 100.0,
                ..l
            },
        ] {
            for p in plan(&path.elements, &l) {
                assert!(p.duration_s() >= 0.0, "{value}: {p:?}");
                assert!(
                    p.profile.exit_mm_s.is_finite() && p.profile.peak_mm_s.is_finite(),
                    "{value}: {p:?}"
                );
            }
        }
    }
}

/// An axis that has no position yet adds nothing; an arc without a start has no length.
#[test]
fn axes_without_position_add_no_length() {
    let mut path = Path::new(6000.0);
    path.at = Position::UNKNOWN;
    path.line(&[(Z, 100.0)]);
    path.line(&[(X, 0.0), (Y, 0.0)]);
    path.line(&[(X, 100.0), (Z, 100.0)]);
    let planned = plan(&path.elements, &limits());
    assert_eq!((planned[0].duration_s(), planned[1].duration_s()), (0.0, 0.0));
    close(planned[2].duration_s(), 1.1);
    let mut path = Path::new(6000.0);
    path.at = Position::UNKNOWN;
    path.to(
        Curve::Arc(Arc {
            plane: Plane::XY,
            centre: [0.0, 0.0],
            sweep_deg: 90.0,
        }),
        Position::ZERO,
    );
    assert_eq!(time(&path, &limits()), 0.0);
}

/// A block to the same point does not stop the path, and the corner is where it goes on.
#[test]
fn blocks_without_length_are_passed() {
    let mut path = Path::new(3000.0);
    path.line(&[(X, 25.0)]).line(&[(X, 25.0)]).line(&[(X, 50.0)]);
    close(time(&path, &limits()), rest_to_rest(50.0, 50.0, 1000.0));
    let mut path = Path::new(3000.0);
    path.line(&[(X, 25.0)]).line(&[(X, 25.0)]).line(&[(Y, 25.0)]);
    close(time(&path, &limits()), 2.0 * rest_to_rest(25.0, 50.0, 1000.0));
}

/// Coordinates as large as numbers go.
#[test]
fn endless_paths_do_not_panic() {
    for far in [1e15, 1e200, f64::MAX, f64::INFINITY] {
        let mut path = Path::new(3000.0);
        path.line(&[(X, far)])
            .line(&[(X, -far), (C, far)])
            .line(&[(Y, 1.0)]);
        assert!(
            plan(&path.elements, &limits())
                .iter()
                .all(|p| p.duration_s() >= 0.0),
            "{far}"
        );
    }
}
