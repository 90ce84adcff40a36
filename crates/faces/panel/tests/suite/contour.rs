//! Graphics while programming: what is being written is drawn beside the program.

use std::time::Instant;

use crate::support::Trainee;
use bahn_panel::GraphicsView;

const PLATE: &str = "BEGIN PGM PLATE MM
BLK FORM 0.1 Z X+0 Y+0 Z-20
BLK FORM 0.2 X+100 Y+100 Z+0
TOOL CALL 0 Z S1000
L X+10 Y+10 Z+2 R0 FMAX
END PGM PLATE MM
";

fn trainee() -> Trainee {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/PLATE.H", PLATE);
    trainee.ready();
    trainee.press("PROGRAM PGM_NR P L A T E ENT").wait(0.3);
    trainee
}

fn png(trainee: &mut Trainee) -> Vec<u8> {
    trainee.wait(0.5);
    let picture = trainee.station.picture().unwrap();
    picture.png(640, 480).unwrap().unwrap()
}

#[test]
fn blocks_are_drawn_as_they_are_completed() {
    let mut trainee = trainee();
    assert!(trainee.screen().graphics.is_none(), "nobody has asked for them");
    trainee.press("GOTO 4 ENT GRAPHICS").wait(0.5);
    let shown = trainee.screen().graphics.unwrap();
    assert_eq!((shown.view, shown.running), (GraphicsView::Lines, false));
    let empty = png(&mut trainee);
    // An open block is not drawn, a complete one is.
    trainee.press("L X 9 0 ENT NO_ENT 2 0 0 ENT");
    assert_eq!(png(&mut trainee), empty);
    let serial = trainee.screen().graphics.unwrap().serial;
    trainee.press("NO_ENT");
    let line = png(&mut trainee);
    assert_ne!(line, empty);
    assert!(trainee.screen().graphics.unwrap().serial > serial);
    // Up to the block at the cursor; the same blocks are the same picture.
    trainee.press("UP");
    assert_eq!(png(&mut trainee), empty);
    trainee.press("DOWN");
    assert_eq!(png(&mut trainee), line);
    trainee.press("GRAPHICS").wait(0.1);
    assert!(trainee.screen().graphics.is_none() && trainee.station.picture().is_none());
}

#[test]
fn soft_keys_draw_the_whole_program_and_block_by_block() {
    let mut trainee = trainee();
    trainee.press("GOTO 4 ENT L X 9 0 ENT NO_ENT 2 0 0 ENT NO_ENT L Y 9 0 END GOTO 0 ENT SK_LEFT");
    let keys = trainee.screen().soft_keys;
    assert_eq!(
        keys.keys[..4],
        ["AUTO DRAW ON", "RESET + START", "START SINGLE", "CLEAR GRAPHICS"]
    );
    assert_eq!((keys.row, keys.rows), (2, 3));
    trainee.press("SK2");
    let whole = png(&mut trainee);
    trainee.press("SK4").wait(0.1);
    assert!(trainee.screen().graphics.is_none());
    // Block by block: blocks 5 and 6 have the lines.
    let mut pictures = Vec::new();
    for _ in 0..=6 {
        trainee.press("SK3");
        pictures.push(png(&mut trainee));
    }
    assert_ne!(pictures[4], pictures[5]);
    assert_ne!(pictures[5], pictures[6]);
    // The whole has no current block that stands out.
    assert_ne!(pictures[6], whole);
    // After the last block there is none.
    assert!(trainee.messages().is_empty());
    for _ in 0..20 {
        trainee.press("SK3");
    }
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    trainee.press("SK_RIGHT");
    assert_eq!(trainee.screen().soft_keys.row, 0);
    trainee.press("SK_LEFT SK1").wait(0.3);
    assert_eq!(trainee.screen().soft_keys.keys[0], "AUTO DRAW OFF");
    // While a dialogue is open its own soft keys are there.
    trainee.press("GOTO 4 ENT L X 1 ENT");
    assert_eq!(trainee.screen().soft_keys.keys[0], "RL");
}

/// A cycle is drawn beside its dialogue, with the word that is asked for; HELP switches that off and on. After the
/// dialogue the contour is back.
#[test]
fn the_cycle_is_drawn_beside_its_dialogue() {
    let mut trainee = trainee();
    trainee.press("GOTO 4 ENT CYCL_DEF 4 ENT").wait(0.1);
    assert_eq!(trainee.screen().graphics.unwrap().view, GraphicsView::Figure);
    let set_up = png(&mut trainee);
    trainee.press("SIGN 2 ENT");
    let depth = png(&mut trainee);
    assert_ne!(set_up, depth);
    trainee.press("LEFT");
    assert_eq!(png(&mut trainee), set_up);
    trainee.press("HELP").wait(0.1);
    assert!(trainee.screen().graphics.is_none());
    trainee.press("DEL CYCL_DEF 1 ENT").wait(0.1);
    assert!(trainee.screen().graphics.is_none(), "it stays off");
    trainee.press("HELP").wait(0.1);
    assert_eq!(trainee.screen().graphics.unwrap().view, GraphicsView::Figure);
    // A cycle without a drawing has none, nor what is no cycle.
    trainee.press("DEL CYCL_DEF 1 2 ENT").wait(0.1);
    assert!(trainee.screen().graphics.is_none());
    trainee.press("DEL L X 9 0").wait(0.1);
    assert!(trainee.screen().graphics.is_none());
    // A word that is highlighted is shown like one that is asked for.
    trainee.press("DEL CYCL_DEF 4 ENT SIGN 2 ENT SIGN 5 ENT SIGN 5 ENT 8 0 ENT X 8 0 ENT Y 4 0 ENT");
    trainee.press("1 0 0 ENT ENT 5 END").wait(0.1);
    assert!(
        trainee.screen().graphics.is_none(),
        "{:?}",
        trainee.screen().dialogue
    );
    trainee.press("GOTO 6 ENT RIGHT RIGHT").wait(0.1);
    assert_eq!(trainee.screen().dialogue.prompt, "SETUP CLEARANCE?");
    assert_eq!(png(&mut trainee), set_up);
}

/// The screen of a TNC 360 has one column: a cycle is drawn when HELP asks for it.
#[test]
fn help_draws_the_cycle_where_there_is_one_column() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.write("programs/7.H", "BEGIN PGM 7 MM\nEND PGM 7 MM\n");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 7 ENT CYCL_DEF 4 ENT").wait(0.1);
    assert!(trainee.screen().graphics.is_none());
    trainee.press("HELP").wait(0.1);
    assert_eq!(trainee.screen().graphics.unwrap().view, GraphicsView::Figure);
}

/// A key does not wait for the drawing of a long program, and real time goes on.
#[test]
fn no_key_waits_for_a_long_program() {
    let mut trainee = Trainee::at("mill");
    let blocks: String = (0..200_000)
        .map(|n| format!("L X+{} Y+{} F500\n", n % 100, n % 77))
        .collect();
    trainee.write(
        "programs/LONG.H",
        &format!("BEGIN PGM LONG MM\n{blocks}END PGM LONG MM\n"),
    );
    trainee.ready();
    trainee.station.run_in_real_time();
    trainee.press("PROGRAM PGM_NR L O N G ENT GRAPHICS GOTO 1 9 9 0 0 0 ENT");
    let mut longest = 0.0_f64;
    for key in ["UP", "UP", "L", "X", "5", "END", "DOWN", "UP"] {
        let begun = Instant::now();
        trainee.give(&format!("{{\"key\":\"{key}\"}}"));
        trainee.station.cycle().unwrap();
        longest = longest.max(begun.elapsed().as_secs_f64());
    }
    assert!(longest < 0.5, "a key took {longest} s");
}

/// MP7363.0 to .2: the ground of the drawing, contour, subprograms; a byte of six bits each for red, green and blue.
#[test]
fn the_program_has_the_colours_of_mp7363() {
    let mut trainee = Trainee::with("mill", |folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        let others = text.lines().filter(|line| !line.starts_with("MP7363"));
        let text: String = others.map(|line| format!("{line}\n")).collect();
        std::fs::write(path, text + "MP7363.0 : $0000015\nMP7363.1 : $03F0000\n").unwrap();
    });
    trainee.write("programs/PLATE.H", PLATE);
    trainee.ready();
    trainee.press("PROGRAM PGM_NR P L A T E ENT").wait(0.3);
    trainee
        .press("GOTO 4 ENT GRAPHICS L X 9 0 ENT NO_ENT 2 0 0 ENT NO_ENT UP")
        .wait(1.0);
    trainee.press("SK_LEFT SK2").wait(1.0);
    let pixels = trainee
        .station
        .picture()
        .unwrap()
        .pixels(640, 480)
        .unwrap()
        .unwrap();
    let count = |colour: [u8; 3]| pixels.iter().filter(|pixel| **pixel == colour).count();
    // 15 hexadecimal of 3F is 85 of 255.
    assert!(count([0, 0, 85]) > 640 * 480 / 2, "{:?}", pixels[0]);
    assert!(count([255, 0, 0]) > 100);
}
