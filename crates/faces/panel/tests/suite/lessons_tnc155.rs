//! The lessons of the knee mill with a TNC 155: commissioning in the order of its check list, and what can fail in a cabinet.

use crate::support::Trainee;
use bahn_panel::LessonState;

/// A trainee whose task has begun.
fn begin(name: &str) -> Trainee {
    let mut trainee = Trainee::at("mill-tnc155");
    trainee.give(&format!("{{\"lesson\":\"{name}\"}}"));
    assert_eq!(state(&trainee), LessonState::Running, "{:#?}", trainee.screen());
    trainee
}

fn state(trainee: &Trainee) -> LessonState {
    trainee.station.lesson().unwrap().state()
}

fn action(trainee: &mut Trainee, text: &str) {
    trainee.give(&format!("{{\"action\":\"{text}\"}}")).wait(0.2);
}

/// Everything was done; when not, what is open.
fn passed(trainee: &mut Trainee) {
    for _ in 0..2400 {
        if state(trainee) != LessonState::Running {
            break;
        }
        trainee.wait(0.05);
    }
    let screen = trainee.screen();
    let lesson = screen.lesson.clone().unwrap();
    assert_eq!(lesson.state, LessonState::Passed, "{lesson:#?} {screen:#?}");
}

/// Who does nothing has not passed.
fn nothing_is_not_enough(name: &str) {
    let mut trainee = begin(name);
    trainee.wait(15.0).give(r#"{"hand_in":true}"#);
    assert_eq!(state(&trainee), LessonState::Failed, "{name}");
}

/// Enters machine parameters by the code number 95 148.
fn parameters(trainee: &mut Trainee, values: &[(&str, &str)]) {
    trainee.press("PROGRAM MOD");
    trainee.down_to("CODE NUMBER");
    trainee.press("ENT").number("95148").press("ENT").wait(0.2);
    for (number, value) in values {
        let digits: Vec<String> = number.chars().map(String::from).collect();
        trainee.press(&format!("GOTO {} ENT", digits.join(" "))).wait(0.1);
        trainee.number(value).press("ENT").wait(0.1);
    }
    trainee.press("END").wait(0.2);
}

/// Runs a program in full sequence.
fn runs(trainee: &mut Trainee, name: &str) {
    action(trainee, "mode full");
    action(trainee, &format!("select {name}.H"));
    trainee.press("NC_START").wait(0.5);
}

#[test]
fn the_contactor_that_sticks() {
    let mut trainee = begin("01-contactor");
    trainee.wait(2.0);
    action(&mut trainee, "repair coolant_contactor");
    passed(&mut trainee);
    nothing_is_not_enough("01-contactor");
}

#[test]
fn e17_never_comes() {
    let mut trainee = begin("02-e17");
    trainee.wait(30.0);
    // Whoever looks for the cause, and whoever breaks it, reads the letters of this control.
    let causes: Vec<String> = trainee
        .station
        .why()
        .into_iter()
        .flat_map(|reason| reason.causes)
        .collect();
    assert!(
        causes.iter().any(|cause| cause == "E17 is 0 (completed: on)"),
        "{causes:?}"
    );
    let drawer = trainee.station.drawer();
    let wire = drawer.iter().find(|breakable| breakable.name == "E17").unwrap();
    action(&mut trainee, &wire.repair);
    passed(&mut trainee);
    nothing_is_not_enough("02-e17");
}

#[test]
fn the_servo_lag() {
    let mut trainee = begin("03-lag");
    runs(&mut trainee, "LAG");
    trainee.wait(8.0);
    assert_eq!(state(&trainee), LessonState::Running, "kv 1 lags by 10 mm");
    trainee.press("NC_STOP").wait(1.5);
    action(&mut trainee, "stop");
    trainee.wait(1.0);
    parameters(&mut trainee, &[("177", "1.5")]);
    runs(&mut trainee, "LAG");
    passed(&mut trainee);
}

#[test]
fn the_kink() {
    let mut trainee = begin("04-kink");
    parameters(&mut trainee, &[("176", "0.5"), ("181", "20")]);
    runs(&mut trainee, "LAG");
    trainee.wait(6.0).give(r#"{"feed_override":20.0}"#);
    passed(&mut trainee);
    nothing_is_not_enough("04-kink");
}

#[test]
fn the_acceleration() {
    let mut trainee = begin("05-acceleration");
    runs(&mut trainee, "ACCEL");
    trainee.wait(8.0);
    assert_eq!(state(&trainee), LessonState::Running, "0.2 m/s^2 are not enough");
    trainee.press("NC_STOP").wait(1.5);
    action(&mut trainee, "stop");
    trainee.wait(1.0);
    parameters(&mut trainee, &[("54", "1"), ("55", "0.5")]);
    runs(&mut trainee, "ACCEL");
    passed(&mut trainee);
}

#[test]
fn the_square_root_characteristic() {
    let mut trainee = begin("06-square-root");
    runs(&mut trainee, "LAG");
    trainee.wait(8.0);
    assert_eq!(state(&trainee), LessonState::Running, "with servo lag");
    trainee.press("NC_STOP").wait(1.5);
    action(&mut trainee, "stop");
    trainee.wait(1.0);
    parameters(
        &mut trainee,
        &[("32", "0.553"), ("33", "0.553"), ("34", "0.691"), ("60", "0")],
    );
    runs(&mut trainee, "LAG");
    passed(&mut trainee);
}
