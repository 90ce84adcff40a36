//! Offset adjustment in all its forms [000:5002-5072].

use crate::common::Bench;
use bahn_parameters::ControlModel::{self, Tnc407, Tnc415b};
use bahn_servo::{Fault, GrossFault, OffsetInterval};

const BASE: &[&str] = &[
    "1010.0=10000",
    "1050.0=9",
    "1810.0=1",
    "1830.0=100",
    "1080.0=0",
    "1110.0=30",
];

/// An axis at rest whose drive has an offset.
fn resting(model: ControlModel, offset_mv: f64, assignments: &[&str]) -> Bench {
    let mut bench = Bench::new(model, &[BASE, assignments].concat());
    bench.offset_volts = offset_mv * 1e-3;
    bench.stand(1.5);
    bench
}

#[test]
fn the_code_number_shows_and_compensates_the_offset() {
    // 1.5 mV against the axis are 10 units of 0.15 mV [000:5016].
    let mut bench = resting(Tnc415b, -1.526, &[]);
    assert_eq!(bench.axis.offset_units(), 10);
    // 0.9 V stand for 1000 mm/min and 1 mm of lag: 1.526 mV are 1.7 µm.
    assert!((bench.axis.lag_mm() - 0.0017).abs() < 1e-4);
    bench.axis.compensate_offset();
    bench.stand(1.5);
    // The axis comes to rest within one step of the converter.
    assert!(bench.axis.offset_units().abs() <= 1);
    assert!(bench.axis.lag_mm().abs() < 3e-4);
    assert!((bench.axis.offset_compensation_volts() - 0.001_526).abs() < 1e-4);
    bench.axis.set_offset_compensation(0.0);
    bench.stand(1.5);
    assert_eq!(bench.axis.offset_units(), 10, "NO ENT switches it off");
}

#[test]
fn a_tnc_407_compensates_from_0_6_mv_on() {
    for (offset, compensation) in [(-0.5, 0.0), (-0.7, 0.000_610)] {
        let mut bench = resting(Tnc407, offset, &[]);
        // Between two steps of the converter the voltage goes to and fro; a finer one shows the offset.
        bench.axis.compensate_offset();
        let volts = bench.axis.offset_compensation_volts();
        assert!(
            volts == 0.0 || (volts - compensation).abs() < 1e-5,
            "{offset}: {volts}"
        );
        assert!(offset < -0.6 || volts == 0.0, "{offset}: {volts}");
    }
}

#[test]
fn each_cyclic_adjustment_corrects_1_mv_and_then_single_steps() {
    // 3.4 mV: 1, 1, 1, then 0.15, 0.15; what is left is below a step.
    let mut bench = resting(Tnc415b, -3.4, &[]);
    let mut interval = OffsetInterval::new(2.0);
    let mut steps = Vec::new();
    for _ in 0..bench.cycles(16.1) {
        bench.stand(0.003);
        if interval.pass(bench.timing.contour_us(), true) {
            let before = bench.axis.offset_compensation_volts();
            bench.axis.adjust_offset();
            let after = bench.axis.offset_compensation_volts();
            steps.push(((after - before) * 1e5).round() as i32);
        }
    }
    assert_eq!(steps, [100, 100, 100, 15, 15, 0, 0, 0]);
    assert!(bench.axis.offset_units().abs() <= 1);
}

#[test]
fn the_interval_waits_until_all_axes_stand() {
    let mut interval = OffsetInterval::new(0.010);
    let due: Vec<bool> = [true, true, true, false, true, true]
        .map(|permitted| interval.pass(3000, permitted))
        .to_vec();
    assert_eq!(
        due,
        [false, false, false, false, true, false],
        "12 ms come while an axis moves"
    );
    let mut off = OffsetInterval::new(0.0);
    assert!(!(0..10).any(|_| off.pass(u32::MAX, true)));
}

#[test]
fn the_integral_factor_takes_the_offset_over_at_standstill() {
    let lag_after = |factor: &str, seconds: f64| {
        let mut bench = resting(Tnc415b, -20.0, &[factor]);
        bench.stand(seconds);
        bench.axis.lag_mm()
    };
    // 20 mV / 0.9 V · 1 mm = 22 µm.
    assert!((lag_after("1080.0=0", 10.0) - 0.0222).abs() < 3e-4);
    let (small, large) = (lag_after("1080.0=100", 2.0), lag_after("1080.0=1000", 2.0));
    assert!(
        small < 0.02 && large < small / 2.0,
        "larger is faster: {small}, {large}"
    );
    assert!(lag_after("1080.0=1000", 10.0).abs() < 2e-4);
}

#[test]
fn the_integral_factor_rests_while_the_axis_moves() {
    let mut bench = Bench::new(
        Tnc415b,
        &[BASE, &["1080.0=1000", "1710.0=300", "1720.0=300"]].concat(),
    );
    bench.run(5000.0, 3.0);
    // 5 m/min at kv 1: 5 mm, no voltage was added.
    assert!(
        (bench.axis.lag_mm() - 5.0).abs() < 5e-3,
        "{}",
        bench.axis.lag_mm()
    );
}

#[test]
fn an_offset_of_100_mv_is_a_fault() {
    for (offset, fault) in [(-99.0, None), (-101.0, Some(Fault::Gross(GrossFault::Offset)))] {
        let mut bench = resting(Tnc415b, offset, &[]);
        assert_eq!(bench.axis.fault(), None, "the control does not know it yet");
        bench.axis.compensate_offset();
        bench.stand(0.003);
        assert_eq!(bench.axis.fault(), fault, "{offset} mV");
    }
    // 60 mV are taken over by the integral factor, then the offset grows.
    let mut integral = resting(Tnc415b, -60.0, &["1080.0=1000"]);
    integral.stand(10.0);
    assert_eq!(integral.axis.fault(), None);
    integral.offset_volts = -0.101;
    integral.stand(10.0);
    assert_eq!(integral.axis.fault(), Some(Fault::Gross(GrossFault::Offset)));
}

#[test]
fn the_integral_factor_does_not_push_against_a_clamp() {
    let mut bench = resting(Tnc415b, 0.0, &["1080.0=1000"]);
    bench.blocked = true;
    bench.table_mm -= 0.2;
    bench.stand(5.0);
    // 0.2 mm are 0.18 V, no offset.
    assert!((bench.axis.volts() - 0.18).abs() < 1e-3, "{}", bench.axis.volts());
    assert_eq!(bench.axis.fault(), None);
}
