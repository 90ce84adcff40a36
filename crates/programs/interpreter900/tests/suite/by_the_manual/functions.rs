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
}

/// M26 stops the look-ahead: where its way ends only the machine knows. What needs the end of the way stands elsewhere.
#[test]
fn m26_reads_nothing_after_its_block() {
    let ran = run(&mut reader(M_TABLE, "N10 M26 G1 X1 F1\nN20 X2\n"));
    assert_eq!(ran.elements[0].functions()[0].function, Function::Residual);
    assert!(matches!(ran.barriers.as_slice(), [Barrier::Acknowledge { .. }]));
    for (block, said) in [
        ("N10 M26", "M26 stands in a block that moves, and drills nothing"),
        (
            "N10 M26 G1 X1 F1 M5",
            "M26 beside an M function that goes out after the path",
        ),
        (
            "N10 M26 G1 X1 F1 M30",
            "M26 beside what ends, repeats or leaves its block",
        ),
    ] {
        assert!(fault(M_TABLE, &format!("{block}\n")).ends_with(said), "{block}");
    }
}

/// q142 and q143 give the words S and S2 to the spindles 1 and 4, of which P11648 and P11708 are the speeds, P11647 and P11707
/// their kinds [002:858-881] [002:6592-6594].
#[test]
fn speeds_go_to_their_spindles() {
    const SPINDLES: &str = "q142: 1\nq143: 4\n";
    let writes = |program: &str| {
        let ran = run(&mut reader(SPINDLES, program));
        assert_eq!(ran.fault, None, "{program}");
        let functions = ran.elements.iter().flat_map(|element| element.functions());
        // Speeds and what is shown of them lie above q2000.
        let writes = functions.filter_map(|own| match own.function {
            Function::Write { q, value } if q < 2000 => Some((q, value)),
            _ => None,
        });
        writes.collect::<Vec<_>>()
    };
    assert_eq!(writes("N10 S2:700\n"), [(1708, Some(700.0))]);
    assert_eq!(writes("N10 G96 S150\n"), [(1647, Some(96.0))]);
    assert_eq!(
        writes("N10 G96 S2:150\nN20 G97\n"),
        [(1707, Some(96.0)), (1708, Some(150.0)), (1647, Some(97.0))]
    );
    // P8981 shows it where the block is executed: the fixed parameters begin at q15000 with P7000.
    let ran = run(&mut reader(SPINDLES, "N10 G96 S150\n"));
    let shown = Function::Write {
        q: 15_000 + 1981,
        value: Some(96.0),
    };
    let mut functions = ran.elements.iter().flat_map(|element| element.functions());
    assert!(functions.any(|own| own.function == shown));
    let without = "G96 needs a spindle: q142 to q149 name none";
    assert!(fault("", "N10 G96 S1\n").ends_with(without));
    let said = fault(SPINDLES, "N10 G96 S1\nN20 G95 G1 X1 F0.1\n");
    assert!(
        said.ends_with("a feed per revolution needs a speed in revolutions: G97"),
        "{said}"
    );
}
