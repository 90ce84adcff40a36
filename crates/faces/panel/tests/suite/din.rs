//! Programs of DIN 66025 at the panel: chosen, run block by block, tested with graphics.

use crate::support::Trainee;
use bahn_panel::Star;

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

/// The list shows the numbers of the file, GOTO takes them, and a message names its block so. Line 6 has none and stands
/// sixth; nothing has the number 2.
#[test]
fn numbers_of_the_file() {
    let mut trainee = Trainee::at("mill");
    let text = "%FRAME\nN10 G00 X0 Y0\n\nN35 G01 X40 F3000\nN70 Y30\nY40\nN105 G77\n";
    trainee.write("programs/FRAME.NC", text);
    trainee.ready();
    trainee.press("FULL PGM_NR F R A M E POINT N C ENT").wait(0.3);
    trainee.press("GOTO 3 5 ENT");
    assert_eq!(current(&mut trainee), "N35 G01 X40 F3000");
    trainee.press("GOTO 5 ENT");
    assert_eq!(current(&mut trainee), "Y40");
    trainee.press("GOTO 2 ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE END GOTO 0 ENT NC_START");
    trainee.until(60.0, |screen| !screen.messages.is_empty());
    let message = trainee.screen().messages[0].clone();
    assert_eq!(message.place.as_deref(), Some("105"), "{message:?}");
}

/// RESTORE AT N calculates as far as block N70, whose start lies at X40 Y30 (N35, N50), leads the axes there, and the run
/// goes on from there alone: it ends at X40 Y60.
#[test]
fn the_block_scan() {
    // MP7680 bit 2 permits it.
    let mut trainee = Trainee::with("mill", |folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        let lines = text.lines().map(|line| match line.starts_with("MP7680") {
            true => "MP7680 : %000111",
            false => line,
        });
        std::fs::write(path, lines.collect::<Vec<_>>().join("\n") + "\n").unwrap();
    });
    let text = "N10 G00 X0 Y0\n\nN35 G01 X40 F3000\nN50 Y30\nN70 Y60\nN80 M30\n";
    trainee.write("programs/FRAME.NC", text);
    trainee.ready();
    trainee.press("FULL PGM_NR F R A M E POINT N C ENT").wait(0.3);
    trainee.soft("RESTORE AT N");
    trainee.press("7 1 ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE CE 7 0 ENT").wait(0.5);
    assert_eq!(trainee.messages(), [""; 0]);
    assert_ne!(trainee.screen().status.star, Star::Off);
    trainee.soft("RESTORE POSITION");
    // One NC START for each axis that is led back [000:9193].
    let place = |trainee: &mut Trainee| ['X', 'Y'].map(|axis| trainee.position(axis).parse::<f64>().unwrap());
    let is_at = |trainee: &mut Trainee, wanted: [f64; 2]| {
        let at = place(trainee);
        (at[0] - wanted[0]).hypot(at[1] - wanted[1]) < 0.01
    };
    let mut starts = 0;
    while !is_at(&mut trainee, [40.0, 30.0]) {
        assert!(starts < 6, "{:#?}", trainee.screen());
        starts += 1;
        trainee.press("NC_START").wait(20.0);
    }
    trainee.press("NC_START").wait(10.0);
    assert!(is_at(&mut trainee, [40.0, 60.0]), "{:#?}", trainee.screen());
    assert_eq!(trainee.messages(), [""; 0]);
}

/// The graphics of TEST RUN execute the same reader: 40 mm and 30 mm at 3000 mm/min, and what rapid traverse and
/// acceleration take beside them. There is no blank to cut.
#[test]
fn test_run_with_graphics() {
    let mut trainee = trainee();
    trainee.press("TEST PGM_NR F R A M E POINT N C ENT GRAPHICS START");
    trainee.until(20.0, |screen| {
        let shown = screen.graphics.as_ref();
        shown.is_some_and(|shown| shown.progress == 1.0)
    });
    let time_s = trainee.screen().graphics.unwrap().machining_time_s.unwrap();
    let least_s = (40.0 + 30.0) / 3000.0 * 60.0;
    assert!((least_s..10.0 * least_s).contains(&time_s), "{time_s} s");
}

/// The keys have capitals alone; the file is found in either case, as one of plain language.
#[test]
fn names_in_small_letters() {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/frame.nc", PROGRAM);
    trainee.write(
        "programs/groove.h",
        "BEGIN PGM groove MM\nL X+1\nEND PGM groove MM\n",
    );
    trainee.ready();
    for (typed, line) in [("F R A M E POINT N C", "N10 G00 X0 Y0"), ("G R O O V E", "L X+1")] {
        for mode in ["FULL", "TEST"] {
            trainee.press(&format!("{mode} PGM_NR {typed} ENT")).wait(0.3);
            assert_eq!(trainee.messages(), [""; 0], "{typed}");
            let lines = trainee.screen().program.lines;
            let there = lines
                .iter()
                .any(|own| own.text.ends_with(line.rsplit(' ').next().unwrap()));
            assert!(there, "{typed}: {lines:#?}");
        }
    }
}

/// The dialogue of the control writes its own languages alone.
#[test]
fn not_edited_as_plain_language() {
    let mut trainee = trainee();
    trainee.press("PROGRAM PGM_NR F R A M E POINT N C ENT").wait(0.3);
    assert_eq!(trainee.messages(), ["FUNCTION NOT YET SUPPORTED"]);
    assert_eq!(trainee.file("programs/FRAME.NC"), PROGRAM);
}

/// CALL PGM of a program of DIN 66025 is refused in its first block, with the reason.
#[test]
fn called() {
    let mut trainee = trainee();
    let text = "BEGIN PGM CALLS MM\nCALL PGM FRAME.NC\nEND PGM CALLS MM\n";
    trainee.write("programs/CALLS.H", text);
    trainee.press("FULL PGM_NR C A L L S ENT NC_START");
    trainee.until(60.0, |screen| !screen.messages.is_empty());
    assert_eq!(trainee.messages(), ["FUNCTION NOT YET SUPPORTED"]);
}
