//! `bahn run` on a machine of two channels: each runs its program, is reported, recorded and drawn.

use std::path::{Path, PathBuf};

use crate::support::Folder;
use serde_json::Value;

fn twin() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/twin")
}

/// Runs the twin with further arguments; the JSON report and the exit code.
fn run(folder: &Folder, arguments: &[&str]) -> (Value, Option<i32>, String) {
    let mut command = folder.command();
    command
        .args(["run", "--fresh", "--no-graphics", "--format", "json", "--machine"])
        .arg(twin());
    let output = command.args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let report = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (report, output.status.code(), said)
}

/// The bare command runs the programs of machine.toml, and reports each channel.
#[test]
fn each_channel_is_reported() {
    let (report, code, said) = run(&Folder::new(), &[]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(
        (&report["program"], &report["completed"]),
        (&"LEFT.H".into(), &true.into())
    );
    let channels = report["channels"].as_array().unwrap();
    assert_eq!(channels.len(), 1, "those beside the first");
    let right = &channels[0];
    assert_eq!(
        (&right["channel"], &right["program"]),
        (&2.into(), &"RIGHT.H".into())
    );
    assert_eq!(right["completed"], true);
    let end = |axis: &str| right["final_position"][axis].as_f64().unwrap();
    assert_eq!(
        [end("X"), end("Y"), end("Z"), end("C")],
        [30.0, 0.0, 100.0, 180.0]
    );
    // 140 mm of slot, then the circle of 30 mm radius.
    let feed = right["path_mm"]["feed"].as_f64().unwrap();
    assert!(
        (feed - 140.0 - 60.0 * std::f64::consts::PI).abs() < 0.01,
        "{feed}"
    );
    // The slot at 800 and the circle at 1200 mm/min, and the rest.
    let time = right["machining_time_s"].as_f64().unwrap();
    assert!((10.5 + 9.42..40.0).contains(&time), "{time}");
    assert!(right["blocks_executed"].as_u64().unwrap() > 10);
    let off = right["contour_deviation_mm"].as_f64().unwrap();
    assert!((0.0001..0.1).contains(&off), "{off}");
    assert!(
        right["axes"]["C"]["max_lag"].as_f64().unwrap() > 0.0,
        "it had the arm"
    );
}

/// One program for each channel in their order; a channel without one stands by.
#[test]
fn programs_are_named_in_the_order_of_the_channels() {
    let folder = Folder::new();
    let program = |name: &str, blocks: &str| {
        folder.write(
            name,
            format!("BEGIN PGM {name} MM\n{blocks}\nEND PGM {name} MM\n"),
        )
    };
    program("one.h", "L X+10 R0 FMAX");
    program("two.h", "L X+20 R0 FMAX");
    let (report, code, said) = run(&folder, &["one.h", "two.h"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(report["final_position"]["X"], 10.0);
    assert_eq!(report["channels"][0]["final_position"]["X"], 20.0);
    let (report, code, _) = run(&folder, &["one.h"]);
    assert_eq!((code, report.get("channels")), (Some(0), None));
    let (_, code, said) = run(&folder, &["one.h", "two.h", "one.h"]);
    assert_eq!(code, Some(2));
    assert!(
        said.contains("the machine has 2 channels: there are more programs"),
        "{said}"
    );
    // What stops the second channel ends the run with an error at its block.
    program("far.h", "L X+20 R0 FMAX\nL X+900 R0 FMAX");
    let (report, code, said) = run(&folder, &["one.h", "far.h"]);
    assert_eq!((code, &report["completed"]), (Some(1), &true.into()));
    assert!(
        said.contains("2: LIMIT SWITCH X+") && said.contains("far.h:"),
        "{said}"
    );
    assert_eq!(report["channels"][0]["completed"], false);
    assert_eq!(report["channels"][0]["error"]["block"], 2);
}

/// Signals of both channels in one recording: while the left one waits at M60 the right one moves; the arm is recorded
/// where it is.
#[test]
fn both_channels_are_recorded_and_drawn() {
    let folder = Folder::new();
    let signals = "X.actual,2:X.actual,2:path.speed,M2045,2:C.nominal,2:M2045";
    let (_, code, said) = run(
        &folder,
        &["--record", "twin.csv", "--every", "10", "--signals", signals],
    );
    assert_eq!(code, Some(0), "{said}");
    let text = std::fs::read_to_string(folder.path("twin.csv")).unwrap();
    let mut lines = text.lines();
    let head =
        "time [s],X.actual [mm],2:X.actual [mm],2:path.speed [mm/min],M2045,2:C.nominal [deg],2:M2045,event";
    assert_eq!(lines.next(), Some(head));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .take(7)
                .map(|field| field.parse().unwrap())
                .collect()
        })
        .collect();
    let waits = rows
        .iter()
        .filter(|row| row[4] == 1.0 && (row[1] - 280.0).abs() < 0.01 && (row[3] - 800.0).abs() < 0.01);
    assert!(waits.count() > 100, "for more than a second");
    assert!(rows.iter().any(|row| (row[5] - 180.0).abs() < 1e-9));
    let drawn = folder.bahn("scope twin.csv --signals X.actual+2:X.actual,2:path.speed,2:M2045 -o twin.svg");
    let said = drawn.out();
    assert!(said.contains("2:M2045"), "{said}");
    assert!(
        std::fs::read_to_string(folder.path("twin.svg"))
            .unwrap()
            .contains("2:X.actual")
    );
    // The way of the second channel in X and Z.
    let (_, code, said) = run(
        &folder,
        &["--record", "way.csv", "--signals", "2:X.actual,2:Z.actual"],
    );
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(folder.bahn("scope way.csv --xy 2:X,2:Z -o way.png").code(), 0);
    assert_eq!(folder.bahn("scope way.csv --xy X,Z -o way.png").code(), 2);
    for (signals, what) in [
        ("3:X.actual", "the machine has no channel 3"),
        ("2:V.actual", "the machine has no axis V"),
    ] {
        let (_, code, said) = run(&folder, &["--record", "twin.csv", "--signals", signals]);
        assert_eq!(code, Some(2), "{signals}");
        assert!(said.contains(what), "{said}");
    }
}

/// A log has the channel of each command, and repeats the run.
#[test]
fn a_log_repeats_the_run() {
    let folder = Folder::new();
    let (first, code, said) = run(&folder, &["--log", "run.log", "--record", "first.csv"]);
    assert_eq!(code, Some(0), "{said}");
    let log = std::fs::read_to_string(folder.path("run.log")).unwrap();
    assert!(log.contains(": 2: select RIGHT.H\n"), "{log}");
    let (second, code, said) = run(&folder, &["--replay", "run.log", "--record", "second.csv"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(first["channels"], second["channels"]);
    let [first, second] = ["first.csv", "second.csv"].map(|name| std::fs::read(folder.path(name)).unwrap());
    assert!(first == second, "to the bit");
}

/// `bahn machine new --from twin` makes one, and it runs.
#[test]
fn a_machine_of_two_channels_is_made_anew() {
    let folder = Folder::new();
    let made = folder.bahn("machine new own --from twin --name Own");
    assert_eq!(made.code(), 0);
    let text = std::fs::read_to_string(folder.path("own/machine.toml")).unwrap();
    assert!(text.contains("name = \"Own\"\n") && text.contains("program = \"RIGHT.H\""));
    assert_eq!(folder.bahn("machine check own").code(), 0);
    assert_eq!(folder.bahn("run --machine own --fresh --no-graphics").code(), 0);
    assert_eq!(
        folder.bahn("machine new other --from twin --model tnc360").code(),
        2
    );
}

/// The scripts of the twin hold wherever its axes stand at the start: the machine keeps its place when it is switched off,
/// also in the middle of a program. What takes the drives away in rapid traverse is a matter of [000:6157], and of no script.
#[test]
fn the_scripts_hold_wherever_the_axes_stand() {
    let folder = Folder::new();
    crate::support::copy(&twin(), &folder.path("twin"));
    let run = |script: &str| folder.bahn(&format!("run --no-graphics --machine twin --script {script}"));
    for left_at in ["6", "8.5", "11", "17"] {
        for script in ["twin/scripts/emergency.txt", "twin/scripts/stop.txt"] {
            folder.write("left.txt", format!("{left_at}: end\n"));
            assert_eq!(run("left.txt").code(), 1, "the run is left at {left_at} s");
            let done = run(script);
            assert_eq!(done.code(), 0, "{script} after {left_at} s: {}", done.err());
            let again = run(script);
            assert_eq!(again.code(), 0, "{script} again: {}", again.err());
        }
    }
}
