//! Single rows of the registry of functions that no other test is about.

use crate::support::Build;

/// MP110 and MP120: X and Y change their encoder inputs and their nominal value outputs, in the machine and in the
/// list: they are referenced as before, and X moves when X is programmed [000:3374-3406].
#[test]
fn inputs_and_outputs_are_assigned() {
    let swap = |plant: &str, what: &str, first: &str, second: &str| {
        let [one, two] = [first, second].map(|name| format!("{what} = \"{name}\""));
        assert_eq!(
            (plant.matches(&one).count(), plant.matches(&two).count()),
            (1, 1),
            "{one}"
        );
        plant.replace(&one, "@").replace(&two, &one).replace('@', &two)
    };
    let run = |exchanged: bool| {
        let mut build = Build::mill().program("MOVE.H", "L Z+100 R0 FMAX\nL X+20 Y+30 FMAX");
        let inputs: &[&str] = if exchanged { &["110.0=1", "110.1=0"] } else { &[] };
        for assignment in inputs.iter().chain(&["120.0=1", "120.1=0"]) {
            build = build.mp(assignment);
        }
        if exchanged {
            build.plant = swap(&build.plant, "output", "1", "2");
            build.plant = swap(&build.plant, "input", "X1", "X2");
        }
        build
    };
    let mut rig = run(true).rig();
    rig.power_on();
    rig.run("MOVE.H", 60.0);
    let axes = rig.control.snapshot().axes;
    assert!((axes[0].nominal - 20.0).abs() < 1e-9 && (axes[0].actual - 20.0).abs() < 0.01);
    assert!((axes[1].nominal - 30.0).abs() < 1e-9 && (axes[1].actual - 30.0).abs() < 0.01);
    // With the outputs of the list alone each loop drives the other axis: it is found at once.
    let mut crossed = run(false).rig();
    if crossed.messages() == ["POWER INTERRUPTED"] {
        crossed.command("ce");
    }
    crossed.seconds(5.0);
    crossed.start();
    crossed.until(60.0, "a message", |rig| {
        rig.messages()
            .iter()
            .any(|message| message.contains("POSITIONING ERROR"))
    });
}

/// M2608: the output of the spindle is 0 V while the PLC sets it, and goes up along its ramp after it
/// [000:5500] [000:6565-6573].
#[test]
fn m2608_takes_the_voltage_away() {
    let mut build = Build::mill();
    build.plc = build
        .plc
        .replacen("\n       EM", "\n       L I28\n       = M2608\n       EM", 1);
    let mut rig = build.rig();
    rig.power_on();
    for function in ["s 500", "m 3"] {
        rig.command(function);
        rig.start();
        rig.seconds(1.0);
    }
    rig.until(5.0, "the spindle turns", |rig| {
        rig.control.snapshot().spindle.volts > 0.1
    });
    rig.seconds(2.0);
    let volts = rig.control.snapshot().spindle.volts;
    rig.event("fault input I28 1");
    rig.seconds(0.05);
    assert_eq!(rig.control.snapshot().spindle.volts, 0.0);
    rig.event("fault input I28 0");
    rig.until(5.0, "the voltage is back", |rig| {
        rig.control.snapshot().spindle.volts == volts
    });
}

/// M94 takes whole turns off the display of a rotary axis; the table does not turn for it [003:7482].
#[test]
fn m94_turns_no_table() {
    let blocks = "L Z+100 R0 FMAX\nL C+400 FMAX\nL IC+0 FMAX M94\nL C+41 F1000";
    let mut rig = Build::mill().program("TURN.H", blocks).rig();
    rig.power_on();
    rig.run("TURN.H", 60.0);
    assert_eq!(rig.messages(), [""; 0]);
    let c = rig.control.snapshot().axes[3].nominal.rem_euclid(360.0);
    assert!((c - 41.0).abs() < 1e-6, "{c}");
}

/// The codes of the operating modes in W272, and their bits in M2176 to M2179 [000:4680-4687].
#[test]
fn modes_have_their_codes() {
    let mut rig = Build::mill().rig();
    rig.power_on();
    for (mode, code) in [
        ("manual", 1),
        ("handwheel", 2),
        ("mdi", 3),
        ("single", 4),
        ("full", 5),
    ] {
        rig.command(&format!("mode {mode}"));
        rig.seconds(0.1);
        let bits = ["M2176", "M2177", "M2178", "M2179"].map(|bit| i32::from(rig.bit(bit)));
        let [one, two, four, eight] = bits;
        assert_eq!(
            (rig.number("W272"), one + 2 * two + 4 * four + 8 * eight),
            (code, code),
            "{mode}"
        );
    }
}

/// M2041 is the basic language English, MP7230 = 1 [000:6962]; D276 the last code number, M2186 after 84159
/// [000:6928-6947].
#[test]
fn language_and_code_number() {
    for (language, english) in [("7230=0", false), ("7230=1", true)] {
        let mut rig = Build::mill().mp(language).rig();
        rig.power_on();
        assert_eq!(rig.bit("M2041"), english, "{language}");
    }
    let mut rig = Build::mill().rig();
    rig.power_on();
    for (code, marker) in [(123, false), (84_159, true)] {
        rig.command(&format!("code {code}"));
        rig.seconds(0.1);
        assert_eq!((rig.number("D276"), rig.bit("M2186")), (code, marker));
    }
}

/// D360 is the programmed feed, D388 the current one, both in mm/min: half of it at 50 %. W322 is the actual speed of
/// the spindle in rpm.
#[test]
fn feed_and_speed_for_the_plc() {
    let blocks = "L X+0 Y+0 Z+100 R0 FMAX M3\nL X+60 F600\nL X+0";
    let mut rig = Build::mill().program("FEED.H", blocks).rig();
    rig.power_on();
    rig.command("s 500");
    rig.start();
    rig.seconds(1.0);
    rig.command("mode full");
    rig.command("select FEED.H");
    rig.start();
    rig.until(60.0, "the feed", |rig| {
        rig.number("D360") == 600 && rig.number("D388") == 600
    });
    rig.event("override feed 50");
    rig.seconds(1.0);
    assert_eq!((rig.number("D360"), rig.number("D388")), (600, 300));
    let speed = rig.number("W322");
    assert!((498..=502).contains(&speed), "{speed}");
}

/// MP4310.0 to .6 in W976 to W988 [000:10261].
#[test]
fn words_for_the_plc() {
    let mut build = Build::mill();
    for index in 0..7 {
        build = build.mp(&format!("4310.{index}={}", 1000 + index));
    }
    let mut rig = build.rig();
    rig.power_on();
    let words = ["W976", "W978", "W980", "W982", "W984", "W986", "W988"];
    assert_eq!(
        words.map(|word| rig.number(word)),
        [1000, 1001, 1002, 1003, 1004, 1005, 1006]
    );
}

/// M2501 turns the spindle at the speed of MP3520.0, M2489 turns its voltage round [000:5500-5518].
#[test]
fn m2501_and_m2489_reach_the_spindle() {
    let mut build = Build::mill().mp("3520.0=60");
    let more = "\n       L I28\n       = M2501\n       L I29\n       = M2489\n       EM";
    build.plc = build.plc.replacen("\n       EM", more, 1);
    let mut rig = build.rig();
    rig.power_on();
    assert_eq!(rig.control.snapshot().spindle.volts, 0.0);
    rig.event("fault input I28 1");
    rig.seconds(3.0);
    let turning = rig.control.snapshot().spindle;
    assert!(
        (turning.nominal_rpm - 60.0).abs() < 0.5 && turning.volts != 0.0,
        "{turning:?}"
    );
    rig.event("fault input I29 1");
    rig.seconds(3.0);
    assert_eq!(rig.control.snapshot().spindle.volts, -turning.volts);
    rig.event("fault input I28 0");
    rig.seconds(3.0);
    assert_eq!(rig.control.snapshot().spindle.volts, 0.0);
}
