//! The status display: which axes it has, the tool length in it, the feed and its highlight.

use crate::support::Trainee;
use bahn_panel::{Screen, Star};

/// A machine whose list says something else.
fn with(machine: &str, changes: &[(&str, &str)]) -> Trainee {
    Trainee::with(machine, |folder| {
        let path = folder.join("parameters.mp");
        let mut list = std::fs::read_to_string(&path).unwrap();
        for (number, value) in changes {
            let is_it = |line: &str| line.split(':').next().is_some_and(|name| name.trim() == *number);
            let lines = list.lines().filter(|line| !is_it(line));
            list =
                lines.map(|line| format!("{line}\n")).collect::<String>() + &format!("{number} : {value}\n");
        }
        std::fs::write(&path, list).unwrap();
    })
}

fn letters(trainee: &mut Trainee) -> String {
    let axes = trainee.screen().status.axes;
    axes.iter().map(|axis| axis.letter).collect()
}

/// MP40 chooses the axes of the status window; the spindle is among them as long as neither M03 nor M04 is active
/// [000:3418-3434], as an angle below 360 degrees [000:5883].
#[test]
fn mp40_chooses_the_axes_of_the_display() {
    let mut trainee = with("mill", &[("MP40", "%000101")]);
    trainee.ready();
    assert_eq!(letters(&mut trainee), "XZ");
    let mut trainee = with("mill", &[("MP40", "%100111")]);
    trainee.ready();
    trainee
        .press("MDI")
        .give(r#"{"text":"TOOL CALL 1 Z S500"}"#)
        .press("NC_START")
        .wait(8.0);
    trainee.give(r#"{"text":"M3"}"#).press("NC_START").wait(8.0);
    assert_eq!(letters(&mut trainee), "XYZ", "M03 is active");
    trainee.give(r#"{"text":"M5"}"#).press("NC_START").wait(8.0);
    assert_eq!(letters(&mut trainee), "XYZS");
    let angle: f64 = trainee.position('S').parse().unwrap();
    assert!((0.0..360.0).contains(&angle), "{angle}");
}

/// MP7285 = 0 leaves the tool length out of the position of the tool axis [000:6428-6434]; DATUM SET with a preset tool on the
/// workpiece is the length L of the tool then, not 0 [003:1170-1174].
#[test]
fn mp7285_leaves_the_tool_length_out_of_the_display() {
    let shown = |value: &str| {
        let mut trainee = with("mill", &[("MP7285", value)]);
        trainee.ready();
        trainee
            .press("MDI")
            .give(r#"{"text":"TOOL CALL 2 Z S1000"}"#)
            .press("NC_START");
        trainee.until(5.0, |screen| screen.status.star == Star::Steady);
        trainee.until(120.0, |screen| screen.status.star == Star::Off);
        trainee.press("MANUAL").wait(0.3);
        trainee
    };
    let (mut with_length, mut without) = (shown("1"), shown("0"));
    let number = |trainee: &mut Trainee, letter| trainee.position(letter).parse::<f64>().unwrap();
    let axis = |trainee: &Trainee| trainee.station.control().snapshot().axes[2].clone();
    let length_mm = axis(&without).tool_length_mm;
    assert!(length_mm > 1.0, "{length_mm}");
    let differ = number(&mut without, 'Z') - number(&mut with_length, 'Z');
    assert!((differ - length_mm).abs() < 0.002, "{differ} {length_mm}");
    assert_eq!(number(&mut without, 'X'), number(&mut with_length, 'X'));
    // The tip touches the datum when the display shows L.
    without
        .press("Z")
        .number(&format!("{length_mm:.3}"))
        .press("ENT")
        .wait(0.2);
    assert!((number(&mut without, 'Z') - length_mm).abs() < 0.002);
    assert!(axis(&without).actual.abs() < 0.002, "{}", axis(&without).actual);
}

/// The feed is that of the program, as the potentiometer varies it from 0 to 150 % [000:6521-6525]; at a stop it stays
/// [003:2164]. Rapid traverse is FMAX.
#[test]
fn the_feed_follows_the_potentiometer_and_stays_at_a_stop() {
    let mut trainee = Trainee::at("mill");
    trainee.write(
        "programs/FEED.H",
        "BEGIN PGM FEED MM\nL X+0 R0 FMAX\nL X+40 F600\nSTOP\nL X+60\nEND PGM FEED MM\n",
    );
    trainee.ready();
    trainee.press("FULL PGM_NR F E E D ENT NC_START");
    trainee.until(60.0, |screen| screen.status.f == "MAX");
    trainee.until(60.0, |screen| screen.status.f == "600");
    trainee.give(r#"{"feed_override":50}"#).wait(0.3);
    assert_eq!(trainee.screen().status.f, "300", "half of it");
    trainee.until(60.0, |screen| screen.status.star == Star::Blinking);
    assert_eq!(trainee.screen().status.f, "300", "at the stop");
    trainee.press("NC_START");
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
    assert_eq!(trainee.screen().status.f, "300");
}

/// A TNC 360 shows the feed by hand with MP7270 + 1 alone [003:7304-7309]; a TNC 415 without it that of the axis whose key is
/// pressed, with it the least of MP1020, which the potentiometer varies, too [000:6529-6540].
#[test]
fn mp7270_shows_the_feed_by_hand() {
    let f = |machine: &str, value: &str| {
        let mut trainee = with(machine, &[("MP7270", value)]);
        trainee.ready();
        trainee.give(r#"{"feed_override":50}"#).wait(0.3);
        let list = &trainee.station.machine().parameters;
        let axes = trainee.station.control().snapshot().axes;
        let least = axes
            .iter()
            .map(|axis| list.axis_parameters(axis.index as u8).motion.manual_mm_min);
        let half = least.reduce(f64::min).unwrap() / 2.0;
        (trainee.screen().status.f, format!("{half:.0}"))
    };
    assert_eq!(f("mill-tnc360", "0").0, "");
    for machine in ["mill-tnc360", "mill"] {
        let (shown, half) = f(machine, "1");
        assert_eq!(shown, half, "{machine}");
    }
    assert_eq!(f("mill", "0").0, "0");
}

/// Without feed enable the letter F is highlighted [000:5352].
#[test]
fn f_is_highlighted_without_feed_enable() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    assert!(!trainee.screen().status.f_inverse);
    trainee.press("EMERGENCY_STOP").wait(0.5);
    assert!(trainee.screen().status.f_inverse);
}

/// The axis that the handwheel moves has its symbol, in ELECTRONIC HANDWHEEL alone.
#[test]
fn the_axis_of_the_handwheel_has_its_symbol() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let chosen = |screen: &Screen| {
        let axes = screen.status.axes.iter().filter(|axis| axis.handwheel);
        axes.map(|axis| axis.letter).collect::<String>()
    };
    assert_eq!(chosen(&trainee.screen()), "");
    trainee.press("HANDWHEEL SK5 Y END");
    assert_eq!(chosen(&trainee.screen()), "Y");
}

/// A flashing message goes with the warm start: END is pressed and held for several seconds [003:7946]. A short press does nothing.
#[test]
fn end_held_is_the_warm_start() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    trainee.give(r#"{"action":"fault encoder X stuck"}"#);
    trainee.give(r#"{"key":"X+","down":true}"#).wait(2.0);
    trainee.give(r#"{"key":"X+","down":false}"#);
    let flashes = |screen: &Screen| screen.messages.iter().any(|message| message.flashing);
    assert!(flashes(&trainee.screen()), "{:?}", trainee.messages());
    trainee.give(r#"{"action":"repair X"}"#).wait(0.5);
    trainee.give(r#"{"key":"END","down":true}"#).wait(1.0);
    trainee.give(r#"{"key":"END","down":false}"#).wait(3.0);
    assert!(flashes(&trainee.screen()));
    trainee.give(r#"{"key":"END","down":true}"#);
    trainee.until(10.0, |screen| {
        screen
            .messages
            .first()
            .is_some_and(|first| first.text == "POWER INTERRUPTED")
    });
    assert!(!flashes(&trainee.screen()));
    trainee.give(r#"{"key":"END","down":false}"#);
    trainee.ready();
}

/// The PLC says which function of the coolant is shown, M09, M07, M08 or MK by M2508 and M2657, and that it is shown inverse by
/// M2609 [000:6563-6579]; with M2610 the T of the tool is [000:10831].
#[test]
fn the_plc_says_how_functions_are_shown() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let coolant = |trainee: &mut Trainee| {
        let memory = trainee.station.control().memory();
        let [low, high, inverse] = ["M2508", "M2657", "M2609"].map(|own| memory.bit(own.parse().unwrap()));
        let status = trainee.screen().status;
        assert_eq!(status.m_inverse[1], inverse);
        (low, high, status.m.split('/').nth(1).unwrap().to_owned())
    };
    assert_eq!(coolant(&mut trainee), (false, false, "9".to_owned()));
    trainee.press("MDI");
    for (function, shown) in [
        ("M8", (true, false, "8".to_owned())),
        ("M9", (false, false, "9".to_owned())),
        ("M7", (false, true, "7".to_owned())),
    ] {
        trainee
            .give(&format!("{{\"text\":\"{function}\"}}"))
            .press("NC_START")
            .wait(3.0);
        assert_eq!(coolant(&mut trainee), shown, "{function}");
    }
    assert!(!trainee.screen().status.t_inverse);
    trainee.give(r#"{"action":"M2610=1"}"#).wait(0.1);
    assert!(trainee.screen().status.t_inverse);
}
