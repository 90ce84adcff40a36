//! Any text is a program of a System 900: reading it comes to an end, with every fault at its place, and its listing is
//! the same program.

use std::sync::Arc;

use bahn_din::system900::{Program, Word, WordKind, examine, words};
use bahn_text::MemoryFiles;
use proptest::prelude::*;

/// Parts of which lines are made, so that many of them can be read.
const PARTS: &[&str] = &[
    "N10",
    "N20",
    "N",
    "n 030",
    "/",
    "X",
    "X:",
    "X1",
    "Y-1.5",
    "Y3:5",
    "Y3",
    "Z.",
    "H5",
    "Q5:1",
    "G0",
    "G01",
    "G2",
    "G4",
    "G54",
    "G71",
    "G81",
    "G51",
    "G999",
    "G",
    "F100",
    "F",
    "S1000",
    "S2:500",
    "S9:",
    "T2",
    "T:P5",
    "I1",
    "J-1",
    "K",
    "R5",
    "M1",
    "M30",
    "M6",
    "M24.10.5",
    "M22.20",
    "M7.",
    "M234",
    "M",
    "P7950",
    "P7950:1",
    "P8840:$00010302",
    "P100:--",
    "P1:P2",
    "P10500:1",
    "P7960<10.20",
    "P1=P2.10",
    "P1>-5.10",
    "P1<=",
    "P",
    ":",
    "=",
    "<",
    ">",
    "--",
    "-",
    "+",
    ".",
    "$",
    "$FF",
    "{",
    "}",
    "{ text }",
    ";",
    "%",
    "(",
    "\n",
    "\r\n",
    "\r",
    "1",
    "99999999999999999999",
    "\t",
    "\u{a0}",
    "ä",
    "\u{0}",
    "LBL",
];

fn text() -> impl Strategy<Value = String> {
    let part = (0..PARTS.len(), prop::bool::ANY).prop_map(|(part, blank)| {
        let part = PARTS.get(part).copied().unwrap_or_default();
        if blank {
            format!("{part} ")
        } else {
            part.to_owned()
        }
    });
    prop::collection::vec(part, 0..40).prop_map(|parts| parts.concat())
}

/// What a text says, wherever its words stand.
fn said(program: &Program) -> Vec<(bool, Option<u32>, Vec<WordKind>)> {
    let kinds = |words: Vec<Word>| words.into_iter().map(|word| word.kind).collect();
    let blocks = (1..=program.line_count()).map(|line| match program.block(line) {
        Some(Ok(block)) => (block.may_be_skipped, block.number, kinds(block.words)),
        _ => (false, None, kinds(program.words_read(line))),
    });
    blocks.collect()
}

/// All laws of a text.
fn check(bytes: &[u8]) {
    let program = Program::from_bytes("P1.900", bytes);
    let found = program.findings();
    assert_eq!(program.findings(), found, "another end");
    let lines = program.line_count();
    for fault in found.faults.iter().chain(&found.warnings) {
        let length = program.line(fault.span.line).chars().count() as u32;
        assert!((1..=lines.max(1)).contains(&fault.span.line), "{fault:?}");
        assert!(
            (1..=length + 1).contains(&fault.span.column),
            "{fault:?} of {length}"
        );
        assert!(fault.span.length >= 1 && !fault.message.is_empty(), "{fault:?}");
    }
    for line in 1..=lines {
        if let Some(Err(faults)) = program.block(line) {
            assert!(
                faults.iter().all(|fault| found.faults.contains(fault)),
                "{faults:?}"
            );
        }
        let mut column = 1;
        for span in words(program.line(line)) {
            assert!(
                span.column >= column && span.length >= 1,
                "{span:?} in line {line}"
            );
            column = span.column + span.length;
        }
        assert!(column <= program.line(line).chars().count() as u32 + 1);
    }
    let listing = program.encoded(&program.listing());
    let listed = Program::from_bytes("P1.900", &listing);
    assert_eq!(
        listed.encoded(&listed.listing()),
        listing,
        "the listing is not stable"
    );
    assert_eq!(said(&listed), said(&program), "the listing is another program");
}

/// The next number of a fixed row, below a bound.
fn next(state: &mut u64, bound: usize) -> usize {
    // Knuth's MMIX generator; its upper bits are the good ones.
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as usize % bound
}

/// A hundred thousand texts, the same each time.
#[test]
fn many_texts() {
    let mut state = 1;
    for _ in 0..100_000 {
        let mut text = String::new();
        for _ in 0..next(&mut state, 9) {
            text += PARTS[next(&mut state, PARTS.len())];
            text += ["", " "][next(&mut state, 2)];
        }
        check(text.as_bytes());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn texts_of_known_parts(text in text()) {
        check(text.as_bytes());
    }

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
        check(&bytes);
    }

    /// Cycles that call each other come to an end, and each fault is said once.
    #[test]
    fn cycles_of_any_text(main in text(), cycle in text()) {
        let cycle = format!("N1 G71 G72\n{cycle}");
        let beside = MemoryFiles::from([("Z71.900", cycle.as_str()), ("Z81.900", &*main), ("Z6.900", "G71 X")]);
        let program = Arc::new(Program::from_bytes("P1.900", main.as_bytes()));
        let found = examine(&program, &beside);
        let mut places: Vec<_> = found
            .iter()
            .map(|found| (found.program.name().to_string(), found.fault.span, found.fault.message.clone()))
            .collect();
        let all = places.len();
        places.sort();
        places.dedup();
        prop_assert_eq!(places.len(), all);
    }
}
