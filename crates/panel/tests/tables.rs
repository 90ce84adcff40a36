//! Tables that the machine uses count at once; correction tables; the plane of 3D ROT; German messages.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use bahn_panel::Star;
use support::Trainee;

/// A machine whose description has another line first, on anew.
fn described(machine: &str, line: &str, files: &[(&str, &str)]) -> Trainee {
    let trainee = Trainee::at(machine);
    let description = trainee.file("machine.toml");
    trainee.write("machine.toml", &format!("{line}\n{description}"));
    for (name, text) in files {
        trainee.write(name, text);
    }
    trainee.killed()
}

#[test]
fn the_datum_table_in_use_counts_at_once() {
    let files = [
        ("programs/ZERO.D", "NR\tX\tY\tZ\n0\t0\t0\t0\n1\t7\t0\t0\n"),
        (
            "programs/SHIFT.H",
            "BEGIN PGM SHIFT MM\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #1\nL X+0 R0 F6000\nEND PGM SHIFT MM\n",
        ),
    ];
    let mut trainee = described("mill", "datum_table = \"ZERO.D\"", &files);
    trainee.ready();
    trainee
        .press("PROGRAM PGM_NR Z E R O POINT D ENT DOWN")
        .number("-12.5")
        .press("ENT");
    assert!(trainee.file("programs/ZERO.D").contains("1\t-12.5\t0\t0"));
    trainee.wait(0.2);
    assert!(
        trainee.station.control().remember().written_datums.is_empty(),
        "the file says it"
    );
    // Without it the machine could not be switched on again.
    trainee.press("END CL_PGM Z E R O POINT D ENT");
    assert_eq!(trainee.messages(), ["BACKGROUND PROGRAMMING NOT POSSIBLE"]);
    trainee.press("CE END FULL PGM_NR S H I F T ENT NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
    trainee.wait(1.0);
    // X+0 behind a shift of -12.5 mm.
    assert_eq!(trainee.position('X'), "-12.500");
}

/// The tool table opens in program run and by hand; what is entered is in its file only.
#[test]
fn the_tool_table_opens_in_program_run() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee
        .press("FULL SK5 RIGHT")
        .number("100")
        .press("ENT END")
        .wait(0.2);
    let tools = trainee.station.control().remember();
    assert!(tools.written.is_empty());
    trainee.press("MANUAL SK8 RIGHT");
    let line = trainee.screen().program.lines[1].clone();
    assert!(line.current && line.text.contains("100"), "{line:?}");
}

#[test]
fn correction_tables_are_edited_point_by_point() {
    let points: String = (0..64)
        .map(|point| format!("{point} {}\n", f64::from(point) * 0.01))
        .collect();
    let table = format!("Z OVER Y MM DATUM -90 DIST 16\n{points}");
    let mut trainee = described(
        "mill",
        "correction_tables = \"ERRORS.COM\"",
        &[("ERRORS.COM", &table)],
    );
    trainee.ready();
    trainee.press("PROGRAM MOD ENT").number("105296").press("ENT");
    let screen = trainee.screen();
    assert_eq!(
        (screen.program.title.as_str(), screen.program.total),
        ("ERRORS.COM", 65)
    );
    // Point 1: 0.01 becomes 0.02. Neighbours may differ by a 64th of 6.5536 mm: 0.5 is too much.
    trainee.press("DOWN DOWN").number("0.5").press("ENT");
    assert!(
        trainee.messages()[0].starts_with("ENTRY VALUE INCORRECT"),
        "{:?}",
        trainee.messages()
    );
    trainee.press("CE CE").number("0.02").press("ENT");
    assert_eq!(trainee.messages(), ["THE CORRECTION COUNTS FROM POWER-ON"]);
    assert_eq!(
        trainee.file("ERRORS.COM"),
        table.replace("\n1 0.01\n", "\n1 0.02\n")
    );
    // A head line is none of the points.
    trainee.press("CE UP UP UP").number("1").press("ENT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
}

/// A machine without such a file says so.
#[test]
fn without_correction_tables_the_code_number_says_so() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM MOD ENT").number("105296").press("ENT");
    assert_eq!(
        trainee.messages(),
        ["THE MACHINE HAS NO CORRECTION TABLES (.COM)"]
    );
}

#[test]
fn the_plane_of_the_swivel_axes_is_switched_by_hand() {
    let mut trainee = Trainee::at("gantry");
    trainee.ready();
    let key = |trainee: &mut Trainee| trainee.screen().soft_keys.keys[5].clone();
    assert_eq!(key(&mut trainee), "3D ROT ON");
    trainee.press("SK6").wait(0.1);
    assert!(trainee.station.control().first().leans());
    assert_eq!(key(&mut trainee), "3D ROT OFF");
    trainee.press("SK6").wait(0.1);
    assert_eq!(key(&mut trainee), "3D ROT ON");
    // The mill has no swivel axes.
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    assert_eq!(key(&mut trainee), "");
}

#[test]
fn messages_are_in_the_language_of_the_dialogue() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("MOD DOWN DOWN DOWN ENT END RL");
    assert_eq!(trainee.messages(), ["TASTE OHNE FUNKTION"]);
    // HELP explains it in the same language.
    trainee.press("HELP");
    let lines = trainee.screen().program.lines;
    assert_eq!(lines[0].text, "URSACHE:");
    assert_eq!(
        lines[1].text.trim(),
        "Die Taste hat im jetzigen Dialog keine Bedeutung."
    );
    trainee.press("END CE PROGRAM CL_PGM Z Z ENT");
    assert_eq!(trainee.messages(), ["PROGRAMM NICHT GEFUNDEN"]);
}
