//! `bahn check` and `bahn fmt` of programs of a System 900, which nobody runs yet.

use crate::support::Folder;
use serde_json::json;

#[test]
fn every_fault_of_a_program_and_of_its_cycle_has_its_place() {
    let folder = Folder::new();
    folder.write("P1000.900", "N10 G71 H5\nN20 LBL 5\nN30 P1<10.99\n");
    folder.write("Z71.900", "N10 X1 FOO7\n");
    let run = folder.bahn("check P1000.900");
    assert_eq!(run.code(), 1);
    let err = run.err();
    for reported in [
        "unknown word LBL",
        "P1000.900:2:5",
        "no block has the number N99",
        "P1000.900:3:5",
        "unknown word FOO7",
        "Z71.900:1:8",
        "P1000.900: 3 blocks, 4 errors, 1 warning",
    ] {
        assert!(err.contains(reported), "{reported} is missing in\n{err}");
    }
    let report = folder.bahn("check --format json P1000.900").json();
    assert_eq!(report[0]["diagnostics"][0]["severity"], "warning", "{report}");
    assert_eq!(report[0]["diagnostics"][1]["block"], json!(20), "{report}");
}

#[test]
fn the_example_is_fine_and_tidy() {
    let folder = Folder::new();
    crate::support::copy(
        &std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/system900"),
        folder.as_ref(),
    );
    let run = folder.bahn("check P1000.900 Z71.900");
    assert_eq!(run.code(), 0, "{}", run.err());
    folder.write("P1.900", "n10g1 x : 25   { Start }\n");
    assert_eq!(folder.bahn("fmt P1.900").out(), "N10 G1 X:25 { Start }\n");
    assert_eq!(folder.bahn("fmt --write P1.900").code(), 0);
    assert_eq!(folder.bahn("fmt --check P1.900").code(), 0);
}

/// What is read and cannot be run is refused at its block.
#[test]
fn no_run_begins() {
    let folder = Folder::new();
    folder.write("P1000.900", "{ part }\nN10 G1 X5 F100\nN20 M30\n");
    let run = folder.bahn("test P1000.900");
    assert_eq!(run.code(), 1, "{}", run.err());
    assert!(
        run.err().contains("System 900") && run.err().contains("P1000.900"),
        "{}",
        run.err()
    );
    assert_eq!(folder.bahn("convert P1000.900 --to iso").code(), 2);
}
