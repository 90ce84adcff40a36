//! M functions and speeds.

use bahn_path::{At, Barrier, Function, Synchronisation};

use super::support::{fault, reader, run};

/// The printed example: P11051 $10050601 has M7 branch, M6 before with stop, M5 after with stop, M4 before, flying
/// [002:5503-5517].
const M_TABLE: &str = "P11051: $10050601\n";

fn outputs(program: &str) -> Vec<(Function, At, Synchronisation)> {
    let ran = run(&mut reader(M_TABLE, program));
    assert_eq!(ran.fault, None);
    let functions = ran.elements.iter().flat_map(|element| element.functions());
    functions
        .map(|own| (own.function.clone(), own.at, own.synchronisation))
        .collect()
}

#[test]
fn functions_go_out_as_the_table_says() {
    assert_eq!(
        outputs("N10 G1 X1 F100 M4\nN20 X2 M5\nN30 M30\n"),
        [
            (Function::M(4), At::Start, Synchronisation::Mos),
            (Function::M(5), At::End, Synchronisation::MnsSns),
        ]
    );
}

/// M7.300 branches: it goes out before the movement and is waited for behind it, and names the block of N300, the second one.
#[test]
fn a_branch_names_its_block() {
    let mut reader = reader(M_TABLE, "N10 G1 X1 F100 M7.300\nN300 M30\n");
    let ran = run(&mut reader);
    let function = &ran.elements[0].functions()[0];
    assert_eq!(
        (function.at, function.synchronisation),
        (At::Start, Synchronisation::MvsSns)
    );
    assert_eq!(function.function, Function::Branch { m: 7, target: 2 });
    let said = fault(M_TABLE, "N10 M7\nN20 M30\n");
    assert!(
        said.ends_with("M7 branches: it needs its target, as in M7.300"),
        "{said}"
    );
}

#[test]
fn m0_stops_and_m1_waits() {
    let ran = run(&mut reader("", "N10 M0\nN20 M1\nN30 M30\nN40 G1 X1\n"));
    assert!(matches!(
        ran.barriers.as_slice(),
        [Barrier::Stop { .. }, Barrier::Acknowledge { .. }]
    ));
    assert_eq!(ran.elements.len(), 0, "M30 ends the program");
}

#[test]
fn the_speed_goes_out_before_the_movement() {
    let speed = (Function::SpindleSpeed(1200.0), At::Start, Synchronisation::MvsSvs);
    assert!(outputs("N10 G1 X1 F100 S1200\nN20 M30\n").contains(&speed));
}

#[test]
fn what_nobody_defines_is_refused() {
    assert_eq!(fault("", "N10 M55\nN20 M30\n"), "M55 is defined nowhere: P11063");
    let said = fault("", "N10 M26 G1 X1 F1\n");
    assert!(said.ends_with("M26 is not executed here"), "{said}");
}
