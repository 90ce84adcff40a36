//! MOD by keys: display, units, language, limits, code numbers, machine parameters, help.

use crate::support::Trainee;

fn code(trainee: &mut Trainee, code: &str) {
    trainee.press("PROGRAM MOD");
    trainee.down_to("CODE NUMBER");
    trainee.press("ENT").number(code).press("ENT");
}

#[test]
fn display_unit_and_language() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("X").number("25.4").press("ENT").wait(0.2);
    trainee.press("MOD");
    assert_eq!(trainee.screen().program.title, "SUPPLEMENTARY FUNCTIONS");
    for expected in ["NOML", "LAG", "DIST", "REF", "ACTL"] {
        trainee.press("ENT");
        assert_eq!(trainee.menu_value("POSITION DISPLAY"), expected);
        assert_eq!(trainee.screen().status.position_type, expected);
    }
    trainee.press("LEFT");
    assert_eq!(trainee.menu_value("POSITION DISPLAY"), "REF");
    trainee.press("RIGHT DOWN ENT");
    // 25.4 mm are an inch.
    assert_eq!(
        (trainee.screen().status.inch, trainee.position('X').as_str()),
        (true, "+1.0000")
    );
    trainee.press("ENT");
    trainee.down_to("DIALOGUE LANGUAGE");
    trainee.press("ENT");
    assert_eq!(trainee.screen().mode, "MANUELLER BETRIEB");
    assert_eq!(trainee.menu_value("DIALOG-SPRACHE"), "DEUTSCH");
    assert_eq!(trainee.screen().status.position_type, "IST");
    // It is kept, and MOD leaves the menu.
    trainee.press("MOD");
    assert_eq!(trainee.screen().program.title, "");
    let mut trainee = trainee.killed();
    trainee.until(5.0, |screen| screen.mode == "MANUELLER BETRIEB");
}

#[test]
fn software_numbers_and_axes_for_l_blocks() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM MOD");
    assert_eq!(
        trainee.menu_value("NC SOFTWARE NUMBER"),
        format!("BAHN {}", env!("CARGO_PKG_VERSION"))
    );
    assert!(
        trainee
            .menu_value("PLC SOFTWARE NUMBER")
            .starts_with("MAIN.PLC 2")
    );
    trainee.down_to("AXES FOR L BLOCK");
    trainee.press("X Z X Y Z Z");
    assert_eq!(trainee.menu_value("AXES FOR L BLOCK"), "YZ");
    trainee.press("X IV");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"], "three at most");
}

#[test]
fn axis_limit_stops_an_axis() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("MOD");
    trainee.down_to("AXIS LIMIT 1");
    trainee.press("ENT");
    assert_eq!(trainee.menu_value("X+"), "+30000.000");
    // CAPTURE takes REF: where the axis stands.
    let snapshot = trainee.station.control().snapshot();
    let machine = snapshot.axes[0].machine;
    trainee.down_to("X+");
    trainee
        .press("ENT")
        .number(&format!("{:.3}", machine + 5.0))
        .press("ENT");
    assert_eq!(trainee.menu_value("X+"), format!("{:+.3}", machine + 5.0));
    trainee.press("UP CAPTURE");
    let least: f64 = trainee.menu_value("X-").parse().unwrap();
    assert!((least - machine).abs() < 0.0021, "{least}, {machine}");
    // Least above greatest.
    trainee.press("ENT").number("29000").press("ENT");
    assert_eq!(trainee.messages().last().unwrap(), "ENTRY VALUE INCORRECT");
    trainee.press("CE CE CE CE END END END");
    let before: f64 = trainee.position('X').parse().unwrap();
    trainee.give(r#"{"key":"X+","down":true}"#);
    trainee.until(30.0, |screen| {
        screen.messages.iter().any(|own| own.text == "LIMIT SWITCH X+")
    });
    trainee.give(r#"{"key":"X+","down":false}"#).wait(0.5);
    let way = trainee.position('X').parse::<f64>().unwrap() - before;
    assert!((way - 5.0).abs() < 0.01, "{way}");
    // HELP says what that means.
    trainee.press("HELP");
    let screen = trainee.screen();
    assert_eq!(
        (
            screen.program.title.as_str(),
            screen.program.lines[0].text.as_str()
        ),
        ("LIMIT SWITCH X+", "CAUSE:")
    );
    // It survives power-off.
    let mut trainee = trainee.killed();
    trainee.ready();
    trainee.press("MOD");
    trainee.down_to("AXIS LIMIT 1");
    trainee.press("ENT");
    assert_eq!(trainee.menu_value("X+"), format!("{:+.3}", machine + 5.0));
}

#[test]
fn a_machine_parameter_is_changed() {
    let mut trainee = Trainee::at("mill");
    let list = trainee.file("parameters.mp");
    let own = list.lines().find(|line| line.starts_with("MP1020.1")).unwrap();
    trainee.write(
        "parameters.mp",
        &list.replace(own, &format!("{own} ; of the mill")),
    );
    trainee.ready();
    let before = trainee.file("parameters.mp");
    code(&mut trainee, "95148");
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT");
    assert_eq!(trainee.screen().dialogue.prompt, "MP1020.1 =");
    // Too much, then right: 30 m/min is the greatest feed of the list.
    trainee.number("999999999").press("ENT");
    assert!(
        trainee.messages()[0].starts_with("3 "),
        "{:?}",
        trainee.messages()
    );
    trainee.press("CE CE").number("600").press("END");
    let after = trainee.file("parameters.mp");
    let differing: Vec<(&str, &str)> = before
        .lines()
        .zip(after.lines())
        .filter(|(a, b)| a != b)
        .collect();
    assert_eq!(differing.len(), 1);
    let (old, new) = differing[0];
    assert!(new.starts_with("MP1020.1") && new.contains("600"));
    assert!(old.ends_with("; of the mill") && new.ends_with("; of the mill"));
    // It acts: Y moves with 600 mm/min.
    trainee.press("MANUAL");
    let y = |trainee: &mut Trainee| trainee.position('Y').parse::<f64>().unwrap();
    let from = y(&mut trainee);
    trainee.give(r#"{"key":"Y+","down":true}"#).wait(1.0);
    trainee.give(r#"{"key":"Y+","down":false}"#).wait(1.0);
    let way = y(&mut trainee) - from;
    assert!((way - 10.0).abs() < 1.0, "{way}");
}

/// A comment is added after the value by a semicolon [000:10017]: with the value, or alone by its soft key.
#[test]
fn a_comment_is_added_to_a_machine_parameter() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    code(&mut trainee, "95148");
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT");
    trainee.give(r#"{"text":"600 ;slow, new guides"}"#).wait(0.1);
    trainee.press("ENT GOTO 1 0 2 0 POINT 2 ENT");
    trainee.soft(";");
    trainee.give(r#"{"text":"as delivered"}"#).wait(0.1);
    trainee.press("ENT").wait(0.1);
    trainee.press("END");
    let list = trainee.file("parameters.mp");
    let line = |name: &str| list.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line("MP1020.1").contains("600"), "{}", line("MP1020.1"));
    assert!(
        line("MP1020.1").ends_with("; slow, new guides"),
        "{}",
        line("MP1020.1")
    );
    assert!(
        line("MP1020.2").ends_with("; as delivered"),
        "{}",
        line("MP1020.2")
    );
}

#[test]
fn a_parameter_that_needs_a_reset_begins_anew() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    code(&mut trainee, "95148");
    let starts = trainee.station.control().starts();
    // MP10 says which axes there are; in binary, by the soft key %.
    trainee.press("GOTO 1 0 ENT");
    let shown = trainee.screen().program.lines;
    let line = shown.iter().find(|line| line.current).unwrap();
    let binary = line
        .text
        .split('%')
        .nth(1)
        .unwrap()
        .split_whitespace()
        .next()
        .unwrap()
        .to_owned();
    trainee.press("SK1").number(&binary).press("END");
    assert_eq!(trainee.station.control().starts(), starts + 1);
    trainee.until(5.0, |screen| {
        screen.messages.iter().any(|own| own.text == "POWER INTERRUPTED")
    });
}

#[test]
fn code_numbers_open_their_pages() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    for (number, title) in [
        ("123", "MACHINE PARAMETERS"),
        ("86357", "PROGRAM DIRECTORY"),
        ("857282", "MACHINE TIME"),
        ("688379", "OSCILLOSCOPE"),
        ("75368", "OFFSET ADJUSTMENT (1 = 0.15 mV)"),
    ] {
        code(&mut trainee, number);
        let screen = trainee.screen();
        assert_eq!(screen.program.title, title);
        assert!(!screen.program.lines.is_empty());
        // The PLC finds it in D276.
        let word = trainee
            .station
            .control()
            .memory()
            .number(bahn_exchange::signal::CODE_NUMBER);
        assert_eq!(word.to_string(), number);
        trainee.press("END END");
    }
    // M1000 ff. are erased only when it is meant.
    trainee.give(r#"{"action":"M1500=1"}"#).wait(0.1);
    let marker = |trainee: &Trainee| {
        let bit = "M1500".parse().unwrap();
        trainee.station.control().memory().bit(bit)
    };
    code(&mut trainee, "531210");
    assert_eq!(
        trainee.screen().dialogue.prompt,
        "M1000-M1999, B0-B127: ERASE = ENT / END = NO ENT"
    );
    trainee.press("NO_ENT");
    assert!(marker(&trainee));
    trainee.press("END");
    code(&mut trainee, "531210");
    trainee.press("ENT").wait(0.1);
    assert!(!marker(&trainee));
}

#[test]
fn machine_times_are_counted_and_kept() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    // In minutes of the control, whatever it needed before.
    let on = trainee.station.control().time_us() / 60_000_000;
    trainee.wait(61.0);
    code(&mut trainee, "857282");
    assert_eq!(trainee.menu_value("CONTROL ON"), format!("0:{:02}", on + 1));
    assert_eq!(trainee.menu_value("PROGRAM RUN"), "0:00");
    let mut trainee = trainee.killed();
    trainee.ready();
    code(&mut trainee, "857282");
    assert_eq!(trainee.menu_value("CONTROL ON"), format!("0:{:02}", on + 1));
}

#[test]
fn help_files_tell_the_plc_their_line() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("HELP");
    assert_eq!(trainee.messages(), ["NO HELP FILE"]);
    trainee.press("CE");
    trainee.write("programs/MILL.HLP", "Tool changer\n#0012 Arm back\n");
    trainee.press("HELP");
    let word = |trainee: &mut Trainee| {
        trainee.wait(0.1);
        trainee
            .station
            .control()
            .memory()
            .number(bahn_exchange::signal::HELP_LINE)
    };
    assert_eq!(
        (trainee.screen().program.title.as_str(), word(&mut trainee)),
        ("MILL.HLP", -2)
    );
    trainee.press("DOWN");
    assert_eq!(word(&mut trainee), 12);
    // It lies open beside one mode only [000:7066].
    trainee.press("PROGRAM HELP");
    assert_eq!(trainee.messages(), ["BACKGROUND PROGRAMMING NOT POSSIBLE"]);
    trainee.press("CE MANUAL END");
    assert_eq!(word(&mut trainee), -1);
    // Another mode leaves it, too.
    trainee.press("HELP DOWN");
    assert_eq!(word(&mut trainee), 12);
    trainee.press("MDI");
    assert_eq!(word(&mut trainee), -1);
}

/// A machine whose list has other values, on anew.
fn with_list(changes: &[(&str, &str)]) -> Trainee {
    let trainee = Trainee::at("mill");
    let list = trainee.file("parameters.mp");
    let line = |line: &str| {
        let found = changes
            .iter()
            .find(|(name, _)| line.starts_with(&format!("{name} ")));
        found.map_or_else(|| line.to_owned(), |(name, value)| format!("{name} : {value}"))
    };
    let list: Vec<String> = list.lines().map(line).collect();
    trainee.write("parameters.mp", &(list.join("\n") + "\n"));
    trainee.killed()
}

/// MP7330 chooses the parameters, MP7340 the dialogues of the machine builder [000:6907-6926].
#[test]
fn user_parameters_have_their_dialogues() {
    let trainee = with_list(&[
        ("MP7330.0", "1020.01"),
        ("MP7340.0", "1"),
        ("MP7330.1", "7430"),
        ("MP7340.1", "0"),
    ]);
    let description = trainee.file("machine.toml");
    trainee.write(
        "machine.toml",
        &description.replace("\"plc/DIALOG.TXT\"", "\"DIALOGUES.TXT\""),
    );
    trainee.write("DIALOGUES.TXT", "OVERLAP OF POCKETS\nFEED OF Y BY HAND\n");
    let mut trainee = trainee.killed();
    trainee.ready();
    trainee.press("PROGRAM MOD");
    trainee.down_to("USER PARAMETERS");
    trainee.press("ENT");
    let lines = trainee.screen().program.lines;
    assert!(
        lines[0].current && lines[0].text.starts_with("FEED OF Y BY HAND"),
        "{lines:?}"
    );
    assert!(lines[1].text.starts_with("OVERLAP OF POCKETS"));
    assert_eq!(trainee.screen().dialogue.prompt, "MP1020.1 =");
    trainee.number("450").press("END");
    let list = trainee.file("parameters.mp");
    assert!(
        list.lines()
            .any(|line| line.starts_with("MP1020.1 ") && line.contains("450"))
    );
}

/// MP7230 = 0 is the first language, which is German here; MP7280 = 0 the decimal comma.
#[test]
fn language_and_decimal_sign_are_those_of_the_list() {
    let mut trainee = with_list(&[("MP7230", "0"), ("MP7280", "0")]);
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    assert_eq!(trainee.screen().mode, "MANUELLER BETRIEB");
    assert!(trainee.position('X').contains(','));
}

/// MP7224.1 protects tool tables (bit 2) [000:6870-6880].
#[test]
fn tables_are_protected_by_the_list() {
    let mut trainee = with_list(&[("MP7224.1", "%00000100")]);
    trainee.ready();
    let before = trainee.file("tools.tsv");
    trainee.press("MANUAL SK8 RIGHT").number("5").press("ENT");
    assert_eq!(trainee.messages(), ["PROTECTED PGM"]);
    assert_eq!(trainee.file("tools.tsv"), before);
}
