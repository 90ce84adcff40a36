//! Small things that an operator expects of the keys.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use bahn_panel::WindowKind;
use support::Trainee;

/// In MANUAL and ELECTRONIC HANDWHEEL the tool table is called by simply pressing ENT [003:1897].
#[test]
fn ent_calls_the_tool_table_by_hand() {
    for (machine, mode) in [
        ("mill", "MANUAL"),
        ("mill", "HANDWHEEL"),
        ("mill-tnc360", "MANUAL"),
    ] {
        let mut trainee = Trainee::at(machine);
        trainee.ready();
        trainee.press(mode).press("ENT");
        let window = trainee.screen().program;
        assert_eq!(window.kind, WindowKind::Table, "{machine} {mode}");
        trainee.press("END");
        assert_eq!(trainee.screen().program.kind, WindowKind::Positions);
    }
}

/// A baud rate is entered with the numerical keys; only those of the list are permitted [003:7048].
#[test]
fn a_baud_rate_is_entered_by_digits() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.ready();
    trainee.press("PROGRAM MOD");
    trainee.down_to("DATA INTERFACES");
    trainee.press("ENT");
    trainee.down_to("RS-232 BAUD RATE");
    trainee.number("2400").press("ENT");
    assert_eq!(trainee.menu_value("RS-232 BAUD RATE"), "2400");
    trainee.number("2500").press("ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE END");
    assert_eq!(trainee.menu_value("RS-232 BAUD RATE"), "2400");
}

/// Behind CL PGM the digits of the next name begin anew, also when the program was not erased [003:985-990].
#[test]
fn behind_cl_pgm_digits_begin_anew() {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/12.H", "BEGIN PGM 12 MM\nEND PGM 12 MM\n");
    trainee.write("programs/3.H", "BEGIN PGM 3 MM\nEND PGM 3 MM\n");
    trainee.ready();
    trainee.press("PROGRAM CL_PGM 1 2 ENT NO_ENT 3 ENT");
    assert_eq!(
        trainee.screen().dialogue.prompt,
        "3.H: ERASE = ENT / END = NO ENT"
    );
}

/// BLK FORM shows a magnified workpiece in its programmed size; the part stays as it was cut [003:939-945].
#[test]
fn blk_form_leaves_the_magnification() {
    let mut trainee = Trainee::at("mill");
    trainee.write(
        "programs/77.H",
        "BEGIN PGM 77 MM\nBLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+40 Y+30 Z+0\nTOOL CALL 2 Z S2000\n\
         L X-10 Y+15 R0 FMAX\nL Z-5 FMAX M3\nL X+50 F600\nEND PGM 77 MM\n",
    );
    trainee.ready();
    trainee.press("TEST PGM_NR 7 7 ENT GRAPHICS START").wait(3.0);
    let magn = |trainee: &mut Trainee| trainee.screen().graphics.unwrap().magn;
    let removed = |trainee: &mut Trainee| trainee.station.picture().unwrap().part().unwrap().removed_mm3();
    let cut = removed(&mut trainee);
    assert!(cut > 0.0);
    trainee.press("MAGN");
    assert!(magn(&mut trainee) > 1);
    trainee.press("BLK_FORM");
    assert_eq!((magn(&mut trainee), removed(&mut trainee)), (1, cut));
    // Not magnified the programmed blank is whole again [003:931-935].
    trainee.press("BLK_FORM");
    assert_eq!(removed(&mut trainee), 0.0);
}

/// GOTO 1 7 ENT addresses a cycle directly [003:4822-4829].
#[test]
fn goto_chooses_a_cycle() {
    for machine in ["mill", "mill-tnc360"] {
        let mut trainee = Trainee::at(machine);
        trainee.ready();
        trainee.press("PROGRAM PGM_NR 2 3 ENT ENT CYCL_DEF GOTO 1 7 ENT");
        assert_eq!(trainee.messages(), [""; 0], "{machine}");
        let lines = trainee.screen().program.lines;
        assert!(
            lines.iter().any(|line| line.text.contains("CYCL DEF 17.0")),
            "{lines:?}"
        );
    }
}
