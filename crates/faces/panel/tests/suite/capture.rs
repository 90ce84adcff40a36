//! Actual position capture [003:2260-2321]: what is captured is what the display shows, and the block is taken.

use crate::support::Trainee;

/// A new program is edited, its cursor at BEGIN.
fn programming(trainee: &mut Trainee, unit: &str) {
    trainee.press("PROGRAM PGM_NR 2 3 ENT").press(unit);
}

/// The blocks between BEGIN and END, as they are on the medium.
fn blocks(trainee: &Trainee) -> Vec<String> {
    let file = trainee.file("programs/23.H");
    let lines: Vec<&str> = file.lines().collect();
    lines[1..lines.len() - 1]
        .iter()
        .map(ToString::to_string)
        .collect()
}

/// `X+263.16`: a value of the display as a block has it.
fn word(trainee: &mut Trainee, letter: char) -> String {
    let shown = trainee.position(letter);
    let shown = shown.trim_end_matches('0').trim_end_matches('.');
    match shown {
        "+" | "-" => format!("{letter}+0"),
        shown => format!("{letter}{shown}"),
    }
}

/// An axis goes in a direction for a time, and stands; after it the position has no round value.
fn drive(trainee: &mut Trainee, key: &str, seconds: f64) {
    trainee
        .press("MANUAL")
        .give(&format!(r#"{{"key":"{key}","down":true}}"#));
    trainee
        .wait(seconds)
        .give(&format!(r#"{{"key":"{key}","down":false}}"#))
        .wait(2.0);
}

/// A coordinate that is asked for, one that is highlighted, and a tool length, on each of the shipped machines.
#[test]
fn coordinates_and_lengths_are_those_of_the_display() {
    for machine in ["mill", "mill-tnc360", "gantry", "dig425"] {
        let mut trainee = Trainee::at(machine);
        trainee.ready();
        drive(&mut trainee, "X+", 0.737);
        drive(&mut trainee, "Z-", 0.377);
        programming(&mut trainee, "ENT");
        // An axis that stands moves by a step of its encoder: what is shown when the key comes counts.
        trainee.press("L X");
        let first = word(&mut trainee, 'X');
        trainee.press("CAPTURE ENT");
        assert_eq!(trainee.messages(), [""; 0], "{machine}");
        trainee.press("END");
        assert_eq!(blocks(&trainee), [format!("L {first}")], "{machine}");

        // The machine went on; the word is highlighted.
        drive(&mut trainee, "X-", 0.391);
        trainee.press("PROGRAM RIGHT RIGHT");
        let second = word(&mut trainee, 'X');
        trainee.press("CAPTURE END");
        assert_eq!(trainee.messages(), [""; 0], "{machine}");
        assert_ne!(second, first, "{machine}");
        assert_eq!(blocks(&trainee), [format!("L {second}")], "{machine}");

        // The tool length is the position of the tool axis [003:1857] [003:1870-1873].
        trainee.press("TOOL_DEF 5 ENT");
        let length = word(&mut trainee, 'Z').replacen('Z', "L", 1);
        trainee.press("CAPTURE ENT").number("5").press("ENT");
        assert_eq!(trainee.messages(), [""; 0], "{machine}");
        assert_eq!(
            blocks(&trainee)[1],
            format!("TOOL DEF 5 {length} R+5"),
            "{machine}"
        );
    }
}

/// A circle centre is captured as any coordinate [003:2752], and in an inch program an inch is 25.4 mm, in steps of
/// 0.0001 inch [003:7825].
#[test]
fn a_program_in_inches_gets_inches() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    drive(&mut trainee, "X+", 0.737);
    programming(&mut trainee, "NO_ENT");
    trainee.press("CC X CAPTURE END");
    assert_eq!(trainee.messages(), [""; 0]);
    let shown_mm: f64 = trainee.position('X').parse().unwrap();
    let inches = (shown_mm / 25.4 * 10_000.0).round() / 10_000.0;
    assert_eq!(blocks(&trainee), [format!("CC X{inches:+}")]);
}

/// A display in steps of 0.005 mm (MP7290 = 1 of a TNC 360) is captured as it stands there [003:7327-7335].
#[test]
fn a_coarse_display_is_captured_as_it_is() {
    let mut trainee = Trainee::with("mill-tnc360", |folder| {
        let path = folder.join("parameters.mp");
        let list = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, list.replace("MP7290   : 0", "MP7290   : 1")).unwrap();
    });
    trainee.ready();
    drive(&mut trainee, "X+", 0.737);
    programming(&mut trainee, "ENT");
    trainee.press("L X CAPTURE END");
    assert_eq!(blocks(&trainee), [format!("L {}", word(&mut trainee, 'X'))]);
    assert!(trainee.position('X').ends_with(['0', '5']));
}

/// A new L block: a block is selected in PROGRAMMING AND EDITING, and in MANUAL OPERATION the key puts the L block after
/// it, with the axes of AXIS SELECTION and nothing else [003:2287-2316] [003:7111-7115].
#[test]
fn manual_operation_writes_a_block() {
    for machine in ["mill", "mill-tnc360"] {
        let mut trainee = Trainee::at(machine);
        trainee.ready();
        trainee.press("CAPTURE");
        assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"], "no block is selected");
        trainee.press("CE");
        programming(&mut trainee, "ENT");
        trainee.press("STOP END STOP END UP");
        drive(&mut trainee, "X+", 0.737);
        trainee.press("CAPTURE");
        assert_eq!(trainee.messages(), [""; 0], "{machine}");
        let words = |trainee: &mut Trainee, letters: &str| {
            let words: Vec<String> = letters.chars().map(|letter| word(trainee, letter)).collect();
            format!("L {}", words.join(" "))
        };
        let first = words(&mut trainee, "XYZ");
        assert_eq!(blocks(&trainee), ["STOP", &first, "STOP"], "{machine}");
        assert_eq!(trainee.screen().mode, "MANUAL OPERATION");

        // Two axes only, from ELECTRONIC HANDWHEEL; the block comes behind the one before.
        trainee.press("MOD");
        trainee.down_to("AXES FOR L BLOCK");
        trainee.press("Z X END HANDWHEEL CAPTURE");
        let second = words(&mut trainee, "XZ");
        assert_eq!(blocks(&trainee), ["STOP", &first, &second, "STOP"], "{machine}");

        // While a block is open none is selected.
        trainee.press("PROGRAM L X 1 MANUAL CAPTURE");
        assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"], "{machine}");
    }
}

/// The key of an HR 410 does the same, where its keys are the NC's [000:8257-8269].
#[test]
fn the_key_of_an_hr_410_captures() {
    for (of_the_plc, expected) in [(0, 1), (1, 0)] {
        let mut trainee = Trainee::with("mill", |folder| {
            let path = folder.join("parameters.mp");
            let list = std::fs::read_to_string(&path).unwrap();
            let list = list.replace("MP7640   : 2 ", "MP7640   : 6 ");
            let list = list.replace("MP7645.0 : 0 ", &format!("MP7645.0 : {of_the_plc} "));
            std::fs::write(&path, list).unwrap();
        });
        trainee.ready();
        programming(&mut trainee, "ENT");
        trainee.press("HANDWHEEL");
        trainee
            .give(r#"{"action":"handwheel key CAPTURE press"}"#)
            .wait(0.5);
        trainee
            .give(r#"{"action":"handwheel key CAPTURE release"}"#)
            .wait(0.2);
        let written = blocks(&trainee);
        assert_eq!(written.len(), expected, "one press, one block: {written:?}");
        assert!(
            written.iter().all(|block| block.starts_with("L X")),
            "{written:?}"
        );
    }
}

/// AXIS LIMIT takes the reference position of its axis, where the line stands and where its number is asked for
/// [003:7157].
#[test]
fn axis_limits_are_captured() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    drive(&mut trainee, "X+", 0.737);
    let shown = |trainee: &mut Trainee| trainee.position('X');
    trainee.press("MOD");
    trainee.down_to("POSITION DISPLAY");
    for _ in 0..6 {
        if trainee.menu_value("POSITION DISPLAY") == "REF" {
            break;
        }
        trainee.press("ENT");
    }
    let reference = shown(&mut trainee);
    trainee.down_to("AXIS LIMIT");
    trainee.press("ENT");
    trainee.down_to("X+");
    trainee.press("ENT CAPTURE ENT");
    assert_eq!(trainee.messages(), [""; 0]);
    assert_eq!(trainee.menu_value("X+"), reference);
}
