//! M functions, speeds, tools and cycles.

use bahn_path::{At, Barrier, Function, Synchronisation};
use bahn_reader::Message;

use crate::support::{ends, fault_with, functions, number, ran_with, reader_with, run};

/// The example of the manual [002:5503-5517]: M4 flying, M5 after with stop, M6 before with stop, M7 branch.
const DEFINED: &str = "P11051: $10050601\n";

#[test]
fn m_functions_go_out_as_they_are_defined() {
    let ran = ran_with("F100 X1 M4\nX2 M5\nN30 X3 M7.30\n", DEFINED);
    let of = |index: usize| {
        let function = &ran.elements[index].functions()[0];
        (function.function.clone(), function.at, function.synchronisation)
    };
    assert_eq!(of(0), (Function::M(4), At::Start, Synchronisation::Mos));
    assert_eq!(of(1), (Function::M(5), At::End, Synchronisation::MnsSns));
    assert_eq!(of(2).0, Function::Branch { m: 7, target: 3 });
    assert_eq!(
        fault_with("X1 F100 M7\n", DEFINED),
        "M7 branches: it needs its target, as in M7.300"
    );
}

#[test]
fn m0_stops_and_m30_ends() {
    let ran = ran_with("F100 X1 M0\nX2 M30\nX3\n", "");
    assert_eq!(ends(&ran).len(), 2);
    assert!(matches!(ran.barriers[..], [Barrier::Stop { .. }]));
}

/// Two jumps back: three movements.
#[test]
fn m24_repeats_so_often() {
    let ran = ran_with("F100 G91\nN110 X1\nN120 M24.110.2\nX10\n", "");
    assert_eq!(ends(&ran).last(), Some(&[13.0, 0.0, 0.0]));
}

/// P8714 when it is executed [002:3884-3887].
#[test]
fn m22_jumps_where_the_plc_says_so() {
    let text = "N100 F100 M22.200\nN110 X1\nN200 Y1\n";
    assert_eq!(ends(&ran_with(text, "P8714: 1\n")).len(), 1);
    assert_eq!(ends(&ran_with(text, "P8714: 0\n")).len(), 2);
}

/// 16.4: in look-ahead P8049 and the block for the PLC, with M6 that for the path; P8048 and P8200 when it is executed.
#[test]
fn t_with_m6_loads_its_records() {
    let mut reader = reader_with("T2 M6\nF100 Z10\n", "", &[]);
    let ran = run(&mut reader);
    let memory = reader.take_memory().unwrap();
    let values = ["P8049", "P8050", "P8060", "P8161", "P8048"].map(|name| number(&memory, name));
    assert_eq!(values, [Some(6.0), Some(2.0), Some(5.0), Some(100.0), None]);
    // The length with its correction shifts the axis that stands on the plane.
    assert_eq!(ends(&ran), [[0.0, 0.0, 110.5]]);
    let all = functions(&ran);
    let written = |number| {
        let q = memory.q(bahn_system900::Name::P(1, number)).unwrap();
        Function::Write { q, value: Some(2.0) }
    };
    assert!(all.contains(&written(8048)) && all.contains(&written(8200)));
    // The display follows the length with the movement after the change.
    let last = all.iter().rposition(|one| *one == Function::M(6));
    assert_eq!(
        all.get(last.unwrap() + 1..),
        Some(
            &[Function::Shift {
                logical: 3,
                by: 100.5
            }][..]
        )
    );
    let sixteen = functions(&ran_with("T2 M16\n", ""));
    assert!(!sixteen.contains(&written(8200)));
    assert_eq!(
        fault_with("T9\n", ""),
        "T9: no tool of the channel has this group, q175 to q178"
    );
}

#[test]
fn cycles_are_called_at_the_end_of_their_block() {
    let cycles = [
        ("Z6.900", "Z200\n"),
        ("Z234.900", "Z1\nM234\n"),
        ("Z71.900", "Z:P11\n"),
    ];
    let mut reader = reader_with("F100 T2 M6\nG71 P11:3 X1\n", "P8161: 0\n", &cycles);
    assert_eq!(
        ends(&run(&mut reader)),
        [[0.0, 0.0, 300.5], [1.0, 0.0, 300.5], [1.0, 0.0, 103.5]]
    );
    // M234 is the third function of P8308; it calls itself without end.
    let mut endless = reader_with("F100 M234\n", "P8308: $00400000\n", &cycles);
    let error = run(&mut endless).error.unwrap();
    let deep = Message::Numbered("more than 10 cycles within one another".to_owned());
    assert_eq!(error.message, deep);
    assert_eq!(error.program, "Z234.900");
}

#[test]
fn speeds_go_out_and_are_shown() {
    let ran = ran_with("S1000 S2:500\n", "");
    let all = functions(&ran);
    assert!(all.contains(&Function::SpindleSpeed(1000.0)));
    let shown = all
        .iter()
        .filter(|function| matches!(function, Function::Write { .. }));
    assert_eq!(shown.count(), 2);
}
