//! `bahn run`: what is reported when something is not as it should be, and what goes on beside the run.

use std::path::{Path, PathBuf};

use crate::support::{Folder, Run, number, program};
use serde_json::{Value, json};

const PROGRAM: &str = "TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX\nL X+0 Y+0 FMAX\nL X+40 F1000\nL X+0 F1000";

fn mill() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/mill")
}

fn run(folder: &Folder, arguments: &str) -> Run {
    folder.bahn(&format!(
        "run main.H --machine {} --fresh --no-graphics {arguments}",
        mill().display()
    ))
}

fn report(folder: &Folder, arguments: &str) -> (i32, Value) {
    let run = run(folder, &format!("--format json {arguments}"));
    (run.code(), run.json())
}

/// `end` before the program is complete is an error in text and JSON, wherever it comes; after its end it is
/// none.
#[test]
fn a_script_that_ends_early_fails() {
    let folder = Folder::with_program(PROGRAM);
    for script in ["1: end", "start+2: end"] {
        folder.write("s.txt", format!("{script}\n"));
        let (code, json) = report(&folder, "--script s.txt");
        assert_eq!((code, &json["completed"]), (1, &json!(false)), "{script}");
        let said = json["error"]["message"].as_str().unwrap();
        assert!(said.contains("the script ended the run"), "{said}");
        let text = run(&folder, "--script s.txt");
        assert_eq!(text.code(), 1);
        assert!(text.out().contains("the script ended the run"), "{}", text.out());
    }
    folder.write("s.txt", "start+60: end\n");
    let (code, json) = report(&folder, "--script s.txt");
    assert_eq!(
        (code, &json["completed"], &json["error"]),
        (0, &json!(true), &Value::Null)
    );
}

/// Faults of machine and script are JSON, too, for whoever reads only that.
#[test]
fn faults_are_json() {
    let folder = Folder::with_program(PROGRAM);
    folder.write("s.txt", "1: jump\n2: ce\n x: ce\n");
    let (code, json) = report(&folder, "--script s.txt");
    assert_eq!((code, &json["completed"]), (1, &json!(false)));
    let places: Vec<_> = json["faults"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fault| (&fault["line"], &fault["column"]))
        .collect();
    assert_eq!(places, [(&json!(1), &json!(4)), (&json!(3), &json!(2))]);
    assert!(
        json["faults"][0]["message"]
            .as_str()
            .unwrap()
            .contains("`jump` is no event")
    );

    std::fs::create_dir(folder.path("faulty")).unwrap();
    folder.write("faulty/machine.toml", "name = 'x'\nmodel = 'tnc999'\n");
    let machine = folder.bahn("run main.H --machine faulty --format json");
    assert_eq!(machine.code(), 1, "{}", machine.err());
    assert!(
        machine.json()["faults"][0]["file"]
            .as_str()
            .unwrap()
            .contains("machine.toml")
    );
}

/// The headline of a run that a message stopped is that message, at its block; the minute that nobody came is
/// no machining time.
#[test]
fn a_stopped_run_is_headed_by_the_message() {
    let folder = Folder::with_program(PROGRAM);
    let (code, json) = report(&folder, "--mp 4310.0=0 --operator start");
    assert_eq!(code, 1);
    assert_eq!(json["error"]["message"], "CHANGE TOOL, THEN CONFIRM");
    assert_eq!(json["error"]["block"], 1);
    assert!(json["error"]["detail"].as_str().unwrap().contains("strobe M2046"));
    assert!(
        number(&json, "/machining_time_s") < 10.0,
        "{}",
        json["machining_time_s"]
    );
    let times = json["times"].as_array().unwrap();
    let sum: f64 = times.iter().map(|share| share["time_s"].as_f64().unwrap()).sum();
    assert!((sum - number(&json, "/machining_time_s")).abs() < 1e-6);
    let message = json["messages"]
        .as_array()
        .unwrap()
        .iter()
        .find(|said| said["text"] == "CHANGE TOOL, THEN CONFIRM");
    assert_eq!(message.unwrap()["block"], 1);

    let limit = Folder::with_program("L Z+50 R0 FMAX\nL X+0 Y+0 FMAX\nL X+4000 F1000");
    let (code, json) = report(&limit, "");
    assert_eq!(
        (code, &json["error"]["message"], &json["error"]["block"]),
        (1, &json!("LIMIT SWITCH X+"), &json!(3))
    );
}

/// A script chooses the axis of the handwheel and turns it: 1000 steps are a turn, 20 mm / 2^4.
#[test]
fn the_handwheel_of_a_script() {
    let folder = Folder::new();
    folder.write(
        "s.txt",
        "20: mode handwheel\n+0.1: handwheel Y 4\n+0.1: expect Y.actual=120±0.5\n+0: handwheel 1000\n\
         +2: expect Y.actual=121.25±0.5\n+0: end\n",
    );
    let run = folder.bahn(&format!(
        "run --machine {} --fresh --format json --script s.txt",
        mill().display()
    ));
    let json = run.json();
    let actual: Vec<f64> = json["failed_expectations"]
        .as_array()
        .unwrap()
        .iter()
        .map(|failed| {
            failed["actual"]
                .as_str()
                .unwrap()
                .trim_start_matches("Y.actual is ")
                .parse()
                .unwrap()
        })
        .collect();
    match actual[..] {
        [] => assert_eq!(run.code(), 0),
        // Wherever the reference run has left Y: it moves by 1.25 mm.
        [before, after] => assert!((after - before - 1.25).abs() < 0.01, "{actual:?}"),
        _ => panic!("{actual:?}"),
    }
}

/// A script probes by hand: the upper face of the mill's block at Z 40 gives the length of the probe, 120 mm, and becomes
/// Z 0, 160 mm below the axis at 200.
#[test]
fn the_probe_menu_of_a_script() {
    let folder = Folder::with_program("TOOL CALL 0 Z S0\nL X+250 Y+140 Z+200 R0 FMAX M91");
    folder.write(
        "s.txt",
        "when run ended: mode manual\n+0.2: probe insert\n+0.1: datum Z 200\n+0.1: probe length 40\n\
         +0.1: key NC_START tap\nwhen probe.touches=1: expect no message\n+1: expect probe.length=120±0.01\n\
         +0: probe surface\n+0: probe direction Z-\n+0.1: key NC_START tap\nwhen probe.touches=1: expect no message\n\
         +1: expect Z.probed=40±0.01\n+0: probe datum Z 0\n+0.1: expect Z.displayed=160±0.01\n+0: end\n",
    );
    let (code, json) = report(&folder, "--script s.txt");
    assert_eq!((code, &json["failed_expectations"]), (0, &json!([])), "{json}");
}

/// TEST RUN while the program runs; what it came to is in the report.
#[test]
fn a_test_run_beside() {
    let folder = Folder::with_program(PROGRAM);
    folder.write("s.txt", "start+1: test main.H\n+1: expect test finished\n");
    let (code, json) = report(&folder, "--script s.txt");
    assert_eq!(code, 0, "{json}");
    assert_eq!(json["test_run"]["completed"], true);
    assert_eq!(json["test_run"]["program"], "main.H");
}

/// TEST RUN of another program: from the folder of the machine's programs, or beside the program of the run.
#[test]
fn a_test_run_of_another_program() {
    let folder = Folder::with_program(PROGRAM);
    folder.write("beside.H", program("L X+1 R0 FMAX"));
    for name in ["SADDLE.H", "beside.H"] {
        folder.write(
            "s.txt",
            format!("start+1: test {name}\n+1: expect test finished\n"),
        );
        let (code, json) = report(&folder, "--script s.txt");
        assert_eq!(code, 0, "{json}");
        assert_eq!(json["test_run"]["program"], name);
    }
}

/// FN15 is in the report and in a file, of a test run and of the machine. FN14 shows the text of the machine.
#[test]
fn printed_lines_and_texts_of_the_machine() {
    let folder =
        Folder::with_program("FN 0: Q1 = +20.25\nFN 15: PRINT 1/Q1\nL Z+50 R0 FMAX\nFN 15: PRINT Q1");
    let lines = "ERROR 1/+20.25\n+20.25\n";
    let expected = json!([
        { "block": 2, "text": "ERROR 1/+20.25", "program": "main.H", "line": 3 },
        { "block": 4, "text": "+20.25", "program": "main.H", "line": 5 }
    ]);
    let (code, test) = folder.test("--print test.txt");
    assert_eq!((code, &test["printed"]), (0, &expected));
    assert_eq!(folder.read("test.txt"), lines);
    let (code, json) = report(&folder, "--print run.txt");
    assert_eq!((code, &json["printed"]), (0, &expected));
    assert_eq!(folder.read("run.txt"), lines);
    let text = run(&folder, "");
    assert!(text.out().contains("Printed"), "{}", text.out());

    let message = std::fs::read_to_string(mill().join("plc/MAIN.ER1"));
    let message = message.unwrap_or_else(|error| panic!("{error}"));
    let first = message.lines().position(|line| !line.trim().is_empty()).unwrap();
    let folder = Folder::with_program(&format!("FN 14: ERROR = {}", 300 + first));
    let (code, json) = report(&folder, "");
    assert_eq!(
        (code, json["error"]["message"].as_str().unwrap()),
        (1, message.lines().nth(first).unwrap().trim())
    );
}

/// The block processing time of the model: 2000 elements of 0.05 mm at 6000 mm/min are 0.5 ms each; at 4 ms for
/// a block they take 8 s, less what is read ahead meanwhile.
#[test]
fn block_processing_time() {
    let mut blocks = "L Z+50 R0 FMAX\nL X+0 Y+0 FMAX\n".to_owned();
    for element in 1..=2000 {
        blocks += &format!("L X+{} F6000\n", f64::from(element) * 0.05);
    }
    let folder = Folder::with_program(&blocks);
    let feed = |arguments: &str| {
        let (code, json) = report(&folder, arguments);
        assert_eq!(code, 0, "{json}");
        number(&json, "/machining_time_s")
    };
    let (plain, simulated) = (feed(""), feed("--block-time"));
    assert!(
        simulated - plain > 4.0 && simulated - plain < 20.0,
        "{plain} {simulated}"
    );
    let test = |arguments: &str| number(&folder.test(arguments).1, "/machining_time_s");
    let (plain, simulated) = (test(""), test("--block-time"));
    assert!(simulated > plain && simulated >= 8.0, "{plain} {simulated}");
}

/// A log that is not as it was written repeats another run: it is said.
#[test]
fn a_damaged_log_is_said() {
    let folder = Folder::with_program(PROGRAM);
    assert_eq!(run(&folder, "--log a.log").code(), 0);
    let replay = run(&folder, "--replay a.log");
    assert_eq!((replay.code(), replay.err().as_str()), (0, ""));
    let whole = folder.read("a.log");
    let end = whole.lines().position(|line| line.ends_with(": end")).unwrap();
    let cut: Vec<&str> = whole.lines().take(end).collect();
    folder.write("a.log", cut.join("\n") + "\n");
    let replay = run(&folder, "--replay a.log");
    assert!(
        replay.err().contains("a.log: the log is not as it was written"),
        "{}",
        replay.err()
    );
}
