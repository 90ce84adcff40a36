//! TEST RUN by keys [003:1514-1535].

use crate::support::Trainee;

/// A program is tested, from a machine that is ready.
fn testing(machine: &str, blocks: &[&str]) -> Trainee {
    let mut trainee = Trainee::at(machine);
    let text = format!("BEGIN PGM 77 MM\n{}\nEND PGM 77 MM\n", blocks.join("\n"));
    trainee.write("programs/77.H", &text);
    trainee.ready();
    trainee.press("TEST PGM_NR 7 7 ENT");
    trainee
}

fn current(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    let line = lines.into_iter().find(|line| line.current).unwrap();
    line.text.split_whitespace().collect::<Vec<_>>().join(" ")
}

const INTERRUPTED: &str = "INTERRUPTED: CONTINUE = NO ENT / END = STOP";

fn prompt(trainee: &mut Trainee) -> String {
    trainee.wait(0.5).screen().dialogue.prompt
}

const BLANK: [&str; 4] = [
    "BLK FORM 0.1 Z X+0 Y+0 Z-20",
    "BLK FORM 0.2 X+100 Y+100 Z+0",
    "TOOL CALL 2 Z S1000",
    "L Z+100 R0 F1000",
];

/// STOP and M0 interrupt the test [003:2234]; NO ENT lets it go on [003:1535], STOP ends it.
#[test]
fn programmed_stops_interrupt_the_test() {
    let blocks = [&BLANK[..], &["STOP", "L X+10 M0", "L X+20", "L X+30"]].concat();
    let mut trainee = testing("mill", &blocks);
    trainee.press("NO_ENT");
    assert_eq!(
        trainee.messages(),
        ["KEY NON-FUNCTIONAL"],
        "nothing is interrupted"
    );
    trainee.press("CE START");
    assert_eq!(prompt(&mut trainee), INTERRUPTED);
    assert_eq!(current(&mut trainee), "5 STOP");
    trainee.press("NO_ENT");
    assert_eq!(prompt(&mut trainee), INTERRUPTED);
    assert_eq!(current(&mut trainee), "6 L X+10 M0");
    trainee.press("NO_ENT");
    assert_eq!(prompt(&mut trainee), "");
    assert_eq!(current(&mut trainee), "8 L X+30");
    // STOP of an interrupted test ends it.
    trainee.press("START");
    assert_eq!(prompt(&mut trainee), INTERRUPTED);
    trainee.press("STOP");
    assert_eq!(prompt(&mut trainee), "");
    trainee.press("NO_ENT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
}

/// A test can be interrupted at any block [003:1524], and goes on after it.
#[test]
fn a_test_is_interrupted_at_a_block() {
    let blocks = [&BLANK[..], &["L X+10", "L X+20", "L X+30", "L X+40"]].concat();
    let mut trainee = testing("mill-tnc360", &blocks);
    trainee.soft("STOP AT N");
    trainee.press("6 ENT");
    assert_eq!(prompt(&mut trainee), INTERRUPTED);
    assert_eq!(current(&mut trainee), "6 L X+20");
    trainee.press("NO_ENT");
    assert_eq!(prompt(&mut trainee), "");
    assert_eq!(current(&mut trainee), "8 L X+40");
}

/// STOP interrupts an endless test, and ends it.
#[test]
fn stop_interrupts_and_ends_the_test() {
    let blocks = [
        &BLANK[..],
        &[
            "LBL 1",
            "L IX+10",
            "L IX-10",
            "CALL LBL 1 REP 60000/60000",
            "L X+30",
        ],
    ]
    .concat();
    let mut trainee = testing("mill", &blocks);
    trainee.press("START STOP");
    assert_eq!(prompt(&mut trainee), INTERRUPTED);
    let there = current(&mut trainee);
    trainee.wait(1.0);
    assert_eq!(current(&mut trainee), there);
    let count = |trainee: &Trainee| trainee.station.control().test_report().unwrap().blocks;
    let before = count(&trainee);
    trainee.press("NO_ENT").wait(0.5);
    assert!(count(&trainee) > before);
    trainee.press("STOP STOP");
    assert_eq!(prompt(&mut trainee), "");
    assert!(trainee.station.control().test_report().is_none());
}

/// Q parameters of an interrupted test are shown and changed [003:4337-4342]; those of the machine are others.
#[test]
fn q_parameters_of_an_interrupted_test() {
    let blocks = [
        &BLANK[..],
        &[
            "FN 0: Q1=+20",
            "STOP",
            "FN 9: IF +Q1 EQU +30 GOTO LBL 1",
            "L X+77 M0",
            "LBL 1",
            "L X+88",
        ],
    ]
    .concat();
    let mut trainee = testing("mill", &blocks);
    trainee.press("Q");
    assert_eq!(
        trainee.messages(),
        ["KEY NON-FUNCTIONAL"],
        "nothing is interrupted"
    );
    trainee.press("CE START").wait(0.5);
    trainee.press("Q GOTO 1 ENT");
    let lines = trainee.screen().program.lines;
    assert!(
        lines
            .iter()
            .any(|line| line.current && line.text == "Q1   = +20.0000")
    );
    trainee.number("30").press("ENT END NO_ENT");
    assert_eq!(prompt(&mut trainee), "");
    assert_eq!(current(&mut trainee), "10 L X+88");
    assert_eq!(trainee.station.control().first().q_value(1), 0.0);
}

/// A test finds the axes that the machine does not have [003:1516-1520] [003:8020-8025].
#[test]
fn an_axis_that_the_machine_does_not_have_is_found() {
    let blocks = [&BLANK[..], &["L X+10", "L A+90", "L X+20"]].concat();
    let mut trainee = testing("mill", &blocks);
    trainee.press("START").wait(0.5);
    let messages = trainee.messages();
    assert!(messages[0].starts_with("WRONG AXIS PROGRAMMED"), "{messages:?}");
    assert_eq!(current(&mut trainee), "5 L X+10");
}

/// Movements in a rotary axis cannot be simulated [003:876] [003:7967-7971]: the first one is said, too.
#[test]
fn the_first_movement_of_a_rotary_axis_cannot_be_shown() {
    let blocks = [&BLANK[..], &["L C+90 F1000"]].concat();
    let mut trainee = testing("mill", &blocks);
    trainee.press("GRAPHICS START").wait(1.0);
    assert_eq!(trainee.messages(), ["PGM SECTION CANNOT BE SHOWN"]);
}
