//! `bahn technology`: programs with functions that the path waits for, on the command line.

use std::path::Path;

use crate::support::{Folder, Run, copy};
use serde_json::{Value, json};

/// Rapid traverse of 10 m/min, mm/s, and acceleration, mm/s².
const RAPID: f64 = 10_000.0 / 60.0;
const ACCELERATION: f64 = 1000.0;

/// A folder with a program, a list and a script.
fn folder(program: &str, list: &str, script: &str) -> Folder {
    let folder = Folder::new();
    folder.write("a.nc", program);
    folder.write("a.lis", list);
    folder.write("a.txt", script);
    folder
}

fn run(folder: &Folder, options: &str) -> (i32, Value) {
    let run = folder.bahn(&format!(
        "technology a.nc --channel a.lis {options} --format json"
    ));
    (run.code(), run.json())
}

/// Events of a kind as function, block and X.
fn events(report: &Value, kind: &str) -> Vec<(String, String, f64)> {
    let all = report["events"].as_array().unwrap().iter();
    let text = |event: &Value, key: &str| event[key].as_str().unwrap_or_default().to_owned();
    all.filter(|event| event["kind"] == kind)
        .map(|event| {
            let x = event["position"]["X"].as_f64().unwrap_or(f64::NAN);
            (text(event, "function"), text(event, "block"), x)
        })
        .collect()
}

fn time_of(report: &Value, kind: &str, function: &str) -> f64 {
    let mut all = report["events"].as_array().unwrap().iter();
    let event = all.find(|event| event["kind"] == kind && event["function"] == function);
    event.unwrap()["t"].as_f64().unwrap()
}

/// The blocks of the manual's example of MVS_SVS, with a type of its own [004:60].
const BLOCKS: &str = "%EXAMPLE\nN20 G00 X25\nN30 X50\nN40 X75 M25\nN50 G01 X100 F2000\nN60 X125 Z100\nM30\n";

/// Output and standstill at X50, and none at X75; the wait is as long as the script says [004:60].
#[test]
fn the_path_waits_at_the_start_of_a_block() {
    let folder = folder(BLOCKS, "m_synch[25] 0x2\n", "M25 ack 0.5\n");
    let (code, report) = run(&folder, "--plc a.txt --start X0");
    assert_eq!(
        (code, &report["completed"], &report["error"]),
        (0, &json!(true), &Value::Null)
    );
    assert_eq!(
        events(&report, "output"),
        [("M25".to_owned(), "N40".to_owned(), 50.0)]
    );
    assert_eq!(
        events(&report, "stop")
            .iter()
            .filter(|stop| stop.2 == 75.0)
            .count(),
        0
    );
    let waits = report["waits"].as_array().unwrap();
    assert_eq!(waits.len(), 1);
    assert_eq!(
        (&waits[0]["function"], &waits[0]["block"]),
        (&json!("M25"), &json!("N40"))
    );
    assert_eq!(waits[0]["position"]["X"], 50.0);
    let cycle = report["cycle_s"].as_f64().unwrap();
    let output = time_of(&report, "output", "M25");
    let acknowledged = time_of(&report, "acknowledge", "M25");
    assert!((acknowledged - output - 0.5).abs() <= cycle, "{report}");
    // 50 mm from standstill to standstill in rapid traverse: as long as the ramps at the speed they reach, if any.
    let reached = RAPID.min((50.0 * ACCELERATION).sqrt());
    let travel = 50.0 / reached + reached / ACCELERATION;
    assert!((output - travel).abs() <= 2.0 * cycle, "{output} is not {travel}");
}

/// `MP1010.0` of a list changes the rapid traverse of X, and nothing else.
#[test]
fn a_list_of_machine_parameters_may_hold_one_line() {
    let folder = folder("%P\nN10 G00 X200\nN20 Y200\nM30\n", "", "");
    folder.write("slow.mp", "MP1010.0 : 3000\n");
    let travel = |rapid: f64| 200.0 / rapid + rapid / ACCELERATION;
    let time = |options: &str| run(&folder, options).1["time_s"].as_f64().unwrap();
    let [plain, slow] = [time("--start X0,Y0"), time("--start X0,Y0 --parameters slow.mp")];
    assert!((plain - 2.0 * travel(RAPID)).abs() < 0.02, "{plain}");
    assert!((slow - travel(RAPID) - travel(50.0)).abs() < 0.02, "{slow}");
    folder.write("wrong.mp", "MP1010.0 : fast\n");
    assert_eq!(
        folder
            .bahn("technology a.nc --channel a.lis --parameters wrong.mp")
            .code(),
        2
    );
}

/// Without a script each function takes its process time [004:225].
#[test]
fn a_plc_that_is_not_there_takes_the_process_time() {
    let folder = folder(BLOCKS, "m_synch[25] 2\nm_prozess_zeit[25] 700000 # 0.7 s\n", "");
    let (_, report) = run(&folder, "");
    // Axes that are programmed first stand at 0.
    assert_eq!(events(&report, "go").first().map(|go| go.2), Some(0.0));
    let taken = time_of(&report, "acknowledge", "M25") - time_of(&report, "output", "M25");
    assert!((taken - 0.7).abs() <= 0.003, "{taken}");
}

/// A list with an error ends the run before it begins, in both formats.
#[test]
fn a_wrong_list_ends_the_run_before_the_first_event() {
    let folder = folder(BLOCKS, "m_synch[25] MVS_SVS\nm_synch[26] MVS_SVX\n", "");
    let (code, report) = run(&folder, "--start X5");
    assert_eq!(
        (code, &report["completed"], &report["events"]),
        (1, &json!(false), &json!([]))
    );
    let error = &report["error"];
    assert!(
        error["message"].as_str().unwrap().contains("`MVS_SVX`"),
        "{error}"
    );
    assert_eq!(
        (&error["program"], &error["block"]),
        (&json!("a.lis"), &json!("#2"))
    );
    assert_eq!(report["path_end"], json!({ "X": 5.0, "Z": 0.0 }));
    let run = folder.bahn("technology a.nc --channel a.lis");
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("a.lis:2:13") && run.out().contains("ended by an error"),
        "{}",
        run.out()
    );
}

/// A function without a type is P-ERR-20157 at its block, those before it have been output [004:42].
#[test]
fn an_unknown_function_ends_the_run_at_its_block() {
    let folder = folder("%P\nN010 M25\nN020 X10 M26\nM30\n", "m_synch[25] 2\n", "");
    let (code, report) = run(&folder, "");
    assert_eq!(code, 1);
    let error = &report["error"];
    assert_eq!(
        (&error["code"], &error["block"]),
        (&json!("P-ERR-20157"), &json!("N20"))
    );
    assert_eq!(error["program"], "a.nc");
}

/// Subroutines lie beside their program and are found without regard to case; a fault within names their file.
#[test]
fn subroutines_lie_beside_their_program() {
    let folder = folder(
        "%P\nN10 X0\nN20 L Laser_on.sub\nN30 X10\nM30\n",
        "m_synch[7] 1\n",
        "",
    );
    folder.write("LASER_ON.SUB", "N1 X5\nN2 M7\nM17\n");
    let (code, report) = run(&folder, "");
    assert_eq!(code, 0, "{report}");
    assert_eq!(
        events(&report, "output"),
        [("M7".to_owned(), "N2".to_owned(), 5.0)]
    );
    folder.write("LASER_ON.SUB", "N1 X5\nN2 M8\nM17\n");
    let (code, report) = run(&folder, "");
    assert_eq!((code, &report["error"]["program"]), (1, &json!("LASER_ON.SUB")));
    assert_eq!(report["error"]["block"], "N2");
    std::fs::remove_file(folder.path("LASER_ON.SUB")).unwrap();
    assert_eq!(run(&folder, "").1["error"]["block"], "N20");
}

/// Late functions stay open over the end of a program, and time goes on [004:78].
#[test]
fn programs_run_in_turn() {
    let folder = folder(
        "%PRG1\nN05 M26 G00 X25\nN10 M27\nM30\n",
        "m_synch[26] 0x4000\nm_synch[27] 0x8000\n",
        "M26 ack 2\nM27 ack 4\n",
    );
    folder.write("b.nc", "%PRG2\nN10 G01 F100 X26\nN20 #EXPL SYN\nN30 X27\nM30\n");
    let report = folder
        .bahn("technology a.nc b.nc --channel a.lis --plc a.txt --start X0 --format json")
        .json();
    assert_eq!(report["completed"], true, "{report}");
    let waits: Vec<(&str, f64)> = report["waits"]
        .as_array()
        .unwrap()
        .iter()
        .map(|wait| {
            (
                wait["function"].as_str().unwrap(),
                wait["position"]["X"].as_f64().unwrap(),
            )
        })
        .collect();
    assert_eq!(waits, [("M26", 25.0), ("M27", 26.0)]);
}

/// Blocks before the one of `--from` are neither run nor output.
#[test]
fn a_run_may_begin_at_a_block() {
    let folder = folder(
        "%P\nN10 G01 F1000 X10 M25\nN20 X20 M26\nN30 X30 M25\nM30\n",
        "m_synch[25] 1\nm_synch[26] 1\n",
        "",
    );
    let (_, report) = run(&folder, "--from n020");
    let blocks: Vec<String> = events(&report, "output")
        .into_iter()
        .map(|event| event.1)
        .collect();
    assert_eq!(blocks, ["N20", "N30"]);
    assert_eq!(run(&folder, "--from N25").0, 1);
    assert_eq!(folder.bahn("technology a.nc --channel a.lis --from M5").code(), 2);
}

/// A name means one file, whoever reads the program: beside it or in a folder below, written so or in another case.
#[test]
fn names_of_subroutines_mean_the_same_to_all() {
    let program = "%P\nN10 G01 F1000 X10\nN20 L Sub.NC\nN30 L folder\\PART.nc\nM30\n";
    let folder = folder(program, "", "");
    folder.write("sub.nc", "N100 X20\nM17\n");
    std::fs::create_dir(folder.path("folder")).unwrap();
    folder.write("folder/part.nc", "N200 X30\nM17\n");
    for command in ["technology a.nc --channel a.lis", "test a.nc", "check a.nc"] {
        let run = folder.bahn(command);
        assert_eq!(run.code(), 0, "{command}: {}{}", run.err(), run.out());
    }
    let (_, report) = run(&folder, "");
    assert_eq!(report["path_end"]["X"], 30.0);
    // One that is written so goes first.
    folder.write("Sub.NC", "N100 #NONSENSE\nM17\n");
    for command in ["technology a.nc --channel a.lis", "test a.nc", "check a.nc"] {
        assert_ne!(folder.bahn(command).code(), 0, "{command}");
    }
}

/// Also in a subroutine beside the program; what was passed over is listed with its last state.
#[test]
fn a_run_may_begin_in_a_subroutine() {
    let folder = folder(
        "%P\nN10 G01 F1000 X10 M25=1\nN20 L SUB\nN30 X30 M25\nM30\n",
        "m_synch[25] 1\nm_synch[26] 1\n",
        "",
    );
    folder.write("SUB.nc", "%SUB\nN100 X20 M25=2\nN110 X25 M26\nM17\n");
    let (code, report) = run(&folder, "--from N110");
    assert_eq!(code, 0);
    let expected =
        json!([{"function": "M25", "value": 2, "target": "channel", "program": "SUB.nc", "block": "N100"}]);
    assert_eq!(report["skipped"], expected);
    let blocks: Vec<String> = events(&report, "output")
        .into_iter()
        .map(|event| event.1)
        .collect();
    assert_eq!(blocks, ["N110", "N30"]);
    let text = folder.bahn("technology a.nc --channel a.lis --from N110").out();
    let (_, listed) = text.split_once("Not output before the block").unwrap();
    assert!(listed.contains("M25=2") && listed.contains("SUB.nc"), "{text}");
    assert_eq!(run(&folder, "").1["skipped"], Value::Null);
}

/// Single block: the functions of a block go out with its start.
#[test]
fn a_run_block_by_block() {
    let folder = folder(
        "%P\nN10 G01 F1000 X10\nN20 X20 M25\nM30\n",
        "m_synch[25] 1\n",
        "single 0..9\nstart 0.1\nstart 3\nstart 6\n",
    );
    let (code, report) = run(&folder, "--plc a.txt");
    assert_eq!((code, time_of(&report, "output", "M25")), (0, 3.0));
    assert_eq!(report["waits"], json!([]));
    assert_eq!(report["time_s"], 6.0);
    // The first start comes while the path moves.
    let warning = report["warnings"][0]["message"].as_str().unwrap();
    assert!(warning.contains("0.1 s has no effect"), "{warning}");
}

/// A lead in time is at least a cycle of the control that runs the path: 6 ms of a TNC 407, 3 ms without a list.
#[test]
fn a_short_lead_counts_by_the_cycle_of_the_run() {
    let folder = folder(BLOCKS, "m_synch[25] MET_SVS\nm_pre_outp[25] 4000\n", "");
    folder.write("a.mp", "; TNC 407\nMP1010.0 : 10000\n");
    let command = "technology a.nc --channel a.lis";
    assert!(!folder.bahn(command).err().contains("21203"));
    let slow = folder.bahn(&format!("{command} --parameters a.mp")).err();
    assert!(slow.contains("6000 us here"), "{slow}");
}

/// What nobody acknowledges ends a run that is not completed, and is no error.
#[test]
fn a_run_that_can_go_nowhere_ends() {
    let folder = folder(BLOCKS, "m_synch[25] 2\n", "M25 ack never\n");
    let (code, report) = run(&folder, "--plc a.txt");
    assert_eq!(
        (code, &report["completed"], &report["error"]),
        (1, &json!(false), &Value::Null)
    );
    assert_eq!(report["waits"][0]["to_s"], Value::Null);
    let text: Run = folder.bahn("technology a.nc --channel a.lis --plc a.txt --image a.svg");
    assert!(
        text.out().contains("never") && text.out().contains("not completed"),
        "{}",
        text.out()
    );
    assert!(folder.read("a.svg").contains("not completed"));
}

/// Whatever cannot be read is wrong use, and nothing that is read is written over.
#[test]
fn wrong_use_is_reported() {
    let folder = folder(BLOCKS, "m_synch[25] 2\n", "M25 ack soon\n");
    for options in [
        "--plc a.txt",
        "--plc none.txt",
        "--start Q5",
        "--image a.gif",
        "--parameters none.mp",
    ] {
        let run = folder.bahn(&format!("technology a.nc --channel a.lis {options}"));
        assert_eq!(
            (run.code(), run.out()),
            (2, String::new()),
            "{options}: {}",
            run.err()
        );
    }
    let script = folder.bahn("technology a.nc --channel a.lis --plc a.txt").err();
    assert!(script.contains("a.txt:1:9\n"), "{script}");
    assert_eq!(folder.bahn("technology a.nc").code(), 2, "a list is needed");
    assert_eq!(folder.bahn("technology none.nc --channel a.lis").code(), 2);
    folder.write("sub.nc", "%L SUB\nN10 M17\n");
    assert_eq!(
        folder.bahn("technology sub.nc --channel a.lis").code(),
        2,
        "no program"
    );
    std::fs::copy(folder.path("a.nc"), folder.path("a.svg")).unwrap();
    assert_eq!(
        folder
            .bahn("technology a.svg --channel a.lis --image a.svg")
            .code(),
        2
    );
    assert_eq!(folder.read("a.svg"), BLOCKS);
}

/// The shipped examples do what their comments say, and their pictures name each function.
#[test]
fn the_examples_do_what_they_say() {
    let folder = Folder::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    copy(&root.join("examples/technology"), &folder.path("t"));
    for name in ["glue", "laser"] {
        let list = folder
            .bahn(&format!("channel check t/{name}.lis --format json"))
            .json();
        assert_eq!(
            (&list["ok"], &list["warnings"]),
            (&json!(true), &json!([])),
            "{name}"
        );
    }
    let report = folder
        .bahn("technology t/glue.nc --channel t/glue.lis --plc t/slow-valve.txt --format json --image g.svg")
        .json();
    // M26 goes out 6 mm before the end of the bead, which ends with a quarter of a circle of 10 mm around X30 Y30.
    let angle = 6.0 / 10.0_f64;
    let (x, y) = (30.0 - 10.0 * angle.cos(), 30.0 - 10.0 * angle.sin());
    let off = report["events"]
        .as_array()
        .unwrap()
        .iter()
        .find(|event| event["function"] == "M26");
    let position = &off.unwrap()["position"];
    assert!((position["X"].as_f64().unwrap() - x).abs() < 0.001, "{position}");
    assert!((position["Y"].as_f64().unwrap() - y).abs() < 0.001, "{position}");
    let svg = folder.read("g.svg");
    for words in [
        "glue.nc",
        ">M25<",
        ">M26<",
        ">H5=4711<",
        " s for M7<",
        "N110 M26",
        "velocity,",
        "time, s",
    ] {
        assert!(svg.contains(words), "{words}");
    }
    let laser = folder
        .bahn("technology t/laser.nc --channel t/laser.lis --format json --image l.png")
        .json();
    let outputs: Vec<(String, f64)> = events(&laser, "output")
        .into_iter()
        .map(|event| (event.0, event.2))
        .collect();
    let expected = [
        ("M12", 0.0),
        ("M300", 5.0),
        ("M500", 19.95),
        ("M300", 22.0),
        ("M500", 39.95),
    ];
    assert_eq!(outputs, expected.map(|(name, x)| (name.to_owned(), x)));
    let cycle = laser["cycle_s"].as_f64().unwrap() * 1e6;
    for event in laser["events"].as_array().unwrap() {
        let offset = event["offset_us"].as_f64();
        assert!(
            offset.is_none_or(|offset| (0.0..cycle).contains(&offset)),
            "{event}"
        );
    }
    assert_eq!(&std::fs::read(folder.path("l.png")).unwrap()[1..4], b"PNG");
}

/// The PLC of the gantry: the nozzle takes 150 ms (plant.toml), the printer T9 of 50 cycles, everything else is done at once; a
/// cycle of it is 20 ms.
#[test]
fn the_plc_of_a_machine_answers() {
    let folder = Folder::new();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/technology");
    copy(&examples, &folder.path("."));
    let gantry = crate::support::machines().join("gantry");
    let command = format!(
        "technology glue.nc --channel glue.lis --plc {} --format json",
        gantry.display()
    );
    let run = folder.bahn(&command);
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let took =
        |function: &str| time_of(&report, "acknowledge", function) - time_of(&report, "output", function);
    // A scan that sees it, and at most as much until the end of the scan that sees that it is done.
    let within = |took: f64, done: f64| assert!((done..=done + 0.046).contains(&took), "{took} {done}");
    within(took("M7"), 0.0);
    within(took("M25"), 0.150);
    within(took("H5"), 1.0);
    // The glue runs out of the nozzle in the same time, for which nobody waits.
    assert_eq!(report["waits"].as_array().unwrap().len(), 2);
    // What happens to the path, a script says beside it.
    folder.write("door.txt", "hold 3.0..3.4\n");
    let held = folder.bahn(&format!("{command} --plc door.txt")).json();
    let longer = held["time_s"].as_f64().unwrap() - report["time_s"].as_f64().unwrap();
    assert!((0.3..0.6).contains(&longer), "{longer}");
}

#[test]
fn a_machine_that_does_not_answer_or_cannot() {
    let folder = folder(BLOCKS, "m_synch[25] 0x2\n", "M25 ack 1\n");
    copy(&crate::support::machines().join("gantry"), &folder.path("gantry"));
    // The PLC looks into B128 and not into B0: after a minute it is given up.
    let silent = folder.bahn("technology a.nc --channel a.lis --plc gantry --window B0 --format json");
    let report = silent.json();
    assert_eq!((silent.code(), &report["error"]), (1, &Value::Null));
    assert_eq!(report["waits"][0]["to_s"], Value::Null);
    assert!(
        silent.err().contains("does it look at B0 to B127?"),
        "{}",
        silent.err()
    );
    // An error of the index, in the scan that sees the function, stops PLC and run.
    let text = folder.read("gantry/plc/MAIN.PLC");
    let free = "       EMT                ; a free slot\n";
    let index = "       L     K+8000\n       =X\n       L     K+1\n       = B128[X]\n";
    folder.write(
        "gantry/plc/MAIN.PLC",
        text.replace(free, &format!("{free}{index}")),
    );
    let (code, report) = self::run(&folder, "--plc gantry");
    assert_eq!((code, &report["error"]["code"]), (1, &json!("plc")));
    let line = 1
        + text
            .lines()
            .take_while(|line| !line.contains("; a free slot"))
            .count()
        + 4;
    let message = report["error"]["message"].as_str().unwrap();
    assert!(
        message.starts_with(&format!("MAIN.PLC:{line}: PLC error 56")),
        "{message}"
    );
}

#[test]
fn who_answers_is_said_once() {
    let folder = folder(BLOCKS, "m_synch[25] 0x2\n", "M25 ack 1\n");
    copy(&crate::support::machines().join("gantry"), &folder.path("gantry"));
    for (options, said) in [
        ("--plc gantry --plc a.txt", "a script says only"),
        ("--plc a.txt --plc a.txt", "one of each"),
        ("--plc gantry --window W128", "B0 to B128"),
        ("--plc gantry --window B132", "B0 to B128"),
        ("--plc nothing", "nothing"),
    ] {
        let run = folder.bahn(&format!("technology a.nc --channel a.lis {options}"));
        assert_eq!(run.code(), 2, "{options}");
        assert!(run.err().contains(said), "{options}: {}", run.err());
    }
    folder.write("gantry/plc/MAIN.PLC", "       L     X5\n       EM\n");
    let run = folder.bahn("technology a.nc --channel a.lis --plc gantry");
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("MAIN.PLC:1"), "{}", run.err());
}

/// All that is wrong stands with its line and a mark on standard error, with what is probably meant: in list, script and program.
#[test]
fn what_is_wrong_has_its_place() {
    let program = "N10 G01 F1000 X1O\nN20 X[M7 Y5\nN30 X5 M8\nM30\n";
    let folder = folder(
        program,
        "m_synch[7] MOS\n",
        "M7 akc 1\nM9 ack 0\nspindle S3 ready 1\n",
    );
    let text = folder.bahn("technology a.nc --channel a.lis").err();
    for words in [
        "--> a.nc:1:17",
        "help: did you mean `X10`?",
        "--> a.nc:2:",
        "help: `]` is missing for the bracket in column 6",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let script = folder.bahn("technology a.nc --channel a.lis --plc a.txt");
    let reported = script.err();
    for words in [
        "--> a.txt:1:4",
        "did you mean `ack`?",
        "--> a.txt:2:1",
        "did you mean `M7`?",
        "--> a.txt:3:9",
    ] {
        assert!(reported.contains(words), "{words}: {reported}");
    }
    assert_eq!(script.code(), 2);
    let (code, report) = run(&folder, "--plc a.txt");
    assert_eq!((code, &report["error"]["code"]), (2, &json!("script")));
    let found = report["diagnostics"].as_array().unwrap();
    let places: Vec<_> = found
        .iter()
        .map(|one| (one["file"].as_str().unwrap(), one["line"].as_u64().unwrap()))
        .collect();
    assert_eq!(
        places,
        [("a.nc", 1), ("a.nc", 2), ("a.txt", 1), ("a.txt", 2), ("a.txt", 3)]
    );
    assert_eq!(found[0]["help"], "did you mean `X10`?");
    // A fault of the run: M8 has no type.
    folder.write("a.nc", "N30 X5 M8\nM30\n");
    let ended = folder.bahn("technology a.nc --channel a.lis");
    assert!(ended.err().contains("--> a.nc:1:1") && ended.err().contains("help: give the function a type"));
    assert_eq!(ended.code(), 1);
    folder.write("a.lis", "m_sinch[8] MOS\nm_synch[7 MOS\nm_synch[8] MVS_SSV\n");
    let list = folder.bahn("channel check a.lis");
    for words in [
        "did you mean `m_synch[8]`?",
        "did you mean `m_synch[7]`?",
        "did you mean `MVS_SVS`?",
    ] {
        assert!(list.err().contains(words), "{words}: {}", list.err());
    }
    let json = folder.bahn("channel check a.lis --format json").json();
    assert_eq!(json["errors"][2]["help"], "did you mean `MVS_SVS`?");
    assert_eq!(json["errors"][2]["length"], 7);
}

/// A run that takes longer than it may ends at its block, as `bahn run` does.
#[test]
fn a_run_has_limits() {
    let folder = folder("N10 G01 F1 X100\nM30\n", "", "");
    let (code, report) = run(&folder, "--max-time 5");
    assert_eq!(code, 1);
    assert_eq!(
        (&report["error"]["code"], &report["error"]["block"]),
        (&json!("endless"), &json!("N10"))
    );
    assert!((report["time_s"].as_f64().unwrap() - 5.0).abs() < 0.01);
    let (code, report) = run(&folder, "--max-blocks 1");
    assert_eq!((code, &report["error"]["code"]), (1, &json!("endless")));
    let wrong = folder.bahn("technology a.nc --channel a.lis --max-time 0");
    assert_eq!((wrong.code(), wrong.out()), (2, String::new()));
}
