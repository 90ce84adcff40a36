//! `bahn test` with many programs: which ones, the table, its files, comparisons.

use std::fs;
use std::io::Write;
use std::process::Stdio;

use crate::support::{Folder, Run, assert_near, number, program};
use serde_json::Value;

/// A slot of 40 mm along X with a tool of radius 5, 2 mm deep; times and lengths follow from it.
fn slot(tool: u32, feed: u32) -> String {
    program(&format!(
        "BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+100 Y+50 Z+0\nTOOL DEF {tool} L+0 R+5\n\
         TOOL CALL {tool} Z S1000\nL X+20 Y+25 Z+5 R0 FMAX M3\nL Z-2 F100\nL X+60 F{feed}\nL Z+5 FMAX M2"
    ))
}

/// Three programs, one of them with an error in block 2.
fn shelf() -> Folder {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("parts/deep")).unwrap();
    folder
        .write("parts/b.H", slot(7, 500))
        .write("parts/a.h", slot(1, 400))
        .write("parts/deep/c.h", program("L X+0 R0 F100\nCALL LBL 9"))
        .write("parts/notes.txt", "no program")
        .write("parts/d.i", slot(1, 400));
    folder
}

fn programs(run: &Run) -> Vec<Value> {
    run.json()["programs"].as_array().unwrap().clone()
}

fn paths(rows: &[Value]) -> Vec<&str> {
    rows.iter().map(|row| row["path"].as_str().unwrap()).collect()
}

#[test]
fn folders_are_taken_with_all_that_is_in_them() {
    let folder = shelf();
    let run = folder.bahn("test parts --format json");
    assert_eq!(run.code(), 1);
    let rows = programs(&run);
    assert_eq!(paths(&rows), ["parts/a.h", "parts/b.H", "parts/deep/c.h"]);
    let run = folder.bahn("test parts --ext i,.TXT --format json");
    assert_eq!(paths(&programs(&run)), ["parts/d.i", "parts/notes.txt"]);
    // Named twice is run once, in the order of the command line.
    let run = folder.bahn("test parts/b.H parts --format json");
    assert_eq!(
        paths(&programs(&run)),
        ["parts/b.H", "parts/a.h", "parts/deep/c.h"]
    );
    let run = folder.bahn("test parts --ext xyz");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("no program with the ending xyz"),
        "{}",
        run.err()
    );
}

#[test]
fn names_come_from_standard_input() {
    let folder = shelf();
    let mut child = folder
        .command()
        .args(["test", "-", "--format", "json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let list = b"parts/b.H\r\n\nparts/missing.h\nparts/a.h\n";
    child.stdin.take().unwrap().write_all(list).unwrap();
    let run = Run(child.wait_with_output().unwrap());
    // One that cannot be read does not stop the others.
    assert_eq!(run.code(), 1);
    let rows = programs(&run);
    assert_eq!(paths(&rows), ["parts/b.H", "parts/missing.h", "parts/a.h"]);
    let results: Vec<_> = rows.iter().map(|row| row["result"].as_str().unwrap()).collect();
    assert_eq!(results, ["ok", "unreadable", "ok"]);
}

#[test]
fn a_row_says_what_the_run_came_to() {
    let folder = Folder::new();
    folder.write("a.h", slot(7, 400));
    let run = folder.bahn("test a.h --density 7.85 --format json --no-such");
    assert_eq!(run.code(), 2);
    let run = folder.bahn("test a.h --density 7.85 --format json --datum Z-300");
    assert_eq!(run.code(), 0, "{}", run.err());
    let row = &programs(&run)[0];
    assert_near(number(row, "/feed_mm"), 7.0 + 40.0);
    assert_near(number(row, "/rapid_mm"), 7.0);
    assert_eq!(row["blank_mm"], serde_json::json!([100.0, 50.0, 10.0]));
    assert_eq!(row["finished_mm"], serde_json::json!([100.0, 50.0, 10.0]));
    // A rectangle and a circle, 2 mm deep. 250,000 columns of 0.14 mm err by half a column along the outline.
    let removed = (40.0 * 10.0 + std::f64::consts::PI * 25.0) * 2.0;
    let outline = 2.0 * 40.0 + std::f64::consts::PI * 10.0;
    let error = outline * 0.5 * (100.0 * 50.0 / 250_000.0_f64).sqrt() * 2.0;
    let measured = number(row, "/removed_mm3");
    assert!((measured - removed).abs() < error, "{measured} is not {removed}");
    assert_near(number(row, "/removed_kg"), measured * 7.85e-6);
    assert_near(number(row, "/finished_kg"), (50_000.0 - measured) * 7.85e-6);
    // One tool, with all of the feed path and all time but the moves before its call.
    let tools = row["tools"].as_array().unwrap();
    assert_eq!(tools.len(), 1);
    assert_eq!(tools[0]["tool"], 7);
    assert_near(number(&tools[0], "/feed_mm"), 47.0);
    assert_near(number(&tools[0], "/time_s"), number(row, "/machining_time_s"));
    assert_eq!(
        (number(row, "/travel/Z/least"), number(row, "/travel/Z/greatest")),
        (-2.0, 5.0)
    );
    assert_eq!(
        (number(row, "/travel/X/least"), number(row, "/travel/X/greatest")),
        (20.0, 60.0)
    );
    assert_eq!(row["warnings"], serde_json::json!([]));
}

#[test]
fn the_travel_is_held_against_the_traverse_range() {
    let folder = Folder::new();
    folder.write("a.h", program("L X+0 Y+0 Z+0 R0 FMAX\nL X+300 FMAX"));
    let fits = |arguments: &str| {
        let run = folder.bahn(&format!(
            "test a.h --density 1 --format json --mp 910.0=200,920.0=-100 {arguments}"
        ));
        programs(&run)[0]["travel"]["X"]["fits"].as_bool().unwrap()
    };
    // 300 mm in a range of 300: without a datum it can fit, at X-100 it does, at X-99 it does not.
    assert!(fits(""));
    assert!(fits("--datum X-100"));
    assert!(!fits("--datum X-99"));
    assert!(!fits("--mp 910.0=199"));
}

#[test]
fn the_table_names_results_and_totals() {
    let folder = shelf();
    let run = folder.bahn("test parts");
    let out = run.out();
    let line = |name: &str| {
        out.lines()
            .find(|line| line.starts_with(name))
            .unwrap()
            .to_owned()
    };
    assert!(line("parts/a.h").contains(" OK "), "{out}");
    assert!(line("parts/deep/c.h").contains(" error "), "{out}");
    assert!(out.contains("LABEL NUMBER NOT ALLOCATED at block 2"), "{out}");
    assert!(out.contains("3 programs: 2 OK, 1 with errors"), "{out}");
    let run = folder.bahn("test parts/a.h parts/b.H");
    assert_eq!((run.code(), run.err().as_str()), (0, ""));
}

#[test]
fn the_csv_has_points_or_commas() {
    let folder = shelf();
    folder.bahn("test parts --report out.csv --report out.json --report out.html");
    let csv = folder.read("out.csv");
    assert_eq!(csv.lines().count(), 4, "{csv}");
    assert!(csv.starts_with("path,result,message,program,block,"), "{csv}");
    let error: Vec<&str> = csv.lines().nth(3).unwrap().split(',').take(6).collect();
    assert_eq!(
        error,
        [
            "parts/deep/c.h",
            "error",
            "LABEL NUMBER NOT ALLOCATED",
            "c.h",
            "2",
            "3"
        ]
    );
    let json: Value = serde_json::from_str(&folder.read("out.json")).unwrap();
    assert_eq!(json["totals"]["errors"], 1);
    // The page has everything in it: nothing is loaded from elsewhere.
    let html = folder.read("out.html");
    assert_eq!(html.matches("data:image/png;base64,").count(), 2);
    assert_eq!(html.matches("<tr class=").count(), 3);
    assert!(!html.contains("http") && !html.contains("<link"), "{html}");
    folder.bahn("test parts --report out.csv --comma");
    let csv = folder.read("out.csv");
    assert!(csv.starts_with("\u{feff}path;result;"), "{csv}");
    // 0.22360679... mm columns: the volume has decimals, with a comma.
    let volume = csv.lines().nth(1).unwrap().split(';').nth(17).unwrap();
    assert!(volume.contains(',') && !volume.contains('.'), "{volume}");
}

#[test]
fn another_run_shows_what_changes() {
    let folder = shelf();
    folder.write("slow.mp", "MP1010.0 : 1000\nMP1010.2 : 1000\n");
    folder.write("tools.t", "T L R\n1 0 4\n");
    folder.write("p.h", slot(1, 400).replace("TOOL DEF 1 L+0 R+5\n", ""));
    let changes = |arguments: &str| {
        let run = folder.bahn(&format!("test {arguments} --format json"));
        let rows = run.json()["programs"].as_array().unwrap().clone();
        rows.into_iter()
            .map(|row| row["changes"].as_array().unwrap().clone())
            .collect::<Vec<_>>()
    };
    // Parameters: 7 mm in rapid traverse take longer at 1000 mm/min.
    let seen = changes("parts/a.h --against slow.mp");
    assert_eq!(seen[0].len(), 1, "{seen:?}");
    assert!(seen[0][0].as_str().unwrap().starts_with("time "), "{seen:?}");
    assert_eq!(
        changes("parts/a.h --parameters slow.mp --against slow.mp"),
        [Vec::<Value>::new()]
    );
    // Tools: without the table the tool has no radius and there is a warning more.
    let seen = format!("{:?}", changes("p.h --against tools.t"));
    assert!(
        seen.contains("removed") && seen.contains("warnings 0 -> 2"),
        "{seen}"
    );
    // Earlier reports, of both kinds, and a program that is new.
    for report in ["before.json", "before.csv"] {
        folder.bahn(&format!("test parts/a.h parts/deep --report {report}"));
        let seen = changes(&format!("parts --against {report}"));
        assert_eq!(format!("{seen:?}"), "[[], [String(\"new\")], []]");
        folder.write("parts/a.h", slot(1, 200));
        let seen = changes(&format!("parts/a.h --against {report}"));
        assert!(
            seen[0][0].as_str().unwrap().starts_with("time 0:00:1"),
            "{seen:?}"
        );
        folder.write("parts/a.h", slot(1, 400));
    }
    // A machine, which must be there.
    let run = folder.bahn("test parts --against nowhere");
    assert_eq!(run.code(), 2);
    let machine = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill");
    let run = folder.bahn(&format!("test parts/a.h --against {machine}"));
    assert!(run.out().contains("1 changed"), "{}{}", run.out(), run.err());
}

#[test]
fn subprograms_are_judged_where_they_are_called() {
    let folder = Folder::new();
    folder
        .write("main.h", program("L X+0 R0 F100\nCALL PGM SUB"))
        // Without a feed of its own it fails alone.
        .write("SUB.H", program("L X+10 R0"))
        .write("alone.h", program("L X+10 R0"));
    let run = folder.bahn("test . --format json");
    let rows = programs(&run);
    let results: Vec<_> = rows
        .iter()
        .map(|row| (row["path"].as_str().unwrap(), row["result"].as_str().unwrap()))
        .collect();
    assert_eq!(
        results,
        [("./SUB.H", "called"), ("./alone.h", "error"), ("./main.h", "ok")]
    );
    assert_eq!(run.json()["totals"]["errors"], 1);
}

#[test]
fn a_program_without_end_stops_neither_the_others_nor_the_table() {
    let folder = Folder::new();
    // More endless ones than there are workers on most machines.
    for number in 0..4 {
        folder.write(
            &format!("endless{number}.h"),
            program("LBL 1\nL X+0 R0 F100\nL X+10\nFN9: IF +0 EQU +0 GOTO LBL 1"),
        );
    }
    folder.write("last.h", slot(1, 400));
    let run = folder.bahn("test . --time-limit 0.3 --format json");
    assert_eq!(run.code(), 1);
    let rows = programs(&run);
    let results: Vec<_> = rows.iter().map(|row| row["result"].as_str().unwrap()).collect();
    assert_eq!(
        results,
        ["time_limit", "time_limit", "time_limit", "time_limit", "ok"]
    );
    // A single program has a report so far.
    let run = folder.bahn("test endless0.h --time-limit 0.3 --format json");
    assert_eq!(run.code(), 1);
    assert_eq!(run.json()["completed"], false);
    assert!(run.err().contains("time limit"), "{}", run.err());
}

#[cfg(unix)]
#[test]
fn ctrl_c_gives_the_table_so_far() {
    let folder = Folder::new();
    folder.write("a.h", slot(1, 400)).write(
        "b.h",
        program("LBL 1\nL X+0 R0 F100\nL X+10\nFN9: IF +0 EQU +0 GOTO LBL 1"),
    );
    for number in 0..8 {
        fs::copy(folder.path("b.h"), folder.path(&format!("c{number}.h"))).unwrap();
    }
    let child = folder
        .command()
        .args(["test", ".", "--format", "json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(2));
    let killed = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    let run = Run(child.wait_with_output().unwrap());
    assert_eq!(run.code(), 130, "{}", run.err());
    let rows = programs(&run);
    assert_eq!((rows.len(), rows[0]["result"].as_str()), (10, Some("ok")));
    assert_eq!(rows[1]["result"], "interrupted");
}

#[test]
fn outputs_of_one_program_are_refused_for_many() {
    let folder = shelf();
    let run = folder.bahn("test parts --image a.png");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("--image belongs to a single program"),
        "{}",
        run.err()
    );
}

#[test]
fn outputs_never_overwrite_inputs_or_each_other() {
    let folder = Folder::with_program("L X+0 R0 F100");
    folder.write("path.csv", program("L X+0 R0 F100"));
    let before = folder.read("path.csv");
    for arguments in [
        "test path.csv --path path.csv",
        "test path.csv --path ./path.csv",
        "test . --ext csv --report path.csv",
        "test main.H --path a.csv --path a.csv",
        "test main.H --image a.png --mesh a.png",
        "run main.H --machine m --script path.csv --log path.csv",
        "scope path.csv -o path.csv",
        "run main.H --machine m --script path.csv --junit path.csv",
        "run main.H --machine m --script s.txt --junit a.xml --record a.xml",
        "plc run path.csv --record path.csv",
        "plc run main.H --script path.csv --junit path.csv",
        "plc run main.H --retain path.csv --record path.csv",
        "plc run main.H --record a.csv --junit a.csv",
        "test path.csv --print main.H",
    ] {
        let run = folder.bahn(arguments);
        assert_eq!(run.code(), 2, "{arguments}");
        assert_eq!(folder.read("path.csv"), before, "{arguments}");
        let said = run.err();
        assert!(
            said.contains("already an")
                || said.contains("does not replace")
                || arguments.starts_with("scope"),
            "{arguments}: {said}"
        );
    }
    assert_eq!(folder.names(), ["main.H", "path.csv"]);
}

#[test]
fn a_file_that_is_not_there_has_its_neighbours_named() {
    let folder = Folder::with_program("L X+0 R0 F100");
    folder.write("bracket.h", "").write("other.txt", "");
    let said = |arguments: &str| folder.bahn(arguments).err();
    assert!(
        said("test braket.h").contains("similar names there: bracket.h"),
        "{}",
        said("test braket.h")
    );
    assert!(said("check main.nc").contains("main.H"));
    assert!(said("test zzzzz.h").contains("there is bracket.h, main.H, other.txt"));
    assert!(said("test no/such.h").contains("there is no folder no"));
}

#[test]
fn negative_values_of_options_are_read() {
    let folder = Folder::with_program("FN0: Q1 = +Q2\nL IX-1 R0 F100\nL X+0 Y+0 Z+0 FMAX M91");
    let (code, report) =
        folder.test("--start X-5,Y-3 --set Q2=-4 --mp 960.0=-5,960.1=-6 --datum Z-7 --tool-change Z-1");
    assert_eq!(code, 0, "{report}");
    assert_near(number(&report, "/q/1"), -4.0);
    // MP960 lies at X-5, and a datum at Z-7 has machine zero above it.
    assert_eq!(
        report["final_position"],
        serde_json::json!({"X": -5.0, "Y": -6.0, "Z": 7.0})
    );
}
