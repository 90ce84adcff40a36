//! The PLC mode by keys: other forms of a program, the binary code of an EPROM, the files of messages.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use bahn_host::eprom::LoadList;
use bahn_host::s_records::Image;
use support::Trainee;

/// The main menu of the PLC mode.
fn plc_mode(trainee: &mut Trainee) {
    trainee.ready();
    trainee.press("PROGRAM MOD ENT").number("807667").press("ENT");
    assert_eq!(trainee.screen().program.title, "PLC PROGRAMMING");
}

fn last_message(trainee: &mut Trainee) -> String {
    trainee.messages().last().cloned().unwrap_or_default()
}

/// Converts the main file to a text of this name, and reads it.
fn converted(trainee: &mut Trainee, key: &str, name: &str) -> String {
    trainee.soft("EDIT");
    trainee.down_to("MAIN.PLC");
    trainee.soft(key);
    assert_eq!(trainee.screen().dialogue.prompt, "DESTINATION FILE = .A");
    trainee.typed(name);
    trainee.press("ENT");
    assert_eq!(last_message(trainee), format!("MAIN.PLC -> {name}.A"));
    trainee.press("CE END");
    trainee.file(&format!("plc/{name}.A"))
}

#[test]
fn a_listing_has_line_numbers_and_references() {
    let mut trainee = Trainee::at("mill");
    plc_mode(&mut trainee);
    let listing = converted(&mut trainee, "LISTING", "L");
    let source = trainee.file("plc/MAIN.PLC");
    let numbered: Vec<String> = (1..)
        .zip(source.lines())
        .map(|(number, line)| format!("{number:>5} {line}").trim_end().to_owned())
        .collect();
    assert_eq!(listing.lines().collect::<Vec<_>>(), numbered);
    let references = converted(&mut trainee, "CROSSREF", "C");
    assert_eq!(
        converted(&mut trainee, "LISTING+CROSSREF", "B"),
        format!("{listing}\n{references}")
    );
    // Every line that a reference names in the main file has its operand; what it writes is no load.
    let mut seen = 0;
    let mut operand = "";
    for line in references.lines() {
        let mut words = line.split_whitespace();
        if !line.starts_with(' ') {
            operand = words.next().unwrap();
        }
        let bare = operand.trim_end_matches("[X]");
        if !bare.starts_with('M') {
            continue;
        }
        for place in words.filter(|place| !place.contains(':')) {
            let number: usize = place.trim_end_matches('*').parse().unwrap();
            let code = source.lines().nth(number - 1).unwrap();
            assert!(code.contains(bare), "{operand} {place}: {code}");
            let loads = code.trim_start().starts_with("L ");
            assert!(!(loads && place.ends_with('*')), "{operand} {place}: {code}");
            seen += 1;
        }
    }
    assert!(seen > 20, "{seen}");
    // A name that is taken is refused.
    trainee.soft("EDIT");
    trainee.down_to("MAIN.PLC");
    trainee.soft("LISTING");
    trainee.typed("L");
    trainee.press("ENT");
    assert_eq!(last_message(&mut trainee), "ENTRY VALUE INCORRECT");
    assert_eq!(trainee.file("plc/L.A"), listing);
}

#[test]
fn binary_code_is_written_for_an_eprom() {
    let mut trainee = Trainee::at("mill");
    plc_mode(&mut trainee);
    trainee.soft("OUTPUT BINARY CODE");
    assert!(trainee.screen().program.title.starts_with("FILE EPROM.A"));
    // The names there are stand in it already; the number is overwritten.
    let preset = trainee.file("plc/EPROM.A");
    assert_eq!(preset, "IDENT 000 000 00\nLOAD MAIN.PLC/M\nLOAD MAIN.ER1\n");
    trainee.press("CE EXT");
    assert!(
        last_message(&mut trainee).starts_with("00000000.BIN: "),
        "{:?}",
        trainee.messages()
    );
    let image = Image::from_records(&trainee.file("plc/00000000.BIN")).unwrap();
    let (list, contents) = LoadList::of_image(&image).unwrap();
    let files: Vec<&str> = list.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(
        (files, list.files[0].is_main),
        (vec!["MAIN.PLC", "MAIN.ER1"], true)
    );
    assert_eq!(contents[1], trainee.file("plc/MAIN.ER1").into_bytes());
    // A fault names its line, and nothing is written.
    trainee.write("plc/EPROM.A", "IDENT 123 456 99\nLOAD NOTHING.PLC\n");
    trainee.press("CE CE END");
    trainee.soft("OUTPUT BINARY CODE");
    trainee.press("EXT");
    assert_eq!(
        last_message(&mut trainee),
        "EPROM.A:2 there is no file NOTHING.PLC"
    );
    assert!(!trainee.has("plc/12345699.BIN"));
}

#[test]
fn the_file_of_messages_is_selected() {
    let mut trainee = Trainee::with("mill", |folder| {
        std::fs::write(folder.join("plc/OTHER.ER1"), "ANOTHER TEXT\n").unwrap();
        std::fs::write(folder.join("plc/LONG.ER1"), "x\n".repeat(2000)).unwrap();
    });
    let before = trainee.file("machine.toml");
    plc_mode(&mut trainee);
    trainee.soft("SELECT .DI1/.ER1");
    let lines = |trainee: &mut Trainee| -> Vec<String> {
        let lines = trainee.screen().program.lines;
        lines.into_iter().map(|line| line.text).collect()
    };
    let shown = lines(&mut trainee);
    assert_eq!(shown.len(), 3, "{shown:?}");
    assert!(
        shown[1].starts_with("MAIN.ER1") && shown[1].ends_with("ACTIVE"),
        "{shown:?}"
    );
    assert_eq!(shown[2], "OTHER.ER1");
    trainee.down_to("OTHER.ER1");
    trainee.press("ENT");
    assert_eq!(
        last_message(&mut trainee),
        "THE TEXTS COUNT WHEN THE MACHINE IS STARTED ANEW"
    );
    let after = trainee.file("machine.toml");
    let differing = before
        .lines()
        .zip(after.lines())
        .filter(|(one, other)| one != other);
    assert_eq!(differing.count(), 1, "{after}");
    let trainee = trainee.killed();
    assert_eq!(trainee.station.machine().plc_messages, ["ANOTHER TEXT"]);
}

#[test]
fn the_machine_parameters_are_a_key_away() {
    let mut trainee = Trainee::at("mill");
    plc_mode(&mut trainee);
    trainee.soft("MP EDIT");
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
    trainee.press("END");
    assert_eq!(trainee.screen().program.title, "PLC PROGRAMMING");
}
