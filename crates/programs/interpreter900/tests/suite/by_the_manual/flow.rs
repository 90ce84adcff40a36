//! Parameters, conditions, loops, skipped blocks, start block.

use bahn_path::{Barrier, Function};
use bahn_system900::Name;

use super::support::{ends, fault, reader, run};

/// The manual's loop: P7960 counts until the condition does not hold any more [002:1634-1655].
#[test]
fn a_condition_jumps_to_its_block() {
    let program = "N100 P500:0\nN110 G91 G1 X1 F100\nN120 P501:P500 P500:1\nN130 P501=0.110\nN140 M30\n";
    assert_eq!(ends("", program), [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    // What is cleared is equal to nothing.
    assert_eq!(ends("", "N10 P500=0.30\nN20 G1 X1 F100\nN30 M30\n").len(), 1);
    assert_eq!(
        ends("P500: 9\n", "N10 P500<10.30\nN20 G1 X1 F100\nN30 M30\n").len(),
        0
    );
}

/// M24.110.5 jumps back five times: the block is executed six times.
#[test]
fn m24_repeats() {
    let program = "N110 G91 G1 X1 F100\nN120 M24.110.5\nN130 Y1\nN140 M30\n";
    let places = ends("", program);
    assert_eq!((places.len(), places[6]), (7, [6.0, 1.0, 0.0]));
}

/// M22.200 jumps where the PLC says so in P8714, which is looked at when everything before is executed [002:3884-3887].
#[test]
fn m22_jumps_where_the_plc_says_so() {
    let program = "N100 G1 X1 F100 M22.200\nN110 Y5\nN200 Z1\nN210 M30\n";
    assert_eq!(ends("P8714: 1\n", program), [[1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]);
    assert_eq!(
        ends("", program),
        [[1.0, 0.0, 0.0], [1.0, 5.0, 0.0], [1.0, 5.0, 1.0]]
    );
    let ran = run(&mut reader("", program));
    assert!(matches!(ran.barriers.as_slice(), [Barrier::Acknowledge { .. }]));
}

/// P8810 skips blocks with a stroke [002:4241-4243]; P8801 is the first block [002:4157-4158].
#[test]
fn blocks_are_skipped_and_passed_over() {
    let program = "N10 G1 X1 F100\n/N20 G1 Y1 F100\nN30 G1 Z1 F100\nN40 M30\n";
    assert_eq!(ends("", program).len(), 3);
    assert_eq!(ends("P8810: 1\n", program), [[1.0, 0.0, 0.0], [1.0, 0.0, 1.0]]);
    assert_eq!(ends("P8801: 30\n", program), [[0.0, 0.0, 1.0]]);
    let said = fault("P8801: 35\n", program);
    assert_eq!(said, "start block: no block has the number N35");
}

/// A parameter with status bit 1.2 is written when the path comes to its block; one with 1.3 lets the look-ahead wait.
#[test]
fn real_time_parameters_go_with_the_path() {
    let text = "P500: 0 $00000005\nP501: 0 $00000009\n";
    let mut reader = reader(text, "N10 P500:7 G1 X1 F100\nN20 P501:8 X2\nN30 M30\n");
    let ran = run(&mut reader);
    assert_eq!(ran.fault, None);
    let held = |number| {
        reader
            .memory()
            .unwrap()
            .cell(Name::P(1, number))
            .unwrap()
            .number()
    };
    assert_eq!((held(500), held(501)), (Some(0.0), Some(8.0)));
    let write = Function::Write {
        q: 10_500,
        value: Some(7.0),
    };
    assert_eq!(ran.elements[0].functions()[0].function, write);
    assert_eq!(ran.barriers.len(), 1);
}

#[test]
fn a_loop_without_movement_is_ended() {
    let said = fault("P500: 1\n", "N10 P501:1\nN20 P500=1.10\n");
    assert!(
        said.ends_with("the program goes round and round without a movement"),
        "{said}"
    );
}

#[test]
fn a_cleared_parameter_gives_no_value() {
    assert_eq!(
        fault("", "N10 G1 X:P500 F100\n"),
        "P500 is cleared: it has no number to take"
    );
}

/// P12111 moves an axis as soon as it is written [002:7799-7806]: a program gives this command when the path comes to its block,
/// however far ahead it is read. q2111 is that of physical axis 1.
#[test]
fn commands_are_given_where_the_path_is() {
    let mut reader = reader("", "N10 G1 X1 F100\nN20 P12111:5 X2\nN30 M30\n");
    let ran = run(&mut reader);
    assert_eq!(ran.fault, None);
    let held = reader.memory().unwrap().cell(Name::P(1, 12_111)).unwrap();
    assert_eq!(held.number(), None, "it is not written while the program is read");
    let write = Function::Write {
        q: 2111,
        value: Some(5.0),
    };
    let second = ran
        .elements
        .iter()
        .find(|element| element.block.block == 2)
        .unwrap();
    assert_eq!(second.functions()[0].function, write);
}
