//! Programs on a machine with a System 900: both channels of the portal, scripts, recordings, what survives power-off; on the ideal
//! machine, where the times are those of the path alone.

use serde_json::{Value, json};

use crate::support::{Folder, machines};

/// What a run with a script came to.
fn with_script(folder: &Folder, script: &str, more: &str) -> (i32, Value, String) {
    folder.write("script.txt", script);
    let run = folder.bahn(&format!(
        "run --machine portal --fresh --script script.txt --format json {more}"
    ));
    let (code, errors) = (run.code(), run.err());
    let report = serde_json::from_str(&run.out()).unwrap_or_else(|error| panic!("{error}: {errors}"));
    (code, report, errors)
}

/// Both heads work at once. Head 1 ends above its last hole at X20 Y180 of G54, on Z100 with tool 5; head 2 has turned the table by
/// four quarters, a whole turn.
#[test]
fn both_heads_run_their_programs() {
    let folder = Folder::with_ideal_portal();
    let run = folder.bahn("run --machine portal --fresh --read P8685,2:P8685,P12151,P12157 --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    assert_eq!(
        (&report["completed"], &report["model"]),
        (&json!(true), &json!("system900"))
    );
    let place = |of: &Value, axis: &str| of["final_position"][axis].clone();
    assert_eq!(
        (place(&report, "X"), place(&report, "Y")),
        (json!(20.0), json!(180.0)),
        "{report}"
    );
    assert_eq!(report["reads"]["2:P8685"], json!(0.0));
    assert_eq!(place(&report, "Z"), json!(100.0));
    // The zero point of G54 is X250 Y120 of the machine.
    assert_eq!(
        (&report["reads"]["P12151"], &report["reads"]["P12157"]),
        (&json!(270.0), &json!(250.0))
    );
    let second = &report["channels"][0];
    assert_eq!(
        (&second["channel"], &second["completed"]),
        (&json!(2), &json!(true))
    );
    assert_eq!(place(second, "C"), json!(0.0), "{second}");
    // T1 M6 and T5 M6 of head 1, acknowledged one PLC cycle later.
    let changes: Vec<&Value> = report["m"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|m| m["m"] == 6)
        .collect();
    assert_eq!(changes.len(), 2, "{report}");
    let waited = changes[0]["ack_t"].as_f64().unwrap() - changes[0]["t"].as_f64().unwrap();
    assert!((0.0..=0.02).contains(&waited), "{waited}");
    assert_eq!(report["messages"], json!([]));
    let text = folder.bahn("run --machine portal --fresh").out();
    assert!(
        text.contains("SYSTEM 900") && text.contains("Channel 2"),
        "{text}"
    );
}

/// A file runs in channel 1 alone; its path is drawn.
#[test]
fn a_named_program_runs_alone() {
    let folder = Folder::with_ideal_portal();
    let run = folder.bahn("run P2000.900 --machine portal --fresh --path p.csv --format json");
    // Channel 1 has no tool 11.
    assert_eq!(run.code(), 1, "{}", run.out());
    assert!(run.err().contains("portal/programs/P2000.900:2"), "{}", run.err());
    let run = folder.bahn("run P1000.900 --machine portal --fresh --path p.csv --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(run.json().get("channels"), None);
    assert!(folder.read("p.csv").lines().count() > 20);
}

/// A drive that gives nothing any more leaves its axis behind: M2001 of logical axis 3 breaks the program off.
#[test]
fn a_dead_drive_is_a_lag_error() {
    let folder = Folder::with_ideal_portal();
    let (code, report, errors) = with_script(&folder, "start+3: fault drive 1 dead\n", "");
    assert_eq!(code, 1, "{report}");
    let said = &report["messages"][0];
    assert_eq!(
        (&said["number"], &said["channel"]),
        (&json!(2001), &json!(1)),
        "{report}"
    );
    assert!(errors.contains("M2001"), "{errors}");
    // A script that expects it wants it so.
    let script =
        "start+3: fault drive 1 dead\nwhen message \"M2001\": repair 1\n+1: expect P8685=0\n+0: end\n";
    let (_, report, errors) = with_script(&folder, script, "");
    assert_eq!(report["failed_expectations"], json!([]), "{errors}");
}

/// STOP of one channel stops the network, q904; START goes on.
#[test]
fn stop_in_the_network() {
    let folder = Folder::with_ideal_portal();
    let script = "start+2: P8682=1\n+1: expect P8685=1, 2:P8685=1\n+0: P8682=2, 2:P8682=2\n+1: expect P8685=2, 2:P8685=2\n";
    let (code, report, errors) = with_script(&folder, script, "");
    assert_eq!(
        (code, &report["failed_expectations"]),
        (0, &json!([])),
        "{errors}"
    );
    let (code, report, _) = with_script(&folder, "start+2: expect P8685=1\n", "");
    assert_eq!(code, 1);
    assert_eq!(report["failed_expectations"][0]["actual"], json!("P8685 is 2"));
}

/// The script is the PLC and the operator: without a start nothing runs.
#[test]
fn without_an_operator_the_script_does_all() {
    let folder = Folder::with_ideal_portal();
    let script = "0.5: P8683=2\n+0.5: P8682=2\n+0.5: expect P8685=2, 2:P8685=0\n+0.1: P8705=1\n+0.2: expect P8685=0\n+0: end\n";
    let (code, report, errors) = with_script(&folder, script, "--operator absent");
    // What was expected came, but the program did not come to its end.
    assert_eq!(
        (code, &report["failed_expectations"]),
        (1, &json!([])),
        "{errors}"
    );
    assert_eq!(report["completed"], json!(false));
    assert!(errors.contains("the program was broken off"), "{errors}");
}

/// A program that is not there is no program that has run.
#[test]
fn a_missing_program_is_said() {
    let folder = Folder::with_ideal_portal();
    std::fs::remove_file(folder.path("portal/programs/P2000.900")).unwrap();
    let run = folder.bahn("run --machine portal --fresh");
    assert_eq!(run.code(), 1, "{}", run.out());
    assert!(run.err().contains("P2000.900"), "{}", run.err());
    // Two files with one number would be one program in both channels.
    for name in ["a", "b"] {
        std::fs::create_dir(folder.path(name)).unwrap();
        folder.write(&format!("{name}/P7.900"), "N10 M30\n");
    }
    let run = folder.bahn("run a/P7.900 b/P7.900 --machine portal --fresh");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("have the same number, 7"), "{}", run.err());
}

/// The PLC calls the emergency program of head 2: X0 of G53 is the zero point of the machine. Where its file is missing, the run
/// goes well until it is called.
#[test]
fn an_emergency_program_is_called() {
    let folder = Folder::with_ideal_portal();
    let script = "start+3: plc 2:P8710=1\n";
    let (code, report, errors) = with_script(&folder, script, "--read 2:P8900,2:P12151");
    assert_eq!((code, &report["messages"]), (0, &json!([])), "{errors}");
    assert_eq!(report["reads"]["2:P12151"], json!(3000.0), "{report}");
    std::fs::remove_file(folder.path("portal/programs/P9002.900")).unwrap();
    assert_eq!(folder.bahn("run --machine portal --fresh").code(), 0);
    let (code, report, _) = with_script(&folder, script, "");
    assert_eq!(code, 1);
    assert_eq!(
        report["messages"][0]["text"],
        json!("emergency program 1 is not there"),
        "{report}"
    );
}

/// P8801 of an earlier run does not let a program that is named begin in its middle. From block 300 on the tool is changed and four
/// holes are drilled, 14 mm each.
#[test]
fn a_named_program_begins_at_its_beginning() {
    let folder = Folder::with_ideal_portal();
    let feed_mm = |more: &str| {
        let run = folder.bahn(&format!("run P1000.900 --machine portal --format json {more}"));
        assert_eq!(run.code(), 0, "{more}: {}", run.err());
        run.json()["path_mm"]["feed"].as_f64().unwrap()
    };
    let whole = feed_mm("--fresh");
    assert_eq!(feed_mm("--start-block 300"), 4.0 * 14.0);
    assert_eq!(feed_mm(""), whole);
}

/// A row for every 100 ms, not rounded; the heading has name and unit.
#[test]
fn parameters_are_recorded() {
    let folder = Folder::with_ideal_portal();
    let run = folder.bahn(
        "run P1000.900 --machine portal --fresh --record r.csv --signals P12151,P8685,q2150 --every 100 --format json",
    );
    assert_eq!(run.code(), 0, "{}", run.err());
    let table = folder.read("r.csv");
    let heading = table.lines().next().unwrap();
    assert_eq!(heading, "time [s],P12151 [mm],P8685,q2150 [mm],event");
    assert!(table.contains(",start\n"), "{table}");
    let run = folder.bahn("run --machine portal --record r.csv --signals X.actual");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("a System 900 has parameters"), "{}", run.err());
}

/// All parameters survive power-off; --fresh begins with the data file.
#[test]
fn parameters_survive_power_off() {
    let folder = Folder::with_ideal_portal();
    folder.write("set.txt", "0.1: P510=2.5\n0.2: end\n");
    let run = folder.bahn("run --machine portal --script set.txt --operator absent --format json");
    assert_eq!(run.json()["reads"], json!({}));
    let read = |more: &str| {
        folder.write("end.txt", "0.1: end\n");
        let run = folder.bahn(&format!(
            "run --machine portal --script end.txt --operator absent --read P510 --format json {more}"
        ));
        run.json()["reads"]["P510"].clone()
    };
    assert_eq!(read(""), json!(2.5));
    assert_eq!(read("--fresh"), Value::Null);
    folder.write("portal/state/parameters.q", "P510: x\n");
    let run = folder.bahn("run --machine portal");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("parameters.q") && run.err().contains("1:7"),
        "{}",
        run.err()
    );
}

/// The event buffer: P11271 and P11272 ask for M functions and blocks. A TNC has none.
#[test]
fn the_event_buffer_is_written() {
    let folder = Folder::with_ideal_portal();
    let script = "0.1: P11271=$110, P11272=$110\n";
    let (code, _, errors) = with_script(&folder, script, "--sample events.txt");
    assert_eq!(code, 0, "{errors}");
    let text = folder.read("events.txt");
    assert!(
        text.starts_with("SAMPLE DATA\n\nOutput:\nDATE: -\n") && text.ends_with("\nSAMPLE END\n"),
        "{text}"
    );
    let after = |earlier: &str, later: &str| {
        let [earlier, later] = [earlier, later].map(|event| text.find(event).unwrap_or(usize::MAX));
        earlier < later && later < usize::MAX
    };
    // A block is shown when its functions are out.
    assert!(
        after(
            "K1 M6 --> PLC, NR in the block:0, without branch",
            "PROG: K1 P1000 N110"
        ) && after("PROG: K1 P1000 N110", "PROG: K1 P1000 N120"),
        "{text}"
    );
    assert!(
        after(
            "K1 END OF BLOCK CNC --> PLC, CNC WAITS for acknowledgement",
            "K1 CNC <-- PLC SAFRE: 1"
        ) && after("K2 M81 --> PLC", "PROG: K2 P2000 N220"),
        "{text}"
    );
    let mill = machines().join("mill");
    let run = folder.bahn(&format!("run --machine {} --sample e.txt", mill.display()));
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("--sample"), "{}", run.err());
}

/// q10 = 170 and 175 keep parameters and programs in the FLASH, which stays over power-off; 200 and 205 bring them back.
#[test]
fn the_flash_keeps_parameters_and_programs() {
    let folder = Folder::with_portal();
    let session = |lines: &str| {
        folder.write("do.txt", lines);
        let run =
            folder.bahn("run --machine portal --script do.txt --operator absent --read P510 --format json");
        (run.json(), run.err())
    };
    folder.write("portal/programs/P7.900", "N10 M30\n");
    // Bit 4.5 of P510: it is stored.
    let file = folder.read("portal/parameters.q");
    folder.write("portal/parameters.q", format!("{file}\nP510: 1 $20000001\n"));
    session("0.1: P510=2\n+0.1: q10=170\n+0.1: q10=175\n+0.1: P510=3\n+0.1: end\n");
    folder.write("portal/programs/P7.900", "N10 M2\n");
    let (report, errors) = session("0.1: expect P510=3\n+0.1: q10=200\n+0.1: q10=205\n+0.1: end\n");
    assert_eq!(report["reads"]["P510"], json!(2.0), "{errors}");
    assert_eq!(folder.read("portal/programs/P7.900"), "N10 M30\n");
    // Only in HAND.
    let (report, _) = session("0.1: P8683=2\n+0.1: q10=120\n+0.1: end\n");
    assert_eq!(
        report["messages"][0]["text"],
        json!("q10: the machine is not in HAND"),
        "{report}"
    );
    folder.write("portal/state/flash", "bahn flash 1\nq");
    let run = folder.bahn("run --machine portal");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("flash") && run.err().contains("not whole"),
        "{}",
        run.err()
    );
}

/// A log repeats the run: the same report.
#[test]
fn a_log_repeats_the_run() {
    let folder = Folder::with_ideal_portal();
    let first = folder
        .bahn("run P1000.900 --machine portal --fresh --log run.log --format json")
        .json();
    let again = folder
        .bahn("run P1000.900 --machine portal --fresh --replay run.log --format json")
        .json();
    assert_eq!(first["m"], again["m"]);
    assert_eq!(first["machining_time_s"], again["machining_time_s"]);
}

/// What means something to a TNC alone is refused; so is what a script does not know.
#[test]
fn wrong_use_is_refused() {
    let folder = Folder::with_ideal_portal();
    for option in ["--mp 7310=0", "--image p.png", "--override 50", "--strict"] {
        let run = folder.bahn(&format!("run --machine portal --fresh {option}"));
        assert_eq!(run.code(), 2, "{option}");
        assert!(run.err().contains("is for a TNC"), "{option}: {}", run.err());
    }
    let run = folder.bahn("run P1.900 P2.900 P3.900 --machine portal --fresh");
    assert_eq!(run.code(), 2, "{}", run.err());
    folder.write("s.txt", "1: P8682\n1: 2:P99999=1\n1: expect P8685\n1: jump\n");
    let run = folder.bahn("run --machine portal --fresh --script s.txt");
    assert_eq!(run.code(), 1);
    for place in ["s.txt:1", "s.txt:2", "s.txt:3", "s.txt:4"] {
        assert!(run.err().contains(place), "{place}: {}", run.err());
    }
    let run = folder.bahn("run --machine portal --fresh --read P99999");
    assert_eq!(run.code(), 2, "{}", run.err());
}
