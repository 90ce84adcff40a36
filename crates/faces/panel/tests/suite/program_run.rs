//! What the screen shows of a program that runs, is interrupted and broken off.

use crate::support::Trainee;
use bahn_panel::Star;

/// The line that is marked as the current one.
fn current(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    let line = lines.into_iter().find(|line| line.current).unwrap();
    line.text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A program of the memory.
fn program(trainee: &Trainee, name: &str, blocks: &[&str]) {
    let text = format!("BEGIN PGM {name} MM\n{}\nEND PGM {name} MM\n", blocks.join("\n"));
    trainee.write(&format!("programs/{name}.H"), &text);
}

/// Time passes until a block is the current one.
fn until_block(trainee: &mut Trainee, block: &str) {
    for _ in 0..600 {
        if current(trainee) == block {
            return;
        }
        trainee.wait(0.1);
    }
    panic!("not in {block}: {:#?}", trainee.screen());
}

/// After INTERNAL STOP the current block is that with which NC START goes on; GOTO 0 goes to the beginning
/// [003:1616-1640] [003:8001-8003].
#[test]
fn after_an_internal_stop_the_interrupted_block_is_the_current_one() {
    let mut trainee = Trainee::at("mill");
    program(
        &trainee,
        "STOPS",
        &["L X+0 R0 F3000", "L X+60 R0 F1000", "L X+0 R0 F1000"],
    );
    trainee.ready();
    trainee.press("FULL PGM_NR S T O P S ENT NC_START");
    until_block(&mut trainee, "2 L X+60 R0 F1000");
    trainee.wait(0.5).press("NC_STOP").wait(0.5);
    assert_eq!(current(&mut trainee), "2 L X+60 R0 F1000");
    trainee.press("STOP").wait(0.2);
    assert_eq!(trainee.screen().status.star, Star::Off);
    assert_eq!(current(&mut trainee), "2 L X+60 R0 F1000");
    trainee.press("NC_START");
    until_block(&mut trainee, "2 L X+60 R0 F1000");
    trainee.press("NC_STOP").wait(0.5).press("STOP").wait(0.2);
    // The arrows go on from there, GOTO 0 to the beginning.
    trainee.press("DOWN");
    assert_eq!(current(&mut trainee), "3 L X+0 R0 F1000");
    trainee.press("GOTO 0 ENT");
    assert_eq!(current(&mut trainee), "0 BEGIN PGM STOPS MM");
}

/// A block that could not be executed is the current one, too: NC START tries it again.
#[test]
fn after_a_fault_its_block_is_the_current_one() {
    let mut trainee = Trainee::at("mill");
    program(&trainee, "FAULT", &["L X+0 R0 F3000", "CALL LBL 7", "L X+10"]);
    trainee.ready();
    trainee.press("FULL PGM_NR F A U L T ENT NC_START");
    trainee.until(60.0, |screen| !screen.messages.is_empty());
    trainee.wait(0.5).press("CE").wait(0.2);
    assert_eq!(current(&mut trainee), "2 CALL LBL 7");
    trainee.press("STOP").wait(0.2);
    assert_eq!(current(&mut trainee), "2 CALL LBL 7");
}

/// A program that is called is shown while it runs [003:586] [003:3876], also where it was broken off.
#[test]
fn the_called_program_is_shown() {
    let mut trainee = Trainee::at("mill");
    program(
        &trainee,
        "OUTER",
        &["L X+0 R0 F3000", "CALL PGM INNER", "L X+20 R0 F1000"],
    );
    program(&trainee, "INNER", &["L X+40 R0 F1000"]);
    trainee.ready();
    trainee.press("FULL PGM_NR O U T E R ENT NC_START");
    until_block(&mut trainee, "1 L X+0 R0 F3000");
    assert_eq!(trainee.screen().program.title, "OUTER");
    until_block(&mut trainee, "1 L X+40 R0 F1000");
    assert_eq!(trainee.screen().program.title, "INNER");
    trainee
        .wait(0.3)
        .press("NC_STOP")
        .wait(0.5)
        .press("STOP")
        .wait(0.2);
    assert_eq!(trainee.screen().program.title, "INNER");
    assert_eq!(current(&mut trainee), "1 L X+40 R0 F1000");
    trainee.press("DOWN");
    assert_eq!(
        trainee.messages(),
        ["KEY NON-FUNCTIONAL"],
        "GOTO counts in the main program"
    );
    trainee.press("CE NC_START");
    until_block(&mut trainee, "3 L X+20 R0 F1000");
    assert_eq!(trainee.screen().program.title, "OUTER");
}

/// The number after the slash after REP is that of the remaining repetitions [003:3762].
#[test]
fn repeats_are_counted_down() {
    let mut trainee = Trainee::at("mill");
    program(
        &trainee,
        "REP",
        &[
            "L X+0 R0 F6000",
            "LBL 1",
            "L IX+10 R0 F1000",
            "CALL LBL 1 REP 2/2",
            "L X+0 R0 F3000",
        ],
    );
    trainee.ready();
    trainee.press("FULL PGM_NR R E P ENT");
    let line = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        let line = lines
            .into_iter()
            .find(|line| line.text.contains("CALL "))
            .unwrap();
        line.text.split_once("CALL ").unwrap().1.trim().to_owned()
    };
    assert_eq!(line(&mut trainee), "LBL 1 REP 2/2");
    trainee.press("NC_START");
    let mut seen = Vec::new();
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    while trainee.screen().status.star == Star::Steady {
        let now = line(&mut trainee);
        if seen.last() != Some(&now) {
            seen.push(now);
        }
        trainee.wait(0.1);
    }
    // The first pass is no repetition; in the second one is left, in the third none.
    assert_eq!(
        seen,
        ["LBL 1 REP 2/2", "LBL 1 REP 2/1", "LBL 1 REP 2/0", "LBL 1 REP 2/2"]
    );
}

/// No program is resumed at a block with a tangential arc or the transfer of a pole [003:7984-7987].
#[test]
fn a_start_at_a_tangential_arc_is_undefined() {
    for (block, starts) in [
        ("CT X+40 Y+20 R0 F600", false),
        ("CC", false),
        ("CC X+0 Y+0", true),
        ("L X+40 R0 F600", true),
    ] {
        let mut trainee = Trainee::at("mill");
        program(
            &trainee,
            "START",
            &["L X+0 Y+0 R0 F3000", "L X+20 R0 F3000", block, "L X+60 R0 F600"],
        );
        trainee.ready();
        trainee
            .press("FULL PGM_NR S T A R T ENT GOTO 3 ENT NC_START")
            .wait(0.5);
        let messages = trainee.messages();
        let undefined = messages
            .iter()
            .any(|text| text.starts_with("PROGRAM-START UNDEFINED"));
        assert_eq!(undefined, !starts, "{block}: {messages:?}");
        assert_eq!(trainee.screen().status.star == Star::Steady, starts, "{block}");
    }
}
