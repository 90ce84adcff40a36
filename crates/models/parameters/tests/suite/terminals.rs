//! The terminals against the tables of the manuals.

use std::collections::BTreeSet;

use bahn_parameters::ControlModel::{self, Tnc151b, Tnc151q, Tnc155fr, Tnc155w, Tnc407, Tnc415b};
use bahn_parameters::terminals::{Board, Fitted, TerminalKind, terminals};

fn fitted(boards: &[(&str, bool)]) -> Vec<Fitted> {
    let one = |(id, analogue): &(&str, bool)| Board::named(id).unwrap().with_analogue(*analogue);
    boards.iter().map(one).collect()
}

/// The operand at a terminal.
fn at(model: ControlModel, fitted: &[Fitted], terminal: &str) -> Option<String> {
    let found = terminals(model, fitted).find(|one| one.to_string() == terminal);
    let found = found.unwrap_or_else(|| panic!("{model} has no {terminal}"));
    found.operand.map(|operand| operand.to_string())
}

/// Inputs, outputs, voltages and thermistors of the PLC; I3 acknowledges "control is ready".
fn totals(model: ControlModel, fitted: &[Fitted]) -> [usize; 4] {
    let all: BTreeSet<(char, u16)> = terminals(model, fitted)
        .filter(|terminal| terminal.kind != TerminalKind::Handwheel)
        .filter_map(|terminal| terminal.operand)
        .map(|operand| (operand.letter, operand.number))
        .filter(|operand| *operand != ('I', 3))
        .collect();
    let count = |wanted: char, words: std::ops::RangeInclusive<u16>| {
        let is = |(letter, number): &&(char, u16)| *letter == wanted && words.contains(number);
        all.iter().filter(is).count()
    };
    let volts = count('W', 464..=470) + count('W', 496..=502);
    let thermistors = count('W', 472..=478) + count('W', 504..=510);
    [count('I', 0..=999), count('O', 0..=999), volts, thermistors]
}

/// The table of configurations [000:2002-2016].
#[test]
fn the_totals_are_those_of_the_table() {
    let (on, off) = (true, false);
    for board in ["PL410", "PL410B"] {
        for (boards, expected) in [
            (vec![(board, off)], [120, 62, 0, 0]),
            (vec![(board, on)], [112, 60, 4, 4]),
            (vec![(board, off), (board, off)], [184, 93, 0, 0]),
            (vec![(board, on), (board, off)], [176, 91, 4, 4]),
            (vec![(board, off), (board, on)], [176, 91, 4, 4]),
            (vec![(board, on), (board, on)], [168, 89, 8, 8]),
        ] {
            assert_eq!(totals(Tnc415b, &fitted(&boards)), expected, "{boards:?}");
        }
    }
    for (boards, expected) in [
        (vec![], [56, 31, 0, 0]),
        (vec![("PL400", off)], [119, 62, 0, 0]),
        (vec![("PL400", off), ("PL400", off)], [182, 93, 0, 0]),
        (vec![("PL400", off), ("PA110", on)], [119, 62, 4, 4]),
        (vec![("PL410", off), ("PA110", on)], [120, 62, 4, 4]),
        (vec![("PL410", on), ("PA110", on)], [112, 60, 8, 8]),
        (vec![("PA110", on)], [56, 31, 4, 4]),
    ] {
        assert_eq!(totals(Tnc407, &fitted(&boards)), expected, "{boards:?}");
    }
}

/// 63 inputs and 31 outputs of a board, doubled by a second one [001:152-165]; I3 is an input like the others here.
#[test]
fn boards_of_the_tnc_151() {
    let counted = |boards: &[(&str, bool)]| {
        let [inputs, outputs, ..] = totals(Tnc151q, &fitted(boards));
        [inputs + 1, outputs]
    };
    for board in ["PL100B", "PL110B"] {
        assert_eq!(counted(&[(board, false)]), [63, 31], "{board}");
        assert_eq!(counted(&[(board, false), (board, false)]), [126, 62], "{board}");
    }
    let two = fitted(&[("PL110B", false), ("PL110B", false)]);
    let bipolar: Vec<String> = terminals(Tnc155w, &two)
        .filter(|terminal| terminal.kind == TerminalKind::Bipolar)
        .filter_map(|terminal| Some(terminal.operand?.to_string()))
        .collect();
    // A25 to A30 and A57 to A62 [001:327].
    let expected: Vec<String> = (25..=30)
        .chain(57..=62)
        .map(|number| format!("O{number}"))
        .collect();
    assert_eq!(bipolar, expected);
}

/// Rows of the lists of manual 001: terminal of version B, of version Q, operand.
#[test]
fn the_lists_of_the_tnc_151() {
    let one = fitted(&[("PL100B", false)]);
    for (b, q, operand) in [
        ("J5/9", "J4/12", "I0"),
        ("J5/12", "J4/9", "I3"),
        ("J6/1", "J4/8", "I4"),
        ("J6/4", "J4/5", "I7"),
        ("J5/8", "J4/4", "I8"),
        ("J6/5", "J4/3", "I9"),
        ("J6/6", "J4/2", "I10"),
        ("J6/7", "J5/12", "I11"),
        ("J6/12", "J5/7", "I16"),
        ("J5/7", "J5/6", "I17"),
        ("J5/6", "J5/5", "I18"),
        ("J5/5", "J5/4", "I19"),
        ("J5/3", "J5/2", "I21"),
        ("J5/2", "J5/1", "I22"),
        ("J5/1", "J6/12", "I23"),
        ("J1/1", "J1/1", "O0"),
        ("J1/7", "J1/7", "O6"),
        ("J2/2", "J1/8", "O7"),
        ("J2/5", "J1/11", "O10"),
        ("J2/6", "J2/1", "O11"),
        ("J2/12", "J2/7", "O17"),
        ("J3/1", "J2/8", "O18"),
        ("J3/4", "J2/11", "O21"),
        ("J3/5", "J3/1", "O22"),
    ] {
        assert_eq!(at(Tnc151b, &[], b).as_deref(), Some(operand), "B {b}");
        assert_eq!(at(Tnc155fr, &[], b).as_deref(), Some(operand), "F {b}");
        assert_eq!(
            at(Tnc151q, &one, &format!("PL1 {q}")).as_deref(),
            Some(operand),
            "Q {q}"
        );
    }
    // Without an operand: EMERGENCY STOP [001:903], nominal values [001:1091-1094].
    assert_eq!(at(Tnc151b, &[], "J1/8"), None);
    assert_eq!(at(Tnc151b, &[], "J4/9"), None);
    assert_eq!(at(Tnc151q, &one, "PL1 J3/10"), None);
    let relays = terminals(Tnc151b, &[]).filter(|one| one.operand.is_some_and(|own| own.letter == 'O'));
    assert!(relays.into_iter().all(|one| one.kind == TerminalKind::Relay));
}

/// Rows of the tables of chapter 3: connector and pin, first board, second board [000:2085-2536].
#[test]
fn the_tables_of_the_tnc_415() {
    for (terminal, operand) in [
        ("X42/1", "I0"),
        ("X42/4", "I3"),
        ("X42/32", "I31"),
        ("X41/1", "O0"),
        ("X41/31", "O30"),
        ("X46/1", "I128"),
        ("X46/25", "I152"),
        ("X46/26", "O0"),
        ("X46/33", "O7"),
    ] {
        assert_eq!(at(Tnc415b, &[], terminal).as_deref(), Some(operand), "{terminal}");
    }
    for (board, rows) in [
        (
            "PL400",
            [
                ("X1/1", "O32", "O64"),
                ("X3/9", "O62", "O94"),
                ("X4/1", "I126", "I254"),
                ("X4/2", "I74", "I202"),
                ("X4/12", "I64", "I192"),
                ("X5/1", "I86", "I214"),
                ("X8/12", "I111", "I239"),
                ("X9/4", "I125", "I253"),
                ("X9/6", "I123", "I251"),
            ],
        ),
        (
            "PL410",
            [
                ("X3/1", "I64", "I192"),
                ("X4/16", "I95", "I223"),
                ("X5/1", "I96", "I224"),
                ("X6/9", "I120", "I248"),
                ("X6/16", "I127", "I255"),
                ("X7/1", "O32", "O64"),
                ("X7/16", "O47", "O79"),
                ("X8/1", "O48", "O80"),
                ("X8/15", "O62", "O94"),
            ],
        ),
    ] {
        let two = fitted(&[(board, false), (board, false)]);
        for (terminal, first, second) in rows {
            assert_eq!(
                at(Tnc415b, &two, &format!("PL1 {terminal}")).as_deref(),
                Some(first)
            );
            assert_eq!(
                at(Tnc415b, &two, &format!("PL2 {terminal}")).as_deref(),
                Some(second)
            );
        }
    }
    // Voltage input 0 and thermistor 3 of each extension [000:8472-8479].
    let analogue = fitted(&[("PL410", true), ("PA110", true)]);
    for (terminal, word) in [
        ("PL1 X15/1", "W496"),
        ("PL1 X22/2", "W510"),
        ("PL2 X2/1", "W464"),
        ("PL2 X10/2", "W478"),
    ] {
        assert_eq!(
            at(Tnc415b, &analogue, terminal).as_deref(),
            Some(word),
            "{terminal}"
        );
    }
}

/// EMERGENCY STOP leaves O24-O30 [000:2166-2174] and O56-O62 of a PL 400 [000:2310-2342] their voltage.
#[test]
fn outputs_fall_with_their_supply() {
    let one = fitted(&[("PL400", false)]);
    let kept: BTreeSet<u16> = terminals(Tnc415b, &one)
        .filter(|terminal| !terminal.switched && terminal.kind == TerminalKind::Digital)
        .filter_map(|terminal| terminal.operand)
        .filter(|operand| operand.letter == 'O')
        .map(|operand| operand.number)
        .collect();
    assert_eq!(kept, (24..=30).chain(56..=62).collect());
}

/// No terminal has two operands, and what PLC programs may name is what terminals have.
#[test]
fn each_terminal_is_one_operand_and_no_operand_is_without() {
    for model in ControlModel::ALL {
        let boards = Board::all_of(model, [false; 2]);
        let all: Vec<_> = terminals(model, &boards).collect();
        let pins: BTreeSet<String> = all
            .iter()
            .filter(|one| one.pin.is_some())
            .map(ToString::to_string)
            .collect();
        assert_eq!(
            pins.len(),
            all.iter().filter(|one| one.pin.is_some()).count(),
            "{model}"
        );
        for (letter, ranges) in [('I', model.limits().inputs), ('O', model.limits().outputs)] {
            let named: BTreeSet<u16> = ranges.iter().flat_map(|(first, last)| *first..=*last).collect();
            let there = all
                .iter()
                .filter_map(|one| one.operand)
                .filter(|one| one.letter == letter);
            assert_eq!(named, there.map(|one| one.number).collect(), "{model} {letter}");
        }
    }
}

/// [000:2029].
#[test]
fn a_pl_410_b_stands_beside_no_pl_410() {
    let excludes = |a: &str, b: &str| Board::named(a).unwrap().excludes(Board::named(b).unwrap());
    assert!(excludes("PL410B", "PL410") && excludes("PL410", "PL410B"));
    assert!(excludes("PA110", "PL410B") && !excludes("PL410", "PA110") && !excludes("PL410B", "PL410B"));
}
