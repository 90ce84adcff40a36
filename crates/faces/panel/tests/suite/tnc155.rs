//! Keyboard, screen and MOD of a TNC 151 and a TNC 155 [001:186] [001:1293-1334].

use crate::support::Trainee;
use bahn_parameters::ControlModel::{Tnc151, Tnc155};
use serde_json::json;

fn screen(trainee: &mut Trainee) -> serde_json::Value {
    serde_json::to_value(trainee.screen()).unwrap()
}

/// The screen of one colour has no soft keys below it, whatever page is shown; a TNC 360 has them.
#[test]
fn the_screen_has_one_colour_and_no_soft_keys() {
    let mut trainee = Trainee::with_tnc155(Tnc155, &[]);
    trainee.wait(0.1);
    assert_eq!(screen(&mut trainee)["look"]["layout"], "monochrome");
    assert_eq!(screen(&mut trainee)["look"]["colours"], json!({}));
    on(&mut trainee);
    for keys in ["", "PROGRAM", "MOD", "END", "PGM_NR", "END", "TEST", "MDI"] {
        trainee.press(keys);
        let keys = screen(&mut trainee)["soft_keys"].clone();
        assert_eq!(keys, json!({"keys": [], "row": 0, "rows": 0}));
    }
    let mut later = Trainee::at("mill-tnc360");
    on(&mut later).press("PROGRAM MOD");
    assert!(!later.screen().soft_keys.keys.is_empty());
}

/// "Clamped axes are indicated in the display by a decimal point which suffixes the axis designation" [001:505-507]: before
/// the reference run no loop is closed [001:484]; the later controls put `*` before the letter [000:5366].
#[test]
fn a_clamped_axis_has_a_point_after_its_letter() {
    let labels = |trainee: &mut Trainee| {
        let axes = screen(trainee)["status"]["axes"].clone();
        let label = |axis: &serde_json::Value| axis["label"].as_str().unwrap_or_default().to_owned();
        axes.as_array().unwrap().iter().map(label).collect::<Vec<_>>()
    };
    let mut trainee = Trainee::with_tnc155(Tnc155, &[]);
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    assert_eq!(labels(&mut trainee), [" X.", " Y.", " Z."]);
    trainee.ready();
    assert_eq!(labels(&mut trainee), [" X ", " Y ", " Z "]);
    let mut later = Trainee::at("mill-tnc360");
    later.wait(0.5);
    assert_eq!(labels(&mut later), ["*X ", "*Y ", "*Z "]);
}

/// Without feed enable the status display shows an inverted F [001:509-516].
#[test]
fn f_is_inverse_without_feed_enable() {
    let mut trainee = Trainee::with_tnc155(Tnc155, &[]);
    trainee.ready();
    assert!(!trainee.screen().status.f_inverse);
    // The door opens the contact at E18.
    trainee.give(r#"{"action":"switch door open"}"#).wait(1.0);
    assert!(trainee.screen().status.f_inverse);
}

/// "TNC 151: character screen; graphics only on the TNC 155" [001:186] [001:2157].
#[test]
fn a_tnc_151_has_no_keys_of_the_graphics() {
    let graphics = ["GRAPHICS", "BLK_FORM", "MAGN", "START"];
    for (model, there) in [(Tnc151, false), (Tnc155, true)] {
        let trainee = Trainee::with_tnc155(model, &[]);
        let names: Vec<_> = trainee.station.keyboard().map(|key| key.name()).collect();
        for key in graphics {
            assert_eq!(names.contains(&key), there, "{model}: {key}");
        }
        assert!(!names.iter().any(|name| name.starts_with("SK")), "{names:?}");
    }
}

/// POWER INTERRUPTED is cleared.
fn on(trainee: &mut Trainee) -> &mut Trainee {
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    trainee.press("CE").until(10.0, |screen| {
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    })
}

fn mode_menu(trainee: &mut Trainee) -> Vec<String> {
    let lines = trainee.screen().program.lines;
    lines.into_iter().map(|line| line.text).collect()
}

/// MP217 says in which language programs are written, so MOD does not ask [001:1653]; a TNC 360 asks [003:7104].
#[test]
fn mp217_is_the_language_of_new_programs() {
    for (line, ending, letters) in [("MP217 : 0", "H", false), ("MP217 : 1", "I", true)] {
        let mut trainee = Trainee::with_tnc155(Tnc155, &[line]);
        on(&mut trainee).press("MOD");
        let menu = mode_menu(&mut trainee);
        assert!(
            !menu.iter().any(|line| line.starts_with("PROGRAM INPUT")),
            "{menu:?}"
        );
        assert_eq!(trainee.screen().look.letters, letters);
        trainee.press("END PROGRAM PGM_NR 7 7 ENT ENT").wait(0.2);
        assert!(trainee.has(&format!("programs/77.{ending}")), "{line}");
    }
    let mut later = Trainee::at("mill-tnc360");
    on(&mut later).press("MOD");
    assert!(
        mode_menu(&mut later)
            .iter()
            .any(|line| line.starts_with("PROGRAM INPUT"))
    );
}

/// MP65 = 1 takes and shows positions in steps of 5 µm; what is finer is no value [001:1612-1614].
#[test]
fn mp65_has_steps_of_5_micrometres() {
    let entered = |line: &'static str, value: &str| {
        let mut trainee = Trainee::with_tnc155(Tnc155, &[line]);
        trainee.ready();
        trainee.press("X").number(value).press("ENT").wait(0.2);
        (trainee.position('X'), trainee.messages())
    };
    // The axis may tremble by a step of its encoder.
    let (fine, messages) = entered("MP65 : 0", "12.344");
    let fine: f64 = fine.parse().unwrap();
    assert!((fine - 12.344).abs() < 0.0011 && messages.is_empty(), "{fine}");
    assert_eq!(entered("MP65 : 1", "12.345"), ("+12.345".to_owned(), Vec::new()));
    let (_, messages) = entered("MP65 : 1", "12.344");
    assert_eq!(messages, ["ENTRY VALUE INCORRECT"]);
}

/// ME, FE and EXT [001:1137-1148]; 110 to 9600 baud [001:1162].
#[test]
fn the_data_interface_has_three_modes_and_9600_baud() {
    let mut trainee = Trainee::with_tnc155(Tnc155, &[]);
    on(&mut trainee).press("PROGRAM MOD");
    trainee.down_to("DATA INTERFACES");
    trainee.press("ENT");
    trainee.down_to("RS-232 INTERFACE");
    let mut modes = Vec::new();
    for _ in 0..3 {
        modes.push(trainee.menu_value("RS-232 INTERFACE"));
        trainee.press("ENT");
    }
    modes.sort();
    assert_eq!(modes, ["EXT", "FE", "ME"]);
    trainee.down_to("RS-232 BAUD RATE");
    assert_eq!(trainee.menu_value("RS-232 BAUD RATE"), "9600");
    trainee.press("RIGHT");
    assert_eq!(trainee.menu_value("RS-232 BAUD RATE"), "110");
    trainee.number("19200").press("ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
}

/// What soft keys do later has its keys: axis keys and digits in ELECTRONIC HANDWHEEL [001:1059], MANUAL for marks that were
/// left out, ENT and GOTO in TEST RUN, P for protection.
#[test]
fn everything_has_a_key_of_the_keyboard() {
    let mut trainee = Trainee::with_tnc155(Tnc151, &[]);
    on(&mut trainee).press("MANUAL").wait(0.2);
    assert_eq!(trainee.screen().mode, "MANUAL OPERATION");
    trainee.press("MANUAL").wait(0.2);
    assert_eq!(trainee.screen().mode, "PASS OVER REFERENCE MARKS");
    trainee.wait(1.0).press("NC_START");
    trainee.until(120.0, |screen| screen.mode == "MANUAL OPERATION");
    trainee.press("HANDWHEEL Y 5 ENT").wait(0.2);
    assert_eq!(trainee.screen().machine.handwheel, ('Y', 5));
    trainee.press("END PROGRAM PGM_NR 8 8 ENT ENT PGM_NR");
    trainee.down_to("88");
    trainee.press("P").wait(0.2);
    let line = |trainee: &mut Trainee| {
        mode_menu(trainee)
            .into_iter()
            .find(|line| line.starts_with("88"))
            .unwrap()
    };
    assert!(line(&mut trainee).ends_with('P'));
    trainee.press("P").number("86357").press("ENT").wait(0.2);
    assert!(!line(&mut trainee).ends_with('P'));
    trainee.press("END TEST ENT").wait(0.5);
    assert!(trainee.station.control().test_report().is_some());
}

/// What the machine waits for is named by the parameter that the control has: MP59 is the order of the reference run
/// [001:1443-1478], MP1340 that of a TNC 360.
#[test]
fn reasons_name_the_parameters_of_the_control() {
    for (model, named) in [(Some(Tnc155), "MP59:"), (None, "MP1340:")] {
        let mut trainee = match model {
            Some(model) => Trainee::with_tnc155(model, &[]),
            None => Trainee::at("mill-tnc360"),
        };
        on(&mut trainee).wait(1.5);
        let why = trainee.screen().why.join(" ");
        assert!(why.contains(named), "{why}");
    }
}

/// The control sees its voltage at E8 [001:904], not at X42/4 of the later ones: nothing is said while it is there.
#[test]
fn the_control_voltage_is_seen_at_e8() {
    let mut trainee = Trainee::with_tnc155(Tnc155, &[]);
    trainee.ready();
    let missing = |trainee: &mut Trainee| {
        let why = trainee.screen().why;
        why.into_iter()
            .find(|line| line.contains("control voltage is missing"))
    };
    assert_eq!(missing(&mut trainee), None);
    trainee.press("EMERGENCY_STOP").wait(0.5);
    assert!(missing(&mut trainee).is_some_and(|line| line.contains("I8")));
}
