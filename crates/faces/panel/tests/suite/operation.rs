//! Small things that an operator expects of the keys.

use crate::support::Trainee;
use bahn_panel::{Star, WindowKind};

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

/// After CL PGM the digits of the next name begin anew, also when the program was not erased [003:985-990].
#[test]
fn after_cl_pgm_digits_begin_anew() {
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

/// SPECIAL TOOL of a TNC 360 has blanks in it [003:1908], later controls have none.
#[test]
fn the_prompt_of_a_special_tool() {
    for (machine, prompt) in [
        ("mill", "SPECIAL TOOL? YES=ENT/NO=NOENT"),
        ("mill-tnc360", "SPECIAL TOOL? YES = ENT / NO = NO ENT"),
    ] {
        let mut trainee = Trainee::at(machine);
        trainee.ready();
        if machine == "mill-tnc360" {
            trainee.write("tools.tsv", "T\tL\tR\tST\n1\t60\t10\t\n");
        }
        trainee.press("ENT");
        if machine == "mill" {
            trainee.soft("POCKET TABLE");
        }
        for _ in 0..20 {
            if trainee.screen().dialogue.prompt == prompt {
                break;
            }
            trainee.press("RIGHT");
        }
        assert_eq!(trainee.screen().dialogue.prompt, prompt);
    }
}

/// MOD is there beside an interrupted program, which goes on after it [003:6980-6989].
#[test]
fn mod_beside_an_interrupted_program() {
    let mut trainee = Trainee::at("mill");
    trainee.write(
        "programs/81.H",
        "BEGIN PGM 81 MM\nL X+0 R0 F3000\nSTOP\nL X+20\nEND PGM 81 MM\n",
    );
    trainee.ready();
    trainee.press("FULL PGM_NR 8 1 ENT NC_START");
    trainee.until(60.0, |screen| screen.status.star == Star::Blinking);
    trainee.press("MOD ENT");
    assert_eq!(trainee.screen().status.position_type, "NOML");
    trainee.press("END NC_START");
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
    assert_eq!(trainee.position('X'), "+20.000");
}

/// A test run comes upon a rotary axis: PGM SECTION CANNOT BE SHOWN with its first block [003:876] [003:7967-7971], before the
/// program is through.
#[test]
fn a_test_run_cannot_show_the_first_rotary_block() {
    let mut trainee = Trainee::at("mill");
    let blocks = "L X+10 R0 FMAX\nL C+90 F1000\nSTOP\nL X+20\n";
    trainee.write(
        "programs/82.H",
        &format!(
            "BEGIN PGM 82 MM\nBLK FORM 0.1 Z X+0 Y+0 Z-10\nBLK FORM 0.2 X+40 Y+30 Z+0\nTOOL CALL 1 Z S2000\n{blocks}END PGM 82 MM\n"
        ),
    );
    trainee.ready();
    trainee.press("TEST PGM_NR 8 2 ENT GRAPHICS START").wait(2.0);
    assert!(trainee.screen().graphics.unwrap().running, "it waits at STOP");
    assert_eq!(trainee.messages(), ["PGM SECTION CANNOT BE SHOWN"]);
}

/// With MP7490 = 0 or 2 there is one traverse range, with 1 or 3 there are three: so many AXIS LIMITs has MOD
/// [000:3499-3508].
#[test]
fn mp7490_says_how_many_axis_limits_there_are() {
    for (value, ranges) in [("0", 1), ("1", 3), ("2", 1), ("3", 3)] {
        let mut trainee = Trainee::with("mill", |folder| {
            let path = folder.join("parameters.mp");
            let list = std::fs::read_to_string(&path).unwrap();
            let old = list.lines().find(|line| line.starts_with("MP7490 ")).unwrap();
            std::fs::write(&path, list.replace(old, &format!("MP7490 : {value}"))).unwrap();
        });
        trainee.ready();
        trainee.press("MOD");
        let lines = trainee.screen().program.lines;
        let limits = lines.iter().filter(|line| line.text.starts_with("AXIS LIMIT"));
        assert_eq!(limits.count(), ranges, "MP7490 = {value}");
    }
}

/// With MP7296 = 1 the datum is set with the soft key only, with 0 with the axis keys, too [000:6277-6285].
#[test]
fn mp7296_leaves_datum_set_to_the_soft_key() {
    for (value, by_axis_key) in [("0", true), ("1", false)] {
        let mut trainee = Trainee::with("mill", |folder| {
            let path = folder.join("parameters.mp");
            let list = std::fs::read_to_string(&path).unwrap();
            let old = list.lines().find(|line| line.starts_with("MP7296 ")).unwrap();
            std::fs::write(&path, list.replace(old, &format!("MP7296 : {value}"))).unwrap();
        });
        trainee.ready();
        trainee.press("X");
        assert_eq!(trainee.screen().dialogue.prompt == "DATUM SET X =", by_axis_key);
        trainee.press(if by_axis_key { "END" } else { "CE" });
        trainee.soft("DATUM SET");
        trainee.press("X").number("7").press("ENT").wait(0.2);
        assert_eq!(trainee.position('X'), "+7.000");
    }
}

/// MOD has HELP where there is a help file only [000:7044].
#[test]
fn help_is_there_with_a_help_file_only() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let has_help = |trainee: &mut Trainee, mode: &str| {
        trainee.press(mode).press("MOD");
        let lines = trainee.screen().program.lines;
        trainee.press("END");
        lines.iter().any(|line| line.text == "HELP")
    };
    for file in std::fs::read_dir(trainee.folder().join("programs"))
        .unwrap()
        .flatten()
    {
        if file.path().extension().is_some_and(|ending| ending == "HLP") {
            std::fs::remove_file(file.path()).unwrap();
        }
    }
    trainee.station.programs_changed();
    for there in [false, true] {
        if there {
            trainee.write("programs/TOOLS.HLP", "#0001 CHAIN FORWARD\n");
            trainee.station.programs_changed();
        }
        for mode in ["PROGRAM", "MANUAL"] {
            assert_eq!(has_help(&mut trainee, mode), there, "{mode}");
        }
    }
}

/// The jog increment is asked for in ELECTRONIC HANDWHEEL where the PLC enables it (M2498) [000:8496-8499].
#[test]
fn the_increment_needs_its_marker() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let has = |trainee: &mut Trainee, mode: &str| {
        trainee.press(mode);
        trainee
            .screen()
            .soft_keys
            .keys
            .iter()
            .any(|key| key == "INCREMENT")
    };
    assert!(!has(&mut trainee, "HANDWHEEL"));
    trainee.give(r#"{"action":"M2498=1"}"#).wait(0.2);
    assert!(has(&mut trainee, "HANDWHEEL"));
    assert!(!has(&mut trainee, "MANUAL"));
}

/// After switch-on the software numbers are displayed [000:327], until CE.
#[test]
fn software_numbers_are_displayed_at_power_on() {
    let mut trainee = Trainee::at("mill");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    let lines = trainee.screen().program.lines;
    assert!(
        lines[0].text.starts_with("NC SOFTWARE NUMBER: BAHN "),
        "{lines:?}"
    );
    assert!(
        lines[1].text.starts_with("PLC SOFTWARE NUMBER: MAIN.PLC "),
        "{lines:?}"
    );
    trainee.ready();
    assert_eq!(trainee.screen().program.kind, WindowKind::Positions);
}

/// MDI of a TNC 360 takes single-axis positioning blocks [003:3566]; a TNC 415 takes any.
#[test]
fn mdi_of_a_tnc_360_positions_one_axis() {
    for (machine, taken) in [("mill", true), ("mill-tnc360", false)] {
        let mut trainee = Trainee::at(machine);
        trainee.ready();
        trainee.press("MDI").give(r#"{"text":"L X+10 Y+10 R0 F500"}"#);
        assert_eq!(trainee.messages().is_empty(), taken, "{:?}", trainee.messages());
        trainee.press(if taken { "" } else { "CE" });
        trainee.give(r#"{"text":"L X+5 R0 F500"}"#);
        assert_eq!(trainee.messages(), [""; 0], "{machine}");
    }
}

/// S 100 000 and M100 are refused when they are entered [003:2180].
#[test]
fn m_and_s_that_are_none_are_refused() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    for keys in ["S 1 0 0 0 0 0 ENT", "M 1 0 0 ENT"] {
        trainee.press(keys);
        assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"], "{keys}");
        trainee.press("CE END");
    }
}

/// A TM 110 in the spindle of dig425, which is no measuring probe as it is shipped.
fn with_measuring_probe() -> Trainee {
    Trainee::with("dig425", |folder| {
        let change = |name: &str, from: &str, to: &str| {
            let path = folder.join(name);
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(text.contains(from), "{name} has no {from}");
            std::fs::write(&path, text.replace(from, to)).unwrap();
        };
        let list = "MP6200 : 1\nMP6310 : 0.5\nMP6330 : 2\nMP6350 : 200\nMP6360 : 600\nMP6361 : 3000\n;";
        change("parameters.mp", "MP6200", list);
        change("plant.toml", "tool = 5", "measuring = true\ninserted = true");
    })
}

/// The soft key PNT of POSITIONING WITH MDI: the machine moves in the direction in which the stylus is deflected until it is
/// pressed again [000:7907]. Without measuring probe there is none.
#[test]
fn pnt_lets_the_machine_follow_the_stylus() {
    let keys = |trainee: &mut Trainee| {
        let rows = trainee.press("MDI").wait(0.1).screen().soft_keys.rows;
        let mut keys = Vec::new();
        for _ in 0..rows {
            keys.extend(trainee.screen().soft_keys.keys);
            trainee.press("SK_RIGHT");
        }
        keys.retain(|key| key.starts_with("PNT"));
        keys
    };
    let mut trainee = Trainee::at("dig425");
    trainee.ready();
    assert_eq!(keys(&mut trainee), [""; 0]);
    let mut trainee = with_measuring_probe();
    trainee.ready();
    assert_eq!(keys(&mut trainee), ["PNT ON"]);
    let x = |trainee: &mut Trainee| trainee.position('X').parse::<f64>().unwrap();
    let from = x(&mut trainee);
    trainee.soft("PNT ON");
    // 2 N deflect it by MP6310: MP6360, 10 mm/s.
    trainee.give(r#"{"action":"probe push X 2"}"#).wait(1.0);
    let way = x(&mut trainee) - from;
    assert!((9.0..10.5).contains(&way), "{way}");
    trainee.soft("PNT OFF");
    trainee.wait(0.5);
    let at = x(&mut trainee);
    trainee.wait(1.0);
    assert!((x(&mut trainee) - at).abs() < 0.002);
    // The keys of the editor are there after it.
    assert_eq!(keys(&mut trainee), ["PNT ON"]);
    trainee.soft("PNT ON");
    trainee.press("MANUAL").wait(0.5);
    let at = x(&mut trainee);
    trainee.wait(0.5);
    assert!((x(&mut trainee) - at).abs() < 0.002, "the mode is left");
    assert_eq!(trainee.messages(), [""; 0]);
}
