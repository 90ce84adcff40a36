//! From power-on to a running program, by keys.

use crate::support::Trainee;
use bahn_panel::Star;

#[test]
fn the_power_on_dialogue_leads_to_manual_operation() {
    let mut trainee = Trainee::at("mill");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    assert_eq!(trainee.messages(), ["POWER INTERRUPTED"]);
    // CE, then the control voltage, then the reference marks [000:7031-7040] [000:4568-4600].
    trainee.press("CE");
    trainee.until(10.0, |screen| screen.mode == "PASS OVER REFERENCE MARKS");
    let asked = trainee.screen().dialogue.prompt;
    assert_eq!(asked, "PASS OVER REFERENCE MARK X Y Z C");
    trainee.until(10.0, |screen| screen.messages.is_empty());
    trainee.wait(1.0).press("NC_START");
    trainee.until(120.0, |screen| screen.mode == "MANUAL OPERATION");
    assert!(
        trainee
            .screen()
            .status
            .axes
            .iter()
            .all(|axis| axis.referenced && !axis.locked)
    );
}

#[test]
fn a_datum_is_set_and_an_axis_moved_by_hand() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("X").number("-12.5");
    let dialogue = trainee.screen().dialogue;
    assert_eq!(
        (dialogue.prompt.as_str(), dialogue.entry.as_str()),
        ("DATUM SET X =", "-12.5")
    );
    trainee.press("ENT").wait(0.2);
    assert_eq!(trainee.position('X'), "-12.500");
    // Y+ held for a second: MP1020.1 is the feed in MANUAL OPERATION.
    let before: f64 = trainee.position('Y').parse().unwrap();
    let parameters = trainee.station.machine().parameters.axis_parameters(1);
    trainee.give(r#"{"key":"Y+","down":true}"#).wait(1.0);
    assert_eq!(
        trainee.screen().status.f,
        parameters.motion.manual_mm_min.to_string()
    );
    trainee.give(r#"{"key":"Y+","down":false}"#).wait(1.0);
    let way = trainee.position('Y').parse::<f64>().unwrap() - before;
    let per_second = parameters.motion.manual_mm_min / 60.0;
    assert!(
        (way - per_second).abs() < 0.1 * per_second,
        "{way} mm, {per_second} mm/s"
    );
    // A key that does not belong here.
    trainee.press("RL");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    assert!(trainee.messages().is_empty());
}

#[test]
fn a_program_is_selected_and_runs() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT").wait(0.5);
    let screen = trainee.screen();
    assert_eq!(screen.mode, "PROGRAM RUN, FULL SEQUENCE");
    assert_eq!(screen.program.title, "CIRCLE");
    assert!(screen.program.lines[0].current && screen.program.lines[0].text.contains("BEGIN PGM CIRCLE"));
    trainee.press("NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.until(300.0, |screen| screen.status.star != Star::Steady);
}

/// Where no program is selected the screen says how to get one.
#[test]
fn without_a_program_the_screen_says_how_to_select_one() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    for mode in ["SINGLE", "FULL", "PROGRAM", "TEST"] {
        trainee.press(mode);
        let window = trainee.screen().program;
        let shown: Vec<_> = window.lines.iter().map(|line| line.text.as_str()).collect();
        assert_eq!(shown, ["SELECT A PROGRAM WITH PGM NR"], "{mode}");
    }
    trainee.press("PROGRAM PGM_NR 7 ENT ENT").wait(0.1);
    assert_eq!(trainee.screen().program.title, "7.H");
}

/// Who leaves PASS OVER REFERENCE MARKS too early gets back to it by a soft key, until all marks are passed [000:4581].
#[test]
fn the_reference_run_is_offered_until_all_marks_are_passed() {
    for (machine, mode) in [("mill", "MANUAL"), ("mill-tnc360", "HANDWHEEL")] {
        let mut trainee = Trainee::at(machine);
        trainee.until(5.0, |screen| !screen.messages.is_empty());
        trainee.press("CE");
        trainee.until(10.0, |screen| {
            screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
        });
        trainee.wait(1.0).press(mode);
        assert_ne!(trainee.screen().mode, "PASS OVER REFERENCE MARKS");
        trainee.soft("PASS OVER REFERENCE");
        assert_eq!(trainee.screen().mode, "PASS OVER REFERENCE MARKS");
        // In the middle of it, too.
        trainee
            .wait(0.5)
            .press("NC_START")
            .wait(1.0)
            .press(mode)
            .wait(2.0);
        trainee.soft("PASS OVER REFERENCE");
        trainee.press("NC_START");
        trainee.until(120.0, |screen| screen.mode == "MANUAL OPERATION");
        let keys = trainee.screen().soft_keys.keys;
        assert!(!keys.iter().any(|key| key == "PASS OVER REFERENCE"), "{keys:?}");
    }
}
