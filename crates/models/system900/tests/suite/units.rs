//! The unit of lengths, and what its change makes of parameters.

use bahn_system900::{Memory, Name, SpaceError, Status, Unit, ValueError};
use proptest::prelude::*;

use crate::memory::{memory, name};

/// Some parameters with values and statuses.
fn with(lengths: &[(&str, &str, u32)]) -> Memory {
    let mut memory = memory(&[("q110", "$01010058")]);
    for (text, value, status) in lengths {
        memory.set_status(name(text), Status::from_word(*status)).unwrap();
        memory.write(name(text), value.parse().unwrap()).unwrap();
    }
    memory
}

fn shown(memory: &Memory, text: &str) -> String {
    memory.cell(name(text)).unwrap().written()
}

const LENGTH: u32 = 0x10;

/// Only what has the inch bit is converted, by 25.4 mm, and gets the decimals that P11308 says [002:282-290]
/// [002:6324-6355].
#[test]
fn lengths_follow_the_unit() {
    let start = with(&[
        ("q9000", "254", 0x0300_0000 | LENGTH),
        ("q9001", "254", 0x0300_0000),
        ("P12153", "-12.7", 0x0200_0000 | LENGTH),
        ("q9002", "--", 0x0300_0000 | LENGTH),
        ("q9003", "1", 0x0300_0000 | LENGTH),
        ("q9004", "$FF", 0x1000_0000 | LENGTH),
    ]);
    // 1 / 25.4 = 0.03937007..: with four decimals 0.0394, with six 0.039370.
    for (decimals, ten, half, one, cleared) in [
        (1, "10.0000", "-0.500", "0.0394", "$04000010"),
        (2, "10.00000", "-0.5000", "0.03937", "$05000010"),
        (3, "10.000000", "-0.50000", "0.039370", "$06000010"),
    ] {
        let mut memory = start.clone();
        memory.change_unit(Unit::Inch(decimals)).unwrap();
        assert_eq!(Unit::of(&memory), Unit::Inch(decimals));
        assert_eq!(shown(&memory, "P11308"), decimals.to_string());
        let values = ["q9000", "P12153", "q9003"].map(|text| shown(&memory, text));
        assert_eq!(values, [ten, half, one]);
        assert_eq!(shown(&memory, "q9001"), "254.000", "it has no inch bit");
        assert_eq!(shown(&memory, "q9004"), "$FF", "bits are no length");
        assert_eq!(memory.cell(name("q9002")).unwrap().status().to_string(), cleared);
        let inches = memory.clone();
        memory.change_unit(Unit::Inch(decimals)).unwrap();
        assert_eq!(memory, inches, "no change of the unit, no change of lengths");
        memory.change_unit(Unit::Metric).unwrap();
        assert_eq!(shown(&memory, "q9000"), "254.000");
        // 0.0394 * 25.4 = 1.00076.
        assert_eq!(
            shown(&memory, "q9003"),
            if decimals == 1 { "1.001" } else { "1.000" }
        );
        assert_eq!(shown(&memory, "P11308"), "0");
    }
    let mut memory = start;
    memory.change_unit(Unit::Inch(1)).unwrap();
    memory.change_unit(Unit::Inch(3)).unwrap();
    assert_eq!(
        shown(&memory, "q9000"),
        "10.000000",
        "more decimals, the same length"
    );
}

#[test]
fn values_of_the_unit() {
    for (value, unit) in [
        (None, Some(Unit::Metric)),
        (Some(0), Some(Unit::Metric)),
        (Some(1), Some(Unit::Inch(1))),
        (Some(3), Some(Unit::Inch(3))),
        (Some(4), None),
        (Some(-1), None),
    ] {
        assert_eq!(Unit::from_value(value), unit);
    }
    assert_eq!(Unit::of_g(170, Unit::Metric), Some(Unit::Inch(1)));
    assert_eq!(Unit::of_g(170, Unit::Inch(3)), Some(Unit::Inch(3)));
    assert_eq!(Unit::of_g(171, Unit::Inch(3)), Some(Unit::Metric));
    assert_eq!(Unit::of_g(172, Unit::Metric), None);
    // The table of steps stays, and a step is a tenth of it in inches [002:6357-6360].
    assert_eq!((Unit::Metric.step(10.0), Unit::Inch(2).step(10.0)), (10.0, 1.0));
}

/// What would need more than four bytes gives up decimals; what does not go in without any keeps the unit as it is.
#[test]
fn great_lengths() {
    // 2000000.000 mm are 78740.157480.. inches: with six decimals more than 2^31 - 1, with four 787401575.
    let mut memory = with(&[("q9000", "2000000", 0x0300_0000 | LENGTH)]);
    memory.change_unit(Unit::Inch(3)).unwrap();
    assert_eq!(shown(&memory, "q9000"), "78740.1575");
    // 100000000 inches are 2540000000 mm.
    let mut memory = with(&[("q9001", "1", LENGTH), ("q9000", "100000000", LENGTH)]);
    memory.write(name("P11308"), "1".parse().unwrap()).unwrap();
    let before = memory.clone();
    let refused = SpaceError::Value(Name::Q(9000), ValueError::TooGreat("100000000".to_owned()));
    assert_eq!(memory.change_unit(Unit::Metric), Err(refused));
    assert_eq!(memory, before);
}

proptest! {
    /// A metric length comes back as it was with two or three decimals more, and within one unit of its last place with one.
    #[test]
    fn metric_there_and_back(mantissa in -20_000_000i32..20_000_000, decimals in 0u32..=5, more in 1u8..=3) {
        let mut memory = with(&[("q9000", &format!("${mantissa:X}"), decimals << 24 | LENGTH)]);
        let before = memory.cell(Name::Q(9000)).unwrap();
        let status = before.status();
        memory.change_unit(Unit::Inch(more)).unwrap();
        let inches = memory.cell(Name::Q(9000)).unwrap();
        prop_assert_eq!(u32::from(inches.status().decimals()), decimals + u32::from(more));
        let exact = f64::from(mantissa) / 10f64.powi(decimals as i32) / 25.4;
        let half = 0.5 * 10f64.powi(-(decimals as i32 + i32::from(more)));
        prop_assert!((inches.number().unwrap() - exact).abs() <= half * 1.000_001);
        memory.change_unit(Unit::Metric).unwrap();
        let back = memory.cell(Name::Q(9000)).unwrap();
        prop_assert_eq!(back.status(), status);
        let off = (back.bits().unwrap() - mantissa).abs();
        prop_assert!(off <= i32::from(more == 1), "{} and {}", mantissa, off);
        // There once more it is what it was: nothing creeps.
        memory.change_unit(Unit::Inch(more)).unwrap();
        prop_assert_eq!(memory.cell(Name::Q(9000)).unwrap(), inches);
    }

    /// An inch length comes back as it was with one decimal more, and settles after one change with others.
    #[test]
    fn inches_there_and_back(mantissa in -20_000_000i32..20_000_000, decimals in 3u32..=5, more in 1u8..=3) {
        let mut memory = with(&[("q9000", &format!("${mantissa:X}"), decimals << 24 | LENGTH)]);
        memory.write(name("P11308"), more.to_string().parse().unwrap()).unwrap();
        let mut changed = |to| {
            memory.change_unit(to).unwrap();
            memory.cell(Name::Q(9000)).unwrap()
        };
        let metric = changed(Unit::Metric);
        let back = changed(Unit::Inch(more));
        if more == 1 {
            prop_assert_eq!(back.bits(), Some(mantissa));
        }
        prop_assert_eq!(u32::from(back.status().decimals()), decimals);
        if more > 1 {
            prop_assert_eq!(changed(Unit::Metric), metric);
        }
        prop_assert_eq!(changed(Unit::Inch(more)), back);
    }
}
