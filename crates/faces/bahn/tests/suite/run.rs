//! `bahn run`: programs on the shipped machines.

use crate::support::{Folder, Run, machines, number, rows};
use serde_json::{Value, json};

/// A pocket corner with a programmed stop: 40 mm in X, 20 mm deep arc, up again.
const CORNER: &str = "
BLK FORM 0.1 Z X-10 Y-10 Z-20
BLK FORM 0.2 X+60 Y+60 Z+0
TOOL CALL 3 Z S1500
L Z+50 R0 FMAX M3
L X+0 Y+0 FMAX
L Z-5 F500
L X+40 F1000
M0
CC X+40 Y+20
C X+40 Y+40 DR+ F1000
L Z+50 FMAX M2";

/// `bahn run main.H` on the mill as it was delivered, with further arguments.
fn run(folder: &Folder, arguments: &str) -> Run {
    let mill = machines().join("mill");
    folder.bahn(&format!(
        "run main.H --machine {} --fresh {arguments}",
        mill.display()
    ))
}

fn report(folder: &Folder, arguments: &str) -> (i32, Value) {
    let run = run(folder, &format!("--format json {arguments}"));
    (run.code(), run.json())
}

/// The time that the report gives for something, s.
fn time_for(report: &Value, what: &str) -> f64 {
    let times = report["times"].as_array().unwrap();
    let share = times.iter().find(|share| share["what"] == what);
    share.map_or(0.0, |share| share["time_s"].as_f64().unwrap())
}

#[test]
fn the_report_is_that_of_a_test_run_and_of_the_machine() {
    let folder = Folder::with_program(CORNER);
    let (code, run) = report(&folder, "");
    assert_eq!(code, 0, "{run}");
    let tools = machines().join("mill/tools.tsv");
    let (_, test) = folder.test(&format!("--tools {}", tools.display()));
    assert_eq!(run["completed"], true);
    for field in [
        "program",
        "unit",
        "error",
        "tool_calls",
        "removed_mm3",
        "warnings",
        "stops",
        "blocks_executed",
    ] {
        assert_eq!(run[field], test[field], "{field}");
    }
    // Feed: Z from 50 to -5, X 40, half a circle of radius 20.
    let feed = 55.0 + 40.0 + 20.0 * std::f64::consts::PI;
    assert!((number(&run, "/path_mm/feed") - feed).abs() < 1e-6);
    assert_eq!(run["final_position"]["Z"], 50.0);
    assert_eq!(run["model"], "tnc415b");
    // The machine waits for spindle, tool and operator beside the way: the sum of it is the machining time.
    let times = run["times"].as_array().unwrap();
    let sum: f64 = times.iter().map(|share| share["time_s"].as_f64().unwrap()).sum();
    assert!((sum - number(&run, "/machining_time_s")).abs() < 1e-6);
    // 55 mm at 500 mm/min, 40 + 62.8 mm at 1000 mm/min.
    let path = 55.0 / 500.0 * 60.0 + (feed - 55.0) / 1000.0 * 60.0;
    assert!(
        (time_for(&run, "feed") - path).abs() < 0.2,
        "{}",
        time_for(&run, "feed")
    );
    assert!(
        time_for(&run, "tool change") > 0.9,
        "the clamp takes 0.5 s each way"
    );
    assert!(time_for(&run, "M3") > 0.3, "until the spindle is at speed");
    assert!(number(&run, "/power_up_s") > 0.5 && number(&run, "/reference_s") > 2.0);
    // M0 was confirmed half a second after it.
    let confirmed = run["confirmed"].as_array().unwrap();
    assert_eq!(confirmed.len(), 1);
    assert_eq!(
        (&confirmed[0]["key"], &confirmed[0]["why"]),
        (&json!("NC_START"), &json!("M0"))
    );
    assert!((time_for(&run, "programmed stop") - 0.5).abs() < 0.1);
    assert_eq!(run["messages"][0]["text"], "POWER INTERRUPTED");
    for axis in ["X", "Y", "Z"] {
        let lag = number(&run, &format!("/axes/{axis}/max_lag"));
        let deviation = number(&run, &format!("/axes/{axis}/max_deviation"));
        assert!(
            lag > 0.0 && lag < 1.0 && deviation < lag,
            "{axis} {lag} {deviation}"
        );
    }
    assert_eq!(
        run["axes"]["C"]["max_deviation"],
        Value::Null,
        "it has no part in the contour"
    );
    let plc = number(&run, "/plc/max_percent");
    assert!(plc >= number(&run, "/plc/mean_percent") && plc < 100.0);
}

/// The lag of the small mill is speed / kv: 10 000 mm/min and kv 1.5 are 6.667 mm.
#[test]
fn the_small_mill_runs_with_lag() {
    let folder = Folder::new();
    let small = machines().join("mill-tnc360");
    let run = folder.bahn(&format!(
        "run COVER.H --machine {} --fresh --no-graphics --format json",
        small.display()
    ));
    assert_eq!(run.code(), 0, "{}", run.err());
    let lag = number(&run.json(), "/axes/X/max_lag");
    assert!((lag - 10_000.0 / 1.5e3).abs() < 0.01 * lag, "{lag}");
}

#[test]
fn the_same_run_gives_the_same_bits() {
    let folder = Folder::with_program(CORNER);
    let record = "--record {}.csv --log {}.log --format json";
    let first = run(&folder, &record.replace("{}", "a"));
    let second = run(&folder, &record.replace("{}", "b"));
    assert_eq!(first.out(), second.out());
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
    // The log does everything again that operator and script did.
    let third = run(&folder, &format!("{} --replay a.log", record.replace("{}", "c")));
    assert_eq!(third.code(), 0, "{}", third.err());
    assert_eq!(folder.read("a.csv"), folder.read("c.csv"));
    assert_eq!(folder.read("a.log"), folder.read("c.log"));
    let head = "time [s],path.speed [mm/min],S.rpm [rpm],X.actual [mm],X.lag [mm],";
    assert!(folder.read("a.csv").starts_with(head));
}

#[test]
fn a_replay_repeats_what_a_script_did() {
    let folder = Folder::with_program(CORNER);
    folder.write(
        "s.txt",
        "start+4: key NC_STOP tap\n+1: expect run interrupted\n+0: override feed 50\n+0.5: key NC_START tap\n\
         +3: expect run running\nstart+40: expect run stopped\n+0: key NC_START tap\n",
    );
    let first = run(&folder, "--script s.txt --record a.csv --log a.log --every 20");
    assert_eq!(first.code(), 0, "{}", first.err());
    let again = run(&folder, "--replay a.log --record b.csv --every 20");
    assert_eq!(again.code(), 0, "{}", again.err());
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
}

#[test]
fn recordings_have_the_signals_that_were_asked_for() {
    let folder = Folder::with_program(CORNER);
    run(
        &folder,
        "--record r.csv --every 10 --signals X.nominal,X.actual,C.speed,M2045,W260",
    );
    let text = folder.read("r.csv");
    assert!(text.starts_with("time [s],X.nominal [mm],X.actual [mm],C.speed [deg/min],M2045,W260,event\n"));
    let rows = rows(&text);
    let times: Vec<f64> = rows.iter().map(|row| row[0].parse().unwrap()).collect();
    // Every 10 ms, at the first contour cycle of 3 ms at or after it.
    assert!(
        times
            .windows(2)
            .all(|pair| (0.008..0.0131).contains(&(pair[1] - pair[0])))
    );
    // M3 was handed over: its code while its strobe was set.
    assert!(rows.iter().any(|row| row[4] == "1" && row[5] == "3"));
    let wrong = run(&folder, "--record r.csv --signals Q.lag");
    assert_eq!(wrong.code(), 2);
    assert!(wrong.err().contains("is no signal"), "{}", wrong.err());
    let none = run(&folder, "--record r.csv --signals V.lag");
    assert!(
        none.err().contains("no axis V; there are X, Y, Z, C"),
        "{}",
        none.err()
    );
}

#[test]
fn expectations_of_a_script_fail_the_run() {
    let folder = Folder::with_program(CORNER);
    folder.write(
        "s.txt",
        "0.2: expect message \"POWER INTERRUPTED\"\n0.3: expect no message\nstart+5: expect X.actual=999±1\n\
         +0: expect tool=3\n+15: expect run stopped\n+0: key NC_START tap\n",
    );
    let (code, report) = report(&folder, "--script s.txt");
    assert_eq!(code, 1);
    let failed: Vec<_> = report["failed_expectations"]
        .as_array()
        .unwrap()
        .iter()
        .map(|failed| failed["line"].as_u64().unwrap())
        .collect();
    assert_eq!(failed, [2, 3]);
    assert_eq!(report["completed"], true, "it runs on");
    let text = run(&folder, "--script s.txt").err();
    assert!(
        text.contains("error: not as expected at 0.300 s\n --> s.txt:2:1"),
        "{text}"
    );
    assert!(text.contains("shown is POWER INTERRUPTED"), "{text}");
}

#[test]
fn faults_of_a_script_have_line_and_column() {
    let folder = Folder::with_program(CORNER);
    folder.write(
        "s.txt",
        "1: jump\n\n2: key NC_HALT tap\nx: ce\n3: expect lamp NO=1\n",
    );
    let run = run(&folder, "--script s.txt");
    assert_eq!(run.code(), 1);
    let said = run.err();
    for (place, what) in [
        ("s.txt:1:4", "`jump` is no event and no command"),
        ("s.txt:3:4", "no key `NC_HALT`"),
        ("s.txt:4:1", "`x` is no time"),
        ("s.txt:5:4", "no lamp `NO`"),
    ] {
        assert!(
            said.contains(place) && said.contains(what),
            "{place} {what}\n{said}"
        );
    }
    assert!(run.out().is_empty(), "nothing was run");
}

/// A change with the magazine, in which for half a minute no axis moves, comes on all the time: it is no run that hangs. An arm
/// that is stuck is one.
#[test]
fn a_change_is_no_run_that_hangs() {
    let folder = Folder::with_program("TOOL CALL 1 Z S0\nTOOL CALL 7 Z S0\nTOOL CALL 2 Z S0");
    let (code, change) = report(&folder, "--mp 7480.0=3,4310.0=3 --max-wait 6");
    assert_eq!((code, &change["waits_for"]), (0, &Value::Null), "{change}");
    folder.write("stuck.txt", "start+1: fault device arm_draw jammed\n");
    let (code, stuck) = report(
        &folder,
        "--mp 7480.0=3,4310.0=3 --max-wait 20 --script stuck.txt --operator full",
    );
    let waits = stuck["waits_for"].as_str().unwrap();
    assert!(code == 1 && waits.contains("M2483"), "{waits}");
}

/// With a script nobody confirms M0; without movement the run hangs and says why.
/// A program without a block begins and ends within one cycle: it is a run that ended, none that hangs.
#[test]
fn a_program_without_a_block_runs_to_its_end() {
    let folder = Folder::with_program("; nothing but this");
    let (code, report) = report(&folder, "");
    assert_eq!((code, &report["completed"]), (0, &json!(true)), "{report}");
}

#[test]
fn a_run_that_hangs_says_what_it_waits_for() {
    let folder = Folder::with_program(CORNER);
    let (code, stopped) = report(&folder, "--operator start --max-wait 20");
    assert_eq!(code, 1);
    assert_eq!(stopped["waits_for"], "the run is stopped: NC start goes on");
    assert_eq!(stopped["error"]["block"], 8);
    // The tool change waits for somebody who confirms it.
    let (code, change) = report(&folder, "--mp 4310.0=0 --operator start");
    assert_eq!(code, 1);
    let waits = change["waits_for"].as_str().unwrap();
    assert!(
        waits.contains("strobe M2046: the PLC must set M2483 (Ack: T/P code with TOOL CALL)"),
        "{waits}"
    );
    assert!(waits.contains("CHANGE TOOL, THEN CONFIRM"), "{waits}");
    let (_, stands) = report(&folder, "--override 0 --max-wait 5");
    assert!(
        stands["waits_for"]
            .as_str()
            .unwrap()
            .contains("the feed override is 0 %"),
        "{stands}"
    );
}

#[test]
fn the_operator_changes_tools() {
    let folder = Folder::with_program(CORNER);
    let (code, report) = report(&folder, "--mp 4310.0=0");
    assert_eq!(code, 0, "{report}");
    let keys: Vec<_> = report["confirmed"]
        .as_array()
        .unwrap()
        .iter()
        .map(|confirmed| confirmed["key"].as_str().unwrap())
        .collect();
    assert_eq!(keys, ["TOOL_RELEASE", "TOOL_RELEASE", "CONFIRM", "NC_START"]);
}

#[test]
fn single_block_and_start_block() {
    let folder =
        Folder::with_program("TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX\nL X+10 F1000\nL X+20 F1000\nL X+30");
    let (code, single) = report(&folder, "--single-block");
    assert_eq!(code, 0, "{single}");
    assert!(time_for(&single, "single block") > 0.5);
    let (code, part) = report(&folder, "--start-block 4");
    assert_eq!(code, 0, "{part}");
    assert_eq!(part["blocks_executed"], 2);
}

#[test]
fn an_error_of_the_program_is_shown_at_its_block() {
    let folder = Folder::with_program("L Z+50 R0 FMAX\nL X+10 F1000\nCALL LBL 9\nL X+20");
    let run = run(&folder, "");
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("error: LABEL NUMBER NOT ALLOCATED"),
        "{}",
        run.err()
    );
    assert!(run.err().contains("main.H:4:1"), "{}", run.err());
    assert!(
        run.out()
            .contains("LABEL NUMBER NOT ALLOCATED at block 3 (line 4)"),
        "{}",
        run.out()
    );
}

#[test]
fn the_part_can_be_seen() {
    let folder = Folder::with_program(CORNER);
    let run = run(&folder, "--image part.png --path path.csv --size 400x300");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        std::fs::read(folder.path("part.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    assert!(folder.read("path.csv").lines().count() > 5);
}

#[test]
fn what_survives_power_off_is_kept_in_the_folder() {
    let folder = Folder::with_mill("TOOL CALL 3 Z S1500\nFN 0: Q5 = +7.5\nL Z+50 R0 FMAX");
    let first = folder.bahn("run main.H --machine mill");
    assert_eq!(first.code(), 0, "{}", first.err());
    let state = folder.read("mill/state/control.toml");
    assert!(
        state.contains("tool = 3\n") && state.contains("\n5 = 7.5\n"),
        "{state}"
    );
    assert!(state.contains("{ X = 200.0, Y = 120.0, Z = 120.0,"), "{state}");
    // The tool is in the spindle already.
    folder.write("s.txt", "0.1: expect tool=3\n");
    let second = folder.bahn("run main.H --machine mill --script s.txt --format json");
    assert_eq!(second.code(), 0, "{}", second.err());
    assert_eq!(time_for(&second.json(), "tool change"), 0.0);
    // Another datum stays.
    folder.write("d.txt", "40: datum X 90\n+0.1: end\n");
    let datum = folder.bahn("run --machine mill --script d.txt");
    assert_eq!(datum.code(), 0, "{}", datum.err());
    assert!(
        !folder
            .read("mill/state/control.toml")
            .contains("datum = [{ X = 200.0")
    );
    // A damaged file starts nothing and is kept; without it the machine begins with the datum of machine.toml.
    folder.write("mill/state/control.toml", "tool = 3\ntool_length = ");
    let damaged = folder.bahn("run main.H --machine mill");
    assert_eq!(damaged.code(), 2, "{}", damaged.err());
    assert!(
        damaged.err().contains("control.toml: its end is missing"),
        "{}",
        damaged.err()
    );
    assert!(!folder.path("mill/state/control.toml").exists());
    std::fs::remove_file(folder.path("mill/state/control.toml.damaged")).unwrap();
    let anew = folder.bahn("run main.H --machine mill");
    assert_eq!(anew.code(), 0, "{}", anew.err());
    assert!(
        folder
            .read("mill/state/control.toml")
            .contains("datum = [{ X = 200.0")
    );
    // --fresh leaves no trace.
    std::fs::remove_dir_all(folder.path("mill/state")).unwrap();
    assert_eq!(folder.bahn("run main.H --machine mill --fresh").code(), 0);
    assert!(!folder.path("mill/state").exists());
}

#[test]
fn real_time_is_kept_and_lateness_reported() {
    let folder = Folder::with_program("L Z+50 R0 FMAX");
    let started = std::time::Instant::now();
    let (code, report) = report(&folder, "--realtime --max-time 1");
    assert_eq!(code, 1, "{report}");
    assert_eq!(report["error"]["message"], "the time allowed is over");
    assert!(started.elapsed().as_secs_f64() >= 0.99);
    assert!(number(&report, "/realtime/cycles") >= 333.0);
    assert!(report["realtime"]["worst_lateness_ms"].is_number());
}

#[test]
fn wrong_use() {
    let folder = Folder::with_program(CORNER);
    let none = folder.bahn("run main.H --machine nowhere");
    assert_eq!(none.code(), 2);
    assert!(none.err().contains("nowhere/machine.toml") && none.err().contains("bahn machine new"));
    let missing = run(&folder, "--script no.txt");
    assert_eq!(missing.code(), 2);
    let mill = machines().join("mill");
    let program = folder.bahn(&format!("run no.H --machine {} --fresh", mill.display()));
    assert_eq!(program.code(), 2, "{}", program.err());
    assert_eq!(run(&folder, "--mp 99999=1").code(), 2);
}

/// Without BLK FORM there is no part: the report comes, does not say that the picture is written, and wrong
/// use it is.
#[test]
fn no_picture_without_a_blank() {
    let folder = Folder::with_program("TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX M3\nL X+0 Y+0 FMAX M2");
    let run = run(&folder, "--image part.png");
    assert_eq!(run.code(), 2);
    assert!(
        run.out().contains("completed") && !run.out().contains("part.png"),
        "{}",
        run.out()
    );
    assert!(run.err().contains("no BLK FORM"), "{}", run.err());
}

/// A machine with an axis-error compensation: a table that is not there, or wrong, is refused with its line;
/// with a right one the machine runs.
#[test]
fn compensation_tables_lie_in_the_folder() {
    let folder = Folder::with_mill("TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX\nL X+100 Y+0 FMAX M2");
    let machine = folder.path("mill/machine.toml");
    let text = std::fs::read_to_string(&machine).unwrap();
    let with_tables = text.replace("plant =", "compensation = \"AXES.CMA\"\nplant =");
    std::fs::write(&machine, &with_tables).unwrap();
    std::fs::write(folder.path("mill/AXES.CMA"), "0 X=SCREW\nACTIVE 0\n").unwrap();
    let run = |mp: &str| {
        folder.bahn(&format!(
            "run main.H --machine mill --fresh {mp} --record o.csv --signals X.actual,X.nominal,X.lag"
        ))
    };
    let missing = run("");
    assert_eq!(missing.code(), 1);
    assert!(missing.err().contains("SCREW.COM"), "{}", missing.err());
    std::fs::write(
        folder.path("mill/SCREW.COM"),
        "SCREW MM DATUM 0 DIST 16 X\n0 X=0\n1 X=nonsense\n",
    )
    .unwrap();
    let wrong = run("");
    assert_eq!(wrong.code(), 1);
    assert!(wrong.err().contains("SCREW.COM:3"), "{}", wrong.err());
    std::fs::write(
        folder.path("mill/SCREW.COM"),
        "SCREW MM DATUM 0 DIST 16 X\n0 X=0\n1 X=0.05\n",
    )
    .unwrap();
    // Without an assignment the axis would have no compensation at all.
    let list = folder.read("mill/parameters.mp");
    folder.write(
        "mill/parameters.mp",
        list.replace("MP730    : %00000", "MP730    : %00001"),
    );
    let check = folder.bahn("machine check mill");
    assert!(!check.err().contains("730"), "{}", check.err());
    std::fs::write(&machine, &text).unwrap();
    let check = folder.bahn("machine check mill");
    let expected = "axis X: neither an assignment (.CMA) nor a correction table; MP720 is off";
    assert!(check.err().contains(expected), "{}", check.err());
    std::fs::write(&machine, &with_tables).unwrap();
    let right = run("--mp 730=%00001");
    assert_eq!(right.code(), 0, "{}", right.err());
    // A line that is not there; three dependencies of 256 points.
    let wide = "WIDE MM DATUM 0 DIST 16 X Y Z\n0 X=0 Y=0 Z=0\n255 X=0 Y=0 Z=0\n";
    std::fs::write(folder.path("mill/WIDE.COM"), wide).unwrap();
    for (assignment, expected) in [
        ("0 X=SCREW\nACTIVE 1\n", "there is no line with this number"),
        ("0 X=SCREW\n1 X=WIDE\nACTIVE 1\n", "more than 640 points"),
    ] {
        std::fs::write(folder.path("mill/AXES.CMA"), assignment).unwrap();
        let wrong = run("--mp 730=%00001");
        let line = assignment.lines().count();
        assert_eq!(wrong.code(), 1);
        assert!(
            wrong.err().contains(&format!("AXES.CMA:{line}")),
            "{}",
            wrong.err()
        );
        assert!(wrong.err().contains(expected), "{}", wrong.err());
    }
}

/// By how much X is shown farther than its table stands at the end of the program, mm.
fn ahead_of_table(folder: &Folder, mp: &str) -> f64 {
    let run = folder.bahn(&format!(
        "run main.H --machine mill --fresh {mp} --no-graphics --record o.csv --signals X.actual,X.table"
    ));
    assert_eq!(run.code(), 0, "{}", run.err());
    let record = folder.read("o.csv");
    let last = record.lines().last().unwrap();
    let values: Vec<f64> = last
        .split(',')
        .map(|value| value.trim().parse().unwrap_or(0.0))
        .collect();
    let [_, actual, table, _] = values[..] else {
        panic!("{last}")
    };
    actual - table
}

/// Correction tables of code number 105 296 [000:3875-3887]: a fault is named with its line, and the word of MP730 is
/// that there is nothing which it selects, or that it does not select what there is. 0.1 mm too far on the way of the
/// tables is taken off: the table stands at 99.9 mm of the machine where the control shows 100.
#[test]
fn correction_tables_lie_in_the_folder() {
    let folder = Folder::with_mill("TOOL CALL 3 Z S1500\nL Z+50 R0 FMAX\nL X+100 Y+0 FMAX M2");
    let list = folder.read("mill/parameters.mp");
    let select = |bits: &str| {
        assert!(list.contains("MP730    : %00000"));
        folder.write(
            "mill/parameters.mp",
            list.replace("MP730    : %00000", &format!("MP730    : %{bits}")),
        );
    };
    let check = || folder.bahn("machine check mill");
    select("00001");
    let nothing = check();
    assert_eq!(nothing.code(), 0, "{}", nothing.err());
    for said in [
        "parameters.mp:27",
        "there is no table",
        "axis X",
        "MP720 is off",
        "1 warning",
    ] {
        assert!(nothing.err().contains(said), "{said}: {}", nothing.err());
    }

    let machine = folder.read("mill/machine.toml");
    folder.write(
        "mill/machine.toml",
        machine.replace("plant =", "correction_tables = \"ERRORS.COR\"\nplant ="),
    );
    let table = |last: &str| {
        let points: String = (0..63).map(|point| format!("{point} 0.1\n")).collect();
        folder.write(
            "mill/ERRORS.COR",
            format!("X OVER X MM DATUM 0 DIST 16\n{points}{last}\n"),
        );
    };
    assert!(check().err().contains("ERRORS.COR"), "it is not there");
    table("63 0.3");
    let wrong = check();
    assert_eq!(wrong.code(), 1);
    assert!(
        wrong.err().contains("ERRORS.COR:65") && wrong.err().contains("64th of the spacing"),
        "{}",
        wrong.err()
    );
    table("63 0.1");
    assert!(check().err().contains("0 warnings"), "{}", check().err());
    let taken_off = ahead_of_table(&folder, "") - ahead_of_table(&folder, "--mp 730=%00000");
    assert!((taken_off - 0.1).abs() < 0.002, "{taken_off}");

    select("00010");
    let other = check().err();
    assert!(
        other.contains("axis X: its correction table has no effect"),
        "{other}"
    );
    assert!(
        other.contains("axis Y: neither") && other.contains("2 warnings"),
        "{other}"
    );
    select("00001");
    folder.write("mill/AXES.CMA", "0 X=SCREW\n");
    folder.write("mill/SCREW.COM", "SCREW MM DATUM 0 DIST 16 X\n0 X=0\n");
    let text = folder.read("mill/machine.toml");
    folder.write(
        "mill/machine.toml",
        text.replace("plant =", "compensation = \"AXES.CMA\"\nplant ="),
    );
    assert!(
        check().err().contains("the correction tables do not apply"),
        "{}",
        check().err()
    );
}

/// Each expectation of a script is a test case for a build server.
#[test]
fn expectations_are_written_as_junit() {
    let folder = Folder::with_program(CORNER);
    folder.write(
        "s.txt",
        "0.2: expect message \"POWER INTERRUPTED\"\n0.3: expect no message\nstart+4: expect tool=3\nstart+5: end\n\
         start+30: expect run stopped\n",
    );
    let run = run(&folder, "--script s.txt --junit out.xml");
    assert_eq!(run.code(), 1, "{}", run.err());
    let xml = folder.read("out.xml");
    for expected in [
        "failures=\"1\" errors=\"1\" skipped=\"1\"",
        "classname=\"s.txt:1\" name=\"0.2: expect message &quot;POWER INTERRUPTED&quot;\"/>",
        "classname=\"s.txt:2\" name=\"0.3: expect no message\">\n      <failure message=\"shown is POWER INTERRUPTED",
        "classname=\"s.txt:3\" name=\"start+4: expect tool=3\"",
        "classname=\"s.txt:5\" name=\"start+30: expect run stopped\">\n      <skipped",
    ] {
        assert!(xml.contains(expected), "{expected} is not in {xml}");
    }
}
