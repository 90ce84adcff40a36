//! Monitoring: each fault at its edge [000:5160-5300].

use crate::common::Bench;
use bahn_parameters::ControlModel::Tnc415b;
use bahn_parameters::MessageId;
use bahn_parameters::fault::FaultId;
use bahn_servo::{EncoderFault, Fault, GrossFault, Method};

/// kv 1 and wide limits; 10 m/min at 10/1 V so that only the monitoring under test answers.
const WIDE: &[&str] = &[
    "1010.0=10000",
    "1050.0=9",
    "1810.0=1",
    "1510.0=1",
    "1710.0=300",
    "1720.0=300",
    "1410.0=30",
    "1420.0=30",
    "1110.0=30",
    "1140.0=10",
    "1030.0=0.01",
];

fn bench(method: Method, assignments: &[&str]) -> Bench {
    let mut bench = Bench::new(Tnc415b, &[WIDE, assignments].concat());
    bench.axis.set_method(method);
    bench.stand(0.1);
    assert_eq!(bench.axis.fault(), None);
    bench
}

/// What a deviation of the table from its place leads to.
fn at_deviation(mut bench: Bench, deviation_mm: f64) -> Option<Fault> {
    bench.blocked = true;
    bench.table_mm -= deviation_mm;
    bench.cycle(bench.axis.target_mm());
    bench.axis.fault()
}

#[test]
fn lag_is_monitored_by_the_limits_of_its_method() {
    let limits = &["1710.0=2", "1720.0=3", "1410.0=0.5", "1420.0=1"];
    let gross = Some(Fault::Gross(GrossFault::Deviation));
    for (method, cancellable, emergency) in [(Method::Lag, 2.0, 3.0), (Method::Precontrol, 0.5, 1.0)] {
        for sign in [-1.0, 1.0] {
            let at = |mm: f64| at_deviation(bench(method, limits), sign * mm);
            assert_eq!(at(cancellable - 0.001), None, "{method:?}");
            assert_eq!(at(cancellable + 0.001), Some(Fault::Positioning), "{method:?}");
            assert_eq!(at(emergency - 0.001), Some(Fault::Positioning), "{method:?}");
            assert_eq!(at(emergency + 0.001), gross, "{method:?}");
        }
    }
}

#[test]
fn rapid_traverse_fits_the_recommended_limits() {
    // 10 m/min at kv 1 lags 10 mm; 1.2 and 1.4 times it, and 0.5, 10, 0.5 V, 0.2 mm [000:9806-9817].
    let recommended = &[
        "1710.0=12",
        "1720.0=14",
        "1410.0=0.5",
        "1420.0=10",
        "1140.0=0.5",
        "1110.0=0.2",
    ];
    for method in [Method::Lag, Method::Precontrol] {
        let mut bench = bench(method, recommended);
        for feed in [10_000.0, -10_000.0, 500.0, -20.0] {
            bench.run(feed, 0.8);
            assert_eq!(bench.axis.fault(), None, "{method:?} F{feed}");
            bench.stand(0.8);
            assert!(bench.axis.in_position(), "{method:?} F{feed}");
        }
        assert_eq!(bench.axis.fault(), None);
    }
}

#[test]
fn a_drive_with_a_time_constant_fits_the_recommended_limits() {
    let recommended = &[
        "1710.0=12",
        "1720.0=14",
        "1140.0=0.5",
        "1110.0=0.2",
        "1410.0=2",
        "1420.0=10",
    ];
    for method in [Method::Lag, Method::Precontrol] {
        for drive_s in [0.005, 0.010, 0.020] {
            let mut bench = bench(method, recommended);
            bench.drive_s = drive_s;
            for (way, feed) in [
                (300.0, 8000.0),
                (-200.0, 8000.0),
                (0.01, 500.0),
                (-5.0, 2000.0),
                (40.0, 300.0),
            ] {
                bench.position(way, feed, 1.0);
                bench.stand(1.0);
                assert_eq!(
                    bench.axis.fault(),
                    None,
                    "{method:?} {drive_s} s, {way} mm F{feed}"
                );
                assert!(
                    bench.axis.in_position(),
                    "{method:?} {drive_s} s, {way} mm F{feed}"
                );
            }
            assert!(
                (bench.table_mm - 135.01).abs() < 2e-4,
                "{method:?}: {}",
                bench.table_mm
            );
        }
    }
}

#[test]
fn more_than_10_volts_is_a_fault_with_precontrol_only() {
    // 10 V are 11 111 mm/min; in 3 ms 0.5555 mm.
    for (feed, fault) in [
        (11_100.0, None),
        (11_120.0, Some(Fault::Gross(GrossFault::Voltage))),
    ] {
        let mut bench = bench(Method::Precontrol, &[]);
        bench.run(feed, 0.1);
        assert_eq!(bench.axis.fault(), fault, "F{feed}");
    }
    let mut lag = bench(Method::Lag, &[]);
    lag.run(12_000.0, 1.0);
    assert_eq!(lag.axis.fault(), None);
    assert_eq!(lag.axis.volts(), 10.0, "the output is limited");
}

#[test]
fn an_axis_that_does_not_move_is_found_above_mp1140() {
    // A lag of 0.6 mm at kv 1 is 600 mm/min, 0.54 V.
    let movement = Some(Fault::Gross(GrossFault::Movement));
    for (threshold, fault) in [
        ("1140.0=0.53", movement),
        ("1140.0=0.55", None),
        ("1140.0=10", None),
    ] {
        let mut bench = bench(Method::Lag, &[threshold]);
        bench.blocked = true;
        bench.table_mm = -0.6;
        bench.stand(0.5);
        assert_eq!(bench.axis.fault(), fault, "{threshold}");
        assert_eq!(
            bench.axis.volts() == 0.0,
            fault.is_some(),
            "a gross fault switches off"
        );
    }
}

#[test]
fn an_axis_that_runs_the_wrong_way_is_found() {
    let mut bench = bench(Method::Lag, &["1140.0=0.5", "1710.0=300"]);
    bench.mm_min_per_volt = -bench.mm_min_per_volt;
    bench.run(1000.0, 1.0);
    assert_eq!(bench.axis.fault(), Some(Fault::Gross(GrossFault::Movement)));
}

#[test]
fn standstill_is_monitored_once_the_window_is_reached() {
    let gross = Some(Fault::Gross(GrossFault::Standstill));
    for method in [Method::Lag, Method::Precontrol] {
        for (deviation, fault) in [(0.199, None), (0.201, gross), (-0.199, None), (-0.201, gross)] {
            let bench = bench(method, &["1110.0=0.2"]);
            assert!(bench.axis.in_position());
            assert_eq!(at_deviation(bench, deviation), fault, "{method:?} {deviation}");
        }
    }
}

#[test]
fn an_overshoot_is_found() {
    let gross = Some(Fault::Gross(GrossFault::Standstill));
    for (overshoot, fault) in [(0.19, None), (0.21, gross)] {
        let mut bench = bench(Method::Lag, &["1110.0=0.2"]);
        bench.run(1000.0, 0.5);
        // The nominal position stands, the axis is on its way; a push takes it over the target.
        bench.stand(0.003);
        assert!(!bench.axis.in_position());
        bench.table_mm = bench.axis.target_mm() + overshoot;
        bench.stand(0.003);
        assert_eq!(bench.axis.fault(), fault, "{overshoot}");
    }
}

#[test]
fn a_start_backwards_is_found() {
    let gross = Some(Fault::Gross(GrossFault::Standstill));
    for (backwards, fault) in [(0.19, None), (0.21, gross)] {
        let mut bench = bench(Method::Lag, &["1110.0=0.2"]);
        bench.run(10.0, 0.006);
        assert_eq!(bench.axis.fault(), None);
        bench.table_mm -= backwards;
        bench.run(10.0, 0.003);
        assert_eq!(bench.axis.fault(), fault, "{backwards}");
    }
    // Once it has gone the right way, its lag may turn round with it.
    let mut turning = bench(Method::Lag, &["1110.0=0.2"]);
    turning.run(2000.0, 0.5);
    turning.run(-2000.0, 0.5);
    assert_eq!(turning.axis.fault(), None);
}

#[test]
fn suppressed_monitoring_finds_nothing() {
    let mut bench = bench(
        Method::Precontrol,
        &["1410.0=0.1", "1420.0=0.2", "1110.0=0.1", "1140.0=0.1"],
    );
    bench.axis.set_monitored(false);
    bench.blocked = true;
    bench.table_mm = -20.0;
    bench.stand(0.5);
    assert_eq!(bench.axis.fault(), None);
    bench.axis.set_monitored(true);
    bench.stand(0.003);
    assert!(bench.axis.fault().is_some());
}

#[test]
fn an_open_loop_is_not_monitored() {
    let mut bench = bench(Method::Lag, &["1710.0=0.1", "1720.0=0.2", "1110.0=0.1"]);
    bench.axis.open();
    bench.table_mm = 5.0;
    bench.stand(0.1);
    assert_eq!((bench.axis.fault(), bench.axis.volts()), (None, 0.0));
    assert_eq!(bench.axis.lag_mm(), -5.0, "the nominal position stays");
}

#[test]
fn the_residual_voltage_goes_after_mp1150() {
    // Clamped: a lag of 1 mm above the limit; MP1150 0.3 s.
    let limits = &["1710.0=0.5", "1150=0.3"];
    let mut bench = bench(Method::Lag, limits);
    bench.blocked = true;
    bench.table_mm = -1.0;
    bench.stand(0.297);
    assert_eq!(bench.axis.fault(), Some(Fault::Positioning));
    assert!(bench.axis.volts() > 0.8, "{}", bench.axis.volts());
    bench.stand(0.009);
    assert_eq!(bench.axis.volts(), 0.0);
    assert_eq!(bench.axis.nominal_mm(), bench.axis.actual_mm());
    assert_eq!(
        bench.axis.fault(),
        Some(Fault::Positioning),
        "CE has not been pressed"
    );
    bench.axis.acknowledge();
    assert_eq!(bench.axis.fault(), None);
    bench.stand(0.1);
    assert_eq!((bench.axis.volts(), bench.axis.fault()), (0.0, None));
}

/// Without residual voltage POSITIONING ERROR leaves the drive 0 V. The actual position becomes the nominal one once, and the
/// position monitoring goes on from there [000:5192-5206] [000:5240-5242]: an axis that its drive needs to stop in may be
/// acknowledged, one that runs farther than MP1720 has a gross positioning error.
#[test]
fn an_axis_that_does_not_stop_at_0_v_is_found() {
    // 10 V of offset are 10 / 9 of rapid traverse; POSITIONING ERROR comes 2 mm beside the place, the gross one 3 mm farther.
    let limits = &["1710.0=2", "1720.0=3", "1410.0=2", "1420.0=3", "1150=0"];
    for method in [Method::Lag, Method::Precontrol] {
        let mut bench = bench(method, limits);
        bench.offset_volts = 10.0;
        let mut found = None;
        for _ in 0..1000 {
            if bench.axis.fault().is_some_and(Fault::opens_loop) {
                break;
            }
            if bench.axis.fault() == Some(Fault::Positioning) {
                found.get_or_insert(bench.table_mm);
                assert_eq!(bench.axis.volts(), 0.0);
            }
            bench.cycle(0.0);
            assert!(bench.table_mm.abs() < 100.0, "{method:?}: nothing stops it");
        }
        assert_eq!(bench.axis.fault(), Some(Fault::Gross(GrossFault::Deviation)));
        // In a cycle of 3 ms it goes 0.56 mm.
        let farther = (bench.table_mm - found.unwrap()).abs();
        assert!((2.4..=4.2).contains(&farther), "{method:?}: {farther}");
    }
    // A drive of 20 ms, which the voltage has left at 6 m/min, stops within 2 mm: CE clears the error, and where the axis
    // stands it is held.
    let mut bench = bench(Method::Lag, limits);
    bench.drive_s = 0.020;
    bench.run(6000.0, 0.5);
    assert_eq!(bench.axis.fault(), Some(Fault::Positioning));
    bench.stand(1.0);
    assert_eq!(bench.axis.fault(), Some(Fault::Positioning));
    bench.axis.acknowledge();
    let stands = bench.table_mm;
    bench.cycle(bench.axis.target_mm());
    bench.stand(0.5);
    assert_eq!(bench.axis.fault(), None);
    assert!((bench.table_mm - stands).abs() < 0.01);
}

#[test]
fn ce_before_switches_the_residual_voltage_off_at_once() {
    let mut bench = bench(Method::Lag, &["1710.0=0.5", "1150=60"]);
    bench.blocked = true;
    bench.table_mm = -1.0;
    bench.stand(0.1);
    assert!(bench.axis.volts() > 0.8);
    bench.axis.acknowledge();
    bench.cycle(bench.axis.target_mm());
    assert_eq!((bench.axis.volts(), bench.axis.lag_mm()), (0.0, 0.0));
}

#[test]
fn a_gross_fault_cannot_be_cleared() {
    let mut bench = bench(Method::Lag, &["1710.0=0.5", "1720.0=1"]);
    bench.blocked = true;
    bench.table_mm = -2.0;
    bench.stand(0.003);
    let fault = bench.axis.fault().unwrap();
    let row = FaultId::from(fault).row();
    assert_eq!(
        (row.message, row.letter),
        (Some(MessageId::GrossPositioningError), "A")
    );
    bench.axis.acknowledge();
    bench.stand(0.003);
    assert_eq!((bench.axis.fault(), bench.axis.volts()), (Some(fault), 0.0));
}

#[test]
fn a_defective_measuring_system_is_found_where_it_is_checked() {
    for (bits, amplitude, edges, fault) in [
        ("31=%000001", true, false, Some(EncoderFault::Amplitude)),
        ("31=%000010", true, false, None),
        ("32=%000001", false, true, Some(EncoderFault::Edges)),
        ("32=%000000", false, true, None),
    ] {
        let mut bench = bench(Method::Lag, &["31=0", "32=0", bits]);
        bench.encoder.amplitude_low = amplitude;
        bench.encoder.edges_too_close = edges;
        bench.stand(0.003);
        assert_eq!(bench.axis.fault(), fault.map(Fault::MeasuringSystem), "{bits}");
    }
}
