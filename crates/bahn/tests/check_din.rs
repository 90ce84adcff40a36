//! `bahn check` of DIN 66025 programs.

mod support;

use serde_json::json;
use support::Folder;

#[test]
fn every_fault_of_a_program_and_of_what_it_calls_is_shown() {
    let folder = Folder::new();
    folder.write(
        "part.nc",
        "%MAIN\nN10 G01 X10 F100\nN20 L sub\n  N30 #HSC ON [X]\nN40 T1\n%L LOCAL\nD2\n",
    );
    folder.write("sub.nc", "X1\nG54 (datum)\nM17\n");
    let run = folder.bahn("check part.nc");
    assert_eq!(run.code(), 1);
    let err = run.err();
    for told in [
        "unknown command #HSC ON",
        "part.nc:4:7",
        "unknown word T1",
        "part.nc:5:5",
        "unknown word D2",
        "part.nc:7:1",
        "unknown G function G54",
        "sub.nc:2:1",
        "part.nc: 5 blocks, 4 errors, 0 warnings; loops were not followed to their end",
    ] {
        assert!(err.contains(told), "{told} is missing in\n{err}");
    }
}

#[test]
fn the_report_has_places_and_messages() {
    let folder = Folder::new();
    folder.write("part.NC", "N0040 X1\n\n Y[P7+1]\n");
    folder.write(
        "good.nc",
        "%A\nN10 M5=V.E.STATE/V.E.STATE\nM30\n%B\nN10 G01 F5 X1\nM30\n; end\n",
    );
    let run = folder.bahn("check --format json part.NC good.nc");
    assert_eq!(run.code(), 1);
    let report = run.json();
    assert_eq!(
        (&report[0]["errors"], &report[0]["blocks"]),
        (&json!(1), &json!(2))
    );
    assert_eq!(
        report[0]["diagnostics"][0],
        json!({
            "severity": "error", "message": "P7 has no value", "program": "part.NC", "block": 3, "line": 3,
            "column": 2, "length": 7, "detail": "", "help": "",
        })
    );
    assert_eq!(
        report[1]["errors"], 0,
        "what follows from unknown values is not reported"
    );
    assert_eq!(report[1]["complete"], false);
}

#[test]
fn whole_programs_are_fine_and_empty_files_are_not() {
    let folder = Folder::new();
    folder.write("part.nc", "%MAIN\nN10 G00 X10 L folder\\sub.nc\nM30\n");
    std::fs::create_dir(folder.path("folder")).expect("a folder");
    std::fs::write(folder.path("folder/sub.nc"), "M300\nM17\n").expect("a file");
    folder.write("remarks.nc", "; nothing to do\n");
    folder.write("empty.nc", "\n");
    let run = folder.bahn("check part.nc remarks.nc");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.err().contains("part.nc: 2 blocks, 0 errors, 0 warnings\n"),
        "{}",
        run.err()
    );
    assert_eq!(folder.bahn("check empty.nc").code(), 1);
    // Nothing above the folder is a subroutine.
    folder.write("out.nc", "L ../part.nc\n");
    assert!(
        folder
            .bahn("check out.nc")
            .err()
            .contains("subroutine ../part.nc is not found")
    );
}
