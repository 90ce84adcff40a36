//! `bahn convert`: programs in another language, with the proof that they do the same.

use std::fs;

use crate::support::{Folder, copy, machines};
use serde_json::Value;

const PLAIN: &str = "BEGIN PGM A MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+60 Y+40 Z+0\n\
    TOOL DEF 1 L+0 R+4\nTOOL CALL 1 Z S1200\nL Z+20 R0 FMAX M3 ; up\nL X-10 Y-10 FMAX\nL Z-4 FMAX\n\
    L X+5 Y+5 RL F300\nRND R2\nL Y+30\nL12\nL X+50\nCC X+50 Y+20\nC X+50 Y+10 DR-\nL X+5 Y+5\n\
    L X-10 Y-10 R0 FMAX\nCALL PGM HOLES.H\nL Z+20 FMAX M2\nEND PGM A MM\n";
const CALLED: &str = "BEGIN PGM HOLES MM\nFN0: Q1 = +2\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\n\
    CYCL DEF 1.2 DEPTH -8\nCYCL DEF 1.3 PECKG -3\nCYCL DEF 1.4 DWELL 0.2\nCYCL DEF 1.5 F120\nL Z+2 R0 FMAX\n\
    LBL 1\nL IX+10 Y+15 FMAX M99\nCALL LBL 1 REP Q1/Q1\nEND PGM HOLES MM\n";
const SCALED: &str = "BEGIN PGM S MM\nTOOL DEF 1 L+0 R+4\nTOOL CALL 1 Z S1200\nL X+0 Y+0 Z+5 R0 FMAX M3\n\
    CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X2\nL X+10 F200\nL Y+10\nEND PGM S MM\n";

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("A.H", PLAIN);
    folder.write("HOLES.H", CALLED);
    folder.write("S.H", SCALED);
    folder
}

/// A conversion with its exit code and report.
fn convert(folder: &Folder, arguments: &str) -> (i32, Value) {
    let run = folder.bahn(&format!("convert {arguments} --format json"));
    (run.code(), run.json())
}

/// The table of the path that a program moves, without programs and blocks, which have other numbers.
fn path(folder: &Folder, program: &str) -> Vec<String> {
    let run = folder.bahn(&format!("test {program} --no-graphics --path path.csv"));
    assert_eq!(run.code(), 0, "{}", run.err());
    let rows = folder.read("path.csv");
    let without_names = |row: &str| row.splitn(3, ',').nth(2).unwrap().to_owned();
    rows.lines().map(without_names).collect()
}

#[test]
fn a_program_and_what_it_calls_go_to_iso_and_back() {
    let folder = folder();
    let (code, report) = convert(&folder, "A.H --to iso --with-calls -o iso");
    assert_eq!(code, 0, "{report}");
    assert_eq!(report["ok"], true);
    let programs = report["programs"].as_array().unwrap();
    assert_eq!(programs.len(), 2);
    assert!(programs.iter().all(|of| of["proof"]["completed"] == true));
    let iso = folder.read("iso/A.I");
    assert!(iso.starts_with("%A G71 *\nN10 G30 G17 X+0 Y+0 Z-20 *\n"), "{iso}");
    assert!(iso.contains("G00 G40 G90 Z+20 M3 ; up *"), "{iso}");
    assert!(iso.contains("%HOLES.I *"), "{iso}");
    assert!(
        folder
            .read("iso/HOLES.I")
            .contains("G83 P01 -2 P02 -8 P03 -3 P04 0.2 P05 120")
    );
    assert_eq!(path(&folder, "iso/A.I"), path(&folder, "A.H"));

    let (code, _) = convert(&folder, "iso/A.I --to plain --with-calls -o back");
    assert_eq!(code, 0);
    assert_eq!(path(&folder, "back/A.H"), path(&folder, "A.H"));
    assert!(folder.read("back/A.H").contains("CALL PGM HOLES.H"));
}

#[test]
fn a_call_stays_as_it_is_when_the_called_program_is_not_converted() {
    let folder = folder();
    let (code, report) = convert(&folder, "A.H --to iso");
    assert_eq!(code, 0, "{report}");
    assert!(folder.read("A.I").contains("%HOLES.H *"));
    assert_eq!(path(&folder, "A.I"), path(&folder, "A.H"));
}

#[test]
fn gcode_has_the_path_with_its_arcs_and_everything_else_unrolled() {
    let folder = folder();
    let (code, report) = convert(&folder, "A.H --to gcode");
    assert_eq!(code, 0, "{report}");
    let text = folder.read("A.ngc");
    // The rounding of 2 mm becomes 2 + 4 outside, the arc of 10 mm one of 14.
    assert!(
        text.lines()
            .any(|line| line.starts_with("G17 G2") || line.starts_with("G2")),
        "{text}"
    );
    let dwells = text.lines().filter(|line| line.starts_with("G4 P0.2")).count();
    assert_eq!(dwells, 3, "{text}");
    assert!(text.contains("; 10 L IX+10 Y+15 FMAX M99"), "{text}");
    assert!(text.ends_with("M2\n"));
    let rows = path(&folder, "A.H");
    let moving = rows.len() as u64 - 1;
    // Moves of no length have no line.
    let elements = report["proof"]["elements"].as_u64().unwrap();
    assert!(elements <= moving && elements + 4 > moving, "{elements} {moving}");
}

#[test]
fn what_iso_cannot_say_is_unrolled_or_refused() {
    let folder = folder();
    let (code, report) = convert(&folder, "S.H --to iso -o path.I");
    assert_eq!(code, 0, "{report}");
    assert_eq!(report["unrolled"][0]["block"], 4, "{report}");
    assert!(report["refused"].as_array().unwrap().is_empty());
    assert_eq!(path(&folder, "path.I"), path(&folder, "S.H"));

    let (code, report) = convert(&folder, "S.H --to iso -o blocks.I --no-unroll");
    assert_eq!(code, 1);
    assert_eq!(report["ok"], false);
    let refused = &report["refused"][0];
    assert_eq!(
        (&refused["block"], &refused["line"]),
        (&4.into(), &5.into()),
        "{report}"
    );
    assert!(folder.read("blocks.I").contains("ERROR = CYCL DEF 26.0"));
    // The target ends where the source goes on.
    assert_eq!(
        report["proof"]["first_difference"]["target"]["program"], "blocks.I",
        "{report}"
    );
    assert_eq!(folder.bahn("test blocks.I").code(), 1);
}

#[test]
fn machine_functions_stop_the_gcode_and_are_listed() {
    let folder = folder();
    folder.write(
        "M.H",
        "BEGIN PGM M MM\nL X+0 Y+0 R0 F500\nL X+10 M17\nL X+20\nEND PGM M MM\n",
    );
    let (code, report) = convert(&folder, "M.H --to gcode");
    assert_eq!(code, 1);
    assert_eq!(report["refused"][0]["block"], 2, "{report}");
    assert!(report["refused"][0]["reason"].as_str().unwrap().contains("M17"));
    let text = folder.read("M.ngc");
    assert!(text.contains("(MSG,") && text.contains("\nM0"), "{text}");
}

#[test]
fn no_input_is_replaced_and_nothing_else_without_asking() {
    let folder = folder();
    folder.write("A.I", "mine\n");
    for arguments in ["A.H --to iso", "A.H --to iso -o HOLES.H"] {
        let run = folder.bahn(&format!("convert {arguments}"));
        assert_eq!(run.code(), 2, "{}", run.err());
    }
    assert_eq!(folder.read("A.I"), "mine\n");
    assert_eq!(folder.bahn("convert A.H --to gcode --replace -o A.H").code(), 2);
    assert_eq!(folder.read("A.H"), PLAIN);
    assert_eq!(folder.bahn("convert A.H --to iso --replace").code(), 0);
    assert!(folder.read("A.I").starts_with("%A"));
    // It is in plain language already.
    assert_eq!(folder.bahn("convert A.H --to plain").code(), 2);
    assert_eq!(folder.bahn("convert none.H --to iso").code(), 2);
}

#[test]
fn standard_output_gets_the_program_alone() {
    let folder = folder();
    let run = folder.bahn("convert HOLES.H --to iso -o -");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.out().starts_with("%HOLES G71 *\n") && run.out().ends_with("G71 *\n"),
        "{}",
        run.out()
    );
    assert!(run.err().contains("Proof"), "{}", run.err());
}

#[test]
fn a_whole_folder_is_converted_and_proved() {
    let folder = Folder::new();
    copy(&machines().join("../examples"), &folder.path("examples"));
    let (code, report) = convert(&folder, "examples --to iso -o iso");
    let programs = report["programs"].as_array().unwrap();
    // The digitizing example has TCH PROBE 5 and 6, which no DIN/ISO has.
    let failed: Vec<&str> = programs
        .iter()
        .filter(|of| of["ok"] == false)
        .map(|of| of["source"].as_str().unwrap())
        .collect();
    assert_eq!(
        (code, failed),
        (1, vec!["examples/digitizing/MODEL.H"]),
        "{report}"
    );
    assert!(programs.len() > 15);
    assert!(folder.path("iso/digitizing/AGAIN.I").is_file() && folder.path("iso/contour.I").is_file());
    let written = fs::read_dir(folder.path("iso")).unwrap().count();
    assert!(written > 15, "{written}");
}

#[test]
fn numbers_of_iso_blocks_follow_mp7220_and_stand_in_the_path_table() {
    let folder = folder();
    folder.write("step.mp", "MP7220 : 5\n");
    assert_eq!(
        folder
            .bahn("convert HOLES.H --to iso --parameters step.mp")
            .code(),
        0
    );
    let text = folder.read("HOLES.I");
    assert!(text.contains("\nN5 D00 Q1 P01 +2 *\nN10 G83"), "{text}");
    let formatted = folder.bahn("fmt HOLES.I --parameters step.mp");
    assert_eq!(formatted.out(), text);
    assert!(folder.bahn("fmt HOLES.I").out().contains("\nN20 G83"));

    folder.write(
        "N.I",
        "%N G71 *\nN7 G01 G40 X+0 Y+0 F500 *\nN21 X+10 *\nX+20 *\nN99999 %N G71 *\n",
    );
    assert_eq!(folder.bahn("test N.I --no-graphics --path n.csv").code(), 0);
    let rows = folder.read("n.csv");
    let blocks: Vec<&str> = rows
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(1).unwrap())
        .collect();
    // A block without a number is called by its place.
    assert_eq!(blocks, ["7", "21", "3"]);
}

#[test]
fn without_proof_nothing_is_said_of_it() {
    let folder = folder();
    let (code, report) = convert(&folder, "A.H --to iso --no-prove");
    assert_eq!((code, &report["proof"]), (0, &Value::Null));
    let (code, report) = convert(&folder, "A.H --to iso --no-prove --prove --replace");
    assert_eq!((code, &report["proof"]["completed"]), (0, &true.into()));
}

/// A probing beside what DIN/ISO cannot say: the report has both reasons.
#[test]
fn why_a_program_is_not_unrolled_is_said() {
    let folder = Folder::new();
    let scaled = "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X1.5\n";
    let probing = "TCH PROBE 0.0 REF. PLANE Q5 X-\nTCH PROBE 0.1 X+5 Y+0 Z-5\n";
    folder.write(
        "T.H",
        format!("BEGIN PGM T MM\nTOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S500\nL Z+2 R0 FMAX M3\n{scaled}{probing}END PGM T MM\n"),
    );
    let (code, report) = convert(&folder, "T.H --to iso");
    assert_eq!(code, 1);
    assert!(
        report["refused"][0]["reason"]
            .as_str()
            .unwrap()
            .contains("cycle 26"),
        "{report}"
    );
    assert!(
        report["not_unrolled"]
            .as_str()
            .unwrap()
            .contains("what a probe finds"),
        "{report}"
    );
    folder.write("D.nc", "%MAIN\nN10 G01 X1 F100\n");
    let refused = folder.bahn("convert D.nc --to iso");
    assert_eq!(refused.code(), 2);
    assert!(refused.err().contains("DIN 66025"), "{}", refused.err());
}
