//! What is done by hand: the touch probe menu, the handwheel, M and S, Q parameters of an interrupted run; and the flags
//! of the status display.

use crate::support::Trainee;
use bahn_panel::Star;

/// The probe is in the spindle, its ball 30 mm over the block of the machine, in the middle: machine X 200 to 300, Y 100 to
/// 180, Z 0 to 40; the probe is 120 mm long.
fn probing() -> Trainee {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.give(r#"{"action":"probe insert"}"#);
    go(&mut trainee, "L Z+220");
    go(&mut trainee, "L X+250 Y+140");
    go(&mut trainee, "L Z+190");
    trainee
}

/// A block of MDI in machine coordinates.
fn go(trainee: &mut Trainee, block: &str) {
    trainee
        .press("MDI")
        .give(&format!("{{\"text\":\"{block} R0 F6000 M91\"}}"));
    trainee.press("NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
    trainee.press("MANUAL").wait(0.3);
}

fn machine(trainee: &Trainee, letter: char) -> f64 {
    let snapshot = trainee.station.control().snapshot();
    snapshot
        .axes
        .iter()
        .find(|axis| axis.letter == letter)
        .unwrap()
        .machine
}

/// NC start, until the dialogue asks for something.
fn touch(trainee: &mut Trainee, prompt: &str) {
    trainee.press("NC_START");
    trainee.until(60.0, |screen| screen.dialogue.prompt == prompt);
    trainee.wait(3.0);
}

/// What a line of the window says after its =.
fn result(trainee: &mut Trainee, name: &str) -> f64 {
    let lines = trainee.screen().program.lines;
    let line = lines
        .into_iter()
        .find(|line| line.text.starts_with(name))
        .unwrap();
    line.text.split('=').nth(1).unwrap().trim().parse().unwrap()
}

fn near(actual: f64, expected: f64) {
    assert!((actual - expected).abs() < 0.02, "{actual} is not {expected}");
}

#[test]
fn the_length_is_calibrated_and_a_surface_becomes_the_datum() {
    let mut trainee = probing();
    // The upper face of the block is at machine Z 40: 40 above a datum at machine Z 0.
    let z = machine(&trainee, 'Z');
    trainee
        .press("Z")
        .number(&format!("{z:.3}"))
        .press("ENT")
        .wait(0.2);
    trainee.press("TOUCH_PROBE");
    let names: Vec<String> = trainee
        .screen()
        .program
        .lines
        .into_iter()
        .map(|line| line.text)
        .collect();
    assert_eq!(names.len(), 6);
    assert!(names[0].starts_with("CALIBRATION EFFECTIVE LENGTH"));
    trainee.press("ENT");
    assert_eq!(trainee.screen().dialogue.prompt, "DATUM =");
    trainee.number("40").press("ENT NC_START");
    trainee.until(60.0, |screen| {
        let lines = &screen.program.lines;
        lines
            .iter()
            .any(|line| line.text.starts_with("EFFECTIVE LENGTH") && line.text.contains("+1"))
    });
    trainee.wait(3.0);
    near(result(&mut trainee, "EFFECTIVE LENGTH"), 120.0);

    // SURFACE = DATUM in Z-: soft key, arrows and axis keys choose the direction.
    trainee.press("END DOWN DOWN DOWN ENT");
    assert_eq!(trainee.screen().program.title, "SURFACE = DATUM");
    let keys = trainee.screen().soft_keys.keys;
    assert_eq!(keys[..6], ["X+", "X-", "Y+", "Y-", "Z+", "Z-"]);
    let chosen = |trainee: &mut Trainee| {
        let line = trainee.screen().program.lines[0].clone();
        let (from, to, _) = line.marks[0];
        line.text[from..to].to_owned()
    };
    trainee.press("Z");
    assert_eq!(chosen(&mut trainee), "Z+");
    trainee.press("Z");
    assert_eq!(chosen(&mut trainee), "Z-");
    trainee.press("RIGHT");
    assert_eq!(chosen(&mut trainee), "X+");
    trainee.press("LEFT");
    touch(&mut trainee, "DATUM Z =");
    near(result(&mut trainee, "DATUM Z"), 40.0);
    trainee.number("5").press("ENT").wait(0.2);
    near(result(&mut trainee, "DATUM Z"), 5.0);
    trainee.press("END END");
    assert_eq!(trainee.screen().mode, "MANUAL OPERATION");
    assert_eq!(trainee.screen().program.title, "");
}

#[test]
fn a_corner_becomes_the_datum_in_both_axes() {
    let mut trainee = probing();
    // Beside the block, the ball 20 mm below its upper face.
    go(&mut trainee, "L Z+220");
    go(&mut trainee, "L X+180 Y+120");
    go(&mut trainee, "L Z+140");
    trainee.press("TOUCH_PROBE DOWN DOWN DOWN DOWN ENT");
    assert!(
        trainee
            .screen()
            .dialogue
            .prompt
            .starts_with("TOUCH POINTS OF BASIC ROTATION?")
    );
    trainee.press("NO_ENT SK1");
    let mut probed = 0.0;
    // Two points of the left side, two of the front side; the axes are moved by direction keys between them.
    for (way, key) in [("SK1", "Y+"), ("SK1", ""), ("SK3", "X+"), ("SK3", "")] {
        if way == "SK3" && key == "X+" {
            // Around the corner.
            hold_until(&mut trainee, "Y-", |trainee| machine(trainee, 'Y') < 80.0);
            hold_until(&mut trainee, "X+", |trainee| machine(trainee, 'X') > 220.0);
        }
        trainee.press(way).press("NC_START");
        probed += 1.0;
        let expected = probed;
        wait_for(&mut trainee, |trainee| {
            let signal = "probe.touches".parse().unwrap();
            trainee.station.control().observe(&signal) == expected
        });
        trainee.wait(3.0);
        match key {
            "Y+" => hold_until(&mut trainee, "Y+", |trainee| machine(trainee, 'Y') > 150.0),
            "X+" => hold_until(&mut trainee, "X+", |trainee| machine(trainee, 'X') > 270.0),
            _ => {}
        }
    }
    assert_eq!(trainee.screen().dialogue.prompt, "DATUM X =");
    trainee.number("10").press("ENT");
    assert_eq!(trainee.screen().dialogue.prompt, "DATUM Y =");
    trainee.number("-20").press("ENT").wait(0.2);
    // The corner is machine X 200, Y 100; the ball of 2 mm is not calibrated.
    let datum = trainee.station.control().remember().datums[0].0;
    near(datum[bahn_path::Axis::X], 200.0 - 2.0 - 10.0);
    near(datum[bahn_path::Axis::Y], 100.0 - 2.0 + 20.0);
}

/// Holds a direction key until something is so.
fn hold_until(trainee: &mut Trainee, key: &str, so: impl Fn(&Trainee) -> bool) {
    trainee.give(&format!("{{\"key\":\"{key}\",\"down\":true}}"));
    wait_for(trainee, so);
    trainee
        .give(&format!("{{\"key\":\"{key}\",\"down\":false}}"))
        .wait(0.5);
}

fn wait_for(trainee: &mut Trainee, so: impl Fn(&Trainee) -> bool) {
    for _ in 0..1200 {
        if so(trainee) {
            return;
        }
        trainee.wait(0.05);
    }
    panic!("not within a minute: {:#?}", trainee.screen());
}

#[test]
fn basic_rotation_is_entered_and_shown() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("TOUCH_PROBE DOWN DOWN ENT");
    assert_eq!(trainee.screen().dialogue.prompt, "ROTATION ANGLE =");
    trainee.number("2.5").press("ENT").wait(0.2);
    assert_eq!(result(&mut trainee, "ROTATION ANGLE"), 2.5);
    assert_eq!(trainee.screen().status.flags, ["ROT"]);
    // It survives power-off; 0 cancels it.
    let mut trainee = trainee.killed();
    trainee.ready();
    assert_eq!(trainee.screen().status.flags, ["ROT"]);
    trainee.press("TOUCH_PROBE DOWN DOWN ENT 0 ENT").wait(0.2);
    assert!(trainee.screen().status.flags.is_empty());
}

#[test]
fn axis_and_factor_of_the_handwheel() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("HANDWHEEL SK5 Y");
    trainee.number("4").press("ENT");
    let screen = trainee.screen();
    assert_eq!(screen.machine.handwheel, ('Y', 4));
    // Factor 4: 20 mm / 2^4 a turn.
    assert!(
        screen.program.lines[0].text.ends_with("1.250 MM/U"),
        "{:?}",
        screen.program.lines
    );
    trainee.number("11").press("ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE END");
    assert_eq!(trainee.screen().dialogue.prompt, "Y: INTERPOLATION FACTOR 4");
    let before: f64 = trainee.position('Y').parse().unwrap();
    trainee.give(r#"{"handwheel":4000}"#).wait(5.0);
    let way = trainee.position('Y').parse::<f64>().unwrap() - before;
    assert!(way.abs() > 0.1, "{way}");
}

#[test]
fn q_parameters_of_an_interrupted_run() {
    let mut trainee = Trainee::at("mill");
    trainee.write(
        "programs/QS.H",
        "BEGIN PGM QS MM\nFN 0: Q1=+20\nL Z+100 R0 F6000\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+5\nL X+0 F3000\nSTOP\nL X+Q1\nEND PGM QS MM\n",
    );
    trainee.ready();
    trainee.press("FULL PGM_NR Q S ENT NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.press("Q");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"], "while it runs");
    trainee.press("CE");
    assert!(
        trainee.screen().status.flags.is_empty(),
        "the shift is read ahead only"
    );
    trainee.until(60.0, |screen| screen.status.star == Star::Blinking);
    assert_eq!(trainee.screen().status.flags, ["N X"]);
    trainee.press("SK4 GOTO 1 ENT");
    let screen = trainee.screen();
    assert_eq!(
        (screen.program.title.as_str(), screen.dialogue.prompt.as_str()),
        ("Q PARAMETERS", "Q1 =")
    );
    assert!(
        screen
            .program
            .lines
            .iter()
            .any(|line| line.current && line.text == "Q1   = +20.0000")
    );
    trainee.number("-7.5").press("ENT END NC_START");
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
    // After the end the shift of the program is still in force: X-7.5 + 5 from the workpiece datum.
    near(trainee.position('X').parse().unwrap(), -7.5 + 5.0);
}

#[test]
fn the_tool_table_opens_by_hand() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    assert_eq!(trainee.screen().soft_keys.keys[7], "TOOL TABLE");
    trainee.press("SK8");
    assert!(trainee.screen().program.title.starts_with("TOOL.T"));
    trainee.press("END");
    assert_eq!(trainee.screen().program.title, "");
}
