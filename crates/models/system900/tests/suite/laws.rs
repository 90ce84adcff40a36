//! What holds for any data file.

use std::time::{Duration, Instant};

use bahn_system900::{Change, DataFile, Memory, Name, check, differences};
use proptest::prelude::*;

const BLOCKS: &str =
    "q2: 2\nq102: 10000\nq103: 5000\nq202: 20000\nq203: 2000\nq110: $01010058\nq210: $00020058\nq10: 99\n";

/// Names that lead somewhere.
fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        (1000u32..8400).prop_map(|q| format!("q{q}")),
        (0u32..5000).prop_map(|p| format!("P{p}")),
        (7000u32..10_000, 1u8..=2).prop_map(|(p, channel)| format!("{channel}:P{p}")),
        (12_000u32..12_200, 1u8..=2).prop_map(|(p, channel)| format!("K{channel}:P{p}")),
    ]
}

fn value() -> impl Strategy<Value = String> {
    prop_oneof![
        Just("--".to_owned()),
        any::<u32>().prop_map(|bits| format!("${bits:X}")),
        any::<i32>().prop_map(|number| number.to_string()),
        (any::<i16>(), 0u16..1000).prop_map(|(whole, thousandths)| format!("{whole}.{thousandths:03}")),
    ]
}

/// What a memory holds, with what each parameter shows.
fn held(memory: &Memory) -> Vec<(Name, String, String)> {
    let places = memory.loaded();
    let of = |place| {
        (
            memory.name_of(place),
            memory.at(place).written(),
            memory.at(place).status().to_string(),
        )
    };
    places.map(of).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any bytes are a data file with faults, and a place in it has each of them.
    #[test]
    fn any_bytes_are_a_file(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let file = DataFile::read(&bytes);
        let lines = file.text().lines().count().max(1);
        for fault in check(&file).faults {
            prop_assert!((1..=lines).contains(&(fault.span.line as usize)), "{fault}");
        }
    }

    /// Lines that are nearly right as well.
    #[test]
    fn any_line_is_read(lines in proptest::collection::vec("[qQpPK0-9:;{} .$\\-]{0,24}", 0..20)) {
        let file = DataFile::read(lines.join("\n").as_bytes());
        prop_assert!(file.entries() <= lines.len());
        check(&file);
    }

    /// A file that is written anew keeps values and order, and changes nothing else.
    #[test]
    fn what_is_written_is_read_again(entries in proptest::collection::vec((name(), value()), 0..30), given in (name(), value())) {
        let lines: String = entries.iter().map(|(name, value)| format!("{name}: {value}\n")).collect();
        let file = DataFile::read(format!("{BLOCKS}{lines}").as_bytes());
        // Two lines for one number may raise its decimals until the second value does not go into four bytes.
        prop_assume!(file.is_readable());
        let again = DataFile::read(&file.bytes());
        prop_assert_eq!(held(again.memory()), held(file.memory()));
        prop_assert_eq!(again.text(), file.text());

        let (name, value) = given;
        let name: Name = name.parse().unwrap();
        let change = Change { name, value: Some(value.clone()), status: None };
        let Ok(changed) = file.changed(&[change]) else { return Ok(()) };
        let mut memory = file.memory().clone();
        memory.write(name, value.parse().unwrap()).unwrap();
        let number = |memory: &Memory| memory.cell(name).unwrap().number();
        prop_assert_eq!(number(changed.memory()), number(&memory));
        let place = memory.place(name).unwrap();
        let others = |memory: &Memory| -> Vec<_> {
            held(memory).into_iter().filter(|(other, ..)| *other != memory.name_of(place)).collect()
        };
        prop_assert_eq!(others(changed.memory()), others(file.memory()));
        let kept = file.text().lines().count();
        prop_assert!((kept..=kept + 1).contains(&changed.text().lines().count()));
    }

    /// A memory differs from itself in nothing, and from another one in what was written.
    #[test]
    fn differences_are_what_was_written(given in (name(), 1i32..1000)) {
        let file = DataFile::read(BLOCKS.as_bytes());
        prop_assert_eq!(differences(file.memory(), file.memory()), []);
        let mut memory = file.memory().clone();
        let name: Name = given.0.parse().unwrap();
        memory.write(name, given.1.to_string().parse().unwrap()).unwrap();
        let found = differences(file.memory(), &memory);
        prop_assert_eq!(found.iter().map(|found| (found.a, found.b)).collect::<Vec<_>>(), [(None, Some(f64::from(given.1)))]);
    }
}

/// A file of 30000 lines is checked in 100 ms; here without optimisation, and beside other tests.
#[test]
fn a_long_file_is_checked_soon() {
    let lines: String = (2000..32_000)
        .map(|q| format!("q{q}: {}.5 $31000001 ; number {q}\n", q % 977))
        .collect();
    let text = format!("q3: 40000\n{lines}");
    let begin = Instant::now();
    let checked = check(&DataFile::read(text.as_bytes()));
    let took = begin.elapsed();
    assert_eq!(checked.errors().count(), 0, "{:?}", checked.faults);
    assert!(took < Duration::from_secs(2), "{took:?}");
}
