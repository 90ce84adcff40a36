//! Programs and situations that would break a weaker command.

use std::fs::File;
use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{Folder, number, program};
use serde_json::json;

#[test]
fn a_missing_called_program_is_an_error() {
    let folder = Folder::with_program("CALL PGM NOWHERE");
    let (code, report) = folder.test("");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("PROGRAM NOT FOUND"))
    );
    assert_eq!(report["error"]["block"], 1);
}

#[test]
fn recursion_ends_with_its_message() {
    for call in ["CALL PGM main", "CALL PGM MAIN.H", "LBL 1\nCALL LBL 1\nLBL 0"] {
        let folder = Folder::with_program(call);
        folder.write("MAIN.H", program(call));
        let (code, report) = folder.test("");
        assert_eq!(
            (code, &report["error"]["message"]),
            (1, &json!("EXCESSIVE SUBPROGRAMMING")),
            "{call}"
        );
    }
}

#[test]
fn a_contour_that_does_not_close_is_an_error() {
    let folder = Folder::with_program(
        "TOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S500\nCYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1\n\
         CYCL DEF 6.0 ROUGH-OUT\nCYCL DEF 6.1 SET UP -2 DEPTH -5\nCYCL DEF 6.2 PECKG -5 F100 ALLOW +0\n\
         CYCL DEF 6.3 ANGLE +0 F200\nL X+0 Y+0 Z+2 R0 FMAX M3\nCYCL CALL\nM2\n\
         LBL 1\nL X+0 Y+0 RR\nL X+50\nL Y+50\nLBL 0",
    );
    let (code, report) = folder.test("");
    assert_eq!(
        (code, report["completed"].as_bool()),
        (1, Some(false)),
        "{report}"
    );
    assert_ne!(report["error"]["message"], json!(""));
}

#[test]
fn a_radius_that_is_too_large_is_an_error() {
    let folder = Folder::with_program(
        "TOOL DEF 1 L+0 R+20\nTOOL CALL 1 Z S500\nL X-50 Y+0 R0 FMAX\nL X+0 Y+0 RL F100\nL X+50\nL Y+10\nL X+60\nL Y+0\nL X+100\nL X+150 R0",
    );
    let (code, report) = folder.test("");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("TOOL RADIUS TOO LARGE")),
        "{report}"
    );
}

#[test]
fn a_q_parameter_out_of_range_is_an_error() {
    let folder = Folder::with_program("FN0: Q400 = +1");
    assert_eq!(folder.test("").0, 1);
}

#[test]
fn endless_loops_end_after_a_number_of_blocks() {
    let folder = Folder::with_program("LBL 1\nFN1: Q1 = +Q1 + +1\nFN9: IF +0 EQU +0 GOTO LBL 1");
    let (code, report) = folder.test("--max-blocks 3000");
    assert_eq!((code, &report["error"]["message"]), (1, &json!("ENDLESS LOOP")));
    // Three blocks a round.
    assert_eq!(number(&report, "/q/1"), 1000.0);
}

#[test]
fn a_file_of_half_a_gigabyte_of_nuls_is_answered_at_once() {
    let folder = Folder::new();
    File::create(folder.path("main.H"))
        .unwrap()
        .set_len(500_000_000)
        .unwrap();
    let started = Instant::now();
    let (code, report) = folder.test("");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("END PGM MISSING"))
    );
    assert_eq!(folder.bahn("check main.H").code(), 1);
    assert!(
        started.elapsed() < Duration::from_secs(30),
        "{:?}",
        started.elapsed()
    );
}

#[test]
fn a_file_that_is_too_large_is_refused() {
    let folder = Folder::new();
    File::create(folder.path("main.H"))
        .unwrap()
        .set_len(2 << 30)
        .unwrap();
    let (code, report) = folder.test("");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("FURTHER PROGRAM ENTRY IMPOSSIBLE"))
    );
    let run = folder.bahn("check main.H");
    assert!(
        run.code() == 1 && run.err().contains("FURTHER PROGRAM ENTRY IMPOSSIBLE"),
        "{}",
        run.err()
    );
    assert_eq!(folder.bahn("fmt --write main.H").code(), 2);
}

#[test]
fn any_bytes_are_answered() {
    let folder = Folder::new();
    // A small generator of bytes, biased to what programs are made of.
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let words = [
        "L ",
        "X+",
        "Y-",
        "CYCL DEF ",
        "FN",
        "Q1",
        "CALL LBL 1",
        "LBL 1",
        "\n",
        " ",
        "R",
        "\0",
        "é",
        "~",
        "9",
    ];
    for _ in 0..30 {
        let mut file = Vec::new();
        for _ in 0..400 {
            let value = next();
            if value % 5 == 0 {
                file.push((value >> 8) as u8);
            } else {
                file.extend_from_slice(words[(value >> 8) as usize % words.len()].as_bytes());
            }
        }
        folder.write("main.H", &file);
        for arguments in [
            "test main.H --max-blocks 100000 --path out.csv",
            "check main.H",
            "fmt main.H",
        ] {
            let run = folder.bahn(arguments);
            assert!(
                [0, 1, 2].contains(&run.code()),
                "{arguments}: {} {file:?}",
                run.err()
            );
            assert!(!run.err().contains("panicked"), "{}", run.err());
        }
    }
}

/// Starts a run, lets it work for a moment, sends SIGINT.
fn interrupted(folder: &Folder, arguments: &[&str]) -> (Option<i32>, serde_json::Value) {
    let mut child = folder
        .command()
        .args(["test", "main.H", "--format", "json"])
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(600));
    assert!(child.try_wait().unwrap().is_none(), "it is still running");
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    let mut json = String::new();
    child.stdout.take().unwrap().read_to_string(&mut json).unwrap();
    (child.wait().unwrap().code(), serde_json::from_str(&json).unwrap())
}

/// The program is done at once; the picture and the mesh would take far longer.
#[test]
fn ctrl_c_ends_picture_and_mesh() {
    let folder = Folder::with_program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-40\nBLK FORM 0.2 X+100 Y+100 Z+0\nTOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S500\n\
         L X+0 Y+0 Z+2 R0 FMAX M3\nL X+100 Y+100 Z-30 F1000",
    );
    for arguments in [
        "--image out.png --view 3d --size 8000x8000",
        "--image out.png --view plan --size 8000x8000",
        "--image out.png --view three-planes --size 8000x8000",
        "--mesh out.stl --resolution 0.02",
    ] {
        let arguments: Vec<_> = arguments.split(' ').collect();
        let (code, report) = interrupted(&folder, &arguments);
        assert_eq!(
            (code, report["completed"].as_bool()),
            (Some(130), Some(true)),
            "{report}"
        );
        let names = folder.names();
        assert!(names.iter().all(|name| name == "main.H"), "{names:?}");
    }
}

#[test]
fn ctrl_c_gives_the_report_so_far() {
    // Moves and comes to no end.
    let folder = Folder::with_program("L X+0 R0 F1000\nLBL 1\nL IX+1\nL IX-1\nFN9: IF +0 EQU +0 GOTO LBL 1");
    let (code, report) = interrupted(&folder, &["--path", "out.csv"]);
    assert_eq!(
        (code, &report["completed"], &report["error"]),
        (Some(130), &json!(false), &json!(null))
    );
    assert!(number(&report, "/path_mm/feed") > 1000.0, "{report}");
    // The table so far is complete to the last row.
    let table = folder.read("out.csv");
    assert!(table.ends_with('\n') && table.lines().all(|line| line.matches(',').count() == 16));
    assert_eq!(folder.names(), ["main.H", "out.csv"]);
}

#[test]
fn ctrl_c_ends_a_loop_without_movements() {
    let folder = Folder::with_program("LBL 1\nFN1: Q1 = +Q1 + +1\nFN9: IF +0 EQU +0 GOTO LBL 1");
    let (code, report) = interrupted(&folder, &["--max-blocks", "1000000000000"]);
    assert_eq!((code, &report["completed"]), (Some(130), &json!(false)));
    assert!(number(&report, "/q/1") > 1000.0);
}

#[test]
fn a_closed_output_is_no_panic() {
    let folder = Folder::with_program(&"L X+1 R0 F100\n".repeat(50_000));
    for arguments in [
        &["fmt", "main.H"][..],
        &["test", "main.H", "--format", "json"],
        &["explain"],
    ] {
        let mut child = folder
            .command()
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.is_empty(), "{arguments:?}: {errors}");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
    }
}

#[test]
fn a_file_that_cannot_be_written_leaves_the_old_one() {
    let folder = Folder::with_program("L X+0 R0 F100");
    folder.write("out.csv", "old");
    // The run fails before the table is complete: the resolution does not fit the blank.
    folder.write(
        "main.H",
        program("BLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+50 Y+50 Z+0\nL X+0 R0 F100"),
    );
    let run = folder.bahn("test main.H --path out.csv --resolution 0.000001");
    assert_eq!(run.code(), 2);
    assert_eq!(folder.read("out.csv"), "old");
    assert_eq!(folder.names(), ["main.H", "out.csv"]);
}

fn mill() -> String {
    format!("{}/../../../machines/mill", env!("CARGO_MANIFEST_DIR"))
}

/// Files that are something else have a fault in each line: a hundred are shown, the others counted.
#[test]
fn a_hundred_faults_of_a_file_are_shown() {
    let folder = Folder::with_program("L X+0 R0 F100");
    folder.write("junk.PLC", "JUNK\n".repeat(100_000));
    for arguments in [
        "plc check junk.PLC".to_owned(),
        "plc run junk.PLC".to_owned(),
        "mp check junk.PLC --model tnc415b".to_owned(),
        format!("run main.H --machine {} --fresh --script junk.PLC", mill()),
    ] {
        let run = folder.bahn(&arguments);
        assert_eq!(run.code(), 1, "{arguments}");
        let shown = run.err().matches("| JUNK").count();
        assert_eq!(shown, 100, "{arguments}");
        assert!(run.err().contains("more"), "{arguments}: {}", run.err());
    }
    let report = folder.bahn("plc check junk.PLC --format json").json();
    assert_eq!(
        (report["errors"].as_array().unwrap().len(), &report["not_listed"]),
        (1000, &json!(99_000))
    );
}

/// The lines that are executed from one cycle to another have no end: the trace has, and says so.
#[test]
fn a_trace_is_bounded() {
    let folder = Folder::new();
    folder.write("MAIN.PLC", "L M1\n= M2\nEM\n");
    // Three lines a cycle.
    let report = folder.bahn("plc run MAIN.PLC --cycles 50000 --trace --format json");
    assert_eq!(report.code(), 0);
    let report = report.json();
    assert_eq!(
        (
            report["trace"].as_array().unwrap().len(),
            &report["trace_left_off"]
        ),
        (100_000, &json!(50_000))
    );
    let text = folder.bahn("plc run MAIN.PLC --cycles 50000 --trace").out();
    assert!(text.contains("\n50000 more lines were executed; 100000 are shown at most\n"));
    let report = folder
        .bahn("plc run MAIN.PLC --cycles 2 --trace --format json")
        .json();
    assert_eq!(report["trace_left_off"], json!(0));
}

/// Expectations cost no more when there are many.
#[test]
fn a_hundred_thousand_expectations_are_reported_at_once() {
    let folder = Folder::with_program("TOOL CALL 1 Z S500\nL X+0 R0 F100");
    folder.write("MAIN.PLC", "L M1\n= M2\nEM\n");
    folder.write("p.txt", "1: expect M2=1\n".repeat(100_000));
    folder.write("s.txt", "1: expect mode manual\n".repeat(100_000));
    let started = Instant::now();
    let run = folder.bahn("plc run MAIN.PLC --script p.txt --junit p.xml");
    assert_eq!(
        (run.code(), folder.read("p.xml").matches("<failure").count()),
        (1, 100_000)
    );
    assert_eq!(run.err().matches(" --> p.txt:").count(), 100);
    let run = folder.bahn(&format!(
        "run main.H --machine {} --fresh --no-graphics --script s.txt --junit s.xml",
        mill()
    ));
    let cases = folder.read("s.xml").matches("<testcase").count();
    assert!(cases >= 100_000, "{cases} {}", run.err());
    assert!(
        started.elapsed() < Duration::from_secs(90),
        "{:?}",
        started.elapsed()
    );
}

/// A medium that is full: every other file and the report are there, and the exit code says what is not.
#[cfg(target_os = "linux")]
#[test]
fn a_full_medium_loses_no_report() {
    let folder = Folder::with_program("TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX\nL X+0 Y+0 FMAX\nL X+10 F1000");
    folder.write("MAIN.PLC", "L M1\n= M2\nEM\n");
    folder.write("s.txt", "1: expect M1=0\n");
    std::os::unix::fs::symlink("/dev/full", folder.path("full.csv")).unwrap();
    for output in [
        "--record full.csv --log good.txt",
        "--log full.csv --record good.txt",
        "--path full.csv --record good.txt",
        "--script s.txt --junit full.csv --operator full --record good.txt",
    ] {
        let run = folder.bahn(&format!(
            "run main.H --machine {} --fresh --no-graphics --format json {output}",
            mill()
        ));
        assert_eq!(run.code(), 2, "{output}: {}", run.err());
        assert!(run.err().contains("No space left"), "{output}: {}", run.err());
        assert!(run.json()["completed"].is_boolean(), "{output}");
        assert!(folder.read("good.txt").lines().count() > 1, "{output}");
        std::fs::remove_file(folder.path("good.txt")).unwrap();
    }
    let way: String = (0..3000)
        .map(|x| format!("L X+{x} Y+{} R0 F1000\n", x % 7))
        .collect();
    folder.write("long.H", program(&way));
    for name in ["main.H", "long.H"] {
        let run = folder.bahn(&format!(
            "test {name} --no-graphics --format json --path full.csv"
        ));
        assert_eq!(run.code(), 2, "{name}: {}", run.err());
        assert!(run.err().contains("No space left"), "{name}: {}", run.err());
        assert_eq!(run.json()["completed"], true, "{name}");
    }
    for output in [
        "--record full.csv --junit good.txt",
        "--junit full.csv --record good.txt",
    ] {
        let run = folder.bahn(&format!(
            "plc run MAIN.PLC --script s.txt --cycles 20000 --format json {output}"
        ));
        assert_eq!(run.code(), 2, "{output}: {}", run.err());
        assert!(run.json()["values"].is_object(), "{output}");
        assert!(folder.read("good.txt").lines().count() > 1, "{output}");
        std::fs::remove_file(folder.path("good.txt")).unwrap();
    }
}
