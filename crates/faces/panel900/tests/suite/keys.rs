//! The keys of the machine: each writes a parameter.

use bahn_host::KeyAction;

use crate::support::Panel;

#[test]
fn a_direction_key_moves_its_axis_as_long_as_it_is_held() {
    let mut panel = Panel::of_the_portal();
    let before = panel.number("P12151").unwrap();
    panel.hold("X+", KeyAction::Press).unwrap();
    assert_eq!(panel.screen().machine.held, ["X+"]);
    panel.run(1.0);
    panel.hold("X+", KeyAction::Release).unwrap();
    panel.run(1.0);
    let after = panel.number("P12151").unwrap();
    assert!(after > before + 1.0, "{before} {after}");
    panel.run(0.5);
    assert_eq!(panel.number("P12151"), Some(after));
    // The same keys move the axes of the channel that is shown.
    let second = panel.number("2:P12151").unwrap();
    panel.keys("CH2");
    panel.hold("X-", KeyAction::Press).unwrap();
    panel.run(0.5);
    panel.keys("CH1");
    panel.run(0.5);
    // A key that is held moves no axis of another channel, and its own stands.
    assert!(panel.number("2:P12151").unwrap() < second);
    assert_eq!(panel.number("P12151"), Some(after));
    assert_eq!(panel.number("2:P8752"), Some(0.0));
    assert_eq!(
        panel.hold("C+", KeyAction::Press).unwrap_err().to_string(),
        "channel 1 has no axis C"
    );
}

#[test]
fn a_key_that_is_tapped_is_down_a_moment() {
    let mut panel = Panel::of_the_portal();
    let before = panel.number("P12151").unwrap();
    panel.keys("X+");
    panel.run(0.1);
    assert_eq!(panel.number("P8752"), Some(1.0));
    panel.run(1.0);
    assert_eq!(panel.number("P8752"), Some(0.0));
    assert!(panel.number("P12151").unwrap() > before);
}

#[test]
fn keys_are_down_as_long_as_they_are_held() {
    let mut panel = Panel::of_the_portal();
    for (key, parameter, down) in [
        ("HAND", "P8681", 1.0),
        ("START", "P8682", 2.0),
        ("STOP", "P8682", 1.0),
    ] {
        panel.hold(key, KeyAction::Press).unwrap();
        panel.run(0.1);
        assert_eq!(panel.number(parameter), Some(down), "{key}");
        panel.hold(key, KeyAction::Release).unwrap();
        assert_eq!(panel.number(parameter), Some(0.0), "{key}");
    }
}

#[test]
fn rapid_takes_the_greatest_feed_by_hand() {
    let mut panel = Panel::of_the_portal();
    let [feed, most] = ["P8755", "P8754"].map(|name| panel.number(name));
    panel.hold("RAPID", KeyAction::Press).unwrap();
    assert_eq!(panel.number("P8755"), most);
    panel.hold("RAPID", KeyAction::Release).unwrap();
    assert_eq!(panel.number("P8755"), feed);
}

#[test]
fn steps_have_the_width_of_the_table() {
    let mut panel = Panel::of_the_portal();
    panel.keys("STEP NEXT_STEP");
    let screen = panel.screen();
    let width = panel.number("P8760").unwrap();
    assert!(screen.lamps["STEP"] && screen.status.flags.iter().any(|flag| flag.starts_with("STEP")));
    let before = panel.number("P12351").unwrap();
    panel.keys("Y+");
    panel.run(3.0);
    let moved = panel.number("P12351").unwrap() - before;
    assert!((moved - width).abs() < 1e-6, "{moved} {width}");
}

#[test]
fn reference_drives_the_axes_that_have_not_passed_theirs() {
    let mut panel = Panel::of_the_portal();
    // The zero pulse counts anew: the axis does not know where it is.
    panel.give("{\"action\":\"P12130=$00010000\"}").unwrap();
    panel.run(0.1);
    let screen = panel.screen();
    assert_eq!(
        screen.why,
        ["Reference points are missing of X: REFERENCE drives there"]
    );
    assert!(
        screen.lamps["REFERENCE"] && !screen.status.axes[0].referenced && screen.status.axes[1].referenced
    );
    // Of the three axes X alone is driven, in the direction plus, and its zero pulse counts [002:8018-8042].
    let [x, y] = ["P12151", "P12351"].map(|name| panel.number(name).unwrap());
    panel.keys("REFERENCE");
    panel.run(1.0);
    assert_eq!(panel.number("P12130"), Some(f64::from(0x0001_0001)));
    assert_eq!(panel.number("P12330"), None);
    assert!(panel.number("P12151").unwrap() > x && panel.number("P12351") == Some(y));
}

#[test]
fn knobs_and_handwheel() {
    let mut panel = Panel::of_the_portal();
    for percent in [50.0, 0.0, 120.0, 100.0] {
        panel.give(&format!("{{\"feed_override\":{percent}}}")).unwrap();
        let screen = panel.screen();
        let shown = screen.status.overrides[0];
        // 255 steps up to 120 %, P11313.
        assert!(
            (shown - percent).abs() <= 120.0 / 255.0 / 2.0 + 1e-9,
            "{percent} {shown}"
        );
        assert_eq!(screen.machine.knobs[0], shown);
        assert_eq!(panel.number("P11310"), Some(shown.round()));
    }
    // 100 increments in a mm, times 10.
    let before = panel.number("P12351").unwrap();
    panel.give("{\"handwheel_axis\":\"Y\",\"factor\":10}").unwrap();
    panel.run(0.1);
    panel.give("{\"handwheel\":100}").unwrap();
    panel.run(3.0);
    let moved = panel.number("P12351").unwrap() - before;
    assert!((moved - 10.0).abs() < 1e-6, "{moved}");
    assert_eq!(panel.screen().machine.handwheel.0, 'Y');
    panel.give("{\"handwheel_axis\":\"Y\",\"factor\":0}").unwrap();
    assert_eq!(panel.number("P11402"), Some(0.0));
}

#[test]
fn the_lock_of_the_editor_holds_back_entries_and_no_keys() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK3");
    // Software switch 1 locks everything, P11018.
    panel.enter("P11008=1").unwrap();
    let refused = panel.enter("P7=1").unwrap_err().to_string();
    assert_eq!(refused, "P7 is locked by the editing lock of values");
    assert_eq!(panel.said(), refused);
    assert_eq!(panel.screen().dialogue.entry, "P7=1");
    panel.keys("SINGLE");
    panel.until(1.0, |panel| panel.number("P8703") == Some(4.0));
    assert_eq!(panel.screen().mode, "AUTO, SINGLE BLOCK");
    assert_eq!(
        panel.hold("X+", KeyAction::Press).unwrap_err().to_string(),
        "direction keys move axes in HAND"
    );
}

#[test]
fn what_the_panel_has_not_is_said() {
    let mut panel = Panel::of_the_portal();
    for (input, why) in [
        ("{\"go_to\":1}", "the panel of a System 900 has no time line"),
        (
            "{\"lesson\":\"door\"}",
            "the panel of a System 900 has no lessons",
        ),
        (
            "{\"transfer\":\"connected 0\"}",
            "the panel of a System 900 has no data interfaces",
        ),
        ("{\"key\":\"CYCL_DEF\"}", "the panel has no key CYCL_DEF"),
        (
            "{\"speed\":1000}",
            "time passes 0.1 to 100 times as fast, not 1000",
        ),
    ] {
        assert_eq!(panel.give(input).unwrap_err().to_string(), why);
    }
    // What a script does can be done, too.
    panel.give("{\"action\":\"P500=7\"}").unwrap();
    assert_eq!(panel.number("P500"), Some(7.0));
}

#[test]
fn parameters_and_places_survive_power_off() {
    let mut panel = Panel::of_the_portal();
    panel.keys("SK3");
    panel.enter("P500=7.5").unwrap();
    panel.hold("X+", KeyAction::Press).unwrap();
    panel.run(1.0);
    panel.give("{\"power\":false}").unwrap();
    let screen = panel.screen();
    assert!(!screen.machine.power && screen.soft_keys.keys.is_empty());
    assert_eq!(screen.why, ["The control is off: switch its supply on"]);
    assert_eq!(panel.tap("SK1").unwrap_err().to_string(), "the control is off");
    panel.give("{\"power\":true}").unwrap();
    panel.run(0.1);
    assert!(panel.screen().machine.power);
    assert_eq!(panel.number("P500"), Some(7.5));
}
