//! What options, tables and machine folders set.

use serde_json::json;

use crate::support::{Folder, assert_near, number, rows};

#[test]
fn q_parameters_are_set() {
    let folder = Folder::with_program("FN1: Q3 = +Q1 + +Q2\nL X+Q3 R0 F100");
    for arguments in [
        "--set Q1=5 --set Q2=-7.5",
        "--set Q1=5,Q2=-7.5",
        "--set q1=+5,Q2=-7.5",
    ] {
        let (code, report) = folder.test(arguments);
        assert_eq!(code, 0);
        assert_near(number(&report, "/q/3"), -2.5);
        assert_near(number(&report, "/final_position/X"), -2.5);
    }
    for wrong in [
        "--set Q1",
        "--set 1=5",
        "--set Q1=x",
        "--set Q9999=1",
        "--set Q1=5,5",
    ] {
        let run = folder.bahn(&format!("test main.H {wrong}"));
        assert_eq!(run.code(), 2, "{wrong}");
        assert!(run.err().contains("--set"), "{}", run.err());
    }
}

#[test]
fn tools_come_from_a_table() {
    let folder = Folder::with_program(
        "TOOL CALL 2 Z S500\nL X+0 Y+0 R0 FMAX\nL X+20 Y+0 RR F100\nL X+50\nL X+50 Y+40\nL Y+60",
    );
    folder.write("tools.txt", "T L R R2 NAME\n2 100 4 0 END MILL\n");
    let (code, report) = folder.test("--tools tools.txt --path out.csv");
    assert_eq!(code, 0, "{report}");
    assert_near(number(&report, "/q/108"), 4.0);
    assert_near(number(&report, "/q/114"), 100.0);
    // With RR the centre runs 4 mm on the right of +X.
    assert_eq!(rows(&folder.read("out.csv"))[1][5], "-4");
    // A tool that is not in the table is an error, and so is a table that cannot be read.
    folder.write("tools.txt", "T L R\n1 100 4\n");
    let (code, report) = folder.test("--tools tools.txt");
    assert_eq!(
        (code, &report["error"]["message"]),
        (1, &json!("TOOL NOT DEFINED"))
    );
    folder.write("tools.txt", "T L R\n1 100 x\n");
    let run = folder.bahn("test main.H --tools tools.txt");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("tools.txt: line 2: R: `x` is no number"),
        "{}",
        run.err()
    );
    assert_eq!(folder.bahn("test main.H --tools nothing.txt").code(), 2);
}

#[test]
fn machine_parameters_come_from_list_and_options() {
    // MP1060: the ramps of 100 mm at 100 mm/s take v / a = 0.1 s at 1 m/s², 1 s at 0.1 m/s².
    let folder = Folder::with_program("L X+0 R0 F6000\nL X+100");
    let time = |arguments: &str| number(&folder.test(arguments).1, "/machining_time_s");
    assert_near(time(""), 1.1);
    assert_near(time("--mp 1060.0=0.1"), 2.0);
    folder.write("machine.mp", "; slow\nMP1060.0 : 0.1 ;m/s2\n");
    assert_near(time("--parameters machine.mp"), 2.0);
    // Single ones replace those of the list; MP1010.0 = 3000 mm/min is 50 mm/s with a ramp of 0.05 s.
    assert_near(time("--parameters machine.mp --mp 1060.0=1,1010.0=3000"), 2.05);
    for wrong in [
        "--mp 1060.0",
        "--mp 1060.0=-1",
        "--mp 9999=1",
        "--parameters nothing.mp",
    ] {
        assert_eq!(folder.bahn(&format!("test main.H {wrong}")).code(), 2, "{wrong}");
    }
    folder.write("machine.mp", "MP1060.0 : much\n");
    let run = folder.bahn("test main.H --parameters machine.mp");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("machine.mp: line 1"), "{}", run.err());
}

#[test]
fn the_override_acts_on_the_time() {
    let folder = Folder::with_program("L X+0 R0 F600\nL X+100");
    // 100 mm at 10, 5, 15 mm/s, and v / a for the ramps.
    for (percent, time) in [("100", 10.01), ("50", 20.005), ("150", 100.0 / 15.0 + 0.015)] {
        let (_, report) = folder.test(&format!("--override {percent}"));
        assert_near(number(&report, "/machining_time_s"), time);
    }
    let (code, report) = folder.test("--override 0");
    assert_eq!(
        (code, &report["machining_time_s"], &report["completed"]),
        (0, &json!(null), &json!(true))
    );
    for wrong in ["151", "-1", "x"] {
        assert_eq!(folder.bahn(&format!("test main.H --override={wrong}")).code(), 2);
    }
}

#[test]
fn auxiliary_times_are_options() {
    let folder = Folder::with_program("TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S100\nL Z+0 R0 FMAX M3\nM8");
    let time = |arguments: &str| number(&folder.test(arguments).1, "/machining_time_s");
    // Tool change 6 s and spindle start 1 s by default.
    assert_near(time(""), 7.0);
    // 20 + 3 and two M functions of 0.5 s.
    assert_near(time("--tool-change-time 20 --spindle-time 3 --m-time 0.5"), 24.0);
    assert_eq!(folder.bahn("test main.H --m-time=-1").code(), 2);
}

#[test]
fn optional_blocks_are_passed_over() {
    let folder = Folder::with_program("L X+0 R0 F100\n/L X+10\nL X+1");
    assert_near(number(&folder.test("").1, "/path_mm/feed"), 19.0);
    let (_, report) = folder.test("--skip-blocks");
    assert_near(number(&report, "/path_mm/feed"), 1.0);
    assert_eq!(report["blocks_executed"], 2);
}

#[test]
fn the_start_position_adds_the_first_way() {
    let folder = Folder::with_program("L X+10 Y+0 R0 F100");
    let (_, report) = folder.test("--start X4,Y8,Z-2.5");
    // hypot(6, 8)
    assert_near(number(&report, "/path_mm/feed"), 10.0);
    assert_eq!(report["final_position"], json!({"X": 10.0, "Y": 0.0, "Z": -2.5}));
    for wrong in [
        "--start Q1",
        "--start X",
        "--start X1,X2",
        "--start X1e9",
        "--start X=nan",
    ] {
        assert_eq!(folder.bahn(&format!("test main.H {wrong}")).code(), 2, "{wrong}");
    }
}

#[test]
fn models_differ() {
    // Formulas came with the TNC 407; WRONG RPM is the text of the TNC 360.
    let folder = Folder::with_program("Q1 = SIN 30 + 2");
    assert_near(number(&folder.test("--model tnc415b").1, "/q/1"), 2.5);
    assert_eq!(folder.test("--model tnc360").0, 1);
    let folder = Folder::with_program("TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S99999.5");
    assert_eq!(folder.test("--model tnc360").1["error"]["message"], "WRONG RPM");
    assert_eq!(
        folder.test("--model tnc415b").1["error"]["message"],
        "WRONG SPINDLE SPEED"
    );
    assert_eq!(folder.bahn("test main.H --model tnc430").code(), 2);
}

/// FN14 shows the texts of the machine: 300 is PLC message 0, 400 dialogue 0 [003:4364-4367].
#[test]
fn fn14_shows_the_texts_of_the_machine() {
    let folder = Folder::with_program("FN14: ERROR= 302");
    let message = |options: &str| {
        let run = folder.bahn(&format!("test main.H --format json {options}"));
        run.json()["error"]["message"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    };
    let made = folder.bahn("machine new m --model tnc360");
    assert_eq!(made.code(), 0, "{}", made.err());
    let description = folder.read("m/machine.toml");
    let texts = |key: &str| {
        let name = description
            .lines()
            .find_map(|line| {
                line.strip_prefix(key)?
                    .trim()
                    .strip_prefix('=')?
                    .trim()
                    .strip_prefix('"')
            })
            .map(|name| name.trim_end_matches('"').to_owned());
        name.unwrap_or_else(|| panic!("{key} in {description}"))
    };
    let file = format!("m/{}", texts("plc_messages"));
    folder.write(&file, "NONE\nONE\nCLOSE THE DOOR\n");
    assert_eq!(message("--model tnc360"), "PLC ERROR 02");
    assert_eq!(message("--machine m"), "CLOSE THE DOOR");
    // Model, parameters and tools are those of the machine, too.
    let run = folder.bahn("test main.H --machine m --model tnc360");
    assert_eq!(run.code(), 2, "{}", run.err());
    folder.write(
        "main.H",
        "BEGIN PGM MAIN MM\nTOOL CALL 77 Z S500\nEND PGM MAIN MM\n",
    );
    assert_eq!(message("--machine m"), "TOOL NOT DEFINED");
    let text = folder.bahn("test main.H --machine m --report shelf.json");
    assert!(
        text.out().contains("TOOL NOT DEFINED"),
        "{}{}",
        text.out(),
        text.err()
    );
    folder.write("m/plc/MAIN.PLC", "EM X\n");
    let broken = folder.bahn("test main.H --machine m");
    assert_eq!(broken.code(), 2);
    assert!(
        broken.err().contains("`bahn machine check` shows all"),
        "{}",
        broken.err()
    );
}

/// A parameter of the command line that does nothing here, or only part of it, is told so.
#[test]
fn parameters_of_the_command_line_say_what_they_do_not() {
    let folder = Folder::with_program("L X+1 R0 FMAX");
    let made = folder.bahn("machine new m --model tnc415b");
    assert_eq!(made.code(), 0, "{}", made.err());
    for command in [
        "test main.H",
        "test main.H --report shelf.json",
        "run main.H --machine m --fresh --no-graphics",
    ] {
        let run = folder.bahn(&format!("{command} --mp 7350=5,7680=1,1060.0=2"));
        assert_eq!(run.code(), 0, "{command}: {}", run.err());
        let said = run.err();
        assert!(
            said.contains("warning: --mp 7350=5: MP7350 has no effect here: colours of the screen"),
            "{command}: {said}"
        );
        assert!(
            said.contains("--mp 7680=1: MP7680 acts in part here, without: "),
            "{command}: {said}"
        );
        assert!(!said.contains("MP1060"), "{command}: {said}");
    }
}
