//! The table: complete, unambiguous, honest.

use std::collections::BTreeSet;

use bahn_system900::{Effect, Explanation, Name, Needs, row, rows};

fn base(name: &str) -> Option<&'static str> {
    row(name.parse().unwrap()).map(|row| row.number)
}

/// Every line of the table can be read: 1417 of them, with distinct numbers.
#[test]
fn every_line_is_a_row() {
    let lines = include_str!("../../data/parameters.tsv").lines().skip(1);
    let named: BTreeSet<&str> = rows().iter().map(|row| row.number).collect();
    assert_eq!((lines.count(), rows().len(), named.len()), (1417, 1417, 1417));
    let kinds: BTreeSet<&str> = rows().iter().map(|row| row.kind).collect();
    let known = ["bits", "bytes", "pointer", "scalar", "status", "trigger", "type"];
    assert!(kinds.iter().all(|kind| known.contains(kind)), "{kinds:?}");
}

/// What acts names its test, what does not says why.
#[test]
fn effects_are_founded() {
    for row in rows() {
        let acts = matches!(row.effect, Effect::Acts | Effect::Partly);
        assert_eq!(!row.proof.is_empty(), acts, "{}", row.number);
        assert_eq!(
            row.reason.is_empty(),
            row.effect == Effect::Acts,
            "{}",
            row.number
        );
        assert!(row.source.starts_with("[002:"), "{}", row.number);
    }
}

#[test]
fn a_number_has_the_row_that_explains_it() {
    for (name, number) in [
        ("P12160", "P12160"),
        ("P12360", "P12160"),
        ("2:P12360", "P12160"),
        ("P18399", "P12199"),
        ("q2360", "P12160"),
        ("q8399", "P12199"),
        ("q1300", "P11300"),
        ("q115", "q110-q141"),
        ("q215", "q110-q141"),
        ("q802", "q102"),
        ("q913", "q903"),
        ("q65", "q60-q68"),
        ("3:P8050", "P8050"),
        ("P8055", "P8050-P8099"),
        ("P8070", "P8065-P8099"),
        ("P7100", "P7096-P7127"),
    ] {
        assert_eq!(base(name), Some(number), "{name}");
    }
    for without in ["P500", "P20000", "q10000", "q9000", "P10500", "q54", "P99999"] {
        assert_eq!(base(without), None, "{without}");
    }
}

/// Changes of q0 to q9 need a reset with `Clear parameter`, of q100 to q899 a restart [002:373-374] [002:662], of
/// M functions the change from HAND to AUTO [002:2088-2089] [002:5519-5521].
#[test]
fn what_a_change_needs() {
    for (name, needs) in [
        ("q0", Needs::Reset),
        ("q9", Needs::Reset),
        ("q10", Needs::Nothing),
        ("q102", Needs::Restart),
        ("q899", Needs::Restart),
        ("q903", Needs::Nothing),
        ("P8250", Needs::Mode),
        ("P8499", Needs::Mode),
        ("P11099", Needs::Mode),
        ("P12004", Needs::Nothing),
    ] {
        let found = row(name.parse().unwrap()).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(found.needs, needs, "{name}");
    }
}

#[test]
fn explanations() {
    let of = |name: &str| Explanation::of(name.parse::<Name>().unwrap());
    let kv = of("P12220").unwrap();
    assert_eq!((kv.base, kv.title, kv.unit), ("P12020", "Kv factor", "1/s"));
    assert_eq!((kv.default, kv.default_number), ("16", Some(16.0)));
    assert_eq!(kv.name.to_string(), "P12220");
    // $030201 = 3 * 65536 + 2 * 256 + 1.
    assert_eq!(of("q152").unwrap().default_number, Some(197_121.0));
    assert_eq!(
        of("q102").unwrap().default_number,
        None,
        "an example is no default"
    );
    assert_eq!(
        of("P12130").unwrap().plc,
        ["REPO+1", "REPO-1", "REPOF1", "REPOS1"]
    );
    assert_eq!(of("q0").unwrap().effect, "none");
    assert_eq!(of("q70").unwrap().effect, "stored");
    assert!(of("P500").is_none());
}
