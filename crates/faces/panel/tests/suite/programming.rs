//! A program is written by dialogue, kept, tested and run.

use crate::support::Trainee;
use bahn_panel::Star;

fn new_program(trainee: &mut Trainee) {
    trainee.write("programs/4711.H", "0 BEGIN PGM 4711 MM\n1 END PGM 4711 MM\n");
    trainee.press("PROGRAM PGM_NR 4 7 1 1 ENT").wait(0.1);
}

#[test]
fn a_block_is_entered_by_dialogue_and_is_on_the_medium() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    new_program(&mut trainee);
    assert_eq!(trainee.screen().mode, "PROGRAMMING AND EDITING");
    trainee
        .press("L X")
        .number("10")
        .press("Y")
        .number("-5.5")
        .press("ENT");
    assert_eq!(
        trainee.screen().dialogue.prompt,
        "TOOL RADIUS COMP.: RL/RR/NO COMP.?"
    );
    trainee.press("ENT").number("200").press("ENT END").wait(0.1);
    assert!(
        trainee.file("programs/4711.H").contains("L X+10 Y-5.5 R0 F200"),
        "{}",
        trainee.file("programs/4711.H")
    );
}

/// Keys of a program or of a fast hand come in one cycle.
#[test]
fn keys_need_no_cycle_between_them() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let at_once = |trainee: &mut Trainee, keys: &str| {
        for key in keys.split_whitespace() {
            trainee.give(&format!("{{\"key\":\"{key}\"}}"));
        }
    };
    at_once(&mut trainee, "PROGRAM PGM_NR 4 8 ENT ENT L X 5 END");
    let text = trainee.file("programs/48.H");
    assert!(text.contains("L X+5"), "{text}");
    at_once(&mut trainee, "FULL PGM_NR 4 8 ENT");
    let screen = trainee.wait(0.1).screen();
    assert_eq!(screen.mode, "PROGRAM RUN, FULL SEQUENCE");
    assert_eq!(screen.program.title, "48");
    assert_eq!(trainee.messages(), [] as [&str; 0]);
}

#[test]
fn what_was_typed_of_a_block_survives_a_kill() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    new_program(&mut trainee);
    trainee.press("L X").number("12").wait(0.1);
    let before = trainee.screen().dialogue;
    assert_eq!(before.prompt, "COORDINATES?");
    let mut trainee = trainee.killed();
    trainee.ready();
    trainee.press("PROGRAM").wait(0.1);
    let after = trainee.screen();
    assert_eq!(after.dialogue, before);
    assert_eq!(after.program.title, "4711.H");
}

#[test]
fn a_block_of_mdi_moves_the_axis() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee
        .press("MDI L X")
        .number("250")
        .press("ENT ENT")
        .number("3000")
        .press("ENT END")
        .wait(0.2);
    assert!(trainee.messages().is_empty(), "{:?}", trainee.messages());
    trainee.press("NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.until(60.0, |screen| screen.status.star != Star::Steady);
    trainee.wait(0.5);
    // The scale resolves 0.1 µm, the drive has noise.
    let at: f64 = trainee.position('X').parse().unwrap();
    assert!((at - 250.0).abs() < 0.002, "{at}");
}

/// A word is added to a block that stands there: the highlight is on a word, the letter of the address begins the new one.
#[test]
fn a_letter_adds_its_word_to_a_block_that_stands_there() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.write(
        "programs/4711.H",
        "0 BEGIN PGM 4711 MM\n1 L Z-5 R0 FMAX\n2 END PGM 4711 MM\n",
    );
    trainee.press("PROGRAM PGM_NR 4 7 1 1 ENT DOWN RIGHT M").wait(0.1);
    let screen = trainee.screen();
    let current = screen.program.lines.iter().find(|line| line.current);
    assert_eq!(
        current.map(|line| line.text.trim_end()),
        Some("1    L Z-5 R0 FMAX M")
    );
    trainee.press("8 END").wait(0.1);
    let text = trainee.file("programs/4711.H");
    assert!(text.contains("L Z-5 R0 FMAX M8\n"), "{text}");
}
