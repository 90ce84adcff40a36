//! MOD: the data interfaces, DIN/ISO, and types of files that are disabled.

use crate::support::Trainee;

fn menu(trainee: &mut Trainee) {
    trainee.press("PROGRAM MOD");
    trainee.down_to("DATA INTERFACES");
    trainee.press("ENT");
    assert_eq!(trainee.screen().program.title, "DATA INTERFACES");
}

/// Presses RIGHT until a line has a value.
fn choose(trainee: &mut Trainee, name: &str, wanted: &str) {
    trainee.down_to(name);
    for _ in 0..12 {
        if trainee.menu_value(name) == wanted {
            return;
        }
        trainee.press("RIGHT");
    }
    panic!("{name} has no {wanted}");
}

fn set(folder: &std::path::Path, lines: &[&str]) {
    let path = folder.join("parameters.mp");
    let mut text = std::fs::read_to_string(&path).unwrap();
    for line in lines {
        let number = line.split_whitespace().next().unwrap();
        let own = text
            .lines()
            .find(|own| own.split_whitespace().next() == Some(number));
        text = text.replace(&format!("{}\n", own.unwrap()), &format!("{line}\n"));
    }
    std::fs::write(path, text).unwrap();
}

#[test]
fn the_interfaces_are_set_up_and_kept() {
    // EXT1: 8 bits, stop by DC3, even parity wanted, 1 stop bit, as the manual sets a printer up [000:17206-17214].
    let mut trainee = Trainee::with("mill", |folder| {
        set(folder, &["MP5020.0 : %10101001", "MP5030.1 : 1"]);
    });
    trainee.ready();
    menu(&mut trainee);
    for (name, expected) in [
        ("RS-232 INTERFACE", "FE1"),
        ("RS-232 BAUD RATE", "9600"),
        ("RS-422 INTERFACE", "FE1"),
        ("ASSIGNMENT: FILES", "RS-232"),
        ("EXT1 (MP5020.0, MP5030.0)", "8E1 DC3 STANDARD"),
        ("EXT2 (MP5020.1, MP5030.1)", "7N1.5 BLOCKWISE"),
    ] {
        assert_eq!(trainee.menu_value(name), expected, "{name}");
    }
    trainee.down_to("RS-232 INTERFACE");
    for expected in ["FE2", "ME", "EXT1", "EXT2", "LSV/2", "FE1"] {
        trainee.press("RIGHT");
        assert_eq!(trainee.menu_value("RS-232 INTERFACE"), expected);
    }
    // ME has 2400 baud, and no other.
    choose(&mut trainee, "RS-232 INTERFACE", "ME");
    assert_eq!(trainee.menu_value("RS-232 BAUD RATE"), "2400");
    trainee.down_to("RS-232 BAUD RATE");
    trainee.press("RIGHT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    choose(&mut trainee, "RS-232 INTERFACE", "EXT1");
    choose(&mut trainee, "RS-232 BAUD RATE", "19200");
    // 19 200 and 38 400 are not possible together [000:17552-17554].
    choose(&mut trainee, "RS-422 BAUD RATE", "19200");
    trainee.press("RIGHT");
    assert_eq!(trainee.messages(), ["BAUD RATE NOT POSSIBLE"]);
    assert_eq!(trainee.menu_value("RS-422 BAUD RATE"), "19200");
    trainee.press("CE LEFT LEFT");
    assert_eq!(trainee.menu_value("RS-422 BAUD RATE"), "4800");
    choose(&mut trainee, "ASSIGNMENT: PROGRAM RUN", "RS-422");
    let mut trainee = trainee.killed();
    trainee.ready();
    menu(&mut trainee);
    for (name, expected) in [
        ("RS-232 INTERFACE", "EXT1"),
        ("RS-232 BAUD RATE", "19200"),
        ("RS-422 BAUD RATE", "4800"),
        ("ASSIGNMENT: FILES", "RS-232"),
        ("ASSIGNMENT: PROGRAM RUN", "RS-422"),
    ] {
        assert_eq!(trainee.menu_value(name), expected, "{name}");
    }
}

#[test]
fn an_inhibited_interface_is_not_set_up() {
    let mut trainee = Trainee::with("mill", |folder| set(folder, &["MP5000 : 2"]));
    trainee.ready();
    menu(&mut trainee);
    assert_eq!(trainee.menu_value("RS-422 INTERFACE"), "INHIBITED (MP5000)");
    trainee.down_to("RS-422 INTERFACE");
    trainee.press("RIGHT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    choose(&mut trainee, "RS-232 INTERFACE", "FE2");
}

/// A TNC 360 has one interface: FE, ME, EXT or nothing [003:7048-7060].
#[test]
fn a_tnc_360_has_one_interface() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    menu(&mut trainee);
    let lines = trainee.screen().program.lines;
    assert!(lines.iter().all(|line| !line.text.starts_with("RS-422")));
    trainee.down_to("RS-232 INTERFACE");
    for expected in ["ME", "EXT", "", "FE"] {
        trainee.press("RIGHT");
        assert_eq!(trainee.menu_value("RS-232 INTERFACE"), expected);
    }
}

/// Nothing is connected: where a transfer would begin, the control says so, and HELP why.
#[test]
fn no_device_answers() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("EXT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    for mode in ["PROGRAM", "TEST", "FULL", "SINGLE"] {
        trainee.press(mode).press("EXT");
        if mode == "PROGRAM" || mode == "TEST" {
            // The menu, with PROGRAM DIRECTORY at the cursor.
            assert_eq!(trainee.screen().program.title, "EXTERNAL DATA TRANSFER");
            trainee.press("ENT");
        }
        assert_eq!(trainee.messages(), ["EXT. OUTPUT/INPUT NOT READY"], "{mode}");
        trainee.press("CE");
    }
    trainee.press("EXT HELP");
    assert_eq!(trainee.screen().program.title, "EXT. OUTPUT/INPUT NOT READY");
    trainee.press("END CE");
    // In German, too.
    trainee.press("MANUAL MOD");
    trainee.down_to("DIALOGUE LANGUAGE");
    trainee.press("ENT MOD PROGRAM EXT ENT");
    assert_eq!(trainee.messages(), ["EXT. AUS-/EINGABE NICHT BEREIT"]);
    trainee.press("CE MOD");
    let lines = trainee.screen().program.lines;
    assert!(
        lines.iter().any(|line| line.text == "DATENSCHNITTSTELLEN"),
        "{lines:?}"
    );
}

/// PROGRAM INPUT says what a name without a type is [003:7104-7110].
#[test]
fn program_input_chooses_the_language_of_new_programs() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("MOD");
    trainee.down_to("PROGRAM INPUT");
    assert_eq!(trainee.menu_value("PROGRAM INPUT"), "HEIDENHAIN");
    trainee.press("ENT");
    assert_eq!(trainee.menu_value("PROGRAM INPUT"), "ISO");
    trainee.press("END PROGRAM PGM_NR 8 8 ENT ENT").wait(0.1);
    assert_eq!(trainee.file("programs/88.I"), "%88 G71 *\nN99999 %88 G71 *\n");
    assert_eq!(trainee.screen().program.title, "88.I");
    // What is there is chosen, whatever the language.
    trainee.write("programs/89.H", "BEGIN PGM 89 MM\nEND PGM 89 MM\n");
    trainee.press("PGM_NR 8 9 ENT").wait(0.1);
    assert_eq!(trainee.screen().program.title, "89.H");
}

/// MP7224.0 hides the files of a type, MP7224.1 protects them [000:6857-6880].
#[test]
fn types_of_files_are_hidden_and_protected() {
    let names = |trainee: &mut Trainee| -> Vec<String> {
        let lines = trainee.screen().program.lines;
        lines.into_iter().map(|line| line.text).collect()
    };
    // Bit 6: help files are hidden, bit 5: texts are protected.
    let mut trainee = Trainee::with("mill", |folder| {
        set(folder, &["MP7224.0 : %01000000", "MP7224.1 : %00100000"]);
        for name in ["A.A", "D.HLP"] {
            std::fs::write(folder.join("programs").join(name), "").unwrap();
        }
    });
    trainee.ready();
    trainee.press("PROGRAM PGM_NR");
    let shown = names(&mut trainee);
    let is_protected = |name: &str| {
        let line = shown
            .iter()
            .find(|line| line.split_whitespace().next() == Some(name));
        line.map(|line| line.ends_with('P'))
    };
    assert_eq!(is_protected("A"), Some(true), "{shown:?}");
    assert_eq!(is_protected("D"), None, "{shown:?}");
    assert_eq!(is_protected("CIRCLE"), Some(false), "{shown:?}");
    trainee.press("D POINT H L P ENT");
    assert_eq!(trainee.messages(), ["PROGRAM NOT FOUND"]);
    trainee.press("CE CE CE CE CE CE");
    trainee.press("A POINT A").press("SK4").press("ENT");
    assert_eq!(trainee.messages(), ["PROTECTED PGM"]);
    assert!(trainee.has("programs/A.A") && trainee.has("programs/D.HLP"));
}

/// MP7224.1 bit 0: programs in plain language "cannot be edited or changed" [000:6855-6882], those in DIN/ISO can.
#[test]
fn programs_of_a_protected_type_are_not_edited() {
    let mut trainee = Trainee::with("mill", |folder| {
        set(folder, &["MP7224.1 : %00000001"]);
        std::fs::write(folder.join("programs/9.H"), "BEGIN PGM 9 MM\nEND PGM 9 MM\n").unwrap();
        std::fs::write(folder.join("programs/8.I"), "%8 G71 *\nN99999 %8 G71 *\n").unwrap();
    });
    trainee.ready();
    let before = trainee.file("programs/9.H");
    trainee.press("PROGRAM PGM_NR 9 ENT STOP END");
    assert!(
        trainee.messages().contains(&"PROTECTED PGM".to_owned()),
        "{:?}",
        trainee.messages()
    );
    assert_eq!(trainee.file("programs/9.H"), before);
    // The code number takes the protection from this file.
    trainee
        .press("CE CE CE PGM_NR 9 SK6")
        .number("86357")
        .press("ENT");
    trainee.press("PGM_NR 9 ENT STOP END").wait(0.1);
    assert_eq!(trainee.messages(), [""; 0]);
    assert!(
        trainee.file("programs/9.H").contains("STOP"),
        "{}",
        trainee.file("programs/9.H")
    );
    trainee.press("PGM_NR 8 POINT I ENT");
    assert_eq!(trainee.screen().program.title, "8.I");
    trainee.give(r#"{"text":"M3"}"#).press("END").wait(0.1);
    assert_eq!(trainee.messages(), [""; 0]);
    let iso = trainee.file("programs/8.I");
    let blocks: Vec<&str> = iso.lines().collect();
    assert!(blocks.len() == 3 && blocks[1].contains("M3"), "{iso}");
}
