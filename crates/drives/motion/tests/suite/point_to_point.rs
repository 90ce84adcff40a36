//! One axis by itself.

use bahn_motion::{Aim, PointToPoint};
use proptest::prelude::*;

const T: f64 = 0.003;

fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9, "{a} is not {b}");
}

/// Time to a target from standstill: ramps and what is between them.
fn trapezoid(distance: f64, speed: f64, a: f64) -> f64 {
    if distance * a >= speed * speed {
        distance / speed + speed / a
    } else {
        2.0 * (distance / a).sqrt()
    }
}

/// 100.07 mm at 6000 mm/min with 1 m/s²: 1.0007 s and 0.1 s for both ramps are 366.9 cycles.
#[test]
fn as_fast_as_it_can_and_to_the_bit() {
    let mut axis = PointToPoint::new(0.0);
    let mut cycles = 0;
    while !axis.is_at(100.07) {
        axis.cycle(T, Aim::Position(100.07), 6000.0, 1.0);
        cycles += 1;
    }
    assert_eq!(cycles, 367);
    assert_eq!(axis.position(), 100.07);
}

/// At 100 mm/s, 2 mm before the new target: 5 mm of braking, then 3 mm back.
#[test]
fn a_target_that_is_too_near_is_come_back_to() {
    let mut axis = PointToPoint::moving(10.0, 100.0);
    let mut farthest = 0.0f64;
    let mut cycles = 0;
    while !axis.is_at(12.0) {
        farthest = farthest.max(axis.cycle(0.001, Aim::Position(12.0), 6000.0, 1.0));
        cycles += 1;
    }
    close(farthest, 15.0);
    // 100 ms, and 2 · sqrt(3 / 1000) s = 109.5 ms.
    assert_eq!(cycles, 210);
}

/// From 100 to -50 mm/s with 1000 mm/s² in 0.15 s; then the limit falls to 20 mm/s, then stop.
#[test]
fn a_feed_in_either_direction() {
    let mut axis = PointToPoint::moving(0.0, 100.0);
    axis.cycle(0.05, Aim::Feed(-3000.0), 6000.0, 1.0);
    close(axis.speed_mm_s(), 50.0);
    close(axis.position(), 3.75);
    axis.cycle(0.1, Aim::Feed(-3000.0), 6000.0, 1.0);
    close(axis.speed_mm_s(), -50.0);
    close(axis.position(), 3.75);
    axis.cycle(0.1, Aim::Feed(-3000.0), 1200.0, 1.0);
    close(axis.speed_mm_s(), -20.0);
    close(axis.position(), 3.75 - 0.03 * 35.0 - 0.07 * 20.0);
    axis.cycle(1.0, Aim::Feed(0.0), 1200.0, 1.0);
    assert_eq!(axis.speed_mm_s(), 0.0);
}

#[test]
fn what_is_no_number_stops() {
    let mut axis = PointToPoint::moving(0.0, 1.0);
    axis.cycle(1.0, Aim::Position(f64::NAN), 6000.0, 1.0);
    assert_eq!(axis.speed_mm_s(), 0.0);
    let at = axis.position();
    axis.cycle(1.0, Aim::Feed(f64::NAN), f64::NAN, f64::NAN);
    axis.cycle(f64::NAN, Aim::Feed(f64::INFINITY), 6000.0, 1.0);
    axis.cycle(1.0, Aim::Position(5.0), f64::NAN, 1.0);
    assert_eq!(axis.position(), at);
}

fn aim() -> impl Strategy<Value = Aim> {
    prop_oneof![
        3 => (-200.0..200.0f64).prop_map(Aim::Position),
        1 => (-0.01..0.01f64).prop_map(Aim::Position),
        1 => (-20_000.0..20_000.0f64).prop_map(Aim::Feed),
        1 => Just(Aim::Feed(0.0)),
    ]
}

proptest! {
    #[test]
    fn it_takes_the_least_time_without_overshoot(
        from in -1000.0..1000.0f64, distance in prop_oneof![-500.0..500.0f64, -0.01..0.01f64],
        feed in 10.0..30_000.0f64, a in 0.05..10.0f64,
    ) {
        let to = from + distance;
        let mut axis = PointToPoint::new(from);
        let whole = trapezoid((to - from).abs(), feed / 60.0, 1000.0 * a);
        prop_assume!(whole < 100.0);
        let mut cycles = 0.0;
        while !axis.is_at(to) {
            let before = axis.position();
            let at = axis.cycle(T, Aim::Position(to), feed, a);
            prop_assert!((to - at) * distance >= 0.0, "overshoot to {at} beyond {to}");
            prop_assert!((at - before) * distance >= 0.0, "backwards from {before} to {at}");
            prop_assert!(cycles * T <= whole + 1e-6, "{} s over {whole}", cycles * T);
            cycles += 1.0;
        }
        prop_assert!(cycles * T >= whole - 1e-6, "{} s of {whole}", cycles * T);
    }

    /// Whatever is asked of it: speed changes with the acceleration only, the distance is that of the speed, the
    /// limit is kept once it is reached, and at last it lands.
    #[test]
    fn it_keeps_its_limits_whatever_comes(
        asks in prop::collection::vec((aim(), 1usize..100, 10.0..20_000.0f64), 1..20), a in 0.05..10.0f64,
    ) {
        let mut axis = PointToPoint::new(0.0);
        for (aim, cycles, feed) in asks {
            for _ in 0..cycles {
                let (x0, v0) = (axis.position(), axis.speed_mm_s());
                let x1 = axis.cycle(T, aim, feed, a);
                let v1 = axis.speed_mm_s();
                let step = 1000.0 * a * T;
                prop_assert!((v1 - v0).abs() <= step + 1e-6, "{v0} to {v1}");
                prop_assert!(v1.abs() <= (feed / 60.0).max(v0.abs() - step) + 1e-6);
                let mean = 0.5 * (v0 + v1);
                // Within a cycle the speed may rise and fall again: a quarter of the step at most.
                prop_assert!((x1 - x0 - mean * T).abs() <= 0.25 * step * T + 1e-9);
            }
        }
        for _ in 0..1_000_000 {
            if axis.is_at(1.0) {
                break;
            }
            axis.cycle(T, Aim::Position(1.0), 30_000.0, a);
        }
        prop_assert_eq!(axis.position(), 1.0);
    }

    /// Two half cycles are one.
    #[test]
    fn time_can_be_split(speed in -100.0..100.0f64, aim in aim(), feed in 10.0..20_000.0f64, a in 0.05..10.0f64) {
        let mut whole = PointToPoint::moving(0.0, speed);
        let mut halves = whole;
        for _ in 0..100 {
            whole.cycle(T, aim, feed, a);
            halves.cycle(0.5 * T, aim, feed, a);
            halves.cycle(0.5 * T, aim, feed, a);
            prop_assert!((whole.position() - halves.position()).abs() <= 1e-9);
        }
    }
}
