//! Scripts: conditions, times, what goes on after an error, and what the end makes of it all.

use std::path::Path;

use crate::support::*;

const THERE_AND_BACK: &str = "TOOL CALL 1 Z S1000\nL Z+50 R0 FMAX M3\nL X+0 Y+0 R0 FMAX\nL X+100 F1500\nL X+0\n\
    L Z+100 R0 FMAX M5";

/// Exit code, standard output and what went to standard error.
fn played(blocks: &str, script: &str) -> (i32, serde_json::Value, String) {
    let folder = Folder::with_mill(blocks);
    folder.write("s.txt", script);
    let run = folder.bahn("run main.H --machine mill --fresh --no-graphics --format json --script s.txt");
    (run.code(), run.json(), run.err())
}

/// X is at 250 when the lag of that moment has passed: NC stop from there on, and not before.
#[test]
fn conditions_on_signals_come_true_in_their_cycle() {
    let folder = Folder::with_mill(THERE_AND_BACK);
    folder.write(
        "s.txt",
        "when X.actual > 250: key NC_STOP tap\n+2: key NC_START tap\n",
    );
    let arguments = "run main.H --machine mill --fresh --no-graphics --script s.txt --log a.log --record a.csv \
        --signals X.actual";
    let run = folder.bahn(arguments);
    assert_eq!(run.code(), 0, "{}", run.err());
    let log = folder.read("a.log");
    let time = |key: &str| {
        let line = log
            .lines()
            .find(|line| line.contains(key) && line.contains("tap"))
            .unwrap();
        line.split(':').next().unwrap().parse::<f64>().unwrap()
    };
    let table = folder.read("a.csv");
    let rows: Vec<(f64, f64)> = table
        .lines()
        .skip(1)
        .map(|row| {
            let mut values = row.split(',').map(|value| value.parse().unwrap_or(0.0));
            (values.next().unwrap(), values.next().unwrap())
        })
        .collect();
    // It was so for the first time after the cycle that ends when the key is pressed.
    let stop = time("NC_STOP");
    let first = rows.iter().find(|(_, x)| *x > 250.0).unwrap();
    assert!((first.0 - stop).abs() < 1e-9, "{first:?}, {stop}");
    let start = log.lines().rfind(|line| line.contains("NC_START tap")).unwrap();
    let start: f64 = start.split(':').next().unwrap().parse().unwrap();
    // 2 s later, at the beginning of a cycle of 3 ms.
    assert!((2.0..2.003).contains(&(start - stop)), "{start} {stop}");
}

#[test]
fn cycles_are_counted() {
    let script = "when run running: mode full\n+100 cycles: expect run running\n";
    let folder = Folder::with_mill("L X+100 R0 F1000");
    folder.write("s.txt", script.replace("expect run running", "override feed 50"));
    let run = folder.bahn("run main.H --machine mill --fresh --no-graphics --script s.txt --log a.log");
    assert_eq!(run.code(), 0, "{}", run.err());
    let log = folder.read("a.log");
    let time = |what: &str| {
        let line = log.lines().rfind(|line| line.contains(what)).unwrap();
        line.split(':').next().unwrap().parse::<f64>().unwrap()
    };
    // The contour cycle of the TNC 415 is 3 ms [000:2992].
    assert!(
        (time("override feed 50") - time("mode full") - 0.3).abs() < 1e-9,
        "{log}"
    );
}

#[test]
fn a_condition_that_never_comes_true_fails_the_run() {
    let (code, report, error) = played("L X+10 R0 F1000", "when X.actual > 5000: expect mode full\n");
    assert_eq!(code, 1, "{error}");
    assert!(error.contains("never came true"), "{error}");
    assert_eq!(report["completed"], true);
    assert_eq!(report["failed_expectations"][0]["line"], 1);
}

#[test]
fn a_script_goes_on_after_an_error_of_the_program() {
    let by_hand = "after message PROGRAM NOT FOUND: expect run interrupted\n+0.5: ce\n+0.5: mode manual\n\
        +0.5: key X+ press\n+1: key X+ release\n+2: expect X.actual>215\n+0: expect no message\n";
    let another =
        "+0.5: mode full\n+0.5: select OTHER.H\n+0.5: key NC_START tap\n+1: expect X.actual=201±0.01\n";
    let folder = Folder::with_mill("L X+10 R0 F1000\nCALL PGM MISSING\nL X+20");
    folder.write("OTHER.H", program("L X+1 R0 F5000"));
    for (script, code, completed) in [
        (by_hand.to_owned(), 1, false),
        (format!("{by_hand}{another}"), 0, true),
    ] {
        folder.write("s.txt", script);
        let run = folder.bahn("run main.H --machine mill --fresh --no-graphics --format json --script s.txt");
        let report = run.json();
        let failed = report["failed_expectations"].as_array().unwrap().len();
        assert_eq!((run.code(), failed), (code, 0), "{}", run.err());
        assert_eq!(report["completed"], completed);
    }
}

/// A flashing message that stands when the script ends the run is a failure unless the script has expected it.
#[test]
fn the_end_with_a_flashing_message_is_a_failure_unless_it_was_expected() {
    let ended = |script: &str| {
        let folder = Folder::with_mill("");
        folder.write("s.txt", script);
        let run = folder.bahn("run --machine mill --fresh --no-graphics --script s.txt");
        (run.code(), run.err() + &run.out())
    };
    let fault = "20: fault encoder X amplitude\n";
    let (code, text) = ended(&format!("{fault}+1: end\n"));
    assert_eq!(code, 1, "{text}");
    let (code, text) = ended(&format!(
        "{fault}+0.5: expect message \"MEASURING SYSTEM\"\n+0.5: end\n"
    ));
    assert_eq!(code, 0, "{text}");
    let (code, text) = ended(&format!("{fault}after message MEASURING SYSTEM: end\n"));
    assert_eq!(code, 0, "{text}");
    // Another one than the one that was expected.
    let (code, text) = ended(&format!("1: expect message \"INTERRUPTED\"\n{fault}+1: end\n"));
    assert_eq!(code, 1, "{text}");
}

/// What is set from outside, changed parameters, a reset and the supply are in the log: a replay is the same run.
#[test]
fn what_scripts_do_to_the_control_is_repeated_from_the_log() {
    let folder = Folder::with_mill(THERE_AND_BACK);
    folder.write(
        "s.txt",
        "start+2: M900=1, W902=$FFF0, S3=\"A, B\"\nwhen X.actual > 230: MP4110.5=200\nwhen X.actual > 250: power off\n\
         +1: power on\n+20: MP7260=40\n+20: expect M900=0, W902=0\n+0: end\n",
    );
    let signals = "X.actual,X.table,X.force,output.1,M900,W902,mode,run,X41/34";
    let common = format!("run main.H --machine mill --fresh --no-graphics --signals {signals}");
    let run = folder.bahn(&format!("{common} --script s.txt --log a.log --record a.csv"));
    assert_eq!(run.code(), 1, "it is incomplete: {}", run.err());
    assert!(!run.err().contains("not as expected"), "{}", run.err());
    let log = folder.read("a.log");
    for what in [
        "M900=1",
        "W902=-16",
        "S3=\"A, B\"",
        "MP4110.5=200",
        "power off",
        "power on",
        "MP7260=40",
    ] {
        assert!(log.contains(what), "{what}: {log}");
    }
    folder.bahn(&format!("{common} --replay a.log --record b.csv"));
    assert!(
        folder.read("a.csv") == folder.read("b.csv"),
        "the recordings differ"
    );
}

/// The examples of docs/scripts.md do what stands beside them.
#[test]
fn documented_scripts_are_played() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/scripts.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks = |kind: &str| -> Vec<String> {
        let begin = format!("```{kind}\n");
        let parts = page.split(&begin).skip(1);
        parts
            .map(|part| part.split("```").next().unwrap().to_owned())
            .collect()
    };
    let [program] = blocks("program").try_into().unwrap();
    let (scripts, failing) = (blocks("script"), blocks("fails"));
    assert!(scripts.len() >= 2 && !failing.is_empty());
    let with_code = scripts.iter().map(|script| (script, 0));
    for (script, expected) in with_code.chain(failing.iter().map(|script| (script, 1))) {
        let (code, report, error) = played(program.trim(), script);
        assert_eq!(code, expected, "{script}{error}");
        let failed = report["failed_expectations"].as_array().unwrap();
        assert!(failed.is_empty(), "{script}{failed:?}");
    }
    let ([bench], [plc]) = (
        <[String; 1]>::try_from(blocks("bench")).unwrap(),
        <[String; 1]>::try_from(blocks("plc")).unwrap(),
    );
    let folder = Folder::new();
    folder.write("DOOR.PLC", plc).write("door.txt", bench);
    let run = folder.bahn("plc run DOOR.PLC --script door.txt");
    assert_eq!(run.code(), 0, "{}", run.err());
}

/// The page lists what `bahn machine list` lists.
#[test]
fn the_page_on_scripts_is_complete() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../docs/scripts.md");
    let page = std::fs::read_to_string(page).unwrap();
    let listed = Folder::with_mill("").bahn("machine list mill").out();
    let (_, forms) = listed.split_once("Events:\n").unwrap();
    assert!(forms.lines().count() > 60);
    for line in forms.lines() {
        assert!(page.lines().any(|own| own == line), "{line}");
    }
}
