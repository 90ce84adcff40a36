//! A machine that stands says why: the marker that is missing, and what keeps it from being there.

use crate::support::Trainee;
use bahn_panel::{Reason, Urgency};

fn ready() -> Trainee {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee
}

/// CIRCLE runs.
fn runs() -> Trainee {
    let mut trainee = ready();
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START").wait(3.0);
    assert!(trainee.screen().why.is_empty(), "{:?}", trainee.screen().why);
    trainee
}

/// Blocks that are given in POSITIONING WITH MDI run.
fn mdi(trainee: &mut Trainee, blocks: &str) {
    trainee.press("MDI").wait(0.2);
    trainee
        .give(&format!("{{\"action\":\"mdi {blocks}\"}}"))
        .press("NC_START")
        .wait(0.5);
}

/// The reason that names a marker.
fn of(trainee: &Trainee, marker: &str) -> Reason {
    let reasons = trainee.station.why();
    let found = reasons
        .iter()
        .find(|reason| reason.marker.as_deref() == Some(marker));
    found
        .unwrap_or_else(|| panic!("nothing of {marker}: {reasons:#?}"))
        .clone()
}

/// A reason names this in its words or its causes.
fn says(trainee: &Trainee, words: &str) {
    let reasons = trainee.station.why();
    let all = |reason: &Reason| format!("{} < {}", reason.text, reason.causes.join(", "));
    assert!(
        reasons.iter().any(|reason| all(reason).contains(words)),
        "`{words}`: {reasons:#?}"
    );
}

/// The line of the PLC program that assigns something, as it stands in the file.
fn line_of(trainee: &Trainee, text: &str) -> String {
    let program = trainee.file("plc/MAIN.PLC");
    let is_it = |line: &str| {
        line.split(';')
            .next()
            .unwrap()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
            == text
    };
    let place = program.lines().position(is_it).unwrap();
    format!("MAIN.PLC:{}", place + 1)
}

#[test]
fn a_machine_that_does_nothing_waits_for_nothing() {
    let mut trainee = ready();
    assert!(trainee.screen().why.is_empty(), "{:?}", trainee.screen().why);
    // A table that is clamped is no reason to wait.
    mdi(&mut trainee, "M10");
    trainee.wait(2.0);
    assert!(trainee.screen().why.is_empty(), "{:?}", trainee.screen().why);
    let reported = of(&trainee, "M2547");
    assert_eq!(reported.urgency, Urgency::Reported);
}

#[test]
fn power_on_says_what_it_waits_for() {
    let mut trainee = Trainee::at("mill");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    says(&trainee, "POWER INTERRUPTED waits for CE");
    trainee.press("CE");
    trainee.until(10.0, |screen| {
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    });
    trainee.wait(1.0);
    says(&trainee, "Reference marks are missing of X Y Z C");
    let reasons = trainee.station.why();
    assert!(
        reasons
            .iter()
            .any(|reason| reason.parameter.as_deref() == Some("MP1340"))
    );
    assert!(!trainee.screen().why.is_empty());
    trainee.give(r#"{"power":false}"#).wait(1.0);
    says(&trainee, "The control is off");
}

#[test]
fn the_emergency_stop_chain_is_named() {
    let mut trainee = ready();
    trainee.give(r#"{"key":"EMERGENCY_STOP","down":true}"#).wait(1.0);
    let stop = of(&trainee, "I3");
    assert_eq!(stop.urgency, Urgency::Stands);
    assert_eq!(stop.causes, ["the EMERGENCY STOP button is pressed: release it"]);
    trainee.give(r#"{"key":"EMERGENCY_STOP","down":false}"#).wait(1.0);
    says(&trainee, "CE closes the loops again");
    trainee.press("CE").wait(1.0);
    assert!(trainee.screen().why.is_empty());
    trainee.give(r#"{"action":"voltage off"}"#).wait(1.0);
    assert_eq!(
        of(&trainee, "I3").causes,
        ["the supply of the control voltage is missing"]
    );
}

#[test]
fn a_relay_that_does_not_pull_in_is_named() {
    let mut trainee = Trainee::at("mill");
    trainee.give(r#"{"action":"fault relay open"}"#);
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    trainee.press("CE").wait(5.0);
    assert_eq!(
        of(&trainee, "I3").causes,
        ["the relay of the control voltage does not pull in"]
    );
}

#[test]
fn an_open_door_takes_the_feed_enable() {
    let mut trainee = runs();
    trainee.give(r#"{"action":"switch door open"}"#).wait(3.0);
    let feed = of(&trainee, "M2451");
    assert_eq!(feed.urgency, Urgency::Stands);
    assert_eq!(feed.causes, ["I21 is 0 (door: closed)"]);
    assert_eq!(feed.lines, [line_of(&trainee, "= M2451")]);
    let line = &feed.lines[0];
    assert_eq!(
        feed.text,
        format!("All axes stand: no feed enable, M2451 is 0, the PLC program sets it ({line})")
    );
    // It stops the program, too.
    assert_eq!(of(&trainee, "M2488").causes, ["I21 is 0 (door: closed)"]);
    assert!(
        trainee.screen().why[0].contains("M2451"),
        "{:?}",
        trainee.screen().why
    );
}

#[test]
fn a_broken_wire_of_a_drive_is_found() {
    let mut trainee = ready();
    trainee.give(r#"{"action":"fault input I6 0"}"#).wait(1.0);
    assert_eq!(of(&trainee, "M2451").causes, ["I6 is 0 (drive of Y: ready)"]);
    trainee.give(r#"{"action":"fault input I8 0"}"#).wait(1.0);
    // Neither alone is to blame.
    assert_eq!(
        of(&trainee, "M2451").causes,
        ["I6 is 0 (drive of Y: ready)", "I8 is 0 (drive of C: ready)"]
    );
}

#[test]
fn an_override_of_nothing_is_named() {
    let mut trainee = runs();
    trainee.give(r#"{"feed_override":0.0}"#).wait(1.0);
    let feed = of(&trainee, "W766");
    assert!(feed.text.contains("turn its knob up"), "{}", feed.text);
}

#[test]
fn nc_stop_is_named_while_it_is_held() {
    let mut trainee = runs();
    trainee.give(r#"{"key":"NC_STOP","down":true}"#).wait(1.0);
    assert_eq!(of(&trainee, "M2488").causes, ["I147 is 0 (key NC_STOP (opens))"]);
    trainee.give(r#"{"key":"NC_STOP","down":false}"#).wait(1.0);
    // Then NC start is all that is missing.
    let start = of(&trainee, "M2448");
    assert!(start.text.contains("is interrupted at block"), "{}", start.text);
    assert_eq!(start.urgency, Urgency::Waits);
    assert!(
        !trainee
            .station
            .why()
            .iter()
            .any(|reason| reason.marker.as_deref() == Some("M2488"))
    );
}

#[test]
fn coolant_that_does_not_flow_holds_the_program() {
    let mut trainee = ready();
    trainee.give(r#"{"action":"fault device flood no-feedback"}"#);
    mdi(&mut trainee, "M8");
    trainee.wait(3.0);
    let waits = of(&trainee, "M2482");
    assert_eq!(waits.urgency, Urgency::Waits);
    assert!(
        waits.text.contains("has waited 3 s") && waits.text.contains("the strobe M2045"),
        "{}",
        waits.text
    );
    assert_eq!(waits.causes, ["I16 is 0 (flood: on)"]);
    assert_eq!(waits.lines, [line_of(&trainee, "SN M2482")]);
}

#[test]
fn a_spindle_without_power_is_not_at_speed() {
    let mut trainee = ready();
    trainee.give(r#"{"action":"fault input I10 0"}"#);
    mdi(&mut trainee, "TOOL CALL 1 Z S500");
    trainee.wait(3.0);
    mdi(&mut trainee, "M3");
    trainee.wait(3.0);
    assert_eq!(of(&trainee, "M2482").causes, ["I10 is 0 (spindle: at speed)"]);
    // One that has lost its drive does not turn, and says with how much voltage.
    let mut trainee = ready();
    mdi(&mut trainee, "TOOL CALL 1 Z S500");
    trainee.wait(3.0);
    // Its wire says that it is ready all the same.
    trainee.give(r#"{"action":"fault input I9 1"}"#);
    trainee.give(r#"{"action":"fault drive S dead"}"#);
    mdi(&mut trainee, "M3");
    trainee.wait(3.0);
    says(
        &trainee,
        "The spindle does not reach its speed: it turns with 0 of 500 rpm",
    );
}

#[test]
fn a_tool_change_by_hand_waits_for_its_keys() {
    let mut trainee = ready();
    trainee.give(r#"{"action":"MP4310.0=0"}"#).wait(1.0);
    mdi(&mut trainee, "TOOL CALL 5 Z S500");
    trainee.wait(3.0);
    let change = of(&trainee, "M2483");
    assert!(change.text.contains("the strobe M2046"), "{}", change.text);
    assert!(
        change
            .causes
            .iter()
            .any(|cause| cause.starts_with("I138 is 0 (key CONFIRM)")),
        "{change:#?}"
    );
}

#[test]
fn a_start_in_vain_says_what_is_not_permitted() {
    let mut trainee = ready();
    trainee.press("FULL PGM_NR C I R C L E ENT");
    trainee.give(r#"{"action":"fault input I19 0"}"#).wait(1.0);
    trainee.press("NC_START").wait(1.0);
    let start = of(&trainee, "M2448");
    assert_eq!(start.causes, ["I19 is 0 (tool_clamp: clamped)"]);
    // Without a program there is nothing to start.
    let mut trainee = ready();
    trainee.press("FULL NC_START").wait(1.0);
    says(&trainee, "No program is selected");
}

#[test]
fn stops_and_ends_of_programs_are_named() {
    let mut trainee = ready();
    trainee.press("SINGLE PGM_NR C I R C L E ENT NC_START").wait(2.0);
    says(&trainee, "Single block");
    trainee.press("FULL NC_START");
    trainee.until(300.0, |screen| screen.status.star == bahn_panel::Star::Off);
    says(&trainee, "The program has come to its end");
    assert!(trainee.screen().why.is_empty());
}

#[test]
fn a_software_limit_says_how_to_leave_it() {
    let mut trainee = ready();
    trainee.give(r#"{"key":"X+","down":true}"#).wait(60.0);
    trainee.give(r#"{"key":"X+","down":false}"#).wait(1.0);
    let limit = of(&trainee, "M2624");
    assert_eq!(limit.parameter.as_deref(), Some("MP910.0"));
    assert!(limit.text.ends_with("drive it off with X-"), "{}", limit.text);
}

#[test]
fn an_encoder_that_fails_switches_the_drives_off() {
    let mut trainee = ready();
    trainee
        .give(r#"{"action":"fault encoder Y amplitude"}"#)
        .wait(1.0);
    says(&trainee, "The drives are off: MEASURING SYSTEM Y DEFECTIVE A");
}

#[test]
fn reasons_are_german_where_the_dialogue_is() {
    let mut trainee = Trainee::with("mill", |folder| {
        let state = folder.join("state");
        std::fs::create_dir_all(&state).unwrap();
        std::fs::write(state.join("panel.json"), r#"{"language":"de"}"#).unwrap();
    });
    trainee.give(r#"{"power":false}"#).wait(1.0);
    assert_eq!(
        trainee.screen().why,
        ["Die Steuerung ist aus: Versorgung einschalten"]
    );
}
