//! From the encoder to the position of the table [000:3184-3330] [000:3632-3929].

use crate::common::{Bench, settings};
use bahn_parameters::ControlModel::{Tnc407, Tnc415b};
use bahn_servo::{Axis, DistanceCode, Encoder, EncoderFault, Fault};

fn axis(assignments: &[&str]) -> Axis {
    let mut axis = Axis::new(settings(Tnc415b, assignments), Tnc415b.timing());
    axis.measure(Encoder::default());
    axis
}

fn at(count: i64, mark: Option<i64>) -> Encoder {
    Encoder {
        count,
        mark,
        ..Encoder::default()
    }
}

#[test]
fn a_signal_period_is_as_long_as_mp330_says() {
    // 10 mm pitch, 2500 lines: 4 µm [000:3202]. A turn of the screw are 2500 periods.
    for (period, periods, way) in [
        ("330.0=4", 2500, 10.0),
        ("330.0=20", 50, 1.0),
        ("330.0=100", 7, 0.7),
    ] {
        let mut axis = axis(&[period]);
        axis.measure(at(periods * Encoder::STEPS, None));
        assert!((axis.actual_mm() - way).abs() < 1e-12, "{period}");
    }
}

/// Square-wave inputs, X5 and X6 of a TNC 407, X6 of a TNC 415 [000:1503-1505], are evaluated fourfold [000:3214]: of a
/// signal period of 4 µm the control sees whole steps of 1 µm, where a sine input sees each 4/1024 µm.
#[test]
fn square_wave_inputs_are_evaluated_fourfold() {
    const STEP: i64 = Encoder::STEPS / 4;
    for (model, input, square) in [
        (Tnc407, "110.0=3", false),
        (Tnc407, "110.0=4", true),
        (Tnc407, "110.0=5", true),
        (Tnc415b, "110.0=4", false),
        (Tnc415b, "110.0=5", true),
    ] {
        let mut axis = Axis::new(settings(model, &["330.0=4", input]), model.timing());
        axis.measure(Encoder::default());
        for count in [-STEP - 1, -1, 1, STEP - 1, STEP, 1000 * STEP + 1] {
            axis.measure(at(count, None));
            let seen = if square {
                count.div_euclid(STEP) * STEP
            } else {
                count
            };
            let way = seen as f64 * 0.004 / 1024.0;
            assert!((axis.actual_mm() - way).abs() < 1e-12, "{model} {input}: {count}");
        }
    }
}

#[test]
fn counts_stay_exact_far_from_the_datum() {
    let mut axis = axis(&["330.0=20"]);
    // 90 m away one step is still one step.
    let far = 90_000 * 51_200;
    axis.set_datum(far, 0.0);
    axis.measure(at(far + 1, None));
    assert_eq!(axis.actual_mm(), 0.02 / 1024.0);
}

#[test]
fn the_play_is_taken_off_in_positive_direction() {
    // The encoder is 0.01 mm ahead of the table [000:3646-3654].
    let mut bench = Bench::new(Tnc415b, &["710.0=0.01", "1810.0=5", "1080.0=0"]);
    bench.run(-600.0, 0.3);
    let start = bench.axis.target_mm();
    bench.stand(1.0);
    let encoder = bench.table_mm;
    bench.run(600.0, 0.3);
    bench.stand(1.0);
    // 3 mm of table are 3.01 mm of encoder.
    assert!((bench.axis.actual_mm() - (start + 3.0)).abs() < 1e-4);
    assert!(
        (bench.table_mm - encoder - 3.01).abs() < 1e-4,
        "{}",
        bench.table_mm - encoder
    );
    bench.run(-600.0, 0.3);
    bench.stand(1.0);
    assert!((bench.table_mm - encoder).abs() < 1e-4, "and back again");
}

#[test]
fn a_table_that_travels_too_far_is_driven_less_far() {
    // MP720 = 0.5 mm/m: for 100 mm the encoder counts 100/1.0005 = 99.95 mm.
    let mut linear = axis(&["720.0=0.5"]);
    linear.measure(at((99.950_025 * 51_200.0) as i64, None));
    assert!((linear.actual_mm() - 100.0).abs() < 1e-4);
    // Not where the tables are chosen.
    let mut table = axis(&["720.0=0.5", "730=%00001"]);
    table.measure(at(51_200, None));
    assert_eq!(table.actual_mm(), 1.0);
    table.set_error(0.02);
    table.measure(at(51_200, None));
    assert_eq!(table.actual_mm(), 1.02);
}

#[test]
fn lag_tracking_moves_the_machine_but_not_the_display() {
    // 20 µm in steps of 0.5 µm: 40 PLC cycles of 20 ms [000:3902-3929].
    let mut bench = Bench::new(Tnc415b, &["1810.0=5", "1080.0=0"]);
    for cycle in 1..=60 {
        bench.axis.track(0.020, 0.000_5);
        bench.stand(0.021);
        if cycle == 20 {
            assert!((bench.table_mm - 0.010).abs() < 5e-4, "{}", bench.table_mm);
        }
    }
    assert!((bench.table_mm - 0.020).abs() < 1e-4);
    assert!(bench.axis.actual_mm().abs() < 1e-4);
}

#[test]
fn one_mark_is_the_scale_datum() {
    let mut axis = axis(&["1350.0=1"]);
    assert_eq!(axis.take_mark(), None);
    axis.measure(at(2000, Some(1500)));
    let mark = axis.take_mark().unwrap();
    assert_eq!((mark.count, mark.scale_mm), (1500, Some(0.0)));
    assert_eq!(axis.take_mark(), None);
    // The machine datum is 30 mm from the scale datum: the mark is at -30 mm.
    axis.set_datum(mark.count, 0.0 - 30.0);
    assert_eq!(axis.actual_mm(), -30.0 + 500.0 * 0.02 / 1024.0);
}

#[test]
fn two_distance_coded_marks_give_the_position() {
    let code = DistanceCode {
        interval: 1000,
        period_steps: 1024,
    };
    for kind in ["1350.0=0", "1350.0=3"] {
        for (counting, sign) in [("210=%00000", 1.0), ("210=%00001", -1.0)] {
            let mut axis = axis(&[kind, counting, "330.0=20"]);
            // Power-on 3 mm before mark 13; marks 13 and 14 are crossed.
            let begin = code.mark(13) * 1024 - 153_600;
            axis.measure(at(153_700, Some(153_600)));
            assert_eq!(axis.take_mark().unwrap().scale_mm, None, "one mark is not enough");
            let second = code.mark(14) * 1024 - begin;
            axis.measure(at(second, Some(second)));
            // Mark 14 is the fixed one after 7 intervals of 20 mm.
            assert_eq!(
                axis.take_mark().unwrap().scale_mm,
                Some(sign * 140.0),
                "{kind} {counting}"
            );
        }
    }
}

#[test]
fn external_interpolation_is_taken_out_of_the_code() {
    // 20 µm grating, 5-fold EXE: signal period 4 µm; 501 gratings are 2505 signal periods.
    let settings = settings(Tnc407, &["1350.0=3", "330.0=4", "340.0=5"]);
    let mut axis = Axis::new(settings, Tnc407.timing());
    axis.measure(at(0, Some(0)));
    axis.measure(at(2505 * 1024, Some(2505 * 1024)));
    let scale = axis.take_mark().unwrap().scale_mm.unwrap();
    assert!((scale - 501.0 * 0.02).abs() < 1e-9, "{scale}");
}

#[test]
fn marks_that_contradict_the_position_are_found() {
    let found = |check: &str, third: i64| {
        let mut axis = axis(&["1350.0=3", "330.0=20", check]);
        axis.measure(at(0, Some(0)));
        axis.measure(at(501 * 1024, Some(501 * 1024)));
        let mark = axis.take_mark().unwrap();
        axis.set_datum(mark.count, mark.scale_mm.unwrap());
        axis.measure(at(third * 1024, Some(third * 1024)));
        axis.fault()
    };
    let fault = Some(Fault::MeasuringSystem(EncoderFault::Position));
    assert_eq!(found("30=%00001", 1000), None);
    assert_eq!(found("30=%00001", 1001), fault, "a period was lost");
    assert_eq!(found("30=%00001", 501), None, "the same mark again");
    assert_eq!(found("30=%00001", 1502), fault, "a mark was lost");
    assert_eq!(found("30=%00000", 1001), None);
}
