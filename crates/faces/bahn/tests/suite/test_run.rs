//! `bahn test`: report, files and every option.

use crate::support::{Folder, assert_near, number, program, rows};
use serde_json::json;

/// A square of 40 mm around the origin at Z-5 with a tool of radius 5, from the outside.
const SQUARE: &str = "
BLK FORM 0.1 Z X-30 Y-30 Z-20
BLK FORM 0.2 X+30 Y+30 Z+0
TOOL DEF 1 L+0 R+5
TOOL CALL 1 Z S1000
L Z+50 R0 FMAX M3
L X-40 Y-40 FMAX
L Z-5 F200
L X-20 Y-20 RL F400
L Y+20
L X+20
L Y-20
L X-20
L X-40 Y-40 R0 FMAX
L Z+50 FMAX M2";

#[test]
fn the_report_has_every_field() {
    let folder = Folder::with_program("FN0: Q1 = +0\nL X+30 Y+40 Z+0 R0 F600\nL X+60 Y+80\nL Z+12 FMAX");
    let (code, report) = folder.test("");
    assert_eq!(code, 0);
    let mut keys: Vec<&str> = report.as_object().unwrap().keys().map(String::as_str).collect();
    let mut expected = vec![
        "program",
        "unit",
        "completed",
        "error",
        "machining_time_s",
        "path_mm",
        "blocks_executed",
        "tool_calls",
        "final_position",
        "q",
        "removed_mm3",
        "warnings",
        "stops",
        "printed",
    ];
    expected.sort_unstable();
    keys.sort_unstable();
    assert_eq!(keys, expected);
    assert_eq!(report["program"], "main.H");
    assert_eq!(report["unit"], "mm");
    assert_eq!(report["completed"], true);
    assert_eq!(report["error"], json!(null));
    // No axis has a position before the first movement, which adds no length; then hypot(30, 40).
    assert_eq!(report["path_mm"], json!({"feed": 50.0, "rapid": 12.0}));
    // BEGIN and END do not count.
    assert_eq!(report["blocks_executed"], 4);
    assert_eq!(report["final_position"], json!({"X": 60.0, "Y": 80.0, "Z": 12.0}));
    assert_eq!(report["q"]["1"], 0.0);
    assert_eq!(report["removed_mm3"], json!(null));
    assert_eq!(report["tool_calls"], json!([]));
    assert_eq!(report["warnings"], json!([]));
    assert_eq!(report["stops"], json!([]));
    // 50 mm at 10 mm/s take 5 s; the ramps of the reference machine (1 m/s²) take 10 ms more, and 12 mm in
    // rapid traverse (200 mm/s, never reached) 2 sqrt(12 / 1000) s.
    assert_near(
        number(&report, "/machining_time_s"),
        5.0 + 0.01 + 2.0 * 0.012f64.sqrt(),
    );
}

#[test]
fn inch_programs_are_reported_in_mm() {
    let folder = Folder::new();
    folder.write(
        "main.H",
        "BEGIN PGM 1 INCH\nL X+0 R0 F10\nL X+1\nEND PGM 1 INCH\n",
    );
    let (_, report) = folder.test("");
    assert_eq!(report["unit"], "inch");
    assert_near(number(&report, "/path_mm/feed"), 25.4);
    assert_near(number(&report, "/final_position/X"), 25.4);
}

#[test]
fn an_error_is_reported_with_its_place_and_exit_code_1() {
    let folder = Folder::with_program("L X+0 R0 F100\n\nL X+10\nCALL LBL 9\nL X+99");
    let (code, report) = folder.test("");
    assert_eq!(code, 1);
    assert_eq!(report["completed"], false);
    assert_eq!(report["error"]["message"], "LABEL NUMBER NOT ALLOCATED");
    assert_eq!(report["error"]["program"], "main.H");
    // The blank line is no block, but a line.
    assert_eq!(report["error"]["block"], 3);
    assert_eq!(report["error"]["line"], 5);
    assert!(report["error"]["detail"].as_str().unwrap().contains('9'));
    // What was done before counts.
    assert_near(number(&report, "/path_mm/feed"), 10.0);
    let run = folder.bahn("test main.H");
    assert_eq!(run.code(), 1);
    assert!(
        run.err()
            .contains("error: LABEL NUMBER NOT ALLOCATED\n --> main.H:5:1"),
        "{}",
        run.err()
    );
    assert!(run.err().contains("5 | CALL LBL 9"), "{}", run.err());
    assert!(
        run.out()
            .contains("LABEL NUMBER NOT ALLOCATED at block 3 (line 5)"),
        "{}",
        run.out()
    );
}

#[test]
fn blocks_that_cannot_be_read_are_marked_where_they_are_wrong() {
    let folder = Folder::with_program("L X+0 R0 F100\nL X+10 Ynan");
    let run = folder.bahn("test main.H");
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("main.H:3:8"), "{}", run.err());
}

#[test]
fn tool_calls_and_speeds_are_listed() {
    let folder = Folder::with_program("TOOL DEF 7 L+0 R+3\nTOOL CALL 7 Z S1500\nTOOL CALL S800");
    let (_, report) = folder.test("");
    let calls = report["tool_calls"].as_array().unwrap();
    let seen: Vec<_> = calls
        .iter()
        .map(|c| (&c["block"], &c["tool"], &c["speed_rpm"]))
        .collect();
    assert_eq!(
        seen,
        [
            (&json!(2), &json!(7), &json!(1500.0)),
            (&json!(3), &json!(7), &json!(800.0))
        ]
    );
}

#[test]
fn material_is_removed_and_shown() {
    let folder = Folder::with_program(SQUARE);
    let arguments = "--image part.png --mesh part.stl --path path.csv --path path.svg";
    let (code, report) = folder.test(arguments);
    assert_eq!(code, 0);
    // Outside the square of 40 mm, of the 60 mm square that is 5 mm deep, everything that the tool of
    // radius 5 passes: its path is 5 mm outside with a quarter circle about each corner, so it clears
    // a band of 10 mm. In the corners of the blank the tool leaves what lies outside its reach.
    let cleared = (60.0 * 60.0 - 40.0 * 40.0) * 5.0;
    let removed = number(&report, "/removed_mm3");
    assert!(
        removed > 0.9 * cleared && removed < cleared,
        "{removed} of {cleared}"
    );
    assert_eq!(
        std::fs::read(folder.path("part.png")).unwrap()[..8],
        *b"\x89PNG\r\n\x1a\n"
    );
    let mesh = std::fs::read(folder.path("part.stl")).unwrap();
    let triangles = u32::from_le_bytes(mesh[80..84].try_into().unwrap()) as usize;
    assert_eq!(mesh.len(), 84 + 50 * triangles);
    let svg = folder.read("path.svg");
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
    assert!(
        svg.contains("A5 5 0 0 0 "),
        "outside corners are arcs of the tool radius"
    );
    // Nothing half-written is left.
    assert_eq!(
        folder.names(),
        ["main.H", "part.png", "part.stl", "path.csv", "path.svg"]
    );
}

#[test]
fn every_view_is_drawn() {
    let folder = Folder::with_program(SQUARE);
    let mut pictures = Vec::new();
    for options in [
        "--view plan",
        "--view three-planes",
        "--view three-planes --section X5,Y-10",
        "--view 3d",
        "--view 3d --angle -60 --elevation 20 --color tool --toolpath",
        "--view 3d --size 640x480",
    ] {
        let run = folder.bahn(&format!("test main.H --image part.png {options}"));
        assert_eq!(run.code(), 0, "{options}: {}", run.err());
        pictures.push(std::fs::read(folder.path("part.png")).unwrap());
    }
    let all = pictures.len();
    pictures.sort();
    pictures.dedup();
    assert_eq!(pictures.len(), all, "every option changes the picture");
}

#[test]
fn the_table_has_one_row_for_each_element() {
    let folder = Folder::with_program(
        "L X+10 Y+0 Z+0 R0 F500\nCC X+0 Y+0\nC X+0 Y+10 DR+\nL X-5 Y+10 C+90 FMAX\nCP IPA-450 IZ-8 DR- F300",
    );
    let (code, report) = folder.test("--path out.csv");
    assert_eq!(code, 0, "{report}");
    let table = folder.read("out.csv");
    assert_eq!(
        table.lines().next(),
        Some("program,block,kind,feed_mm_min,X,Y,Z,A,B,C,U,V,W,centre_X,centre_Y,centre_Z,sweep_deg")
    );
    let rows = rows(&table);
    assert_eq!(
        rows[0],
        "main.H,1,line,500,10,0,0,,,,,,,,,,"
            .split(',')
            .collect::<Vec<_>>()
    );
    assert_eq!(
        rows[1],
        "main.H,3,arc,500,0,10,0,,,,,,,0,0,,90"
            .split(',')
            .collect::<Vec<_>>()
    );
    assert_eq!(
        rows[2],
        "main.H,4,rapid,,-5,10,0,,,90,,,,,,,"
            .split(',')
            .collect::<Vec<_>>()
    );
    // The helix: 450 degrees clockwise about the pole from (-5, 10) are a quarter more than a turn, to
    // (10, 5), and 8 mm down.
    let helix = &rows[3];
    let value = |column: usize| helix[column].parse::<f64>().unwrap();
    assert_eq!((helix[1], helix[2]), ("5", "arc"));
    for (column, expected) in [
        (3, 300.0),
        (4, 10.0),
        (5, 5.0),
        (6, -8.0),
        (13, 0.0),
        (14, 0.0),
        (16, -450.0),
    ] {
        assert_near(value(column), expected);
    }
    assert_eq!(rows.len(), 4);
}

#[test]
fn the_table_adds_up_to_the_report() {
    // Pocket with transition arcs, pecking, a helix, a called program: the rows give the same lengths.
    let folder = Folder::with_program(
        "TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1000\nL X-20 Y-20 Z+2 R0 FMAX M3\nL X+0 Y+0 RL F500\nL Y+40\nRND R8\n\
         L X+50\nL Y+0 IZ-3\nL X+0\nL X-20 Y-20 R0\nCC X+0 Y+0\nCP IPA+800 IZ-12 DR+\nL Z+2 FMAX\n\
         CYCL DEF 4.0 POCKET MILLING\nCYCL DEF 4.1 SET UP -2\nCYCL DEF 4.2 DEPTH -10\nCYCL DEF 4.3 PECKG -4 F80\n\
         CYCL DEF 4.4 X+40\nCYCL DEF 4.5 Y+30\nCYCL DEF 4.6 F300 DR+ RADIUS 0\nL X+25 Y+20 FMAX M99\nCALL PGM SUB",
    );
    folder.write("SUB.H", program("L X+7 Y+8 C+90 FMAX\nL C+180 F1000"));
    let (code, report) = folder.test("--path out.csv");
    assert_eq!(code, 0, "{report}");
    let table = folder.read("out.csv");
    let (mut feed, mut rapid) = (0.0, 0.0);
    let mut at = [f64::NAN; 3];
    for row in rows(&table) {
        let end = [4, 5, 6].map(|column| row[column].parse().unwrap_or(f64::NAN));
        let delta = |axis: usize| {
            let delta: f64 = end[axis] - at[axis];
            if delta.is_nan() { 0.0 } else { delta }
        };
        let in_plane = if row[2] == "arc" {
            let [x, y, sweep] = [13, 14, 16].map(|column| row[column].parse::<f64>().unwrap());
            (at[0] - x).hypot(at[1] - y) * sweep.abs().to_radians()
        } else {
            delta(0).hypot(delta(1))
        };
        let length = in_plane.hypot(delta(2));
        if row[3].is_empty() {
            rapid += length;
        } else {
            feed += length;
        }
        at = end;
    }
    assert!(table.lines().count() > 30 && feed > 500.0 && rapid > 50.0);
    assert_near(number(&report, "/path_mm/feed"), feed);
    assert_near(number(&report, "/path_mm/rapid"), rapid);
}

#[test]
fn stops_are_listed_and_passed_over() {
    // M6 is a tool change, no stop for the operator.
    let folder = Folder::with_program("L X+0 R0 F100\nSTOP M6\nL X+10 M6\nL X+20 M0\nM1\nL X+30");
    let (code, report) = folder.test("");
    assert_eq!(code, 0);
    let stops = report["stops"].as_array().unwrap();
    let seen: Vec<_> = stops
        .iter()
        .map(|stop| (&stop["block"], &stop["function"], &stop["line"]))
        .collect();
    assert_eq!(
        seen,
        [
            (&json!(2), &json!("STOP"), &json!(3)),
            (&json!(4), &json!("M0"), &json!(5))
        ]
    );
    assert_near(number(&report, "/final_position/X"), 30.0);
    let (code, report) = folder.test("--stop");
    assert_eq!(
        (code, &report["completed"], &report["error"]),
        (0, &json!(false), &json!(null))
    );
    assert_near(number(&report, "/final_position/X"), 0.0);
    assert_eq!(report["blocks_executed"], 2);
    assert_eq!(report["stops"].as_array().unwrap().len(), 1);
}

#[test]
fn signs_that_disagree_are_a_warning_or_an_error() {
    let folder = Folder::with_program(
        "TOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S500\nCYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 DEPTH -10\n\
         CYCL DEF 1.3 PECKG 5\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100\nL Z+2 R0 FMAX M3\nL X+0 Y+0 FMAX M99\nL X+9 FMAX M99",
    );
    let (code, report) = folder.test("");
    assert_eq!(code, 0, "{report}");
    let warnings = report["warnings"].as_array().unwrap();
    assert!(
        warnings
            .iter()
            .any(|warning| warning["message"].as_str().unwrap().contains("sign")),
        "{report}"
    );
    let (code, report) = folder.test("--strict");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("WRONG SIGN PROGRAMMED"))
    );
}

#[test]
fn repeated_warnings_are_counted() {
    let folder = Folder::with_program("LBL 1\nTOOL CALL 9 Z S100\nCALL LBL 1 REP 4/4");
    let (_, report) = folder.test("");
    let warnings = report["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{report}");
    // Once and four repeats.
    assert_eq!(
        (&warnings[0]["block"], &warnings[0]["count"]),
        (&json!(2), &json!(5))
    );
    assert_eq!(report["tool_calls"].as_array().unwrap().len(), 5);
}

#[test]
fn rapid_cuts_are_reported() {
    let folder = Folder::with_program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+50 Y+50 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1\n\
         L X+25 Y+25 Z+5 R0 FMAX M3\nL Z-5 FMAX\nL Z-15 F100",
    );
    let (_, report) = folder.test("");
    let all: Vec<_> = report["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|w| (&w["block"], &w["message"]))
        .collect();
    assert_eq!(
        all,
        [
            (&json!(6), &json!("material is removed in rapid traverse")),
            (&json!(7), &json!("tool 1 is below the blank"))
        ]
    );
    // Without graphics nothing is removed, and nothing known of it.
    let (_, report) = folder.test("--no-graphics");
    assert_eq!(
        (&report["removed_mm3"], &report["warnings"]),
        (&json!(null), &json!([]))
    );
}

#[test]
fn the_resolution_can_be_chosen() {
    // A slot of 50 mm with a tool of radius 5 through the blank: 50 * 10 and a circle of 78.54, 2 mm deep.
    let folder = Folder::with_program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+100 Y+50 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S1\n\
         L X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL X+70",
    );
    let exact = 2.0 * (500.0 + std::f64::consts::PI * 25.0);
    for (option, tolerance) in [
        ("", 0.002),
        ("--resolution 0.05", 0.001),
        ("--resolution 1", 0.05),
    ] {
        let removed = number(&folder.test(option).1, "/removed_mm3");
        assert!(
            (removed / exact - 1.0).abs() < tolerance,
            "{option}: {removed}, exactly {exact}"
        );
    }
    let run = folder.bahn("test main.H --resolution 0.000001");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("too fine"), "{}", run.err());
    assert_eq!(folder.bahn("test main.H --resolution 0").code(), 2);
}

#[test]
fn a_picture_needs_a_blank() {
    let folder = Folder::with_program("L X+0 R0 F100");
    let run = folder.bahn("test main.H --image part.png");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("no BLK FORM"), "{}", run.err());
    assert_eq!(folder.names(), ["main.H"]);
}

#[test]
fn the_probe_touches_the_part_as_machined() {
    // A pocket of 3 mm depth is milled at the point that is then probed from above: the surface is at -3.
    let blocks = "
BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+40 Y+40 Z+0
TOOL DEF 1 L+0 R+8
TOOL CALL 1 Z S1000
L X+20 Y+20 Z+10 R0 FMAX M3
L Z-3 F100
L Z+10 FMAX
TCH PROBE 0.0 REF. PLANE Q10 Z-
TCH PROBE 0.1 X+20 Y+20 Z+0
L Z+20 FMAX";
    let folder = Folder::with_program(blocks);
    let (code, report) = folder.test("");
    assert_eq!(code, 0, "{report}");
    assert!((number(&report, "/q/10") + 3.0).abs() < 0.001, "{report}");
    // Without a part there is nothing to touch.
    let without = blocks
        .lines()
        .filter(|line| !line.starts_with("BLK"))
        .collect::<Vec<_>>()
        .join("\n");
    folder.write("main.H", program(&without));
    let (code, report) = folder.test("");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("TOUCH POINT INACCESSIBLE"))
    );
}

#[test]
fn called_programs_are_found_beside_the_caller() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("parts")).unwrap();
    folder.write(
        "parts/main.H",
        program("CALL PGM A\nCALL PGM B\nCALL PGM C\nCALL PGM D"),
    );
    for (name, x) in [("A", 1), ("B.H", 2), ("C.h", 3)] {
        folder.write(&format!("parts/{name}"), program(&format!("L X+{x} R0 F100")));
    }
    // Files that end with .I are in DIN/ISO.
    folder.write(
        "parts/D.I",
        "%D G71 *\nN10 G01 G40 G90 X+4 F100 *\nN99999 %D G71 *\n",
    );
    let run = folder.bahn("test parts/main.H --format json --path out.csv");
    assert_eq!(run.code(), 0, "{}", run.err());
    // Four calls and four movements.
    assert_eq!(run.json()["blocks_executed"], 8);
    let table = folder.read("out.csv");
    let ends: Vec<_> = rows(&table)
        .iter()
        .map(|row| (row[0].to_owned(), row[4].to_owned()))
        .collect();
    let expected = [("A", "1"), ("B.H", "2"), ("C.h", "3"), ("D.I", "4")];
    assert_eq!(ends, expected.map(|(name, x)| (name.to_owned(), x.to_owned())));
}

#[test]
fn errors_in_called_programs_name_them() {
    let folder = Folder::with_program("CALL PGM SUB");
    folder.write("SUB.H", program("\nL X+1 R0 F100\nCC X+0 Y+0\nC X+50 Y+50 DR+"));
    let (code, report) = folder.test("");
    assert_eq!(
        (code, &report["error"]["program"], &report["error"]["block"]),
        (1, &json!("SUB.H"), &json!(3))
    );
    assert!(folder.bahn("test main.H").err().contains("SUB.H:4"));
}

#[test]
fn text_reports_say_the_same() {
    let folder = Folder::with_program(SQUARE);
    let run = folder.bahn("test main.H --path out.csv --set Q5=2.5");
    assert_eq!(run.code(), 0);
    let out = run.out();
    for line in [
        "main.H (mm), TNC415B",
        "completed",
        "mm feed",
        "block 4: tool 1, 1000 rpm",
        "Q5 = 2.5",
        "out.csv",
    ] {
        assert!(out.contains(line), "{line} is not in\n{out}");
    }
}

#[test]
fn wrong_use_has_exit_code_2() {
    let folder = Folder::with_program("L X+0 R0 F100");
    for arguments in [
        "",
        "frobnicate",
        "test",
        "test nothing.H",
        "test main.H --format xml",
        "test main.H --path out.txt",
        "test main.H --path nowhere/out.csv",
        "test main.H --view plan",
        "test main.H --max-blocks 0",
        "test main.H --image part.png --size 5x5",
        "test main.H --unknown",
    ] {
        let run = folder.bahn(arguments);
        assert_eq!(run.code(), 2, "bahn {arguments}");
        assert!(!run.err().is_empty() && run.out().is_empty(), "bahn {arguments}");
    }
    for arguments in [
        "--help",
        "help",
        "help test",
        "test --help",
        "check --help",
        "fmt --help",
        "--version",
    ] {
        let run = folder.bahn(arguments);
        assert_eq!(run.code(), 0, "bahn {arguments}");
        assert!(run.err().is_empty() && !run.out().is_empty(), "bahn {arguments}");
    }
    assert!(
        folder
            .bahn("test --help")
            .out()
            .contains("bahn test part.h --image part.png --view 3d")
    );
}

#[test]
fn q_parameters_are_set() {
    let folder = Folder::with_program("FN1: Q3 = +Q1 + +Q2\nL X+Q3 R0 F100");
    for arguments in [
        "--set Q1=5 --set Q2=-7.5",
        "--set Q1=5,Q2=-7.5",
        "--set q1=+5,Q2=-7.5",
    ] {
        let (code, report) = folder.test(arguments);
        assert_eq!(code, 0);
        assert_near(number(&report, "/q/3"), -2.5);
        assert_near(number(&report, "/final_position/X"), -2.5);
    }
    for wrong in [
        "--set Q1",
        "--set 1=5",
        "--set Q1=x",
        "--set Q9999=1",
        "--set Q1=5,5",
    ] {
        let run = folder.bahn(&format!("test main.H {wrong}"));
        assert_eq!(run.code(), 2, "{wrong}");
        assert!(run.err().contains("--set"), "{}", run.err());
    }
}

#[test]
fn tools_come_from_a_table() {
    let folder = Folder::with_program(
        "TOOL CALL 2 Z S500\nL X+0 Y+0 R0 FMAX\nL X+20 Y+0 RR F100\nL X+50\nL X+50 Y+40\nL Y+60",
    );
    folder.write("tools.txt", "T L R R2 NAME\n2 100 4 0 END MILL\n");
    let (code, report) = folder.test("--tools tools.txt --path out.csv");
    assert_eq!(code, 0, "{report}");
    assert_near(number(&report, "/q/108"), 4.0);
    assert_near(number(&report, "/q/114"), 100.0);
    // With RR the centre runs 4 mm on the right of +X.
    assert_eq!(rows(&folder.read("out.csv"))[1][5], "-4");
    // A tool that is not in the table is an error, and so is a table that cannot be read.
    folder.write("tools.txt", "T L R\n1 100 4\n");
    let (code, report) = folder.test("--tools tools.txt");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("TOOL NOT DEFINED"))
    );
    folder.write("tools.txt", "T L R\n1 100 x\n");
    let run = folder.bahn("test main.H --tools tools.txt");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("tools.txt: line 2: R: `x` is no number"),
        "{}",
        run.err()
    );
    assert_eq!(folder.bahn("test main.H --tools nothing.txt").code(), 2);
}

#[test]
fn machine_parameters_come_from_list_and_options() {
    // MP1060: the ramps of 100 mm at 100 mm/s take v / a = 0.1 s at 1 m/s², 1 s at 0.1 m/s².
    let folder = Folder::with_program("L X+0 R0 F6000\nL X+100");
    let time = |arguments: &str| number(&folder.test(arguments).1, "/machining_time_s");
    assert_near(time(""), 1.1);
    assert_near(time("--mp 1060.0=0.1"), 2.0);
    folder.write("machine.mp", "; slow\nMP1060.0 : 0.1 ;m/s2\n");
    assert_near(time("--parameters machine.mp"), 2.0);
    // Single ones replace those of the list; MP1010.0 = 3000 mm/min is 50 mm/s with a ramp of 0.05 s.
    assert_near(time("--parameters machine.mp --mp 1060.0=1,1010.0=3000"), 2.05);
    for wrong in [
        "--mp 1060.0",
        "--mp 1060.0=-1",
        "--mp 9999=1",
        "--parameters nothing.mp",
    ] {
        assert_eq!(folder.bahn(&format!("test main.H {wrong}")).code(), 2, "{wrong}");
    }
    folder.write("machine.mp", "MP1060.0 : much\n");
    let run = folder.bahn("test main.H --parameters machine.mp");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("machine.mp: line 1"), "{}", run.err());
}

#[test]
fn the_override_acts_on_the_time() {
    let folder = Folder::with_program("L X+0 R0 F600\nL X+100");
    // 100 mm at 10, 5, 15 mm/s, and v / a for the ramps.
    for (percent, time) in [("100", 10.01), ("50", 20.005), ("150", 100.0 / 15.0 + 0.015)] {
        let (_, report) = folder.test(&format!("--override {percent}"));
        assert_near(number(&report, "/machining_time_s"), time);
    }
    let (code, report) = folder.test("--override 0");
    assert_eq!(
        (code, &report["machining_time_s"], &report["completed"]),
        (0, &json!(null), &json!(true))
    );
    for wrong in ["151", "-1", "x"] {
        assert_eq!(folder.bahn(&format!("test main.H --override={wrong}")).code(), 2);
    }
}

#[test]
fn auxiliary_times_are_options() {
    let folder = Folder::with_program("TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S100\nL Z+0 R0 FMAX M3\nM8");
    let time = |arguments: &str| number(&folder.test(arguments).1, "/machining_time_s");
    // Tool change 6 s and spindle start 1 s by default.
    assert_near(time(""), 7.0);
    // 20 + 3 and two M functions of 0.5 s.
    assert_near(time("--tool-change-time 20 --spindle-time 3 --m-time 0.5"), 24.0);
    assert_eq!(folder.bahn("test main.H --m-time=-1").code(), 2);
}

#[test]
fn optional_blocks_are_passed_over() {
    let folder = Folder::with_program("L X+0 R0 F100\n/L X+10\nL X+1");
    assert_near(number(&folder.test("").1, "/path_mm/feed"), 19.0);
    let (_, report) = folder.test("--skip-blocks");
    assert_near(number(&report, "/path_mm/feed"), 1.0);
    assert_eq!(report["blocks_executed"], 2);
}

#[test]
fn the_start_position_adds_the_first_way() {
    let folder = Folder::with_program("L X+10 Y+0 R0 F100");
    let (_, report) = folder.test("--start X4,Y8,Z-2.5");
    // hypot(6, 8)
    assert_near(number(&report, "/path_mm/feed"), 10.0);
    assert_eq!(report["final_position"], json!({"X": 10.0, "Y": 0.0, "Z": -2.5}));
    for wrong in [
        "--start Q1",
        "--start X",
        "--start X1,X2",
        "--start X1e9",
        "--start X=nan",
    ] {
        assert_eq!(folder.bahn(&format!("test main.H {wrong}")).code(), 2, "{wrong}");
    }
}

#[test]
fn models_differ() {
    // Formulas came with the TNC 407; WRONG RPM is the text of the TNC 360.
    let folder = Folder::with_program("Q1 = SIN 30 + 2");
    assert_near(number(&folder.test("--model tnc415b").1, "/q/1"), 2.5);
    assert_eq!(folder.test("--model tnc360").0, 1);
    let folder = Folder::with_program("TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S99999.5");
    assert_eq!(folder.test("--model tnc360").1["error"]["message"], "WRONG RPM");
    assert_eq!(
        folder.test("--model tnc415b").1["error"]["message"],
        "WRONG SPINDLE SPEED"
    );
    assert_eq!(folder.bahn("test main.H --model tnc430").code(), 2);
}
