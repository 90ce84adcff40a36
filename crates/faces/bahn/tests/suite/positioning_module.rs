//! `bahn run --with`: the mill with a positioning module beside it.

use crate::support::{Folder, machines};
use serde_json::Value;

/// Runs PALLET.H of the mill with the loader and further arguments; the JSON report and the exit code.
fn pair(folder: &Folder, arguments: &[&str]) -> (Value, Option<i32>, String) {
    let mut command = folder.command();
    command
        .args([
            "run",
            "PALLET.H",
            "--fresh",
            "--no-graphics",
            "--format",
            "json",
            "--machine",
        ])
        .arg(machines().join("mill"))
        .arg("--with")
        .arg(machines().join("module-tnc360"));
    let output = command.args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let report = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (report, output.status.code(), said)
}

fn script(name: &str) -> String {
    let path = machines().join("module-tnc360/scripts").join(name);
    path.display().to_string()
}

/// Five jobs go: one to be ready, four of PALLET.H, the last ones to Z 15, X 350 and C 180. A job is 8 bytes and so 16
/// characters with CR LF, an answer 2 bytes and so 4 with CR LF; DC3 and DC1 hold the other side after each.
#[test]
fn the_loader_is_where_the_program_wants_it() {
    let folder = Folder::new();
    let recorded = folder.path("pair.csv").display().to_string();
    let record = [
        "--record",
        &recorded,
        "--signals",
        "M161,module:M20,module:X.volts",
    ];
    let (report, code, said) = pair(&folder, &record);
    assert_eq!(code, Some(0), "{said}");
    let module = &report["module"];
    for (axis, place) in [("X", 350.0), ("Z", 15.0), ("C", 180.0)] {
        let position = module["axes"][axis]["position"].as_f64().unwrap();
        assert!((position - place).abs() < 0.05, "{axis} {position}");
    }
    assert_eq!(module["characters"]["received"], 5 * (16 + 2 + 2));
    assert_eq!(module["characters"]["sent"], 5 * (4 + 2 + 2));
    assert_eq!(module["messages"], Value::Array(Vec::new()));
    // The references of the module come after those of the mill.
    let text = folder.read("pair.csv");
    let first = |column: usize| {
        let on = |line: &&str| line.split(',').nth(column) == Some("1");
        text.lines().position(|line| on(&line)).unwrap()
    };
    let (of_mill, of_module) = (first(1), first(2));
    assert!(of_mill < of_module, "{of_mill} {of_module}");
    let (again, _, _) = pair(&folder, &record);
    assert_eq!((again, folder.read("pair.csv")), (report, text));
}

/// A stop of one stops the other, and the order is done after both.
#[test]
fn the_stop_of_one_stops_the_other() {
    let (report, code, said) = pair(
        &Folder::new(),
        &["--operator", "full", "--script", &script("stop.txt")],
    );
    assert_eq!(code, Some(0), "{said}");
    let position = report["module"]["axes"]["C"]["position"].as_f64().unwrap();
    assert!((position - 180.0).abs() < 0.05, "{position}");
}

/// A relay of the mill that never drops fails its test: X41/34 stays off, and the module gets no control voltage either.
#[test]
fn a_test_that_fails_keeps_both_off() {
    let folder = Folder::new();
    folder.write(
        "welded.txt",
        "0: fault relay welded\n3: expect message \"EMERGENCY STOP DEFECTIVE\", X41/34=0, module:I3=0, module:M23=0\n+0: end\n",
    );
    let (report, _, said) = pair(&folder, &["--script", "welded.txt"]);
    assert_eq!(report["failed_expectations"], Value::Array(Vec::new()), "{said}");
}

#[test]
fn a_job_before_the_reference_run_is_refused() {
    let arguments = [
        "--operator",
        "full",
        "--script",
        &script("refused.txt"),
        "--mp",
        "4310.0=17",
    ];
    let (report, code, said) = pair(&Folder::new(), &arguments);
    assert_eq!(code, Some(0), "{said}");
    let messages = report["messages"].to_string();
    assert!(messages.contains("REFERENCE RUN FIRST"), "{messages}");
}

/// What is no module, and what speaks of one where there is none, is said.
#[test]
fn what_is_no_module_is_refused() {
    let folder = Folder::new();
    let mill = machines().join("mill").display().to_string();
    let small = machines().join("mill-tnc360").display().to_string();
    let run = folder
        .command()
        .args(["run", "--machine", &mill, "--with", &small])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(
        run.status.code() == Some(2) && said.contains("no positioning module"),
        "{said}"
    );
    folder.write(
        "alone.txt",
        "1: module: emergency press\n2: expect module:M20=1\n",
    );
    let run = folder
        .command()
        .args(["run", "--fresh", "--machine", &mill, "--script", "alone.txt"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(
        run.status.code() == Some(1) && said.matches("--with DIR").count() == 2,
        "{said}"
    );
}
