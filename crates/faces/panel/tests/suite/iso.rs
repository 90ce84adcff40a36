//! A program in DIN/ISO is written, tested and run at the panel.

use crate::support::Trainee;
use bahn_panel::Star;

/// The mill with a block scan: MP7680 [000:6804-6808]. Its block numbers go up in steps of 10.
fn mill() -> Trainee {
    Trainee::with("mill", |folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        let set = |line: &str| match line.split_whitespace().next() {
            Some("MP7680") => "MP7680 : %000111".to_owned(),
            _ => line.to_owned(),
        };
        let lines: Vec<String> = text.lines().map(set).collect();
        std::fs::write(path, lines.join("\n") + "\n").unwrap();
    })
}

/// A trainee who writes: each block, and END.
fn written(blocks: &[&str]) -> Trainee {
    let mut trainee = mill();
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 7 POINT I ENT ENT").wait(0.1);
    for block in blocks {
        let text = serde_json::to_string(block).unwrap();
        trainee.give(&format!("{{\"text\":{text}}}"));
        trainee.press("END");
        assert_eq!(trainee.messages(), [] as [&str; 0], "{block}");
    }
    trainee
}

fn current(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    let current = lines.into_iter().find(|line| line.current);
    current.map_or_else(String::new, |line| line.text.trim_end().to_owned())
}

const PART: [&str; 7] = [
    "G30 G17 X+0 Y+0 Z-20",
    "G31 G90 X+100 Y+100 Z+0",
    "G00 G40 G90 X+10 Y+10",
    "M3",
    "G01 X+60 F2000",
    "G38",
    "G01 Y+40",
];

#[test]
fn a_program_is_written_with_numbers_and_is_on_the_medium() {
    let mut trainee = mill();
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 7 POINT I ENT ENT").wait(0.1);
    assert_eq!(trainee.screen().program.title, "7.I");
    // By keys: G and letters of the alpha keyboard, axis keys, digits.
    trainee.press("G 0 0 G 4 0 X").number("-12.5").press("F");
    assert_eq!(trainee.screen().dialogue.prompt, "FEED RATE F = ?");
    assert_eq!(current(&mut trainee), "       G00 G40 X-12.5 F");
    trainee.press("2 0 0 ENT").wait(0.1);
    assert_eq!(
        trainee.file("programs/7.I"),
        "%7 G71 *\nN10 G00 G40 X-12.5 F200 *\nN99999 %7 G71 *\n"
    );
    assert_eq!(current(&mut trainee), "N10    G00 G40 X-12.5 F200 *");
    // A fault stays out of the program, and its word is highlighted.
    trainee.press("X 1 X 2 END");
    assert_eq!(trainee.messages(), ["AXIS DOUBLE PROGRAMMED"]);
    let dialogue = trainee.screen().dialogue;
    assert_eq!(dialogue.entry, "X2");
    trainee.press("Y END").wait(0.1);
    assert!(!trainee.file("programs/7.I").contains("X+1"));
}

#[test]
fn what_was_typed_of_a_block_survives_a_kill() {
    let mut trainee = written(&["M3"]);
    trainee.press("G 0 1 Y SIGN 4").wait(0.1);
    let before = (trainee.screen().dialogue, current(&mut trainee));
    let mut trainee = trainee.killed();
    trainee.ready();
    trainee.press("PROGRAM").wait(0.1);
    assert_eq!((trainee.screen().dialogue, current(&mut trainee)), before);
}

#[test]
fn it_is_tested_and_run_from_the_number_of_a_block() {
    let mut trainee = written(&PART);
    // G38 interrupts the test.
    trainee.press("TEST START").wait(0.5);
    assert_eq!(current(&mut trainee), "N60    G38 *");
    trainee.press("NO_ENT");
    trainee.until(20.0, |screen| {
        screen
            .program
            .lines
            .iter()
            .any(|line| line.current && line.text.starts_with("N70"))
    });
    assert_eq!(trainee.messages(), [] as [&str; 0]);
    trainee.press("FULL PGM_NR 7 POINT I ENT").wait(0.2);
    assert_eq!(trainee.screen().program.title, "7.I");
    // It starts at the cursor, which goes to the number.
    trainee.press("GOTO 5 0 ENT");
    assert_eq!(current(&mut trainee), "N50    G01 X+60 F2000 *");
    trainee.press("GOTO 5 1 ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE END GOTO 0 ENT NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    // It waits at G38, the seventh block.
    trainee.until(60.0, |screen| screen.status.star == Star::Blinking);
    assert_eq!(current(&mut trainee), "N60    G38 *");
    let why = format!("{:?}", trainee.screen().why);
    assert!(why.contains("block 60"), "{why}");
    // The program that runs is edited by nobody.
    trainee.press("PROGRAM M 5");
    assert_eq!(trainee.messages(), ["BACKGROUND PROGRAMMING NOT POSSIBLE"]);
    trainee.press("CE FULL NC_START");
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
    trainee.wait(0.5);
    let at: f64 = trainee.position('Y').parse().unwrap();
    assert!((at - 40.0).abs() < 0.01, "{at}");
}

/// A message names the block by its number, and RESTORE AT N goes there.
#[test]
fn messages_and_the_block_scan_know_the_numbers() {
    let mut trainee = mill();
    trainee.ready();
    trainee.press("FULL");
    trainee.soft("RESTORE AT N");
    assert_eq!(trainee.messages(), ["PROGRAM NOT FOUND"]);
    trainee.press("CE");
    trainee.write(
        "programs/7.I",
        "%7 G71 *\nN35 G00 G40 G90 X+10 *\nN70 G01 X+20 F3000 *\nN105 FOO *\nN99999 %7 G71 *\n",
    );
    trainee.press("PGM_NR 7 POINT I ENT").wait(0.2);
    trainee.soft("RESTORE AT N");
    trainee.press("3 6 ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE CE 7 0 ENT").wait(0.5);
    assert_eq!(trainee.messages(), [] as [&str; 0]);
    assert_ne!(trainee.screen().status.star, Star::Off);
    trainee.soft("INTERNAL STOP");
    trainee.press("GOTO 0 ENT NC_START");
    trainee.until(60.0, |screen| !screen.messages.is_empty());
    let message = trainee.screen().messages[0].clone();
    assert_eq!(message.place.as_deref(), Some("105"), "{message:?}");
}
