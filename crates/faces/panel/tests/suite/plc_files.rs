//! The PLC mode by keys: other forms of a program, the binary code of an EPROM, the files of messages.

use crate::support::Trainee;
use bahn_host::eprom::LoadList;
use bahn_host::s_records::Image;
use bahn_panel::{TransferAction, TransferFiles};

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
    trainee.soft("CONVERT");
    trainee.wait(0.1);
    trainee.soft(key);
    trainee.wait(0.1);
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
    trainee.soft("CONVERT");
    trainee.soft("LISTING");
    trainee.wait(0.1);
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
        std::fs::write(folder.join("plc/OTHER.ER1"), "-\n".repeat(20) + "ANOTHER TEXT\n").unwrap();
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
    // It is active at once [000:11237-11240]: M2944 is message 20, which the program of the mill leaves alone.
    assert_eq!(
        trainee.screen().program.lines[2].text.split_whitespace().last(),
        Some("ACTIVE")
    );
    let shows = |trainee: &mut Trainee, text: &str| {
        trainee.give(r#"{"action":"M2944=1"}"#).wait(0.05);
        let shown = trainee.messages().iter().any(|own| own == text);
        trainee.press("CE");
        shown
    };
    assert!(shows(&mut trainee, "ANOTHER TEXT"), "{:?}", trainee.messages());
    // What is written into the active file is there when its editor is left.
    trainee.press("END");
    trainee.soft("EDIT");
    trainee.down_to("OTHER.ER1");
    trainee
        .press("ENT")
        .press(&"DOWN ".repeat(20))
        .typed("X")
        .press("END");
    assert!(shows(&mut trainee, "XANOTHER TEXT"), "{:?}", trainee.messages());
    let after = trainee.file("machine.toml");
    let differing = before
        .lines()
        .zip(after.lines())
        .filter(|(one, other)| one != other);
    assert_eq!(differing.count(), 1, "{after}");
    let trainee = trainee.killed();
    assert_eq!(trainee.station.machine().plc_messages[20], "XANOTHER TEXT");
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

fn lines(trainee: &mut Trainee) -> Vec<String> {
    let lines = trainee.screen().program.lines;
    lines.into_iter().map(|line| line.text).collect()
}

/// UNFORM.: the program without the columns of its editor; strings and comments are what they were.
#[test]
fn an_unformatted_program_compiles_to_the_same() {
    let mut trainee = Trainee::with("mill", |folder| {
        let text = "        L      M0       ;   a  comment\n        =      O5\n        L  S\"A  ; B\"\n        =      S1\n";
        std::fs::write(folder.join("plc/X.PLC"), text).unwrap();
    });
    plc_mode(&mut trainee);
    let plain = converted(&mut trainee, "UNFORM.", "U");
    let source = trainee.file("plc/MAIN.PLC");
    let words = |text: &str| -> Vec<String> { text.split_whitespace().map(str::to_owned).collect() };
    assert_eq!(words(&plain), words(&source));
    assert_eq!(plain.lines().count(), source.lines().count());
    assert!(plain.len() < source.len());
    trainee.soft("EDIT");
    trainee.down_to("X.PLC");
    trainee.soft("CONVERT");
    trainee.soft("UNFORM.");
    trainee.wait(0.1).typed("V").press("ENT");
    assert_eq!(
        trainee.file("plc/V.A"),
        "L M0 ;   a  comment\n= O5\nL S\"A  ; B\"\n= S1\n"
    );
}

/// Files are copied, renamed and protected; what the machine needs keeps its name.
#[test]
fn files_are_managed_by_soft_keys() {
    let mut trainee = Trainee::at("mill");
    plc_mode(&mut trainee);
    // PGM NAME opens the file management, too.
    trainee.press("PGM_NR");
    assert_eq!(trainee.screen().program.title, "PLC FILES");
    trainee.down_to("MAIN.PLC");
    trainee.soft("COPY");
    assert_eq!(trainee.screen().dialogue.prompt, "DESTINATION FILE = .PLC");
    trainee.typed("B").press("ENT").wait(0.1);
    assert_eq!(trainee.file("plc/B.PLC"), trainee.file("plc/MAIN.PLC"));
    trainee.down_to("B.PLC");
    trainee.soft("PROTECT");
    trainee.wait(0.1);
    assert!(lines(&mut trainee).contains(&"B.PLC             P".to_owned()));
    // A protected file is neither renamed nor changed.
    trainee.soft("RENAME");
    trainee.typed("C").press("ENT");
    assert_eq!(last_message(&mut trainee), "PROTECTED PGM");
    let before = trainee.file("plc/B.PLC");
    trainee.press("CE ENT X");
    assert_eq!(last_message(&mut trainee), "PROTECTED PGM");
    assert_eq!(trainee.file("plc/B.PLC"), before);
    trainee.press("CE END PGM_NR");
    trainee.down_to("B.PLC");
    trainee.soft("UNPROTECT");
    trainee.soft("RENAME");
    trainee.typed("C").press("ENT").wait(0.1);
    assert!(trainee.has("plc/C.PLC") && !trainee.has("plc/B.PLC"));
    assert!(lines(&mut trainee).iter().any(|line| line == "C.PLC"));
    trainee.down_to("MAIN.PLC");
    trainee.soft("RENAME");
    assert_eq!(last_message(&mut trainee), "PROTECTED PGM");
    // SELECT TYPE shows some of them.
    trainee.press("CE");
    trainee.soft("SELECT TYPE");
    trainee.soft(".ER1");
    trainee.wait(0.1);
    assert_eq!(lines(&mut trainee), ["MAIN.ER1"]);
    trainee.soft("SELECT TYPE");
    trainee.soft("SHOW ALL");
    trainee.wait(0.1);
    assert!(lines(&mut trainee).len() > 2);
}

/// Two windows: the files of an EPROM in one are transferred into the memory, which the other shows.
#[test]
fn a_file_of_an_eprom_is_transferred_from_window_to_window() {
    let mut trainee = Trainee::at("mill");
    plc_mode(&mut trainee);
    trainee.soft("OUTPUT BINARY CODE");
    trainee.press("EXT").press("CE END");
    assert!(trainee.has("plc/00000000.BIN"));
    let texts = trainee.file("plc/MAIN.ER1");
    trainee.soft("EDIT");
    trainee.down_to("MAIN.ER1");
    trainee.soft("WINDOW");
    assert_eq!(
        trainee.screen().soft_keys.keys,
        [
            "PAGE UP",
            "PAGE DOWN",
            "TRANSFER",
            "TRANSFER TAGGED",
            "TRANSFER ALL",
            "SELECT TYPE",
            "WINDOW",
            "END"
        ]
    );
    let shown = lines(&mut trainee);
    assert!(shown.iter().all(|line| line.contains(" | ")), "{shown:#?}");
    // The right window shows the EPROM, too; the left one does not.
    trainee.press("RIGHT");
    trainee.soft("MODIFY WINDOW");
    trainee.soft("SELECT TNC/EPROM");
    trainee.wait(0.1);
    let shown = lines(&mut trainee);
    let of_eprom = |line: &&String| line.contains("EPROM 00000000.BIN");
    assert_eq!(shown.iter().filter(of_eprom).count(), 2, "{shown:#?}");
    assert!(
        !shown
            .iter()
            .any(|line| line.split(" | ").next().unwrap().contains("EPROM 0"))
    );
    // What is not there is transferred; what is there is asked for, and stays without ENT.
    let main = trainee.file("plc/MAIN.PLC");
    trainee.write("plc/MAIN.PLC", &format!("{main};mine\n"));
    std::fs::remove_file(trainee.folder().join("plc/MAIN.ER1")).unwrap();
    trainee.soft("TRANSFER ALL");
    let asked = "ERASE/OVERREAD MAIN.PLC: YES = ENT / NO = NO ENT";
    assert_eq!(trainee.screen().dialogue.prompt, asked);
    trainee.press("NO_ENT");
    assert_eq!(last_message(&mut trainee), "1 FILES TRANSFERRED");
    assert!(trainee.file("plc/MAIN.PLC").ends_with(";mine\n"));
    assert_eq!(trainee.file("plc/MAIN.ER1"), texts);
    // Tagged files only: that of the EPROM after those of the memory.
    trainee.press("CE");
    trainee.soft("TRANSFER TAGGED");
    assert_eq!(last_message(&mut trainee), "KEY NON-FUNCTIONAL");
    trainee.press("CE");
    let count = trainee.screen().program.total;
    for _ in 0..count {
        trainee.press("DOWN");
    }
    while !lines(&mut trainee).iter().any(|line| line.contains("*MAIN.PLC")) {
        trainee.soft("TAG");
        trainee.press("UP UP");
    }
    trainee.soft("TRANSFER TAGGED");
    while trainee.screen().dialogue.prompt.starts_with("ERASE/OVERREAD") {
        trainee.press("ENT");
    }
    assert!(last_message(&mut trainee).ends_with("FILES TRANSFERRED"));
    assert_eq!(trainee.file("plc/MAIN.PLC"), main);
    // A file of the memory lies in both windows.
    trainee.press("CE LEFT");
    trainee.soft("TRANSFER");
    assert_eq!(last_message(&mut trainee), "KEY NON-FUNCTIONAL");
    trainee.press("CE");
    trainee.soft("MODIFY WINDOW");
    trainee.soft("SELECT EXT");
    trainee.wait(0.1);
    assert_eq!(last_message(&mut trainee), "EXT. OUTPUT/INPUT NOT READY");
}

/// CL PGM erases a file when ENT says so; what the machine needs, and what is protected, stays.
#[test]
fn a_file_is_erased_by_its_key() {
    let mut trainee = Trainee::at("mill");
    trainee.write("plc/OLD.PLC", "  EM\n");
    plc_mode(&mut trainee);
    trainee.soft("EDIT");
    trainee.down_to("OLD.PLC");
    trainee.press("CL_PGM");
    assert_eq!(
        trainee.screen().dialogue.prompt,
        "OLD.PLC: ERASE = ENT / END = NO ENT"
    );
    trainee.press("NO_ENT");
    assert!(trainee.has("plc/OLD.PLC"));
    trainee.soft("PROTECT");
    trainee.press("CL_PGM ENT");
    assert_eq!(last_message(&mut trainee), "PROTECTED PGM");
    trainee.press("CE");
    trainee.soft("UNPROTECT");
    trainee.press("CL_PGM ENT").wait(0.1);
    assert!(!trainee.has("plc/OLD.PLC"));
    assert!(!lines(&mut trainee).iter().any(|line| line.contains("OLD")));
    trainee.down_to("MAIN.PLC");
    trainee.press("CL_PGM");
    assert_eq!(last_message(&mut trainee), "PROTECTED PGM");
}

/// The lines of a program are checked, those of a list are not; COMPILE offers programs only.
#[test]
fn only_programs_are_checked_and_compiled() {
    let mut trainee = Trainee::at("mill");
    plc_mode(&mut trainee);
    trainee.soft("OUTPUT BINARY CODE");
    trainee.press("1 DOWN UP");
    assert!(trainee.messages().is_empty(), "{:?}", trainee.messages());
    trainee.press("CE END");
    trainee.soft("COMPILE");
    let shown = lines(&mut trainee);
    assert!(shown.iter().any(|line| line.starts_with("MAIN.PLC")));
    assert!(
        !shown
            .iter()
            .any(|line| line.contains(".ER1") || line.contains(".A")),
        "{shown:?}"
    );
}

/// EXT in PLC PROGRAMMING: the .CMA file is assigned the extension .S and the .COM file the extension .V [000:3867-3869];
/// programs and texts go as they are [000:11386-11390].
#[test]
fn files_of_the_plc_are_transferred() {
    let mut trainee = Trainee::with("mill", |folder| {
        std::fs::write(
            folder.join("plc/ACHSE-Y.COM"),
            "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n",
        )
        .unwrap();
        std::fs::write(folder.join("plc/CONFIG.CMA"), "0 Y=ACHSE-Y\n").unwrap();
    });
    let orders = trainee.station.transfer_orders();
    plc_mode(&mut trainee);
    trainee.give(r#"{"transfer":"connected 0"}"#);
    for (typed, name) in [
        ("CONFIG.S", "CONFIG.CMA"),
        ("NEW.V", "NEW.COM"),
        ("MAIN", "MAIN.PLC"),
        ("M.ER1", "M.ER1"),
    ] {
        trainee.press("EXT DOWN DOWN DOWN ENT");
        trainee.give(&format!("{{\"text\":\"{typed}\"}}")).press("ENT");
        let order = orders.try_recv().unwrap();
        assert_eq!(order.action, TransferAction::Read(name.to_owned()));
        assert_eq!(order.files, TransferFiles::Plc);
        trainee.give(r#"{"transfer":"ended complete"}"#).press("END END");
        assert_eq!(trainee.screen().program.title, "PLC PROGRAMMING");
    }
    // From the files, too: all of them that an interface knows. The main program has the status M [000:14608].
    trainee.soft("EDIT");
    let shown = lines(&mut trainee);
    let status = |name: &str| {
        let line = shown.iter().find(|line| line.starts_with(name)).unwrap();
        line.split_whitespace().nth(1).map(str::to_owned)
    };
    assert_eq!(
        (status("MAIN.PLC").as_deref(), status("CONFIG.CMA")),
        (Some("M"), None)
    );
    trainee.press("EXT DOWN DOWN DOWN DOWN DOWN ENT");
    let order = orders.try_recv().unwrap();
    let TransferAction::Write(names) = order.action else {
        panic!("{order:?}");
    };
    for name in ["ACHSE-Y.COM", "CONFIG.CMA", "MAIN.ER1", "MAIN.PLC"] {
        assert!(names.iter().any(|own| own == name), "{names:?}");
    }
    assert!(!names.iter().any(|name| name.ends_with(".TXT")), "{names:?}");
}
