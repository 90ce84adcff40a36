//! Whatever a text says, reading it ends, and no value is lost on the way.

use bahn_path::{Axis, ElementSource, LiveData, Step};
use bahn_reader::Reader;
use proptest::prelude::*;

use crate::support::reader_with;

fn word() -> impl Strategy<Value = String> {
    let number = prop_oneof![
        (-200i32..200).prop_map(|n| n.to_string()),
        (-2000i32..2000).prop_map(|n| format!("{}.{}", n / 10, (n % 10).abs())),
    ];
    let letter = prop::sample::select(vec![
        "X", "Y", "Z", "C", "F", "S", "I", "J", "K", "R", "T", "X:P", "G", "M",
    ]);
    prop_oneof![
        4 => (letter, number).prop_map(|(letter, number)| format!("{letter}{number}")),
        3 => prop::sample::select(vec![
            "G0", "G1", "G2", "G3", "G4", "G8", "G10", "G17", "G18", "G19", "G28", "G45", "G46", "G54", "G61", "G62",
            "G60", "G81", "G83", "G84", "G85", "G86", "G87", "G88", "G89", "G91", "G92", "G93", "G95", "M0", "M1", "M6",
            "G12", "G40", "G41", "G42", "G41 X20", "G42 Y30", "X50 Y50", "P70:2", "P71:3", "P8844:3", "P8845:0", "P8857:0.1",
            "P8160:5", "M16", "M30", "M22.20", "M24.10.3", "P1<3.10", "P1=P2.20", "T2", "P100:--",
        ]).prop_map(str::to_owned),
        2 => (0u32..165, -50i32..50).prop_map(|(p, value)| format!("P{p}:{value}")),
        1 => (8800u32..8900, 0i32..70000).prop_map(|(p, value)| format!("P{p}:{value}")),
        1 => "[ -~]{0,6}",
    ]
}

fn program() -> impl Strategy<Value = String> {
    let block = prop::collection::vec(word(), 0..4).prop_map(|words| words.join(" "));
    prop::collection::vec(block, 1..12).prop_map(|blocks| {
        let numbered = blocks.iter().enumerate();
        let lines = numbered.map(|(at, block)| format!("N{} {block}\n", 10 * (at + 1)));
        format!("F100 S100\n{}", lines.collect::<String>())
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn reading_ends_without_a_panic(text in program()) {
        let hole = "P32: 50\nP33: -10\nP34: 2\nP106: 3\nP116: 2\nP126: 4\n";
        let mut reader = reader_with(&text, hole, &[("Z6.900", "G1 Z5\n"), ("Z83.900", "M1\n")]);
        reader.keep_checkpoints();
        reader.allow(4000);
        let mut last = reader.position();
        for _ in 0..20_000 {
            match reader.next() {
                Step::Element(element) => {
                    // The path is whole: each element begins where the one before it ends.
                    prop_assert_eq!(element.start, last);
                    prop_assert!(Axis::ALL.iter().all(|axis| element.end[*axis].is_finite()));
                    prop_assert!(element.length().is_finite());
                    reader.forget_before(element.sequence);
                    last = element.end;
                }
                Step::Barrier(_) => reader.resume(LiveData::default()),
                Step::Starved | Step::End | Step::Error(_) => break,
            }
        }
    }
}
