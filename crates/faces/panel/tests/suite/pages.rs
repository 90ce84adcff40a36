//! What single pages show, and which soft keys they have.

use crate::support::Trainee;

/// The texts of the soft keys that are shown.
fn soft_keys(trainee: &mut Trainee) -> Vec<String> {
    let keys = trainee.screen().soft_keys.keys;
    keys.into_iter().filter(|key| !key.is_empty()).collect()
}

/// A parameter of the mill's list.
fn parameter(folder: &std::path::Path, line: &str) {
    let path = folder.join("parameters.mp");
    let number = line.split(' ').next().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let lines = text
        .lines()
        .map(|own| match own.starts_with(&format!("{number} ")) {
            true => line.to_owned(),
            false => own.to_owned(),
        });
    let lines: Vec<String> = lines.collect();
    assert!(lines.iter().any(|own| own == line), "{line}");
    std::fs::write(path, lines.join("\n") + "\n").unwrap();
}

#[test]
fn the_program_run_shows_block_numbers() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT").wait(0.2);
    let file = trainee.file("programs/CIRCLE.H");
    let shown = trainee.screen().program.lines;
    assert!(shown.len() > 5 && file.lines().count() >= shown.len());
    for (number, line) in shown.iter().enumerate() {
        // Numbers in a column of five, as in the editor; texts as the file has them, whose numbers do not count.
        assert_eq!(line.text[..5], format!("{number:<5}"));
        assert!(
            !line.text[5..].starts_with(|c: char| c.is_ascii_digit() || c == ' '),
            "{}",
            line.text
        );
    }
    assert_eq!(shown[0].text, "0    BEGIN PGM CIRCLE MM");
}

#[test]
fn a_screen_of_one_column_is_not_split() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM SCREEN").wait(0.1);
    assert!(trainee.messages().is_empty() && trainee.screen().beside.is_some());
    // The keyboard of the TNC 360 does not have the key.
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    trainee.press("PROGRAM").wait(0.1);
    let key = serde_json::from_str::<bahn_panel::InputText>(r#"{"key":"SCREEN"}"#).unwrap();
    let refused = trainee.station.input(&key.try_into().unwrap()).unwrap_err();
    assert_eq!(refused.to_string(), "the TNC 360 has no key SCREEN");
    assert!(trainee.screen().beside.is_none());
}

#[test]
fn an_empty_word_leaves_no_blank_in_the_current_block() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let program = "0 BEGIN PGM 4711 MM\n1 L X+10 M3\n2 END PGM 4711 MM\n";
    trainee.write("programs/4711.H", program);
    trainee.press("PROGRAM PGM_NR 4 7 1 1 ENT DOWN").wait(0.1);
    let line = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        lines.into_iter().find(|line| line.current).unwrap()
    };
    assert_eq!(line(&mut trainee).text, "1    L X+10 M3");
    trainee.press("RIGHT");
    assert_eq!(line(&mut trainee).text, "1    L X+10 M3");
}

/// MP7680 allows the return to the contour with bit 1, the block scan with bit 2 [000:6785-6812].
#[test]
fn soft_keys_that_are_not_allowed_are_not_shown() {
    for (bits, at_rest, interrupted) in [
        ("%000001", false, ["INTERNAL STOP", "Q"].as_slice()),
        (
            "%000011",
            false,
            &["MANUAL OPERATION", "RESTORE POSITION", "INTERNAL STOP", "Q"],
        ),
        ("%000101", true, &["RESTORE POSITION", "INTERNAL STOP", "Q"]),
    ] {
        let mut trainee = Trainee::with("mill", |folder| parameter(folder, &format!("MP7680   : {bits}")));
        trainee.ready();
        trainee.press("FULL PGM_NR C I R C L E ENT").wait(0.2);
        let scan = soft_keys(&mut trainee).contains(&"RESTORE AT N".to_owned());
        assert_eq!(scan, at_rest, "{bits}");
        trainee.press("NC_START").wait(3.0).press("NC_STOP").wait(2.0);
        let shown = soft_keys(&mut trainee);
        assert_eq!(shown[..interrupted.len()], *interrupted, "{bits}");
    }
}

/// Where EMERGENCY STOP leaves the tool in a thread, MANUAL OPERATION leads it out whatever MP7680 says.
#[test]
fn manual_operation_stays_in_a_thread() {
    let mut trainee = Trainee::with("mill", |folder| parameter(folder, "MP7680   : %000001"));
    trainee.ready();
    let program = "0 BEGIN PGM 4711 MM\n1 TOOL CALL 3 Z S600\n2 CYCL DEF 17.0 RIGID TAPPING\n\
                   3 CYCL DEF 17.1 SET UP -3\n4 CYCL DEF 17.2 DEPTH -20\n5 CYCL DEF 17.3 PITCH +1.5\n\
                   6 L X+20 Y+20 R0 FMAX\n7 L Z+3 FMAX M3\n8 CYCL CALL\n9 END PGM 4711 MM\n";
    trainee.write("programs/4711.H", program);
    trainee
        .press("FULL PGM_NR 4 7 1 1 ENT")
        .wait(0.2)
        .press("NC_START");
    for _ in 0..1200 {
        if trainee.station.control().first().is_in_thread() {
            break;
        }
        trainee.wait(0.1);
    }
    assert!(
        trainee.station.control().first().is_in_thread(),
        "{:#?}",
        trainee.screen()
    );
    trainee.wait(0.5).press("EMERGENCY_STOP").wait(2.0);
    assert!(soft_keys(&mut trainee).contains(&"MANUAL OPERATION".to_owned()));
}

/// The panel does not repeat what the control says.
#[test]
fn a_message_stands_there_once() {
    let mut trainee = Trainee::at("mill");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    trainee.press("CE");
    trainee.until(10.0, |screen| {
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    });
    // A key of the panel without a function here, then a start before the reference marks, which the control refuses.
    trainee.press("RL");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START").wait(0.5);
    assert_eq!(trainee.station.control().shown().len(), 1);
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    assert!(trainee.messages().is_empty(), "{:?}", trainee.messages());
}

/// M, S and TOUCH PROBE are soft keys that the PLC presses by their codes, where they are shown [000:7406-7440].
#[test]
fn soft_keys_and_letters_are_pressed_by_the_plc() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    fn simulate(trainee: &mut Trainee, code: i32) -> bool {
        trainee.give(&format!("{{\"action\":\"W516={code}\"}}"));
        trainee.give("{\"action\":\"M2813=1\"}").wait(0.2);
        let not_executed = "M2187".parse().unwrap();
        !trainee.station.control().memory().bit(not_executed)
    }
    for (code, shown) in [
        (0x0100, "MISCELLANEOUS FUNCTION M ="),
        (0x0200, "SPINDLE SPEED S ="),
    ] {
        assert!(simulate(&mut trainee, code), "{code:04X}");
        assert_eq!(trainee.screen().dialogue.prompt, shown);
        trainee.press("END");
    }
    assert!(simulate(&mut trainee, 0x0300));
    assert_eq!(trainee.screen().program.title, "TOUCH PROBE");
    trainee.press("END");
    // The machine side is in the background.
    trainee.press("PROGRAM");
    assert!(simulate(&mut trainee, 0x0100));
    assert_eq!(trainee.screen().mode, "MANUAL OPERATION");
    assert_eq!(trainee.screen().dialogue.prompt, "MISCELLANEOUS FUNCTION M =");
    trainee.press("END FULL");
    // Not shown in a program run.
    assert!(!simulate(&mut trainee, 0x0100));
    // Letters, unless M2876 inhibits them: as the name of a program.
    trainee.press("PGM_NR");
    for letter in "CIRCLE".bytes() {
        assert!(simulate(&mut trainee, i32::from(letter) << 8 | 0x50));
    }
    assert_eq!(trainee.screen().dialogue.entry, "CIRCLE");
    trainee.give("{\"action\":\"M2876=1\"}").wait(0.1);
    simulate(&mut trainee, 0x4150);
    assert_eq!(trainee.screen().dialogue.entry, "CIRCLE");
    // No code of a key.
    assert!(!simulate(&mut trainee, 0x0600));
}

/// M2876 inhibits the letters, M2877 the soft keys, M2878 those that change the row; a letter is reported by its code
/// [000:7319-7336] [000:7406-7410].
#[test]
fn groups_of_keys_are_inhibited() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let set = |trainee: &mut Trainee, marker: &str, to: u8| {
        trainee
            .give(&format!("{{\"action\":\"{marker}={to}\"}}"))
            .wait(0.1);
    };
    trainee.press("PROGRAM PGM_NR");
    set(&mut trainee, "M2876", 1);
    trainee.press("B");
    assert_eq!(trainee.screen().dialogue.entry, "");
    let memory = trainee.station.control().memory();
    assert!(memory.bit("M2182".parse().unwrap()));
    assert_eq!(memory.number("W274".parse().unwrap()), 0x4250);
    set(&mut trainee, "M2876", 0);
    trainee.press("B");
    assert_eq!(trainee.screen().dialogue.entry, "B");
    trainee.press("END MANUAL");
    set(&mut trainee, "M2877", 1);
    trainee.press("SK1");
    assert_eq!(trainee.screen().dialogue.prompt, "");
    set(&mut trainee, "M2877", 0);
    trainee.press("SK1");
    assert_eq!(trainee.screen().dialogue.prompt, "MISCELLANEOUS FUNCTION M =");
    // The table of the PLC mode has two rows.
    trainee
        .press("END PROGRAM MOD ENT")
        .number("807667")
        .press("ENT SK2");
    let row = |trainee: &mut Trainee| trainee.screen().soft_keys.row;
    let rows = trainee.screen().soft_keys.rows;
    assert!(rows > 1 && row(&mut trainee) == 0);
    set(&mut trainee, "M2878", 1);
    trainee.press("SK_RIGHT");
    assert_eq!(row(&mut trainee), 0);
    set(&mut trainee, "M2878", 0);
    trainee.press("SK_RIGHT");
    assert_eq!(row(&mut trainee), 1);
}

/// M2854 to M2923 inhibit single keys: M2856 the key L, whose code 60 stands in W274 then [000:7319-7342].
#[test]
fn single_keys_are_inhibited() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 9 9 ENT ENT");
    for (marker, key, code) in [("M2856", "L", 60), ("M2905", "X", 109), ("M2915", "END", 119)] {
        trainee.give(&format!("{{\"action\":\"{marker}=1\"}}")).wait(0.1);
        trainee.press(key);
        assert_eq!(trainee.screen().dialogue.prompt, "", "{key}");
        let memory = trainee.station.control().memory();
        assert!(memory.bit("M2182".parse().unwrap()), "{key}");
        assert_eq!(memory.number("W274".parse().unwrap()), code);
        trainee.give(&format!("{{\"action\":\"{marker}=0\"}}"));
        trainee.give("{\"action\":\"M2182=0\"}").wait(0.1);
    }
    trainee.press("L");
    assert_eq!(trainee.screen().dialogue.prompt, "COORDINATES?");
}
