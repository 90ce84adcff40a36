//! Operation with feed pre-control [000:4929-4975].

use std::f64::consts::TAU;

use crate::common::Bench;
use bahn_parameters::ControlModel::{self, Tnc407, Tnc415b};
use bahn_servo::Method;

const BASE: &[&str] = &[
    "1010.0=30000",
    "1050.0=9",
    "1510.0=2",
    "1810.0=2",
    "1710.0=100",
    "1720.0=200",
];

/// Greatest deviation of the table from a circle at the speed that MP1070 allows, mm, and the chord error
/// of the contour cycle there: MP1070 · T² / 8.
fn circle_deviation(model: ControlModel, radius_mm: f64, acceleration_m_s2: f64) -> (f64, f64) {
    let mut x = Bench::with_precontrol(model, &[BASE, &["1510.0=10"]].concat());
    let mut y = x.clone();
    let cycle_s = f64::from(x.timing.contour_us()) * 1e-6;
    // v = sqrt(r · MP1070) [000:5084].
    let velocity_mm_s = (radius_mm * acceleration_m_s2 * 1e3).sqrt();
    let mut deviation = 0.0f64;
    let mut angle = 0.0;
    // The angle runs up within a quarter turn; measured is the full turn after it.
    let full = velocity_mm_s / radius_mm * cycle_s;
    let mut way = 0.0;
    let mut last = (radius_mm, 0.0);
    while angle < TAU * 1.5 {
        way = (way + full / 200.0).min(full);
        angle += way;
        // The circle begins at the origin, its centre is left of it.
        let mut points = Vec::new();
        x.cycle_with(radius_mm * (angle.cos() - 1.0), |_, table| {
            points.push(table + radius_mm)
        });
        let mut at = points.into_iter();
        y.cycle_with(radius_mm * angle.sin(), |_, table_y| {
            let table_x = at.next().unwrap();
            // In a servo step the table goes straight on: its middle is farthest from the circle.
            let middle = ((table_x + last.0) / 2.0).hypot((table_y + last.1) / 2.0);
            if angle > TAU / 2.0 {
                for distance in [table_x.hypot(table_y), middle] {
                    deviation = deviation.max((distance - radius_mm).abs());
                }
            }
            last = (table_x, table_y);
        });
        assert_eq!((x.axis.fault(), y.axis.fault()), (None, None));
    }
    (deviation, acceleration_m_s2 * 1e3 * cycle_s * cycle_s / 8.0)
}

#[test]
fn a_circle_deviates_by_the_chord_error_of_the_contour_cycle() {
    for model in [Tnc415b, Tnc407] {
        for (radius, acceleration) in [(5.0, 0.5), (20.0, 0.5), (60.0, 0.2), (100.0, 1.0)] {
            let (deviation, chord) = circle_deviation(model, radius, acceleration);
            // Half a step of the converter is 1 or 0.25 mm/min at 30 m/min for 9 V, and with kv 10 a lag of
            // 0.1 or 0.025 µm; the encoder has steps of 0.02 µm.
            let fine = if model == Tnc407 { 0.000_15 } else { 0.000_06 };
            assert!(
                deviation <= chord + fine && deviation >= chord - fine,
                "{model} r {radius} a {acceleration}: {deviation} is not {chord}"
            );
        }
    }
}

#[test]
fn at_constant_speed_the_lag_is_almost_0() {
    for model in [Tnc407, Tnc415b] {
        let mut bench = Bench::with_precontrol(model, BASE);
        bench.run(5000.0, 1.0);
        assert!(bench.axis.lag_mm().abs() < 2e-4, "{}", bench.axis.lag_mm());
        assert!((bench.axis.volts() - 1.5).abs() < 2e-3, "{}", bench.axis.volts());
        assert_eq!(bench.axis.fault(), None);
    }
}

#[test]
fn kv_takes_out_what_lag_is_left() {
    // Moved away by 0.1 mm: 2 (m/min)/mm · 0.1 mm = 200 mm/min on top.
    let mut bench = Bench::with_precontrol(Tnc415b, BASE);
    bench.run(1000.0, 0.5);
    bench.table_mm -= 0.1;
    bench.run(1000.0, 0.0006);
    bench.run(1000.0, 0.003);
    assert!(
        (bench.axis.velocity_mm_min() - 1200.0).abs() < 25.0,
        "{}",
        bench.axis.velocity_mm_min()
    );
    bench.run(1000.0, 0.5);
    assert!(bench.axis.lag_mm().abs() < 1e-4);
}

#[test]
fn a_change_of_method_in_motion_does_not_jump() {
    for (first, second) in [
        (Method::Lag, Method::Precontrol),
        (Method::Precontrol, Method::Lag),
    ] {
        let mut bench = Bench::new(Tnc415b, BASE);
        bench.axis.set_method(first);
        bench.run(3000.0, 1.0);
        let mut before = bench.axis.volts();
        bench.axis.set_method(second);
        let target = bench.axis.target_mm();
        let mut largest = 0.0f64;
        for cycle in 1..=600 {
            bench.cycle_with(target + f64::from(cycle) * 0.15, |axis, _| {
                largest = largest.max((axis.volts() - before).abs());
                before = axis.volts();
            });
        }
        // 0.9 V run over to the other method with kv, 33/s: 0.9 · 33.3 · 0.6 ms = 0.018 V in a step.
        assert!(largest < 0.019, "{first:?}: {largest} V");
        let lag = if second == Method::Lag { 1.5 } else { 0.0 };
        assert!(
            (bench.axis.lag_mm() - lag).abs() < 1e-3,
            "{second:?}: {}",
            bench.axis.lag_mm()
        );
        assert_eq!(bench.axis.fault(), None, "{first:?}");
    }
}

#[test]
fn the_window_is_checked_below_mp1525_only() {
    // 3 ms · 2 mm/min is 0.1 µm for each contour cycle, far inside the window of 10 µm.
    let mut slow = Bench::with_precontrol(Tnc415b, &[BASE, &["1525=10"]].concat());
    slow.run(3000.0, 0.3);
    assert!(!slow.axis.in_position(), "the axis moves");
    let target = slow.axis.target_mm();
    let mut cycles = 0;
    while !slow.axis.in_position() {
        slow.cycle(target);
        cycles += 1;
        assert!(cycles < 10, "the axis does not arrive");
    }
    slow.stand(0.1);
    assert!(slow.axis.in_position());
}

/// The drive comes behind its nominal position. A window of 2 mm holds the axis all the time, so that MP1525 alone says
/// when it has arrived: when the axis itself is slow enough, not when the nominal position stands [000:813]. One
/// counting step of 20/1024 um in 3 ms is 0.39 mm/min: slower than 1.5 of them is standing. From 10 to 0.6 mm/min the drive takes 6 ms · ln(10/0.6) = 17 ms.
#[test]
fn the_window_waits_for_the_axis_itself() {
    let arrival = |entry: &str| {
        let entry = format!("1525={entry}");
        let mut bench = Bench::with_precontrol(Tnc415b, &[BASE, &["1030.0=2", &entry]].concat());
        bench.drive_s = 0.006;
        bench.run(3000.0, 0.5);
        let target = bench.axis.target_mm();
        let mut cycles = 0;
        while !bench.axis.in_position() {
            bench.cycle(target);
            cycles += 1;
            assert!(cycles < 1000, "the axis does not arrive");
        }
        (bench.velocity_mm_min.abs(), cycles)
    };
    let ((speed, early), (slower, late)) = (arrival("10"), arrival("0.5"));
    assert!(speed < 10.0 && slower < 1.5 * 0.39, "{speed} {slower}");
    assert!(early + 3 < late, "{early} {late}");
}

#[test]
fn a_small_entry_of_mp1520_arrives_more_slowly() {
    let arrival = |entry: &str| {
        let mut bench = Bench::with_precontrol(Tnc415b, &[BASE, &[entry]].concat());
        bench.run(3000.0, 0.3);
        let target = bench.axis.target_mm();
        let mut steps = 0;
        while !bench.axis.in_position() {
            bench.cycle_with(target, |axis, _| steps += i32::from(!axis.in_position()));
        }
        steps
    };
    assert!(arrival("1520=0.1") > arrival("1520=0.5") + 15);
    assert!(arrival("1520=0.5") > arrival("1520=10"));
}

/// A servo step is 0.6 ms, 1e-5 min, kv 2 is 2000/min; MP1520 = 10 rounds nothing and the drive is ideal. At F3000
/// with MP1530 = 0.5 the steps are pre-controlled with 1500, 2250 and 2625 mm/min. The first leaves
/// (3000 - 1500) mm/min · 1e-5 min = 0.015 mm of lag, which adds 30 mm/min to the second; 2280 of it leave 0.0222 mm,
/// 44.4 mm/min for the third. With the smallest entry, 0.01, the first has 2970. Braking is not damped.
#[test]
fn mp1530_damps_the_acceleration_and_not_the_braking() {
    let bench = |entry: &str| Bench::with_precontrol(Tnc415b, &[BASE, &["1520=10", entry]].concat());
    let velocities = |bench: &mut Bench, nominal_mm: f64| {
        let mut velocities = Vec::new();
        bench.cycle_with(nominal_mm, |axis, _| velocities.push(axis.velocity_mm_min()));
        velocities
    };
    let is = |found: f64, wanted: f64| assert!((found - wanted).abs() < 0.2, "{found}, not {wanted}");
    // F3000 for a contour cycle of 3 ms.
    let distance_mm = 0.15;
    let mut damped = bench("1530=0.5");
    let found = velocities(&mut damped, distance_mm);
    is(found[0], 1500.0);
    is(found[1], 2280.0);
    is(found[2], 2669.4);
    is(velocities(&mut bench("1530=0.01"), distance_mm)[0], 2970.0);

    // In uniform motion the lag has run down; then the nominal position stands.
    damped.run(3000.0, 0.5);
    let target = damped.axis.target_mm();
    is(velocities(&mut damped, target)[0], 0.0);
    // The other way it accelerates from standstill.
    is(velocities(&mut damped, target - distance_mm)[0], -1500.0);
    // With lag there is no pre-control.
    let mut lag = bench("1530=0.5");
    lag.axis.set_method(Method::Lag);
    let mut other = bench("1530=0.01");
    other.axis.set_method(Method::Lag);
    assert_eq!(
        velocities(&mut lag, distance_mm),
        velocities(&mut other, distance_mm)
    );
}

/// On a ramp of 1 m/s² the pre-control comes 0.5/(1 - 0.5) = 1 step of 0.6 ms late: 0.6 mm/s, which a loop of kv 2,
/// 33.3/s, holds with 0.018 mm of lag. Undamped (0.01) it is a 99th of it.
#[test]
fn the_lag_on_a_damped_ramp_is_what_the_delay_costs() {
    let lag_mm = |entry: &str| {
        let mut bench = Bench::with_precontrol(Tnc415b, &[BASE, &["1520=10", entry]].concat());
        let cycle_s = 0.003;
        for cycle in 1..=150 {
            let time_s = f64::from(cycle) * cycle_s;
            bench.cycle(0.5 * 1000.0 * time_s * time_s);
        }
        bench.axis.lag_mm()
    };
    // The velocity goes up in steps of a contour cycle, which moves the lag by some um to and fro.
    assert!((lag_mm("1530=0.5") - lag_mm("1530=0.01") - 0.018 * 98.0 / 99.0).abs() < 0.003);
}

#[test]
fn stiction_adds_what_the_manual_computes() {
    // The axis sticks at F60: the lag grows by 0.003 mm in each cycle of 3 ms. kv 2, MP1511 6000 µs:
    // 0.003/3000 · 2 · 6000 = 0.012 m/min = 12 mm/min.
    let stiction = &["1511.0=6000", "1512.0=1000", "1513.0=500", "1530=0.1"];
    let mut bench = Bench::with_precontrol(Tnc415b, &[BASE, stiction].concat());
    bench.blocked = true;
    bench.run(60.0, 0.03);
    assert!(
        (bench.axis.stiction_mm_min() - 12.0).abs() < 1e-6,
        "{}",
        bench.axis.stiction_mm_min()
    );
    // MP1512: 10 steps of 20 µm/256 are 0.78 µm: 0.00078125/3000 · 2 · 6000 m/min = 3.125 mm/min.
    let mut settings = *bench.axis.settings();
    settings.compensation.stiction_limit_steps = 10.0;
    bench.axis.configure(settings);
    bench.run(60.0, 0.03);
    assert!((bench.axis.stiction_mm_min() - 3.125).abs() < 1e-6);
    // From MP1513 on not at all, nor with lag.
    bench.run(500.0, 0.01);
    assert_eq!(bench.axis.stiction_mm_min(), 0.0);
    bench.axis.set_method(Method::Lag);
    bench.run(60.0, 0.03);
    assert_eq!(bench.axis.stiction_mm_min(), 0.0);
}

#[test]
fn reversal_peaks_push_after_the_quadrant() {
    let peaks = &["711.0=0.003", "712.0=0.001", "715.0=-0.002", "716.0=0.002"];
    let push = |circular: bool, second: bool| {
        let mut bench = Bench::new(Tnc415b, &[BASE, peaks].concat());
        bench.axis.set_circular(circular);
        bench.axis.set_second_set(second);
        bench.run(60.0, 0.3);
        let target = bench.axis.target_mm();
        let mut values = Vec::new();
        for cycle in 1..=8 {
            let nominal = target - 0.003 * f64::from(cycle);
            bench.cycle(nominal);
            // The last step's nominal position is a fifth of a cycle behind its end.
            bench.axis.step();
            values.push(((bench.axis.nominal_mm() - nominal) * 1e3).round() as i32);
        }
        values
    };
    assert_eq!(push(true, false), [-1, -2, -3, -2, -1, 0, 0, 0]);
    assert_eq!(push(true, true), [2, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(push(false, false), [0; 8]);
}
