//! What is fitted to a control: terminals, boards, versions, options, software.

use crate::support::Folder;
use bahn_parameters::ControlModel;
use serde_json::Value;

fn new(model: &str) -> Folder {
    let folder = Folder::new();
    let run = folder.bahn(&format!("machine new m --model {model} --name Test"));
    assert_eq!(run.code(), 0, "{}", run.err());
    folder
}

/// A machine with more lines at the begin of machine.toml.
fn with(model: &str, lines: &str) -> Folder {
    let folder = new(model);
    say(&folder, lines);
    folder
}

fn say(folder: &Folder, lines: &str) {
    let text = folder.read("m/machine.toml");
    folder.write("m/machine.toml", format!("{lines}\n{text}"));
}

fn edit(folder: &Folder, file: &str, from: &str, to: &str) {
    let text = folder.read(file);
    assert!(text.contains(from), "{file} has no `{from}`");
    folder.write(file, text.replacen(from, to, 1));
}

/// The rows of `machine io`.
fn terminals(folder: &Folder) -> Vec<Value> {
    let run = folder.bahn("machine io m --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    run.json().as_array().unwrap().clone()
}

fn row<'a>(rows: &'a [Value], terminal: &str) -> &'a Value {
    let found = rows.iter().find(|row| row["terminal"] == terminal);
    found.unwrap_or_else(|| panic!("no {terminal}"))
}

fn count(rows: &[Value], letter: char) -> usize {
    let mut operands: Vec<&str> = rows.iter().filter_map(|row| row["operand"].as_str()).collect();
    operands.sort_unstable();
    operands.dedup();
    operands
        .iter()
        .filter(|operand| operand.starts_with(letter))
        .count()
}

/// 119 inputs and I3, 62 outputs with one PL 400 [000:2005]; each terminal has its row, the free ones, too.
#[test]
fn terminals_of_a_tnc_415() {
    let folder = with("tnc415b", "boards = [\"PL400\"]");
    let rows = terminals(&folder);
    assert_eq!((count(&rows, 'I'), count(&rows, 'O')), (120, 62));
    let ready = row(&rows, "X41/34");
    assert_eq!(
        (&ready["operand"], &ready["name"]),
        (&Value::Null, &"control is ready".into())
    );
    let start = row(&rows, "X46/19");
    assert_eq!(
        (&start["operand"], &start["name"]),
        (&"I146".into(), &"key NC_START".into())
    );
    assert_eq!(start["kind"], "digital");
    // I151 has no key [000:7549-7600].
    assert_eq!(row(&rows, "X46/24")["name"], Value::Null);
    let text = folder.bahn("machine io m");
    assert!(text.out().contains("X46/19"), "{}", text.out());
}

/// One row of each kind.
#[test]
fn terminals_of_boards_and_of_version_b() {
    let rows = terminals(&with("tnc415b", "boards = [\"PL400\", \"PL400\"]"));
    assert_eq!((count(&rows, 'I'), count(&rows, 'O')), (183, 93));
    assert_eq!(row(&rows, "PL1 X4/1")["operand"], "I126");
    assert_eq!(row(&rows, "PL2 X4/1")["operand"], "I254");

    let rows = terminals(&new("tnc155b"));
    let relay = row(&rows, "J1/1");
    assert_eq!(
        (&relay["operand"], &relay["kind"]),
        (&"O0".into(), &"relay".into())
    );
    assert_eq!(row(&rows, "J5/9")["operand"], "I0");
    assert_eq!(row(&rows, "J4/9")["kind"], "analogue");
    assert_eq!((count(&rows, 'I'), count(&rows, 'O')), (24, 23));

    let rows = terminals(&with("tnc151q", "boards = [\"PL110B\"]"));
    assert_eq!((count(&rows, 'I'), count(&rows, 'O')), (63, 31));
    assert_eq!(row(&rows, "PL1 J3/4")["kind"], "bipolar");
    // Without the key both boards.
    let rows = terminals(&new("tnc151q"));
    assert_eq!((count(&rows, 'I'), count(&rows, 'O')), (126, 62));
}

/// Control, lines of machine.toml, place and message of their fault.
const WRONG: [(&str, &str, &str, &str); 15] = [
    (
        "tnc415b",
        "boards = [\"PL410B\", \"PL410\"]",
        "1:21",
        "a PL 410 is never beside a PL 410 B",
    ),
    (
        "tnc415b",
        "boards = [\"PL410B\", \"PA110\"]",
        "1:21",
        "a PA 110 is never beside a PL 410 B",
    ),
    (
        "tnc415b",
        "boards = [\"PL500\"]",
        "1:11",
        "`PL500` is no board of the TNC 415 B; there are PL410, PL410B, PL400, PA110",
    ),
    (
        "tnc415b",
        "boards = [\"PL100B\"]",
        "1:11",
        "`PL100B` is no board of the TNC 415 B",
    ),
    (
        "tnc155q",
        "boards = [\"PL400\"]",
        "1:11",
        "`PL400` is no board of the TNC 155 Q; there are PL100B, PL110B",
    ),
    (
        "tnc155b",
        "boards = [\"PL100B\"]",
        "1:11",
        "`PL100B` is no board of the TNC 155 B; it has none",
    ),
    (
        "tnc415b",
        "boards = [\"PL400\", \"PL400\", \"PL400\"]",
        "1:29",
        "2 boards are the most",
    ),
    (
        "tnc415b",
        "boards = \"PL400\"",
        "1:10",
        "boards is a list of texts",
    ),
    (
        "tnc415b",
        "boards = [\"PL410\"]\nanalogue = true",
        "2:12",
        "`analogue` is true, but MP4410 has analogue inputs of no board",
    ),
    (
        "tnc155",
        "options = [\"ts120\"]",
        "1:12",
        "`ts120` is no option of the TNC 155; there are spindle-orientation",
    ),
    (
        "tnc407",
        "options = [\"tm110\"]",
        "1:12",
        "`tm110` is no option of the TNC 407; there are ts120",
    ),
    (
        "tnc415b",
        "software = \"280 58 06\"",
        "1:12",
        "`280 58 06` is no software of the TNC 415 B; there are 243 05 02 to 16",
    ),
    (
        "tnc155",
        "software = 100",
        "1:12",
        "`100` is no level of the software of the TNC 155; there are 1 to 99",
    ),
    (
        "tnc360",
        "software = 8",
        "1:12",
        "no manual tells releases of the TNC 360",
    ),
    (
        "tnc155",
        "software = true",
        "1:12",
        "software is a text in quotes, or a whole number",
    ),
];

/// A wire beyond what is fitted, and boards that do not go together, are faults at their places.
#[test]
fn machine_check_refuses_what_is_not_fitted() {
    let folder = with("tnc415b", "boards = []");
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    let said = run.err();
    assert!(
        said.contains("TNC 415 B has no input I64; there are I0-I31, I128-I152, I160-I175"),
        "{said}"
    );
    assert_eq!(folder.bahn("machine io m").code(), 1);
    // With the board it is there.
    edit(&folder, "m/machine.toml", "boards = []", "boards = [\"PL410\"]");
    assert_eq!(folder.bahn("machine check m").code(), 0);

    for (model, line, place, message) in WRONG {
        let folder = with(model, line);
        let run = folder.bahn("machine check m");
        assert_eq!(run.code(), 1, "{line}: {}", run.err());
        assert!(run.err().contains(message), "{model} {line}: {}", run.err());
        assert!(
            run.err().contains(&format!("machine.toml:{place}\n")),
            "{model} {line}: {}",
            run.err()
        );
    }
}

/// The analogue inputs of a PL 410 take the place of I120-I127 and O61, O62 [000:2057]: MP4410 switches them on.
#[test]
fn analogue_inputs_take_the_place_of_others() {
    let folder = with("tnc415b", "boards = [\"PL410\"]\nanalogue = true");
    edit(&folder, "m/parameters.mp", "MP4410   : %00", "MP4410   : %01");
    let rows = terminals(&folder);
    assert_eq!(
        (count(&rows, 'I'), count(&rows, 'O'), count(&rows, 'W')),
        (113, 60, 8)
    );
    let volts = row(&rows, "PL1 X15/1");
    assert_eq!(
        (&volts["operand"], &volts["kind"]),
        (&"W496".into(), &"analogue".into())
    );
    edit(
        &folder,
        "m/plant.toml",
        "input_second = \"I18\"",
        "input_second = \"I120\"",
    );
    assert!(folder.bahn("machine check m").err().contains("has no input I120"));
}

/// F and W: no movement in three axes [001:132-136]; B moves them.
#[test]
fn export_versions_move_no_line_in_space() {
    let folder = Folder::new();
    folder.write(
        "3.h",
        crate::support::program("L X+1 Y+1 R0 F100\nL X+2 Y+2 Z+2 R0"),
    );
    for (model, allowed) in [
        ("tnc151f", false),
        ("tnc155w", false),
        ("tnc155fr", false),
        ("tnc155b", true),
        ("tnc151qr", true),
        ("tnc155", true),
    ] {
        let run = folder.bahn(&format!("check 3.h --model {model}"));
        let refused = run.err().contains("3.h:3:") && run.err().contains("WRONG AXIS PROGRAMMED");
        assert_eq!(
            (run.code() == 0, refused),
            (allowed, !allowed),
            "{model}: {}",
            run.err()
        );
    }
    // Four of five axes on the TNC 415 F and 425 E, five on the others [000:139].
    folder.write("4.h", crate::support::program("L X+1 Y+1 Z+1 C+1 R0 F100"));
    folder.write("5.h", crate::support::program("L X+1 Y+1 Z+1 C+1 V+1 R0 F100"));
    for (model, five) in [
        ("tnc415b", true),
        ("tnc415f", false),
        ("tnc425", true),
        ("tnc425e", false),
    ] {
        assert_eq!(
            folder.bahn(&format!("check 4.h --model {model}")).code(),
            0,
            "{model}"
        );
        assert_eq!(
            folder.bahn(&format!("check 5.h --model {model}")).code() == 0,
            five,
            "{model}"
        );
    }
}

/// F and W run nothing while it is transferred [001:173]; a TNC 151 has no graphics to print [001:2157].
#[test]
fn what_versions_lack_is_named() {
    let folder = new("tnc155f");
    let run = folder.bahn("link dnc run --machine m --port tcp:127.0.0.1:0 1.H");
    assert_eq!(run.code(), 2);
    assert!(
        run.err().contains("the TNC 155 F is an export version"),
        "{}",
        run.err()
    );

    let folder = new("tnc151");
    folder.write("part.png", "");
    let run = folder.bahn("link print part.png --machine m --output part.prn");
    assert_eq!(run.code(), 1);
    assert!(
        run.err()
            .contains("the TNC 151 makes no hard copy: it has no graphics"),
        "{}",
        run.err()
    );

    let run = folder.bahn("machine new n --model tnc151x");
    assert_eq!(run.code(), 2);
}

/// New machines of the versions are whole and run.
#[test]
fn new_machines_of_the_versions_run() {
    for model in [
        "tnc151b", "tnc155br", "tnc155wr", "tnc155f", "tnc151q", "tnc415f", "tnc425e",
    ] {
        let folder = new(model);
        let check = folder.bahn("machine check m --format json");
        assert_eq!(check.json()[0]["model"], model);
        let space = model.contains(['f', 'w']) && model.starts_with("tnc15");
        let blocks = match space {
            true => "L X+0 Y+0 R0 FMAX\nL X+10 Y+5 R0 F500",
            false => "L X+0 Y+0 Z+50 R0 FMAX\nL X+10 Y+5 R0 F500",
        };
        folder.write("P.H", crate::support::program(blocks));
        let run = folder.bahn("run P.H --machine m --no-graphics --fresh --format json");
        assert_eq!(run.code(), 0, "{model}: {}{}", run.err(), run.out());
    }
}

/// A program and a list that take an option which is not there.
#[test]
fn a_missing_option_is_named() {
    let range = "TCH PROBE 5.0 RANGE\nTCH PROBE 5.1 PGM NAME: BOSS\nTCH PROBE 5.2 Z X+23 Y+24 Z-10\n\
                 TCH PROBE 5.3 X+41 Y+32 Z+2\nTCH PROBE 5.4 HEIGHT: +10";
    let refused = "TCH PROBE 5 is only with the option ts120";
    for (options, missing) in [("[]", true), ("[\"ts120\"]", false), ("[\"tm110\"]", false)] {
        let folder = with("tnc415b", &format!("options = {options}"));
        folder.write("m/programs/DIG.H", crate::support::program(range));
        let run = folder.bahn("machine check m");
        assert_eq!(run.err().contains(refused), missing, "{options}: {}", run.err());
        assert_eq!(run.code() == 1, missing, "{options}: {}", run.err());
        let run = folder.bahn("run DIG.H --machine m --no-graphics --fresh");
        assert_eq!(
            run.err().contains(refused) || run.out().contains(refused),
            missing,
            "{options}"
        );
    }
    // Its machine parameters are absent without it [000:7893-7895].
    let folder = with("tnc415b", "options = []");
    edit(&folder, "m/parameters.mp", "MP6210   : 0", "MP6210   : 10");
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("MP6210 = 10 is only with the option ts120"),
        "{}",
        run.err()
    );

    let folder = with("tnc155q", "options = []");
    folder.write(
        "m/programs/M19.H",
        crate::support::program("TOOL DEF 1 L+0 R+5\nTOOL CALL 1 Z S100\nL X+1 R0 F100 M19"),
    );
    let run = folder.bahn("machine check m");
    assert!(
        run.err()
            .contains("M19 is only with the option spindle-orientation"),
        "{}",
        run.err()
    );
}

/// What came later is a fault that names the release which has it [000:829-838] [000:803-823].
#[test]
fn a_later_release_is_named() {
    let folder = with("tnc415b", "software = \"280 540 06\"");
    assert_eq!(folder.bahn("machine check m").code(), 0);
    edit(&folder, "m/machine.toml", "280 540 06", "280 54 02");
    folder.write(
        "m/programs/ROTARY.H",
        crate::support::program("L C+10 R0 F100 M126"),
    );
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    let m126 = "M126 is there from software 280 54 04 on; this control has 280 54 02";
    assert!(run.err().contains(m126), "{}", run.err());

    // Modules and markers in the PLC program, at their lines.
    edit(&folder, "m/machine.toml", "280 54 02", "280 54 01");
    let main = folder.read("m/plc/MAIN.PLC");
    folder.write(
        "m/plc/MAIN.PLC",
        format!("{main}\nLBL 77\n L M2827\n = M900\n PS K+0\n CM 9171\n EM\n"),
    );
    let run = folder.bahn("machine check m");
    for said in [
        "M2827 is there from software 280 54 02 on; this control has 280 54 01",
        "module 9171 is there from software 280 54 02 on",
    ] {
        assert!(run.err().contains(said), "{said}: {}", run.err());
    }
    let table = folder.bahn("explain software --model tnc415b");
    assert!(
        table
            .out()
            .lines()
            .any(|line| line.contains("M126-M127") && line.contains("280 54 04")),
        "{}",
        table.out()
    );
    // Markers of a level, parameters by their value [001:1516-1536] [001:1678].
    let folder = with("tnc155", "software = 2");
    let list = folder.read("m/parameters.mp");
    folder.write("m/parameters.mp", format!("{list}\nMP158 : 16384\n"));
    let run = folder.bahn("machine check m");
    assert!(
        run.err()
            .contains("MP158 = 16384 is there from software level 03 on; this control has level 02"),
        "{}",
        run.err()
    );
    edit(&folder, "m/machine.toml", "software = 2", "software = 3");
    assert_eq!(folder.bahn("machine check m").code(), 0);
}

/// A machine of each model and version can be switched on as it is made.
#[test]
fn a_new_machine_of_each_version_has_no_fault() {
    for model in ControlModel::ALL.map(ControlModel::id) {
        let folder = new(model);
        let run = folder.bahn("machine check m");
        assert_eq!(run.code(), 0, "{model}: {}", run.err());
    }
}

/// A wrong name is one fault: what follows from it would hide it.
#[test]
fn an_unknown_board_or_option_is_one_fault() {
    for (model, line) in [
        ("tnc155q", "boards = [\"PL999\"]"),
        ("tnc155q", "boards = [\"PL400\"]"),
        ("tnc155q", "options = [\"ts120\"]"),
        ("tnc415b", "boards = [\"PL110B\"]"),
        ("tnc415b", "options = [\"spindle-orientation\"]"),
    ] {
        let run = with(model, line).bahn("machine check m --format json");
        assert_eq!(run.code(), 1, "{model} {line}");
        let faults = run.json()[0]["faults"].as_array().map(Vec::len);
        assert_eq!(faults, Some(1), "{model} {line}: {}", run.json());
    }
}
