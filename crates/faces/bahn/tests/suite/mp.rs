//! `bahn mp`: check, list, explain, diff, new.

use crate::support::Folder;
use serde_json::{Value, json};

const MODELS: [&str; 6] = ["tnc151", "tnc155", "tnc360", "tnc407", "tnc415b", "tnc425"];

/// A folder with the complete reference list of the TNC 415 B, as `mill.mp`.
fn mill() -> Folder {
    let folder = Folder::new();
    assert_eq!(folder.bahn("mp new -o mill.mp").code(), 0);
    folder
}

/// Replaces the line of a parameter.
fn replace(folder: &Folder, from: &str, to: &str, start: &str, line: &str) {
    let text = folder.read(from);
    assert!(text.lines().any(|old| old.starts_with(start)), "no line {start}");
    let lines = text
        .lines()
        .map(|old| if old.starts_with(start) { line } else { old });
    folder.write(to, lines.collect::<Vec<_>>().join("\n") + "\n");
}

#[test]
fn new_lists_are_complete_and_without_faults() {
    let folder = Folder::new();
    for model in MODELS {
        for kind in ["", "--smallest"] {
            assert_eq!(
                folder
                    .bahn(&format!("mp new {kind} --model {model} -o {model}.mp"))
                    .code(),
                0
            );
            let run = folder.bahn(&format!("mp check {model}.mp"));
            assert_eq!(run.code(), 0, "{model}: {}", run.err());
            // The list names its control.
            assert!(
                run.err().contains(&format!("{model}.mp: {model}, ")),
                "{}",
                run.err()
            );
            assert!(run.err().ends_with("0 errors, 0 warnings\n"), "{}", run.err());
        }
    }
    let run = folder.bahn("mp check .");
    assert_eq!((run.code(), run.err().lines().count()), (0, 6), "{}", run.err());
}

#[test]
fn new_prints_the_list_and_completes_others() {
    let folder = Folder::new();
    let reference = folder.bahn("mp new --reference-only").out();
    assert!(
        reference.contains("MP1060.0 : 1           ;acceleration"),
        "{reference}"
    );
    assert!(
        !reference.contains("MP4110.0"),
        "what has the smallest value is not there"
    );
    folder.write("part.mp", "; my mill, TNC 360\r\nMP1010.0 : 8000 ;slow\r\n");
    assert_eq!(folder.bahn("mp check part.mp").code(), 1);
    let run = folder.bahn("mp new --from part.mp -o part.mp");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        folder
            .read("part.mp")
            .starts_with("; my mill, TNC 360\r\nMP1010.0 : 8000 ;slow\r\n")
    );
    assert_eq!(folder.bahn("mp check part.mp").code(), 0);
    // A list with faults is not completed, and stays.
    folder.write("bad.mp", "MP1010.0 : x\n");
    assert_eq!(folder.bahn("mp new --from bad.mp -o bad.mp").code(), 2);
    assert_eq!(folder.read("bad.mp"), "MP1010.0 : x\n");
}

#[test]
fn check_shows_all_faults_with_their_places() {
    let folder = Folder::new();
    folder.write(
        "bad.mp",
        "; TNC 415 B\nMP10 : %00111\nMP1060.0 : 9 ;too fast\nMP7430 1.2 mm\nfoo\nMP10 : 1\nMP77 : 1\n",
    );
    let run = folder.bahn("mp check --partial bad.mp");
    assert_eq!(run.code(), 1);
    let err = run.err();
    for expected in [
        "error: 3 Entry value incorrect\n --> bad.mp:3:12",
        "MP1060.0: 9 is not between 0.001 and 5",
        "help: MP1060.0 is Acceleration, 0.001 to 5 m/s^2",
        "error: 2 No separator \";\" found\n --> bad.mp:4:12",
        "error: 0 No MP number found\n --> bad.mp:5:1",
        "error: 4 MP doubly defined\n --> bad.mp:6:1",
        "MP10 is already defined in line 2",
        "error: 1 Invalid MP number\n --> bad.mp:7:1",
        "bad.mp: tnc415b, 1 parameter (0 without effect here, 0 in part), 5 errors, 0 warnings",
    ] {
        assert!(err.contains(expected), "{expected} is not in {err}");
    }
    // The whole list lacks most parameters; what has a faulty line is not missing.
    let err = folder.bahn("mp check bad.mp").err();
    assert!(
        err.contains("error: 5 MP not defined: ") && err.contains(" MP1010.0-4 "),
        "{err}"
    );
    assert!(
        err.contains(" MP1060.1-4 ") && !err.contains("MP7430 MP7431"),
        "{err}"
    );
}

#[test]
fn check_reports_as_json() {
    let folder = mill();
    replace(&folder, "mill.mp", "bad.mp", "MP7431 ", "MP7431   : 0.5 ;wide");
    replace(&folder, "mill.mp", "odd.mp", "MP110.1 ", "MP110.1  : 0");
    let run = folder.bahn("mp check bad.mp odd.mp --format json");
    assert_eq!((run.code(), run.err().as_str()), (1, ""));
    let report = run.json();
    assert_eq!(
        (&report[0]["file"], &report[0]["model"]),
        (&json!("bad.mp"), &json!("tnc415b"))
    );
    let error = &report[0]["errors"][0];
    assert_eq!(
        (&error["number"], &error["text"]),
        (&json!(3), &json!("Entry value incorrect"))
    );
    assert_eq!(
        (&error["parameter"], &error["column"], &error["length"]),
        (&json!("MP7431"), &json!(12), &json!(3))
    );
    assert_eq!(report[0]["errors"].as_array().map(Vec::len), Some(1));
    let warning = &report[1]["warnings"][0];
    assert_eq!(warning["text"], "two axes have the same encoder input");
    assert_eq!(
        (&warning["parameter"], &warning["number"]),
        (&json!("MP110.1"), &Value::Null)
    );
    assert_eq!(report[1]["errors"], json!([]));
}

#[test]
fn check_goes_on_after_files_that_cannot_be_read() {
    let folder = mill();
    let run = folder.bahn("mp check nothing.mp mill.mp");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("nothing.mp") && run.err().contains("mill.mp: tnc415b"),
        "{}",
        run.err()
    );
    let empty = Folder::new();
    let run = empty.bahn("mp check .");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("holds no list of machine parameters"),
        "{}",
        run.err()
    );
}

#[test]
fn warnings_say_what_does_not_go_together() {
    let folder = mill();
    replace(
        &folder,
        "mill.mp",
        "odd.mp",
        "MP1710.0 ",
        "MP1710.0 : 10 ;too tight",
    );
    let run = folder.bahn("mp check odd.mp");
    assert_eq!(run.code(), 0, "a warning is no error");
    let err = run.err();
    assert!(
        err.contains("warning: rapid traverse gives POSITIONING ERROR in lag operation"),
        "{err}"
    );
    assert!(
        err.contains("MP1710.0 : 10 ;too tight") && err.contains("the lag at rapid traverse is 15.000 mm"),
        "{err}"
    );
}

#[test]
fn explain_says_everything_of_a_parameter() {
    let folder = Folder::new();
    for written in ["1030", "MP1030", "mp 1030"] {
        let run = folder
            .command()
            .args(["mp", "explain", written])
            .output()
            .unwrap_or_else(|e| panic!("{e}"));
        let out = String::from_utf8_lossy(&run.stdout).into_owned();
        for expected in [
            "MP1030  Positioning window",
            "0.0001 .. 2 mm or deg",
            "recommended: 0.01",
            "  does:        How near an axis must be",
            "  too small:   ",
            "  too large:   ",
            "MP1110 Standstill monitoring",
            "  source:      Technical manual TNC 407/415/425, chapter 5 Machine",
            "MP1030.4  0.01",
        ] {
            assert!(out.contains(expected), "{written}: {expected} is not in {out}");
        }
    }
    for line in folder.bahn("mp explain 1060").out().lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    let json = folder.bahn("mp explain 1060 --format json").json();
    assert_eq!(json[0]["related"][0], 1070);
    assert!(
        json[0]["too_large"]
            .as_str()
            .is_some_and(|text| text.contains("overshoot")),
        "{json}"
    );
    let out = folder.bahn("mp explain 1030.2").out();
    assert!(
        out.contains("MP1030.2  Positioning window, Z axis") && !out.contains("MP1030.1"),
        "{out}"
    );
    let out = folder.bahn("mp explain 10").out();
    assert!(
        out.contains("a restart of the control (RESET)") && out.contains("X axis: active; Y axis: active"),
        "{out}"
    );
    // The same number is something else on the TNC 155.
    let out = folder.bahn("mp explain 60 --model tnc155").out();
    assert!(
        out.contains("= on (square-root characteristic, small lag)"),
        "{out}"
    );
    assert_eq!(folder.bahn("mp explain 9999").code(), 2);
    assert_eq!(folder.bahn("mp explain 1920").code(), 2, "TNC 425 only");
    assert_eq!(folder.bahn("mp explain 1920 --model tnc425").code(), 0);
}

#[test]
fn explain_takes_the_value_of_a_list() {
    let folder = Folder::new();
    folder.write("mill.mp", "; TNC 407\nMP7420 : %00010 ;clear first\n");
    let report = folder.bahn("mp explain 7420 --list mill.mp --format json").json();
    let row = &report[0];
    assert_eq!(
        (&row["value"], &row["number"], &row["user"]),
        (&json!("%00010"), &json!(2.0), &json!(true))
    );
    assert_eq!(row["meaning"][1], "clear first then channel");
    assert_eq!(
        (&row["min"], &row["max"], &row["reaction"]),
        (&json!("%00000"), &json!("%11111"), &json!("none"))
    );
}

#[test]
fn list_finds_by_number_and_word() {
    let folder = Folder::new();
    let out = folder.bahn("mp list acceleration axis").out();
    assert!(out.starts_with("Positioning\nMP1060.0 "), "{out}");
    assert_eq!(out.lines().filter(|line| line.starts_with("MP1060.")).count(), 5);
    let out = folder.bahn("mp list 1070 MP1080.3").out();
    assert_eq!(out.lines().count(), 3, "{out}");
    let all = folder.bahn("mp list --model tnc155 --format json").json();
    assert_eq!(all.as_array().map(Vec::len), Some(264));
    let user = folder.bahn("mp list --user --format json").json();
    let rows = user.as_array().map_or(&[][..], Vec::as_slice);
    assert!(rows.len() > 50 && rows.iter().all(|row| row["user"] == true));
    assert_eq!(folder.bahn("mp list coffee").code(), 2);
}

#[test]
fn list_shows_what_a_list_sets_apart() {
    let folder = Folder::new();
    folder.write("mill.mp", "MP1010.0 : 8000\nMP1010.1 : 10\n");
    let rows = folder
        .bahn("mp list --changed --list mill.mp --format json")
        .json();
    let names: Vec<&Value> = rows
        .as_array()
        .into_iter()
        .flatten()
        .map(|row| &row["parameter"])
        .collect();
    // 10 is the smallest rapid traverse.
    assert_eq!(names, ["MP1010.0"]);
}

#[test]
fn diff_says_values_meanings_and_what_the_change_needs() {
    let folder = mill();
    replace(&folder, "mill.mp", "a.mp", "MP10 ", "MP10     : %01111");
    replace(&folder, "a.mp", "b.mp", "MP330.0 ", "MP330.0  : 10");
    replace(&folder, "b.mp", "new.mp", "MP1390 ", "MP1390   : 1 ;lag");
    let run = folder.bahn("mp diff mill.mp new.mp");
    assert_eq!(run.code(), 1);
    let expected = "\
MP10  Active axes (control, display, reference run)  needs a restart of the control (RESET)
  - %11111  5th axis: active
  + %01111  5th axis: not active
MP330.0  Signal period of measuring system, X axis  needs a reference run (REF)
  - 20 um or 1/1000 deg
  + 10 um or 1/1000 deg
MP1390  Feed precontrol in MDI, single block, full sequence
  - 0  feed precontrol
  + 1  servo lag
3 differences; the change needs a restart of the control (RESET) and a reference run (REF)
";
    assert_eq!(run.out(), expected);
    let report = folder.bahn("mp diff mill.mp new.mp --format json").json();
    assert_eq!(report[1]["reaction"], "REF");
    assert_eq!(
        (&report[2]["a"]["number"], &report[2]["b"]["meaning"]),
        (&json!(0.0), &json!(["servo lag"]))
    );
    // Against the reference list; spelling and comments are no difference.
    replace(&folder, "mill.mp", "same.mp", "MP1390 ", "1390=$0 ;lag");
    let run = folder.bahn("mp diff same.mp");
    assert_eq!((run.code(), run.out().as_str()), (0, "no difference\n"));
    folder.write("bad.mp", "MP1390 : x\n");
    assert_eq!(folder.bahn("mp diff mill.mp bad.mp").code(), 2);
}

/// A list of a TNC 155 without any comment: in the folder of its machine it is checked as such.
#[test]
fn a_list_in_the_folder_of_a_machine_is_for_its_control() {
    let folder = Folder::new();
    assert_eq!(folder.bahn("machine new m --model tnc155").code(), 0);
    let list = folder.read("m/parameters.mp");
    let bare: String = list
        .lines()
        .filter(|line| !line.trim_start().starts_with([';', '*']))
        .map(|line| format!("{line}\n"))
        .collect();
    folder.write("m/parameters.mp", &bare).write("alone.mp", &bare);
    let inside = folder.bahn("mp check m/parameters.mp --format json");
    assert_eq!(inside.json()[0]["model"], "tnc155", "{}", inside.err());
    let alone = folder.bahn("mp check alone.mp --format json");
    assert_eq!(alone.json()[0]["model"], "tnc415b");
}

/// The list of a machine leaves to the reference list what it does not name. What takes an option or a later software is an
/// error there, and wherever else a parameter is set.
#[test]
fn the_list_of_a_machine_is_checked_as_the_machine_has_it() {
    let folder = Folder::new();
    assert_eq!(folder.bahn("machine new m --model tnc155").code(), 0);
    let whole = folder.bahn("mp check m");
    assert_eq!(whole.code(), 0, "{}", whole.err());
    let (machine, list) = (folder.read("m/machine.toml"), folder.read("m/parameters.mp"));
    folder.write(
        "m/machine.toml",
        machine.replacen("plc = ", "software = 7\noptions = []\nplc = ", 1),
    );
    let steep = "MP54 = 2 is there from software level 08 on; this control has level 07";
    folder.write("steep.mp", "MP54 : 2\n");
    folder.write("steep.txt", "1: MP54=2\n");
    for (command, code, expected) in [
        ("mp check m", 0, "0 errors"),
        ("test m/programs/BLOCK.H --machine m --mp 54=1.5", 0, ""),
        ("test m/programs/BLOCK.H --machine m --mp 54=2", 2, steep),
        (
            "test m/programs/BLOCK.H --machine m --parameters steep.mp",
            2,
            steep,
        ),
        ("run BLOCK.H --machine m --fresh --mp 54=2", 2, steep),
        ("run BLOCK.H --machine m --fresh --script steep.txt", 1, steep),
        ("tune m X --mp 54=2", 2, steep),
        (
            "run BLOCK.H --machine m --fresh --mp 237=1",
            2,
            "only with the option spindle-orientation",
        ),
    ] {
        let run = folder.bahn(command);
        assert_eq!(run.code(), code, "{command}: {}", run.err());
        assert!(run.err().contains(expected), "{command}: {}", run.err());
    }
    folder.write(
        "m/parameters.mp",
        list.replacen("MP54     : 1 ", "MP54     : 2 ", 1),
    );
    let run = folder.bahn("mp check m");
    assert!(run.code() == 1 && run.err().contains(steep), "{}", run.err());
    let run = folder.bahn("mp check m --format json").json();
    assert_eq!(run[0]["errors"][0]["parameter"], "MP54");
}
