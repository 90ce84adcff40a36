//! `bahn check` of DIN 66025 programs.

use crate::support::Folder;
use serde_json::json;

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
    for reported in [
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
        assert!(err.contains(reported), "{reported} is missing in\n{err}");
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

/// What only a block after a fault does is said all the same.
#[test]
fn macros_and_subroutines_that_nobody_has_are_faults_of_their_blocks() {
    let folder = Folder::new();
    folder.write(
        "part.nc",
        "%MAIN\nN10 T1\nN20 G01 F100 X\"WIDTH\"\nN30 \"HEIGHT\"\nN40 L lost\nN50 LL LOST\nN60 L sub\nN70 V.G.M_FCT[5].SYNCH = \"MOS\"\n",
    );
    folder.write("sub.nc", "\"WIDTH\" = \"10\"\nX\"DEPTH\"\nL deeper\nL part\n");
    folder.write("deeper.nc", "M99999999\nG54\n");
    let run = folder.bahn("check part.nc --format json");
    let report = run.json();
    let found: Vec<String> = report[0]["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fault| {
            format!(
                "{}:{}:{} {}",
                fault["program"], fault["line"], fault["column"], fault["message"]
            )
            .replace('"', "")
        })
        .collect();
    assert_eq!(
        found,
        [
            "part.nc:2:5 unknown word T1",
            "part.nc:4:5 unknown macro \\HEIGHT\\",
            "part.nc:5:5 subroutine lost is not found",
            "part.nc:6:5 subroutine LOST is not found",
            "deeper.nc:2:1 unknown G function G54",
            "sub.nc:2:2 unknown macro \\DEPTH\\",
        ]
    );
}

#[test]
fn a_program_that_calls_itself_has_its_faults_once() {
    let folder = Folder::new();
    folder.write("part.nc", "N10 X1\nN20 L part\nN30 G54\n");
    let report = folder.bahn("check part.nc --format json").json();
    let lines: Vec<_> = report[0]["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fault| &fault["line"])
        .collect();
    assert_eq!(lines, [&json!(2), &json!(3)], "called too deep, and G54");
}

#[test]
fn listings_are_printed_compared_and_written() {
    let folder = Folder::new();
    let text = b"%MAIN  ( head )\r\nn10g1x - 5 f200;H\xf6he \r\n  t5 x1\r\n";
    let listed = b"%MAIN  ( head )\r\nN10 G1 X-5 F200 ;H\xf6he \r\n  t5 x1\r\n";
    folder.write("part.nc", text);
    assert_eq!(
        folder.bahn("fmt part.nc").out(),
        "%MAIN  ( head )\r\nN10 G1 X-5 F200 ;Höhe \r\n  t5 x1\r\n"
    );
    let compared = folder.bahn("fmt --check part.nc");
    assert_eq!((compared.code(), compared.out()), (1, "part.nc\n".to_owned()));
    assert_eq!(std::fs::read(folder.path("part.nc")).unwrap(), text);
    assert_eq!(folder.bahn("fmt --write part.nc").code(), 0);
    assert_eq!(std::fs::read(folder.path("part.nc")).unwrap(), listed);
    assert_eq!(folder.bahn("fmt --check part.nc").code(), 0);
    // Plain language by another name, and what is no program.
    folder.write("plain.nc", "BEGIN PGM 3 MM\nL X+15 R0 F100\nEND PGM 3 MM\n");
    assert!(
        folder
            .bahn("fmt plain.nc")
            .out()
            .starts_with("0 BEGIN PGM 3 MM\n1 L X+15")
    );
    folder.write("grid.nc", b"CDF\x01\x00\nx  1\n");
    assert_eq!(folder.bahn("fmt --write grid.nc").code(), 2);
    assert_eq!(
        std::fs::read(folder.path("grid.nc")).unwrap(),
        b"CDF\x01\x00\nx  1\n"
    );
}
