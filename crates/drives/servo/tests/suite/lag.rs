//! Operation with servo lag [000:4735-4925].

use crate::common::Bench;
use bahn_parameters::ControlModel::{Tnc407, Tnc415b};
use bahn_servo::Method;

/// kv 2, rapid traverse 5000 mm/min at 9 V [000:4881-4891].
const MANUAL: &[&str] = &[
    "1810.0=2",
    "1010.0=5000",
    "1050.0=9",
    "1820.0=1",
    "1830.0=100",
    "1710.0=100",
    "1720.0=200",
];

#[test]
fn rapid_traverse_lags_2_5_mm_at_9_volts() {
    for model in [Tnc407, Tnc415b] {
        let mut bench = Bench::new(model, MANUAL);
        bench.run(5000.0, 2.0);
        assert!(
            (bench.axis.lag_mm() - 2.5).abs() < 1e-3,
            "{}",
            bench.axis.lag_mm()
        );
        assert!((bench.axis.volts() - 9.0).abs() < 3e-3, "{}", bench.axis.volts());
    }
}

#[test]
fn a_micrometre_of_lag_is_24_or_6_steps_of_the_output() {
    // 9000 mV / 2500 µm = 3.6 mV; 3.6/0.15 = 24 (23.6 of the exact step), 3.6/0.6 = 6 (5.9) [000:4887-4891].
    for (model, steps) in [(Tnc415b, 24.0), (Tnc407, 6.0)] {
        // Half the scale's period of 20 µm is 512 steps: 10 µm.
        let mut bench = Bench::new(model, MANUAL);
        bench.table_mm = -0.010;
        bench.blocked = true;
        bench.cycle(0.0);
        let millivolts = bench.axis.volts() * 1e3;
        assert!((millivolts / 10.0 - 3.6).abs() < 0.05, "{millivolts}");
        let output_steps = bench.axis.volts() / bench.timing.resolution_volts();
        assert_eq!(
            output_steps,
            output_steps.round(),
            "the converter knows no half steps"
        );
        assert!((output_steps / 10.0 - steps).abs() < 0.5, "{output_steps}");
    }
}

#[test]
fn above_the_kink_the_lag_is_4_mm() {
    // 2.5 · (0.4 + 60/(0.5 · 100)) = 4.0 mm [000:4898-4907].
    let mut bench = Bench::new(Tnc415b, &[MANUAL, &["1820.0=0.5", "1830.0=40"]].concat());
    bench.run(5000.0, 3.0);
    assert!(
        (bench.axis.lag_mm() - 4.0).abs() < 4e-3,
        "{}",
        bench.axis.lag_mm()
    );
    // Below the kink, 40 % of 5000 = 2000 mm/min: 2/2 = 1 mm.
    bench.run(2000.0, 3.0);
    assert!(
        (bench.axis.lag_mm() - 1.0).abs() < 1e-3,
        "{}",
        bench.axis.lag_mm()
    );
}

#[test]
fn without_feed_enable_the_output_is_0_volts_at_once() {
    let mut bench = Bench::new(Tnc415b, MANUAL);
    bench.run(3000.0, 1.0);
    assert!(bench.axis.volts() > 5.0);
    bench.axis.set_enabled(false);
    assert_eq!(bench.axis.step(), 0.0);
}

#[test]
fn actual_position_becomes_nominal_position() {
    let mut bench = Bench::new(Tnc415b, MANUAL);
    bench.run(5000.0, 1.0);
    bench.axis.transfer();
    assert_eq!(bench.axis.lag_mm(), 0.0);
    bench.cycle(bench.axis.target_mm());
    assert!(bench.axis.volts().abs() < 0.2, "{}", bench.axis.volts());
}

#[test]
fn a_datum_shifts_nominal_and_actual_position_alike() {
    let mut bench = Bench::new(Tnc415b, MANUAL);
    bench.run(1000.0, 1.0);
    let (lag, volts) = (bench.axis.lag_mm(), bench.axis.volts());
    let (count, actual) = (bench.axis.count(), bench.axis.actual_mm());
    let shift = bench.axis.set_datum(count, 100.0);
    assert!((shift - (100.0 - actual)).abs() < 1e-9);
    assert_eq!(bench.axis.actual_mm(), 100.0);
    assert!((bench.axis.lag_mm() - lag).abs() < 1e-9);
    bench.run(1000.0, 0.003);
    assert!((bench.axis.volts() - volts).abs() < 1e-3);
}

#[test]
fn both_methods_know_their_kv_and_that_after_m105() {
    let mut bench = Bench::new(
        Tnc415b,
        &[MANUAL, &["1815.0=1", "1510.0=4", "1515.0=0.5"]].concat(),
    );
    bench.blocked = true;
    bench.table_mm = -1.0;
    for (method, second, velocity) in [
        (Method::Lag, false, 2000.0),
        (Method::Lag, true, 1000.0),
        (Method::Precontrol, false, 4000.0),
        (Method::Precontrol, true, 500.0),
    ] {
        let mut bench = bench.clone();
        bench.axis.set_method(method);
        bench.axis.set_second_set(second);
        bench.stand(0.003);
        assert!(
            (bench.axis.velocity_mm_min() - velocity).abs() < 1e-6,
            "{method:?} {second}"
        );
    }
}

#[test]
fn rounding_of_a_position_that_stands_is_no_movement() {
    let mut bench = Bench::new(Tnc415b, &[MANUAL, &["710.0=0.05"]].concat());
    bench.run(1000.0, 0.3);
    bench.stand(1.0);
    let (target, table) = (bench.axis.target_mm(), bench.table_mm);
    for cycle in 0..100 {
        let jitter = if cycle % 2 == 0 { 2e-12 } else { -2e-12 };
        bench.cycle_with(target + jitter, |axis, _| assert!(axis.in_position()));
    }
    assert!((bench.table_mm - table).abs() < 1e-4, "no play was compensated");
}
