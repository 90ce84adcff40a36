//! `bahn plc`: check, run, trace, list, xref, signals.

use crate::support::Folder;
use serde_json::json;

/// O2 follows I4 AND I5; W8 counts cycles.
const DOOR: &str = "L I4\nA I5 ; door\n= O2\nINC W8\nEM\n";

fn folder(program: &str) -> Folder {
    let folder = Folder::new();
    folder.write("MAIN.PLC", program);
    folder
}

#[test]
fn check_reports_all_errors_in_one_pass() {
    let folder = folder("L I4\nLOAD M5\n= W7\nEM\n");
    let run = folder.bahn("plc check MAIN.PLC --format json");
    assert_eq!(run.code(), 1);
    let report = run.json();
    assert_eq!(report["ok"], false);
    let errors = report["errors"].as_array().unwrap();
    let places: Vec<_> = errors
        .iter()
        .map(|e| (e["number"].clone(), e["line"].clone()))
        .collect();
    // No command LOAD; words lie at even addresses.
    assert_eq!(places, [(json!(0), json!(2)), (json!(4), json!(3))]);
    assert_eq!(errors[0]["file"], "MAIN.PLC");
    assert_eq!(errors[0]["column"], 1);
    let run = folder.bahn("plc check MAIN.PLC");
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("MAIN.PLC:2:1") && run.err().contains("2 | LOAD M5"),
        "{}",
        run.err()
    );
    assert!(run.err().contains("2 errors"), "{}", run.err());
}

#[test]
fn check_knows_length_and_time() {
    let folder = folder("L I4\n= O2\nEM\n");
    let run = folder.bahn("plc check MAIN.PLC --model tnc407 --format json");
    assert_eq!(run.code(), 0);
    let report = run.json();
    // L 4 bytes, = 4 bytes, EM 4 bytes; 0.7 + 0.5 + 3.8 us of 5 ms.
    assert_eq!((&report["ok"], &report["size_bytes"]), (&json!(true), &json!(12)));
    crate::support::assert_near(report["nominal_percent"].as_f64().unwrap(), 0.1);
    assert_eq!((&report["errors"], &report["warnings"]), (&json!([]), &json!([])));
    assert_eq!(folder.bahn("plc check NOTHING.PLC").code(), 2);
}

/// Up to 8000 logic commands are processed within 10 ms, which are 200 % [000:11185, 11245]; the block processing speed is kept
/// at 100 %, and values above 150 % should not occur [000:12038]. L and = of bits take 0.7 and 0.5 µs, EM 3.8 µs.
#[test]
fn a_program_that_is_too_much_is_said() {
    let load = |pairs: usize| {
        let folder = folder(&format!("{}EM\n", "L I4\n= O2\n".repeat(pairs)));
        let run = folder.bahn("plc check MAIN.PLC --model tnc407 --format json");
        assert_eq!(run.code(), 0, "{}", run.err());
        run.json()["load"].clone()
    };
    let percent = |pairs: usize| (pairs as f64 * 1.2 + 3.8) / 5000.0 * 100.0;
    assert_eq!(load(3999), json!([]));
    let commands = "12001 commands: a PLC run has time for 8000 of them";
    let speed = "above 100 % the control does not keep its block processing speed";
    let time = format!("nominal cycle time {:.2} %: {speed}", percent(6000));
    assert_eq!(load(6000), json!([commands, time]));
    assert!(percent(6500) > 150.0);
    let said = load(6500).to_string();
    assert!(said.contains("no reserve is left"), "{said}");
}

#[test]
fn linked_files_lie_beside_the_main_file() {
    let folder = folder("USES GEAR.PLC\nEXTERN 10\nCM 10\nEM\n");
    folder.write("GEAR.PLC", "GLOBAL 10\nLBL 10\nL K+7\n= B0\nEM\n");
    let run = folder.bahn("plc run MAIN.PLC --show B0 --format json");
    assert_eq!(
        (run.code(), &run.json()["values"]["B0"]),
        (0, &json!(7)),
        "{}",
        run.err()
    );
}

#[test]
fn machines_with_an_eprom_link_its_files() {
    let folder = folder("USES GEAR.PLC\nEXTERN 10\nCM 10\nEM\n");
    let gear = |value: u8| format!("GLOBAL 10\nLBL 10\nL K+{value}\n= B0\nEM\n");
    folder.write("GEAR.PLC", gear(7));
    folder
        .write("ram.MP", "MP4010 : 1\n")
        .write("eprom.MP", "MP4010 : 0\n");
    let errors = |list: &str| {
        let run = folder.bahn(&format!("plc check MAIN.PLC --parameters {list} --format json"));
        let errors = run.json()["errors"].clone();
        errors
            .as_array()
            .unwrap()
            .iter()
            .map(|e| e["number"].as_u64().unwrap())
            .collect::<Vec<_>>()
    };
    assert_eq!(errors("ram.MP"), [0_u64; 0]);
    assert_eq!(errors("eprom.MP"), [35_u64, 39]);
    std::fs::create_dir(folder.path("EPROM")).unwrap();
    folder.write("EPROM/GEAR.PLC", gear(8));
    let value = |list: &str| {
        let run = folder.bahn(&format!(
            "plc run MAIN.PLC --parameters {list} --show B0 --format json"
        ));
        run.json()["values"]["B0"].clone()
    };
    assert_eq!((value("ram.MP"), value("eprom.MP")), (json!(7), json!(8)));
    folder.write("EPROM/GEAR.PLC", "GLOBAL 10\nLBL 10\n= B0\nEM\n");
    let run = folder.bahn("plc check MAIN.PLC --parameters eprom.MP");
    assert!(run.err().contains("EPROM/GEAR.PLC:3:1"), "{}", run.err());
}

#[test]
fn run_shows_operands() {
    let folder = folder(DOOR);
    let run =
        folder.bahn("plc run MAIN.PLC --cycles 3 --set I4=1,I5=1,W8=-5 --show O2,w8,B9,S0 --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    assert_eq!(report["cycles"], 3);
    // -5 and three increments: -2 = FFFEh.
    assert_eq!(report["values"], json!({"O2": 1, "W8": -2, "B9": -2, "S0": ""}));
    assert_eq!(report["error"], json!(null));
    // 0.7 + 0.5 (A: no time printed) + 0.5 + 0.5 (INC) + 3.8 us of 5 ms.
    crate::support::assert_near(report["processing_percent"]["current"].as_f64().unwrap(), 0.12);
    assert_eq!(report.as_object().unwrap().len(), 4);
    let run = folder.bahn("plc run MAIN.PLC --set I4=1 --show O2");
    assert!(run.out().starts_with("O2 = 0\n1 cycle,"), "{}", run.out());
}

#[test]
fn machine_parameters_reach_timers() {
    // T4 runs MP4110.4 cycles: T52 is its running output.
    let folder = folder("L I0\n= T4\nL T52\n= O0\nEM\n");
    let run = folder.bahn("plc run MAIN.PLC --cycles 3 --set I0=1,MP4110.4=100 --show O0 --format json");
    assert_eq!(run.json()["values"]["O0"], 1, "{}", run.err());
    assert_eq!(folder.bahn("plc run MAIN.PLC --set MP9999=1").code(), 2);
}

#[test]
fn scripts_set_and_expect() {
    let folder = folder(DOOR);
    folder.write(
        "good.txt",
        "; door\ncycle 1: I4=1\ncycle 1: expect O2=0\ncycle 2: I5=1 # closed\ncycle 2: expect O2=1, W8=2\n\
         cycle 5: expect W8=5\n",
    );
    let run = folder.bahn("plc run MAIN.PLC --script good.txt --record out.csv");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        folder.read("out.csv"),
        "cycle,I4,O2,I5,W8\n1,1,0,0,1\n2,1,1,1,2\n3,1,1,1,3\n4,1,1,1,4\n5,1,1,1,5\n"
    );
    folder.write(
        "bad.txt",
        "cycle 2: I4=1, I5=1\ncycle 2: expect O2=0\ncycle 3: expect W8=7\n",
    );
    let run = folder.bahn("plc run MAIN.PLC --script bad.txt --format json");
    assert_eq!(run.code(), 1);
    let err = run.err();
    assert!(
        err.starts_with("error: cycle 2: O2 expected 0, found 1\n --> bad.txt:2:17\n"),
        "{err}"
    );
    assert!(
        err.contains("3 | cycle 3: expect W8=7\n  |                 ^^^^ found 3\n"),
        "{err}"
    );
    let failed = &run.json()["failed_expectations"][1];
    assert_eq!(
        failed,
        &json!({"cycle": 3, "line": 3, "operand": "W8", "expected": 7, "found": 3})
    );
    folder.write(
        "late.txt",
        "cycle 2: expect O2=0\ncycle 3: expect W8=7\ncycle 9: expect O2=1\n",
    );
    let run = folder.bahn("plc run MAIN.PLC --script late.txt --cycles 3 --junit out.xml");
    assert_eq!(run.code(), 1);
    let xml = folder.read("out.xml");
    for expected in [
        "<testsuite name=\"MAIN.PLC\" tests=\"3\" failures=\"1\" errors=\"0\" skipped=\"1\">",
        "<testcase classname=\"late.txt:1\" name=\"cycle 2: expect O2=0\"/>",
        "<testcase classname=\"late.txt:2\" name=\"cycle 3: expect W8=7\">\n      <failure message=\"W8 is 3\"/>",
        "<testcase classname=\"late.txt:3\" name=\"cycle 9: expect O2=1\">\n      <skipped",
    ] {
        assert!(xml.contains(expected), "{expected} is not in {xml}");
    }
    folder.write("wrong.txt", "cycle 1: I4=1\ncycle 2: W7=1\n");
    let run = folder.bahn("plc run MAIN.PLC --script wrong.txt");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("wrong.txt:2:"), "{}", run.err());
}

/// The language of `bahn run`: seconds, cycles, conditions, and an end.
#[test]
fn scripts_have_times_and_conditions() {
    // O2 follows I4 for as long as W8 counts to 5.
    let folder = folder("L I4\n= O2\nINC W8\nL W8\n== K+5\n= O3\nEM\n");
    // A scan of the TNC 415 lasts 20 ms [000:239]: 0.1 s is after the fifth.
    folder.write(
        "s.txt",
        "0: I4=1\n+1 cycle: expect O2=1, W8=1\n0.1: expect W8=5, O3=1\nwhen O3=1: I4=0\n+1 cycle: expect O2=0\n\
         +2 cycles: expect W8=8\n+0.04: end\n",
    );
    let run = folder.bahn("plc run MAIN.PLC --script s.txt --show W8,O2 --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    // The condition comes true after cycle 5; 1 + 2 + 2 cycles later the script ends.
    assert_eq!(run.json()["cycles"], 10);
    assert_eq!(run.json()["values"], json!({"W8": 10, "O2": 0}));

    folder.write(
        "never.txt",
        "cycle 2: I4=1\nwhen O2=1, W8>30000: I4=0\ncycle 3: expect O2>1\n",
    );
    let run = folder.bahn("plc run MAIN.PLC --script never.txt --format json --junit n.xml");
    assert_eq!(run.code(), 1);
    let report = run.json();
    // A minute after the last thing that was done.
    assert_eq!(report["cycles"], 3002);
    assert_eq!(
        report["failed_expectations"],
        json!([
            {"cycle": 3, "line": 3, "operand": "O2", "expected": "> 1", "found": 1},
            {"cycle": 3002, "line": 2, "operand": "W8", "expected": "> 30000", "found": 3002},
        ])
    );
    assert!(
        folder.read("n.xml").contains("it never came true"),
        "{}",
        folder.read("n.xml")
    );

    // What the bench does not have is said with its place.
    folder.write("key.txt", "cycle 1: key NC_START tap\n1: expect mode full\n");
    let run = folder.bahn("plc run MAIN.PLC --script key.txt");
    assert_eq!(run.code(), 2);
    let err = run.err();
    assert!(
        err.contains("key.txt:1:10") && err.contains("key.txt:2:4"),
        "{err}"
    );
}

#[test]
fn run_time_errors_name_the_line() {
    let folder = folder("L M0\n= M1\nLBL 1\nJP 1\nEM\n");
    let run = folder.bahn("plc run MAIN.PLC --cycles 4 --format json");
    assert_eq!(run.code(), 1);
    assert_eq!(
        run.json()["error"],
        json!({"number": 53, "file": "MAIN.PLC", "line": 4})
    );
    assert_eq!(run.json()["cycles"], 0);
    assert!(
        run.err().contains("53 time out") && run.err().contains("MAIN.PLC:4:1"),
        "{}",
        run.err()
    );
    folder.write("MAIN.PLC", "L\nEM\n");
    let run = folder.bahn("plc run MAIN.PLC --format json");
    assert_eq!((run.code(), &run.json()["error"]["number"]), (1, &json!(3)));
}

#[test]
fn retained_memory_survives() {
    // M1000 and B0 are kept, M100 and B128 are not.
    let folder = folder("INC B0\nINC B128\nLN M1000\n= M100\nS M1000\nEM\n");
    let run = |cycles: u32| {
        let run = folder.bahn(&format!(
            "plc run MAIN.PLC --retain memory --cycles {cycles} --show B0,B128,M100 --format json"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
        run.json()["values"].clone()
    };
    assert_eq!(run(1), json!({"B0": 1, "B128": 1, "M100": 1}));
    assert_eq!(run(2), json!({"B0": 3, "B128": 2, "M100": 0}));
    // Power-off in the middle of a record loses that record only: the one with the greatest number.
    let mut journal = std::fs::read(folder.path("memory")).unwrap();
    let newest = journal
        .chunks(512)
        .enumerate()
        .max_by_key(|(_, record)| record[4..12].to_vec());
    let (newest, _) = newest.unwrap();
    journal[newest * 512 + 300] ^= 1;
    std::fs::write(folder.path("memory"), &journal).unwrap();
    assert_eq!(run(1), json!({"B0": 2, "B128": 1, "M100": 0}));
    assert_eq!(std::fs::read(folder.path("memory.damaged")).unwrap(), journal);
    folder.write("memory", "a letter");
    assert_eq!(folder.bahn("plc run MAIN.PLC --retain memory").code(), 2);
    assert_eq!(
        folder.read("memory"),
        "a letter",
        "files of others are left alone"
    );
}

#[test]
fn traces_show_executed_lines() {
    let folder = folder("L I4\nJPT 1\nL K+9\n= W8\nLBL 1\nEM\n");
    let run = folder.bahn("plc trace MAIN.PLC --format json");
    let lines = run.json();
    let row = |index: usize| (lines[index]["line"].clone(), lines[index]["operand"].clone());
    assert_eq!(row(0), (json!(1), json!(0)));
    assert_eq!(row(3), (json!(4), json!(9)));
    assert_eq!((&lines[3]["word"], &lines[3]["logic"]), (&json!(9), &json!(0)));
    assert_eq!(lines[3]["instruction"], "= W8");
    let run = folder.bahn("plc run MAIN.PLC --cycles 3 --set I4=1 --trace 2..3 --format json");
    let lines = run.json()["trace"].clone();
    let executed: Vec<_> = lines
        .as_array()
        .unwrap()
        .iter()
        .map(|l| (l["cycle"].as_u64().unwrap(), l["line"].as_u64().unwrap()))
        .collect();
    assert_eq!(executed, [(2, 1), (2, 2), (2, 6), (3, 1), (3, 2), (3, 6)]);
    assert!(
        folder
            .bahn("plc trace MAIN.PLC")
            .out()
            .contains("cycle 1, MAIN.PLC")
    );
    assert_eq!(folder.bahn("plc run MAIN.PLC --trace 3..2").code(), 2);
    folder.write("MAIN.PLC", "L K-1\nA K+43\n= W8\nEM\n");
    let table = folder.bahn("plc trace MAIN.PLC --hex").out();
    let columns: Vec<_> = table.lines().nth(3).unwrap().split_whitespace().collect();
    assert_eq!(columns, ["2", "A", "K+43", "2Bh", "0", "2Bh"], "{table}");
}

#[test]
fn listings_have_columns() {
    let folder = folder("l i4;on\nIFT\nL K1\n= B0\nENDI\nEM\nLBL 5\nEM\n  ; door\n");
    let run = folder.bahn("plc list MAIN.PLC");
    assert_eq!(run.code(), 0, "{}", run.err());
    let lines: Vec<String> = run.out().lines().map(str::to_owned).collect();
    assert_eq!(lines[0], "MAIN.PLC");
    assert_eq!(lines[1], format!("    1  {:<30} ;on", "  l     i4"));
    assert_eq!(lines[3], "    3      L     K1");
    assert_eq!(lines[5], "    5    ENDI");
    assert_eq!(lines[7], "    7  LBL   5");
    assert_eq!(lines[9], "    9  ; door");
}

#[test]
fn listings_mark_errors_and_warnings() {
    let folder = folder("LM 4\nL M5\n= M6\nEM\n");
    let run = folder.bahn("plc list MAIN.PLC");
    assert_eq!(run.code(), 1);
    let lines: Vec<String> = run.out().lines().map(str::to_owned).collect();
    assert!(lines[2].starts_with("       ^^^ warning 5 "), "{}", run.out());
    assert!(lines[4].starts_with("       ^^^ error 20 "), "{}", run.out());
    assert_eq!(lines[5], "    3    =     M6");
    let run = folder.bahn("plc list MAIN.PLC --format json");
    assert_eq!(run.code(), 1);
    let files = run.json();
    assert_eq!(files[0]["file"], "MAIN.PLC");
    let line = &files[0]["lines"][1];
    assert_eq!(
        (&line["line"], &line["command"], &line["operand"]),
        (&json!(2), &json!("L"), &json!("M5"))
    );
    assert_eq!(
        (&line["errors"][0]["number"], &line["warnings"]),
        (&json!(20), &json!([]))
    );
}

#[test]
fn warnings_are_said_by_all_that_compile() {
    let folder = folder("LM 4\n= M6\nEM\n");
    for command in ["run", "trace", "diagram --show M6", "xref"] {
        let run = folder.bahn(&format!("plc {command} MAIN.PLC"));
        assert_eq!(run.code(), 0);
        assert!(run.err().contains("warning: 5 "), "{command}: {}", run.err());
        let strict = folder.bahn(&format!("plc {command} MAIN.PLC --strict"));
        assert_eq!(strict.code(), 1);
        assert!(strict.err().contains("error: 5 "), "{command}: {}", strict.err());
    }
}

#[test]
fn cross_references_name_every_place() {
    let folder = folder("L I4\n= O2\nL I5\n= O2\nS M7\nCM 5\nEM\nLBL 5\nL W8\n= W10\nEM\nLBL 6\nEM\n");
    let run = folder.bahn("plc xref MAIN.PLC --format json");
    let report = run.json();
    let operand = |name: &str| {
        let all = report["operands"].as_array().unwrap();
        all.iter().find(|o| o["operand"] == name).unwrap().clone()
    };
    assert_eq!(operand("I4")["read"], json!([{"file": "MAIN.PLC", "line": 1}]));
    assert_eq!(operand("O2")["written_twice"], true);
    assert_eq!(operand("O2")["unused"], false);
    assert_eq!(operand("M7")["unused"], true);
    assert_eq!(operand("W10")["written"][0]["line"], 10);
    let label = |name: &str| {
        let all = report["labels"].as_array().unwrap();
        all.iter().find(|l| l["label"] == name).unwrap().clone()
    };
    assert_eq!(label("5")["used"], json!([{"file": "MAIN.PLC", "line": 6}]));
    assert_eq!(
        (&label("6")["unused"], &label("6")["defined"]["line"]),
        (&json!(true), &json!(12))
    );
    let text = folder.bahn("plc xref MAIN.PLC --only O").out();
    assert_eq!(text, "O2  (assigned twice)\n    written  MAIN.PLC:2 MAIN.PLC:4\n");
}

#[test]
fn cross_references_see_overlaps_and_indices() {
    // W2 lies in D0; B100[X] may be any byte; M2482 is read by the NC, T4 starts a timer.
    let folder =
        folder("L K+1\n= D0\nL K+2\n= W2\n= W40\nL W0\n= B8\nLX\n= B100[X]\nL M1\n= M2482\n= T4\n= M9\nEM\n");
    let report = folder.bahn("plc xref MAIN.PLC --format json").json();
    let operand = |name: &str| {
        let all = report["operands"].as_array().unwrap();
        all.iter().find(|o| o["operand"] == name).unwrap().clone()
    };
    assert_eq!(operand("D0")["overlaps"], json!(["W0", "W2"]));
    assert_eq!(operand("W2")["overlaps"], json!(["D0"]));
    assert_eq!(operand("W40")["overlaps"], json!([]));
    let flags = |name: &str| {
        (
            operand(name)["unused"] == true,
            operand(name)["written_twice"] == true,
        )
    };
    assert_eq!(flags("D0"), (false, true), "read through W0, written through W2");
    assert_eq!(flags("W2"), (true, true), "nobody reads bytes 2 and 3");
    assert_eq!(flags("W40"), (true, false));
    assert_eq!(
        (flags("M2482"), flags("T4"), flags("M9")),
        ((false, false), (false, false), (true, false))
    );
    assert_eq!(operand("M2482")["name"], "M_FUNCTION_ACK");
    let indexed = operand("B100[X]");
    assert_eq!(
        (&indexed["range"], &indexed["unused"]),
        (&json!("B0-B1023"), &json!(false))
    );
    assert_eq!(operand("B8")["range"], json!(null));
    let text = folder.bahn("plc xref MAIN.PLC --only B").out();
    assert_eq!(
        text,
        "B8  (never read)\n    written  MAIN.PLC:7\nB100[X]  (B0-B1023)\n    written  MAIN.PLC:9\n"
    );
    // A load with an index may read everything.
    let folder = self::folder("L K+1\n= W40\nL B100[X]\n= B2\nEM\n");
    let report = folder.bahn("plc xref MAIN.PLC --format json").json();
    let unused = |index: usize| report["operands"][index]["unused"].clone();
    assert_eq!(
        (unused(0), unused(1), unused(2)),
        (json!(false), json!(false), json!(false))
    );
}

#[test]
fn labels_at_one_place_have_their_own_uses() {
    let folder = folder(
        "USES PART\nEXTERN FAR\nCM 1\nCM FAR\nL M1\nJPT 3\nLBL 3\nCASE B0\nCM 1\nCM 2\nENDC\nL KF F\n= D0\nEM\n\
         LBL 1\nLBL 2\nLBL 4\nEM\nKFIELD F\nK1\nENDK\n",
    );
    folder.write("PART.PLC", "GLOBAL FAR\nLBL 1\nLBL FAR\nEM\n");
    let run = folder.bahn("plc xref MAIN.PLC --format json");
    let report = run.json();
    let lines = |places: &serde_json::Value| -> Vec<String> {
        let places = places.as_array().unwrap().iter();
        places
            .map(|place| format!("{}:{}", place["file"].as_str().unwrap(), place["line"]))
            .collect()
    };
    let labels: Vec<String> = report["labels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|label| {
            let name = label["label"].as_str().unwrap();
            let kind = label["kind"].as_str().unwrap();
            format!("{kind} {name}: {}", lines(&label["used"]).join(" "))
        })
        .collect();
    assert_eq!(
        labels,
        [
            "LBL 3: MAIN.PLC:6",
            "LBL 1: MAIN.PLC:3 MAIN.PLC:9",
            "LBL 2: MAIN.PLC:10",
            "LBL 4: ",
            "KFIELD F: MAIN.PLC:12",
            "LBL 1: ",
            "LBL FAR: MAIN.PLC:4",
        ]
    );
}

#[test]
fn signals_are_listed() {
    let folder = Folder::new();
    let run = folder.bahn("plc signals M2045 --format json");
    let list = run.json();
    assert_eq!(list.as_array().map(Vec::len), Some(1));
    assert_eq!(
        (&list[0]["name"], &list[0]["operand"]),
        (&json!("M_FUNCTION_STROBE"), &json!("M2045"))
    );
    assert_eq!(list[0]["set_by"], "NC");
    assert!(folder.bahn("plc signals").out().lines().count() > 500);
    let run = folder.bahn("plc signals fn19 strobe");
    assert!(
        run.out().contains("FN19_STROBE") && !run.out().contains("M2045"),
        "{}",
        run.out()
    );
}

/// Editors save UTF-16, scripts write to pipes: the program is the same.
#[test]
fn programs_come_in_utf_16_and_from_pipes() {
    let folder = folder(DOOR);
    let plain = folder.bahn("plc check MAIN.PLC").err();
    let units: Vec<u8> = DOOR.encode_utf16().flat_map(u16::to_le_bytes).collect();
    folder.write("WIDE.PLC", [&[0xff, 0xfe], units.as_slice()].concat());
    for model in ["tnc151", "tnc155", "tnc360", "tnc407", "tnc415b", "tnc425"] {
        let run = folder.bahn(&format!("plc check WIDE.PLC --model {model}"));
        assert_eq!(run.code(), 0, "{}", run.err());
    }
    // Bytes that are no text are refused at their place, whatever they are.
    folder.write(
        "BROKEN.PLC",
        [b"L I4\n".as_slice(), &[0, 0xd8, 0, 0x85, 0xff, b'[', 0, b'\n']].concat(),
    );
    let run = folder.bahn("plc check BROKEN.PLC --model tnc151");
    assert_eq!(run.code(), 1, "{}", run.err());
    assert!(run.err().contains("BROKEN.PLC:2:"), "{}", run.err());

    let mut child = folder
        .command()
        .args(["plc", "check", "/dev/stdin"])
        .stdin(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::io::Write::write_all(&mut child.stdin.take().unwrap(), DOOR.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let of_pipe = String::from_utf8(output.stderr).unwrap();
    assert_eq!(of_pipe.replace("/dev/stdin", "MAIN.PLC"), plain);
}

/// An error tells what is wrong, where that was opened which it does not fit, and what to do.
#[test]
fn compile_errors_help() {
    let folder = folder("L I4\nA[\nL I5\nJP 7\n]\nLBL 7\nEM\n");
    let err = folder.bahn("plc check MAIN.PLC").err();
    assert!(
        err.contains("error: 16 jump within a parenthesis\n --> MAIN.PLC:4:1"),
        "{err}"
    );
    assert!(err.contains("2 | A[\n  | -- opened here"), "{err}");
    assert!(
        err.contains("= help: A jump or call leaves an open bracket"),
        "{err}"
    );
}

/// The standard program is printed or written, and has no fault on its control; others have none.
#[test]
fn the_standard_program() {
    let folder = Folder::new();
    let printed = folder.bahn("plc standard");
    assert_eq!(printed.code(), 0, "{}", printed.err());
    assert_eq!(folder.bahn("plc standard -o MAIN.PLC --model tnc151").code(), 0);
    assert_eq!(folder.read("MAIN.PLC"), printed.out());
    for model in ["tnc151", "tnc155"] {
        let report = folder
            .bahn(&format!("plc check MAIN.PLC --model {model} --format json"))
            .json();
        let faults = [
            &report["ok"],
            &report["errors"],
            &report["warnings"],
            &report["load"],
        ];
        assert_eq!(faults, [&json!(true), &json!([]), &json!([]), &json!([])]);
    }
    let again = folder.bahn("plc standard -o MAIN.PLC");
    assert_eq!(again.code(), 0, "{}", again.err());
    let none = folder.bahn("plc standard --model tnc407");
    assert_eq!(none.code(), 2);
    assert!(
        none.err()
            .contains("the TNC 407 has no standard PLC program; TNC 151 and TNC 155 have one"),
        "{}",
        none.err()
    );
}
