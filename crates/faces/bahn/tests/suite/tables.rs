//! `bahn table`, and tables of a machine against its parameters.

use crate::support::{Folder, number};
use serde_json::Value;

/// As a later control writes it: columns under their names, values of several kinds.
const TOOL_T: &str = "\
BEGIN TOOL  .T MM
T    NAME             L         R        R2   DL     TL RT CUT. LTOL  DIRECT. PLC
0                     +0        +0       +0
5    MILL D20         +95.5     +10      +0   +0.02        4    0.1   -       %00000101
7    DRILL            +105      +5.25    +0          L
[END]
";

fn json(folder: &Folder, command: &str) -> Value {
    let run = folder.bahn(command);
    serde_json::from_str(&run.out()).unwrap_or_else(|_| panic!("{command}: {}{}", run.out(), run.err()))
}

#[test]
fn show_in_columns_and_as_json() {
    let folder = Folder::new();
    folder.write("TOOL.T", TOOL_T);
    let shown = folder.bahn("table show TOOL.T").out();
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!(lines.len(), 4, "{shown}");
    // Numbers to the right: L ends where its name ends.
    let end = lines[0].find('L').unwrap() + 1;
    assert!(lines[2][..end].trim_end().ends_with("+95.5"), "{shown}");
    let report = json(&folder, "table show TOOL.T --format json");
    assert_eq!((&report["kind"], &report["unit"]), (&"tool".into(), &"mm".into()));
    let row = &report["rows"][1];
    assert_eq!(
        (&row["T"], &row["L"], &row["CUT"]),
        (&5.0.into(), &95.5.into(), &4.0.into())
    );
    assert_eq!(
        (&row["NAME"], &row["PLC"]),
        (&"MILL D20".into(), &"%00000101".into())
    );
    assert_eq!(row["line"], 4);
    let tsv = folder.bahn("table show TOOL.T --format tsv").out();
    assert!(
        tsv.contains("\n7\tDRILL\t+105\t+5.25\t+0\t\tL\t\t\t\t\t\n"),
        "{tsv}"
    );
}

/// The columns of the tool table of a machine are those of MP7266, in their order.
#[test]
fn a_machine_shows_the_columns_of_mp7266() {
    let folder = Folder::with_mill("");
    let list = folder.read("mill/parameters.mp");
    let changed = list
        .lines()
        .map(|line| match line.split_once(':') {
            Some((name, _)) if name.starts_with("MP7266.") => {
                let place = match name.trim() {
                    "MP7266.2" => 1,
                    "MP7266.0" => 2,
                    _ => 0,
                };
                format!("{name}: {place}\n")
            }
            _ => format!("{line}\n"),
        })
        .collect::<String>();
    folder.write("mill/parameters.mp", changed);
    let shown = folder.bahn("table show mill").out();
    let header: Vec<&str> = shown.lines().next().unwrap().split_whitespace().collect();
    assert_eq!(header, ["T", "R", "NAME"]);
    let all = folder.bahn("table show mill --all").out();
    assert!(all.lines().next().unwrap().contains(" L "), "{all}");
    let none = folder.bahn("table show mill --kind pallet");
    assert_eq!(none.code(), 2);
    assert!(none.err().contains("names no pallet table"), "{}", none.err());
}

#[test]
fn faults_have_file_line_and_column() {
    let folder = Folder::new();
    folder.write("bad.T", "T;L;R;CUT\n1;80;5;2\n2;x;5;\n2x;1;1;\n3;1;1;99\n");
    let run = folder.bahn("table check bad.T");
    assert_eq!(run.code(), 1);
    let said = run.err();
    for expected in ["bad.T:3:3", "bad.T:4:1", "bad.T:5:7", "L: `x` is no number"] {
        assert!(said.contains(expected), "{expected}: {said}");
    }
    let report = json(&folder, "table check bad.T --format json");
    let faults = report[0]["faults"].as_array().unwrap();
    let places: Vec<_> = faults
        .iter()
        .map(|fault| (fault["line"].as_u64(), fault["column"].as_u64()))
        .collect();
    assert_eq!(
        places,
        [(Some(3), Some(3)), (Some(4), Some(1)), (Some(5), Some(7))]
    );
    for (name, text) in [
        ("a.D", "NR X\n0 1\n0 2\n"),
        ("a.P", "NR PGM\n0\n"),
        ("a.TCH", "P T\n1 x\n"),
        ("a.PNT", "NR X\n0 y\n"),
    ] {
        folder.write(name, text);
        assert_eq!(folder.bahn(&format!("table check {name}")).code(), 1, "{name}");
    }
    folder.write("what.txt", "A B\n1 2\n");
    assert_eq!(folder.bahn("table check what.txt").code(), 2);
}

/// Only the fields that are named change; comments, order and every other byte stay.
#[test]
fn set_changes_one_line() {
    let folder = Folder::new();
    let text = "; my tools\r\nT\tL\tR\tNAME\r\n1\t80\t5\tMILL\r\n2\t62\t4\tBALL ; old\r\n";
    folder.write("tools.tsv", text);
    assert_eq!(folder.bahn("table set tools.tsv 1 L=80.45 name=ROUGH").code(), 0);
    assert_eq!(
        folder.read("tools.tsv"),
        text.replace("1\t80\t5\tMILL", "1\t80.45\t5\tROUGH")
    );
    assert_eq!(folder.bahn("table set tools.tsv 9 R=3 L=70").code(), 0);
    assert!(folder.read("tools.tsv").ends_with("BALL ; old\r\n9\t70\t3\t\r\n"));
    assert_eq!(folder.bahn("table set tools.tsv 2 --delete").code(), 0);
    assert!(!folder.read("tools.tsv").contains("BALL"));
    // What would be a fault changes nothing.
    let before = folder.read("tools.tsv");
    for wrong in ["1 R=x", "1 R=-1", "1 T=9", "1 CUT=3", "5 --delete", "1 L"] {
        assert_eq!(
            folder.bahn(&format!("table set tools.tsv {wrong}")).code(),
            2,
            "{wrong}"
        );
        assert_eq!(folder.read("tools.tsv"), before);
    }
    // The file of a control: fields stay under their names.
    folder.write("TOOL.T", TOOL_T);
    assert_eq!(folder.bahn("table set TOOL.T 5 L=+100.125 CUT=3").code(), 0);
    let expected = TOOL_T.replace(
        "+95.5     +10      +0   +0.02        4",
        "+100.125  +10      +0   +0.02        3",
    );
    assert_eq!(folder.read("TOOL.T"), expected);
    assert_eq!(
        json(&folder, "table show TOOL.T --format json")["rows"][1]["R"],
        10.0
    );
    assert_eq!(folder.bahn("table set TOOL.T 5 CUT=123456").code(), 2);
    // Nothing is left beside the files.
    assert_eq!(folder.names(), ["TOOL.T", "tools.tsv"]);
}

/// MP7224.1 bit 2 protects tool tables [000:6870-6880].
#[test]
fn a_protected_table_is_not_changed() {
    let folder = Folder::with_mill("");
    assert_eq!(folder.bahn("table set mill/tools.tsv 1 L=71").code(), 0);
    let list = folder.read("mill/parameters.mp");
    folder.write(
        "mill/parameters.mp",
        list.replace("MP7224.1 : %00000000", "MP7224.1 : %00000100"),
    );
    let run = folder.bahn("table set mill/tools.tsv 1 L=72");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("is protected (MP7224.1)"), "{}", run.err());
    assert!(folder.read("mill/tools.tsv").contains("\n1\t71\t"));
}

/// MP7224.0 bit 2 disables tool tables: nobody sees them [000:6857-6868].
#[test]
fn a_disabled_table_is_neither_seen_nor_changed() {
    let folder = Folder::with_mill("");
    assert_eq!(folder.bahn("table show mill").code(), 0);
    let list = folder.read("mill/parameters.mp");
    folder.write(
        "mill/parameters.mp",
        list.replace("MP7224.0 : %00000000", "MP7224.0 : %00000100"),
    );
    let run = folder.bahn("table show mill");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("MP7224.0 disables tool tables"),
        "{}",
        run.err()
    );
    let run = folder.bahn("table set mill/tools.tsv 1 L=72");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("is disabled (MP7224.0)"), "{}", run.err());
}

/// A machine that is switched on reads its tables at power-on only: they are not changed behind its back.
#[test]
fn tables_of_a_machine_that_is_on_stay() {
    let folder = Folder::with_mill("");
    std::fs::create_dir_all(folder.path("mill/state")).unwrap();
    let lock = std::fs::File::create(folder.path("mill/state/lock")).unwrap();
    lock.lock().unwrap();
    let run = folder.bahn("table set mill/tools.tsv 1 L=72");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("a machine that is switched on"),
        "{}",
        run.err()
    );
    drop(lock);
    let run = folder.bahn("table set mill/tools.tsv 1 L=72");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.read("mill/tools.tsv").contains("\n1\t72\t"));
}

/// As JSON the faults of a machine are in the report, and nowhere else.
#[test]
fn faults_of_a_machine_as_json() {
    let folder = Folder::with_mill("");
    folder.write("mill/tools.tsv", "T\tL\tR\n1\tx\t5\n");
    let run = folder.bahn("table check mill --format json");
    assert_eq!((run.code(), run.err().as_str()), (1, ""));
    assert_eq!(run.json()[0]["faults"][0]["line"], 2);
    assert!(folder.bahn("table check mill").err().contains("tools.tsv:2:3"));
}

#[test]
fn convert_to_and_fro() {
    let folder = Folder::new();
    folder.write("TOOL.T", TOOL_T.replace("MM", "INCH"));
    let run = folder.bahn("table convert TOOL.T -o tools.csv");
    assert_eq!(run.code(), 0, "{}", run.err());
    let csv = folder.read("tools.csv");
    // 95.5 inches are 2425.7 mm.
    assert!(
        csv.contains("\n5,MILL D20,2425.7,254,0,0.508,,,4,2.54,-,%00000101\n"),
        "{csv}"
    );
    assert_eq!(folder.bahn("table convert tools.csv -o again.T").code(), 0);
    assert!(
        folder
            .read("again.T")
            .starts_with("BEGIN AGAIN .T MM\nT NAME     L      R")
    );
    assert_eq!(folder.bahn("table convert again.T -o third.csv").code(), 0);
    assert_eq!(folder.read("third.csv"), csv);
    assert_eq!(
        folder.bahn("table convert again.T -o third.csv").code(),
        2,
        "it is there"
    );
    let all = folder.bahn("table convert again.T --all-columns --to tsv").out();
    assert!(
        all.starts_with("T\tNAME\tL\tR\tR2\tDL\tDR\tDR2\tTL\tRT\tTIME1\tTIME2\tCUR.TIME\tDOC\tCUT\t"),
        "{all}"
    );
}

/// "If MP7260 contains a zero value, then the system will run without a tool table" [000:9103]: that of machine.toml is not
/// used, which is said.
#[test]
fn a_machine_without_a_tool_table_says_so() {
    let folder = Folder::with_mill("");
    let list = folder.read("mill/parameters.mp");
    let mut lines = list.lines();
    let line = lines.find(|line| line.starts_with("MP7260")).unwrap();
    folder.write("mill/parameters.mp", list.replace(line, "MP7260 : 0"));
    let run = folder.bahn("machine check mill");
    let text = run.out() + &run.err();
    assert_eq!(run.code(), 0, "{text}");
    assert!(
        text.contains("the control has no tool table (MP7260 = 0)"),
        "{text}"
    );
}

/// What does not fit the machine is a fault of its folder: MP7260, MP7261 (TNC 151/155: MP225), MP7264, MP7226
/// [000:9103-9113] [001:1600-1607].
#[test]
fn tables_fit_the_parameters_of_their_machine() {
    let said = |change: &[(&str, &str)], files: &[(&str, &str)], toml: &str| {
        let folder = Folder::with_mill("");
        let mut list = folder.read("mill/parameters.mp");
        for (number, value) in change {
            let line = list
                .lines()
                .find(|line| line.split([' ', ':']).next() == Some(number))
                .unwrap()
                .to_owned();
            list = list.replace(&line, &format!("{number} : {value}"));
        }
        folder.write("mill/parameters.mp", list);
        let description = folder.read("mill/machine.toml");
        folder.write(
            "mill/machine.toml",
            description.replacen("\nprograms =", &format!("\n{toml}\nprograms ="), 1),
        );
        for (name, text) in files {
            folder.write(&format!("mill/{name}"), text);
        }
        let run = folder.bahn("table check mill");
        (run.code(), run.err())
    };
    assert_eq!(said(&[], &[], "").0, 0);
    let (code, text) = said(&[("MP7260", "8")], &[], "");
    assert_eq!(code, 1);
    assert!(
        text.contains("tools.tsv:10:1") && text.contains("the tool table ends with tool 8 (MP7260)"),
        "{text}"
    );
    // With MP7260 = 0 "the system will run without a tool table" [000:9103].
    assert_eq!(said(&[("MP7260", "0")], &[], "").0, 0);
    let old = Folder::new();
    assert_eq!(old.bahn("machine new o --model tnc155").code(), 0);
    assert_eq!(old.bahn("table check o").code(), 0);
    let list = old.read("o/parameters.mp");
    let line = list.lines().find(|line| line.starts_with("MP225")).unwrap();
    old.write("o/parameters.mp", list.replace(line, "MP225 : 2"));
    let text = old.bahn("table check o").err();
    assert!(text.contains("the tool table ends with tool 2"), "{text}");
    let pockets = "P\tT\tST\tF\tL\tPLC\n1\t1\tS\t\t\t\n2\t\t\t\tL\t%00000001\n3\t2\t\tF\t\t\n12\t3\t\t\t\t\n";
    let with = "";
    let sized = [("MP7261", "12"), ("MP7264", "0")];
    assert_eq!(said(&sized, &[("pockets.tsv", pockets)], with).0, 0);
    let (_, text) = said(
        &[("MP7261", "11"), ("MP7264", "0")],
        &[("pockets.tsv", pockets)],
        with,
    );
    assert!(
        text.contains("pockets.tsv:5:1") && text.contains("the magazine has 11 pockets (MP7261)"),
        "{text}"
    );
    let (_, text) = said(
        &[("MP7261", "12"), ("MP7264", "1")],
        &[("pockets.tsv", pockets)],
        with,
    );
    assert!(
        text.contains("pockets.tsv:2:5") && text.contains("but 12 holds one"),
        "{text}"
    );
    let datums = [("programs/ZERO.D", "NR X\n0 1\n20 2\n")];
    assert_eq!(said(&[("MP7226.1", "21")], &datums, "").0, 0);
    let (_, text) = said(&[("MP7226.1", "20")], &datums, "");
    assert!(
        text.contains("ZERO.D:3:1") && text.contains("`20` is no line from 0 to 19"),
        "{text}"
    );
    let pallets = [("programs/JOBS.P", "NR PGM\n5 CIRCLE\n")];
    let (_, text) = said(&[("MP7226.0", "5")], &pallets, "pallets = \"JOBS.P\"");
    assert!(text.contains("JOBS.P:2:1"), "{text}");
}

/// Variable coding on the mill with its magazine: tool 2 goes to where tool 3 was. What the run leaves is in the state,
/// the table shows it, and the next run finds the tools there [000:9273-9283].
#[test]
fn variable_coding_survives_power_off() {
    let folder = Folder::with_mill("");
    folder.write(
        "mill/programs/TWO.H",
        "BEGIN PGM TWO MM\nTOOL CALL 2 Z S0\nTOOL CALL 3 Z S0\nEND PGM TWO MM\n",
    );
    folder.write(
        "mill/programs/BACK.H",
        "BEGIN PGM BACK MM\nTOOL CALL 2 Z S0\nEND PGM BACK MM\n",
    );
    let list = folder.read("mill/parameters.mp");
    let with_magazine = list
        .replace("MP7480.0 : 1 ", "MP7480.0 : 3 ")
        .replace("MP4310.0 : 1 ", "MP4310.0 : 3 ");
    assert_ne!(with_magazine, list);
    folder.write("mill/parameters.mp", with_magazine);
    let pockets = |folder: &Folder| -> Vec<i64> {
        let report = json(folder, "table show mill --kind pocket --format json");
        let rows = report["rows"].as_array().unwrap();
        let tool = |row: &Value| row["T"].as_str().map_or(0, |tool| tool.parse().unwrap());
        rows.iter().take(4).map(tool).collect()
    };
    assert_eq!(pockets(&folder), [1, 2, 3, 4]);
    let run = folder.bahn("run TWO.H --machine mill");
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    assert_eq!(pockets(&folder), [1, 3, 2, 4]);
    let run = folder.bahn("run BACK.H --machine mill");
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    assert_eq!(pockets(&folder), [1, 2, 3, 4]);
    // The file is as it was.
    assert!(folder.read("mill/pockets.tsv").contains("\n2\t2\t"));
}

/// The tool probe finds tool 2 as it really is, 94.96 long instead of 95; the control counts how long it was in use. Both
/// stand in the table, also in a column that its file does not have, in steps of 1/10 000 mm.
#[test]
fn what_the_control_has_written_is_shown() {
    let folder = Folder::with_mill("");
    let blocks = "TOOL CALL 2 Z S800\nL X+0 Y+0 Z+100 R0 FMAX\nTCH PROBE 31.0 MEASURE LENGTH\nTCH PROBE 31.1 CHECK: 0\n\
                  TCH PROBE 31.2 HEIGHT: +100\nTCH PROBE 31.3 PROBING THE TEETH: 0\n";
    let program = format!("BEGIN PGM TT MM\n{blocks}END PGM TT MM\n");
    folder.write("mill/programs/TT.H", program);
    let tool = |folder: &Folder| json(folder, "table show mill --format json")["rows"][1].clone();
    let of = |row: &Value, name: &str| row[name].as_f64().unwrap_or_default();
    assert_eq!(of(&tool(&folder), "L"), 95.0);
    let run = folder.bahn("run TT.H --machine mill");
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    let row = tool(&folder);
    let length = of(&row, "L");
    assert!((length - 94.96).abs() < 0.002, "{length}");
    assert_eq!(length, (length * 10_000.0).round() / 10_000.0);
    assert!(of(&row, "CUR.TIME") > 0.1, "{row}");
    assert!(!folder.read("mill/tools.tsv").contains("CUR.TIME"));
}

/// Several tool tables in the folder of a machine: a run takes another one than that of machine.toml, here one in which tool 2
/// has a radius of 6 in place of 10 mm; it is checked as that is, and the folder stays as it was.
#[test]
fn a_run_takes_another_tool_table() {
    let folder = Folder::with_mill(
        "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+70 Z+0\nTOOL CALL 2 Z S2000\nL Z+80 R0 FMAX\n\
         L X-20 Y+35 FMAX M3\nL Z-3 FMAX\nL X+120 F3000\nL Z+80 FMAX M30",
    );
    let table = folder.read("mill/tools.tsv");
    let small = table.replacen("\n2\t95\t10\t", "\n2\t95\t6\t", 1);
    assert_ne!(small, table);
    folder.write("mill/small.tsv", small);
    folder.write("mill/wrong.tsv", "T\tL\tR\n2\t95\twide\n");
    let removed = |tools: &str| {
        let run = folder.bahn(&format!(
            "run main.H --machine mill --fresh --format json {tools}"
        ));
        assert_eq!(run.code(), 0, "{}", run.err());
        number(&run.json(), "/removed_mm3")
    };
    for (tools, width) in [("", 20.0), ("--tools small.tsv", 12.0), ("", 20.0)] {
        let removed = removed(tools);
        assert!(
            (removed / (width * 3.0 * 100.0) - 1.0).abs() < 0.02,
            "{tools}: {removed}"
        );
    }
    let wrong = folder.bahn("run main.H --machine mill --fresh --tools wrong.tsv");
    assert_eq!(wrong.code(), 1, "{}", wrong.err());
    assert!(wrong.err().contains("wrong.tsv:2"), "{}", wrong.err());
    // What the control remembers belongs to the table of machine.toml.
    let kept = folder.bahn("run main.H --machine mill --tools small.tsv");
    assert_eq!(kept.code(), 2);
    assert!(kept.err().contains("--fresh"), "{}", kept.err());
}
