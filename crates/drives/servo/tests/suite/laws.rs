//! Laws of the position loop.

use crate::common::Bench;
use bahn_parameters::ControlModel::{Tnc407, Tnc415b};
use bahn_servo::Method;
use proptest::prelude::*;

/// Feeds of 50 cycles each, mm/min.
fn feeds() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-8000f64..8000.0, 1..6)
}

fn run(bench: &mut Bench, feeds: &[f64]) -> Vec<f64> {
    let mut volts = Vec::new();
    for feed in feeds {
        let start = bench.axis.target_mm();
        for cycle in 1..=50 {
            let nominal = start + feed * f64::from(bench.timing.contour_us()) / 60e6 * f64::from(cycle);
            bench.cycle_with(nominal, |axis, _| volts.push(axis.volts()));
        }
    }
    volts
}

const FREE: &[&str] = &[
    "1010.0=10000",
    "1720.0=300",
    "1710.0=300",
    "1420.0=30",
    "1410.0=30",
    "1110.0=30",
];

fn bench(precontrol: bool, assignments: &[&str]) -> Bench {
    let assignments = [FREE, assignments].concat();
    if precontrol {
        Bench::with_precontrol(Tnc415b, &assignments)
    } else {
        Bench::new(Tnc415b, &assignments)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The other polarity gives the mirrored voltages, on a drive that is wired the other way.
    #[test]
    fn polarity_mirrors_the_voltage(feeds in feeds(), precontrol: bool) {
        let plus = run(&mut bench(precontrol, &["1040=%00000"]), &feeds);
        let minus = run(&mut bench(precontrol, &["1040=%00001"]), &feeds);
        let mirrored: Vec<f64> = minus.iter().map(|volts| -volts).collect();
        prop_assert_eq!(plus, mirrored);
    }

    /// The other counting direction gives the same voltages, on an encoder that counts the other way.
    #[test]
    fn counting_direction_changes_nothing_outside(feeds in feeds(), precontrol: bool) {
        let plus = run(&mut bench(precontrol, &["210=%00000"]), &feeds);
        let minus = run(&mut bench(precontrol, &["210=%00001"]), &feeds);
        prop_assert_eq!(plus, minus);
    }

    /// The mirrored path gives the mirrored voltages.
    #[test]
    fn the_loop_is_symmetrical(feeds in feeds(), precontrol: bool) {
        let there = run(&mut bench(precontrol, &[]), &feeds);
        let mirrored: Vec<f64> = feeds.iter().map(|feed| -feed).collect();
        let back = run(&mut bench(precontrol, &[]), &mirrored);
        for (there, back) in there.iter().zip(back) {
            // Half a step of the converter rounds away from 0 on both sides; half a step of the encoder too.
            prop_assert!((there + back).abs() < 1e-3, "{} {}", there, back);
        }
    }

    /// Following error equals the formula within 1 %, with and without kink.
    #[test]
    fn the_lag_is_that_of_the_formula(
        feed in 1000f64..9000.0, kv in 0.5f64..8.0, factor in 0.2f64..1.0, percent in 5f64..100.0,
    ) {
        let parameters = [
            format!("1810.0={kv:.3}"), format!("1820.0={factor:.3}"), format!("1830.0={percent:.3}"),
        ];
        let parameters: Vec<&str> = parameters.iter().map(String::as_str).collect();
        let mut bench = bench(false, &parameters);
        bench.run(feed, 6.0);
        let lag = &bench.axis.settings().lag;
        let kink = lag.kink_percent / 100.0 * 10_000.0;
        let formula = (feed.min(kink) + (feed - kink).max(0.0) / lag.kink_factor) / (lag.kv * 1000.0);
        prop_assert!((bench.axis.lag_mm() / formula - 1.0).abs() < 0.01, "{} {formula}", bench.axis.lag_mm());
    }

    /// Where the count begins is of no importance: the same bits.
    #[test]
    fn a_datum_changes_no_voltage(feeds in feeds(), periods in -1_000_000i64..1_000_000) {
        let here = run(&mut bench(false, &["330.0=16"]), &feeds);
        let mut other = bench(false, &["330.0=16"]);
        // Whole periods of 1/64 mm are exact in binary.
        let datum = periods as f64 / 64.0;
        other.axis.set_datum(0, datum);
        let mut volts = Vec::new();
        let mut target = 0.0;
        for feed in &feeds {
            let start = target;
            for cycle in 1..=50 {
                target = start + feed * 0.003 / 60.0 * f64::from(cycle);
                other.cycle_with(target + datum, |axis, _| volts.push(axis.volts()));
            }
        }
        for (here, there) in here.iter().zip(volts) {
            prop_assert!((here - there).abs() < 2.0 * other.timing.resolution_volts());
        }
    }

    /// Whatever comes in, a multiple of the converter's step within 10 V goes out.
    #[test]
    fn the_output_is_what_the_converter_can_give(
        counts in prop::collection::vec(any::<i64>(), 1..20), nominal in prop::collection::vec(any::<f64>(), 20),
        method: bool, tnc407: bool,
    ) {
        let model = if tnc407 { Tnc407 } else { Tnc415b };
        let mut bench = Bench::new(model, FREE);
        bench.axis.set_monitored(false);
        bench.axis.set_method(if method { Method::Lag } else { Method::Precontrol });
        let resolution = model.timing().resolution_volts();
        for (count, nominal) in counts.iter().zip(nominal) {
            bench.encoder.count = *count;
            bench.encoder.mark = Some(count.wrapping_mul(3));
            bench.axis.command(nominal);
            bench.axis.measure(bench.encoder);
            let volts = bench.axis.step();
            prop_assert!(volts.abs() <= 10.0);
            prop_assert_eq!(volts / resolution, (volts / resolution).round());
        }
    }
}

#[test]
fn the_same_inputs_give_the_same_bits() {
    let feeds = [3000.0, -100.0, 7777.7, 0.0, -9000.0];
    let bits =
        |mut bench: Bench| -> Vec<u64> { run(&mut bench, &feeds).into_iter().map(f64::to_bits).collect() };
    assert_eq!(bits(bench(true, &["1530=0.1"])), bits(bench(true, &["1530=0.1"])));
}
