//! The portal as it is shipped: both programs on the simulated machine, with lag, PLC, tool changers and the shared beam.

use serde_json::{Value, json};

use crate::support::Folder;

/// A run of the portal, with more options.
fn run(folder: &Folder, more: &str) -> (i32, Value, String) {
    let run = folder.bahn(&format!("run --machine portal --fresh --format json {more}"));
    let (code, errors) = (run.code(), run.err());
    let report = serde_json::from_str(&run.out()).unwrap_or_else(|error| panic!("{error}: {errors}"));
    (code, report, errors)
}

/// The columns of a recording, with what each row has.
fn columns(table: &str, of: &[usize]) -> Vec<Vec<f64>> {
    let rows = table.lines().skip(1);
    rows.map(|row| {
        let cells: Vec<&str> = row.split(',').collect();
        of.iter()
            .map(|at| cells[*at].parse().unwrap_or(f64::NAN))
            .collect()
    })
    .collect()
}

/// Both heads do their work: head 1 ends above its last hole at X20 Y180 of G54, head 2 has turned the table once. The second head
/// comes into the shared part only when the first one has left it; until then its X waits.
#[test]
fn both_heads_work_and_share_the_beam() {
    let folder = Folder::with_portal();
    let signals = "P12151,2:P12151,2:P8891,P12160,P11649";
    let (code, report, errors) = run(&folder, &format!("--record r.csv --signals {signals} --every 20"));
    assert_eq!(code, 0, "{errors}");
    assert_eq!(report["messages"], json!([]), "{report}");
    let place = |of: &Value, axis: &str| of["final_position"][axis].as_f64().unwrap();
    // Actual positions: within the exact stop of 0.01 mm, and what friction leaves.
    for (axis, wanted) in [("X", 20.0), ("Y", 180.0), ("Z", 100.0)] {
        let found = place(&report, axis);
        assert!((found - wanted).abs() < 0.03, "{axis} {found}");
    }
    let table = folder.read("r.csv");
    let rows = columns(&table, &[1, 2, 3, 4, 5]);
    // It waited, and while both were on their ways they came no nearer than the 250 mm of range 2.
    let waits: Vec<&Vec<f64>> = rows.iter().filter(|row| row[2] == 1.0).collect();
    assert!(waits.len() > 500, "{}", waits.len());
    assert!(waits.iter().all(|row| row[1] > 2599.9), "its X stands at 2600");
    let nearest = rows
        .iter()
        .map(|row| row[1] - row[0])
        .fold(f64::INFINITY, f64::min);
    assert!(nearest > 250.0, "{nearest}");
    // It moves with lag: 2400 mm/min and Kv 20, 60 % of it taken away by pre-control, leave 2400 / 60 / 20 * 0.4 = 0.8 mm.
    let lag = rows.iter().map(|row| row[3].abs()).fold(0.0, f64::max);
    assert!(lag > 0.7, "{lag}");
    // The spindle turned with 4000 and 6000 rpm.
    let rpm = rows.iter().map(|row| row[4]).fold(0.0, f64::max);
    assert!((5950.0..6100.0).contains(&rpm), "{rpm}");
}

/// The tool change takes its time: place 5 is four strokes from place 1. P8100 has the tool afterwards, P510 the place.
#[test]
fn the_tool_is_changed_by_the_plc() {
    let folder = Folder::with_portal();
    let (code, report, errors) = run(&folder, "--read P8100,P8102,P510,2:P8100,2:P510");
    assert_eq!(code, 0, "{errors}");
    assert_eq!(
        report["reads"],
        json!({"P8100": 5.0, "P8102": 5.0, "P510": 5.0, "2:P8100": 11.0, "2:P510": 1.0}),
        "{report}"
    );
    let changes: Vec<&Value> = report["m"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|m| m["m"] == 66)
        .collect();
    assert_eq!(changes.len(), 2, "{report}");
    let waited = |change: &Value| change["ack_t"].as_f64().unwrap() - change["t"].as_f64().unwrap();
    // Disk there and back 2 * 0.7 s, draw bar 2 * 0.25 s; four strokes of 2 * 0.12 s more.
    let (first, second) = (waited(changes[0]), waited(changes[1]));
    assert!((1.9..2.3).contains(&first), "{first}");
    assert!((0.96..1.3).contains(&(second - first)), "{first} {second}");
}

/// Each script that is shipped comes to its end as it says.
#[test]
fn the_shipped_scripts_are_right() {
    let folder = Folder::with_portal();
    for script in ["stop", "again", "emergency", "lock"] {
        let (code, report, errors) = run(&folder, &format!("--script portal/scripts/{script}.txt"));
        assert_eq!(report["failed_expectations"], json!([]), "{script}: {errors}");
        assert_eq!(code, 0, "{script}: {errors}");
        assert_eq!(
            report["refused"].as_array().map_or(0, Vec::len),
            usize::from(script == "lock"),
            "{script}"
        );
    }
}

/// EMERGENCY STOP while both cut: everything stands, the outputs fall, and after RESET the programs can be started again.
#[test]
fn emergency_stop_stops_both() {
    let folder = Folder::with_portal();
    folder.write(
        "e.txt",
        "when P8901=190: emergency press\n+1: expect P8685=0, 2:P8685=0, P8700=0, P8701=0, 2:P8701=0, message \"EMERGENCY STOP\"\n\
         +0: emergency release\n+0.5: key RESET tap\n+1: expect no message, P8700=1, P8701=1\n+0: end\n",
    );
    let (_, report, errors) = run(&folder, "--script e.txt");
    assert_eq!(report["failed_expectations"], json!([]), "{errors}");
}

/// The door stops both on their ramps, and they go on when it is closed; no start while it is open.
#[test]
fn the_door_holds_the_heads() {
    let folder = Folder::with_portal();
    folder.write(
        "d.txt",
        "when P8901=190: switch door open\n+2: expect P8938=0, P8702=1\n+0: switch door closed\n+2: expect P8938>0, P8702=0\n+0: end\n",
    );
    let (_, report, errors) = run(&folder, "--script d.txt");
    assert_eq!(report["failed_expectations"], json!([]), "{errors}");
}

/// `bahn plc` takes the folder; what is wrong with the window is said with it.
#[test]
fn the_plc_is_looked_at_in_its_folder() {
    let folder = Folder::with_portal();
    let run = folder.bahn("plc check portal");
    assert_eq!(run.code(), 0, "{}", run.err());
    let listing = folder.bahn("plc list portal").out();
    assert!(listing.contains("TOOL_1"), "{listing}");
    let uses = folder.bahn("plc xref portal --only M466").out();
    assert!(uses.contains("M466"), "{uses}");
    let toml = folder.read("portal/machine.toml");
    folder.write(
        "portal/machine.toml",
        toml.replace("\"REOK_K1 = M100\"", "\"REOK_K7 = M100\""),
    );
    let run = folder.bahn("plc check portal");
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("there is no channel 7"), "{}", run.err());
    let run = folder.bahn("plc trace portal");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("System 900"), "{}", run.err());
}

/// The portal is a machine to start from, and `machine list` tells of it.
#[test]
fn the_portal_is_a_machine_to_start_from() {
    let folder = Folder::new();
    let run = folder.bahn("machine new mine --from portal900 --name Mine");
    assert_eq!(run.code(), 0, "{}", run.err());
    let check = folder.bahn("machine check mine");
    assert_eq!(check.code(), 0, "{}", check.err());
    assert!(
        check.err().contains("Mine, System 900 with 2 channels"),
        "{}",
        check.err()
    );
    let list = folder.bahn("machine list mine");
    assert_eq!(list.code(), 0, "{}", list.err());
    for said in [
        "channel 1",
        "axes",
        "RESET",
        "door",
        "SAFREK1 = M105",
        "plc P8706=1",
    ] {
        assert!(list.out().contains(said), "{said}: {}", list.out());
    }
    let readme = folder.read("mine/README.md");
    assert!(readme.contains("--machine mine"), "{readme}");
}
