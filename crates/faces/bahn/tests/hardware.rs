//! What is fitted to a control: terminals, boards, versions, options, software.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use serde_json::Value;
use support::Folder;

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
    operands.iter().filter(|operand| operand.starts_with(letter)).count()
}

/// Without boards LE 56/31 and I3 [000:2004]; each terminal has its row, the free ones, too.
#[test]
fn terminals_of_a_tnc_415() {
    let folder = with("tnc415b", "boards = []");
    edit(&folder, "m/plant.toml", "switched_outputs", "#switched_outputs");
    let rows = terminals(&folder);
    assert_eq!((count(&rows, 'I'), count(&rows, 'O')), (57, 31));
    let ready = row(&rows, "X41/34");
    assert_eq!((&ready["operand"], &ready["name"]), (&Value::Null, &"control is ready".into()));
    let start = row(&rows, "X46/19");
    assert_eq!((&start["operand"], &start["name"]), (&"I146".into(), &"key NC_START".into()));
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
    assert_eq!((&relay["operand"], &relay["kind"]), (&"O0".into(), &"relay".into()));
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

/// A wire beyond what is fitted, and boards that do not go together, are faults at their places.
#[test]
fn machine_check_refuses_what_is_not_fitted() {
    let folder = with("tnc415b", "boards = []");
    edit(&folder, "m/plant.toml", "input_second = \"I18\"", "input_second = \"I64\"");
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    let said = run.err();
    assert!(said.contains("TNC 415 B has no input I64; there are I0-I31, I128-I152, I160-I175"), "{said}");
    // With the board it is there.
    edit(&folder, "m/machine.toml", "boards = []", "boards = [\"PL410\"]");
    assert_eq!(folder.bahn("machine check m").code(), 0);

    for (model, line, message) in [
        ("tnc415b", "boards = [\"PL410B\", \"PL410\"]", "machine.toml:1:21: error: a PL 410 is never beside a PL 410 B"),
        ("tnc415b", "boards = [\"PL410B\", \"PA110\"]", "1:21: error: a PA 110 is never beside a PL 410 B"),
        ("tnc415b", "boards = [\"PL500\"]", "1:11: error: `PL500` is no board of the TNC 415 B; there are PL410, PL410B, PL400, PA110"),
        ("tnc415b", "boards = [\"PL100B\"]", "`PL100B` is no board of the TNC 415 B"),
        ("tnc155q", "boards = [\"PL400\"]", "`PL400` is no board of the TNC 155 Q; there are PL100B, PL110B"),
        ("tnc155b", "boards = [\"PL100B\"]", "`PL100B` is no board of the TNC 155 B; it has none"),
        ("tnc415b", "boards = [\"PL400\", \"PL400\", \"PL400\"]", "1:29: error: 2 boards are the most"),
        ("tnc415b", "boards = \"PL400\"", "boards is a list of texts"),
        ("tnc415b", "boards = [\"PL410\"]\nanalogue = true", "2:12: error: `analogue` is true, but MP4410 has analogue inputs of no board"),
        ("tnc155", "options = [\"ts120\"]", "1:12: error: `ts120` is no option of the TNC 155; there are spindle-orientation"),
        ("tnc407", "options = [\"tm110\"]", "`tm110` is no option of the TNC 407; there are ts120"),
        ("tnc415b", "software = \"280 58 06\"", "1:12: error: `280 58 06` is no software of the TNC 415 B; there are 259 96 01 to 09"),
        ("tnc155", "software = 100", "1:12: error: `100` is no level of the software of the TNC 155; there are 1 to 99"),
        ("tnc360", "software = 8", "no manual tells releases of the TNC 360"),
        ("tnc155", "software = true", "software is a text in quotes, or a whole number"),
    ] {
        let folder = with(model, line);
        let run = folder.bahn("machine check m");
        assert_eq!(run.code(), 1, "{line}: {}", run.err());
        assert!(run.err().contains(message), "{model} {line}: {}", run.err());
    }
}

/// The analogue inputs of a PL 410 take the place of I120-I127 and O61, O62 [000:2057]: MP4410 switches them on.
#[test]
fn analogue_inputs_take_the_place_of_others() {
    let folder = with("tnc415b", "boards = [\"PL410\"]\nanalogue = true");
    let list = folder.read("m/parameters.mp");
    folder.write("m/parameters.mp", format!("{list}\nMP4410 : %01\n"));
    let rows = terminals(&folder);
    assert_eq!((count(&rows, 'I'), count(&rows, 'O'), count(&rows, 'W')), (113, 60, 8));
    let volts = row(&rows, "PL1 X15/1");
    assert_eq!((&volts["operand"], &volts["kind"]), (&"W496".into(), &"analogue".into()));
    edit(&folder, "m/plant.toml", "input_second = \"I18\"", "input_second = \"I120\"");
    assert!(folder.bahn("machine check m").err().contains("has no input I120"));
}
