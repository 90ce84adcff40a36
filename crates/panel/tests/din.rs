//! Programs of DIN 66025 at the panel: chosen, run block by block, tested with graphics.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use support::Trainee;

/// The third line is empty, and no block.
const PROGRAM: &str = "%FRAME\nN10 G00 X0 Y0\n\nN20 G01 X40 F3000 M8\nN30 Y30\nN40 M30\n";

/// The line that is marked as the current one.
fn current(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    let line = lines.into_iter().find(|line| line.current).unwrap();
    line.text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn trainee() -> Trainee {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/FRAME.NC", PROGRAM);
    trainee.ready();
    trainee
}

/// Each NC START executes one block, which is the current one; M8 goes to the PLC, whose coolant flows.
#[test]
fn single_block() {
    let mut trainee = trainee();
    trainee.press("SINGLE PGM_NR F R A M E POINT N C ENT");
    for block in ["N10 G00 X0 Y0", "N20 G01 X40 F3000 M8", "N30 Y30"] {
        trainee.press("NC_START").wait(8.0);
        assert!(current(&mut trainee).ends_with(block), "{:#?}", trainee.screen());
        assert_eq!(trainee.messages(), [""; 0]);
    }
}

/// TEST RUN comes to the end, and so does the picture of it.
#[test]
fn test_run() {
    let mut trainee = trainee();
    trainee
        .press("TEST PGM_NR F R A M E POINT N C ENT START")
        .wait(1.0);
    assert!(
        current(&mut trainee).ends_with("N40 M30"),
        "{:#?}",
        trainee.screen()
    );
    assert_eq!(trainee.messages(), [""; 0]);
}

/// A block that the control cannot execute is told, and is the current one.
#[test]
fn a_refused_block() {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/PRINT.NC", "N10 G00 X0\nN20 H5\n");
    trainee.ready();
    trainee.press("FULL PGM_NR P R I N T POINT N C ENT NC_START");
    trainee.until(60.0, |screen| !screen.messages.is_empty());
    assert_eq!(trainee.messages(), ["FUNCTION NOT YET SUPPORTED"]);
    trainee.wait(0.5);
    assert!(
        current(&mut trainee).ends_with("N20 H5"),
        "{:#?}",
        trainee.screen()
    );
}
