//! Tables that the machine uses count at once; correction tables; the plane of 3D ROT; German messages.

use crate::support::Trainee;
use bahn_host::Operable;
use bahn_panel::Star;

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
    // X+0 after a shift of -12.5 mm.
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

/// A table in Latin-1, the alphabet of the control's own files, stays one: only what is entered is another.
#[test]
fn a_table_keeps_its_alphabet() {
    let mut trainee = Trainee::with("mill", |folder| {
        let path = folder.join("tools.tsv");
        let mut bytes = std::fs::read(&path).unwrap();
        bytes.extend_from_slice(b"; Fr\xe4ser\n");
        std::fs::write(path, bytes).unwrap();
    });
    trainee.ready();
    trainee
        .press("FULL SK5 RIGHT")
        .number("100")
        .press("ENT END")
        .wait(0.2);
    let bytes = std::fs::read(trainee.folder().join("tools.tsv")).unwrap();
    let has = |wanted: &[u8]| bytes.windows(wanted.len()).any(|own| own == wanted);
    assert!(
        has(b"; Fr\xe4ser\n") && has(b"100"),
        "{}",
        String::from_utf8_lossy(&bytes)
    );
}

/// The mill with another number of tools in the tool table, and without the files of tools and pockets.
fn without_tools(most: u32) -> Trainee {
    Trainee::with("mill", |folder| {
        let edit = |name: &str, what: &dyn Fn(&str) -> Option<String>| {
            let text = std::fs::read_to_string(folder.join(name)).unwrap();
            let lines: Vec<String> = text.lines().filter_map(what).collect();
            std::fs::write(folder.join(name), lines.join("\n") + "\n").unwrap();
        };
        edit("machine.toml", &|line| {
            let own = line.starts_with("tools ") || line.starts_with("pockets ");
            (!own || most == 0).then(|| line.to_owned())
        });
        edit("parameters.mp", &|line| {
            Some(match line.starts_with("MP7260") {
                true => format!("MP7260 : {most}"),
                false => line.to_owned(),
            })
        });
        if most > 0 {
            std::fs::remove_file(folder.join("tools.tsv")).unwrap();
        }
    })
}

fn has_soft(trainee: &mut Trainee, name: &str) -> bool {
    let rows = trainee.screen().soft_keys.keys;
    rows.iter().any(|key| key == name)
}

/// "If MP7260 contains a zero value, then the system will run without a tool table ("TOOL.T" does not exist)" [000:9103]:
/// neither soft key nor directory offer the file that machine.toml names.
#[test]
fn without_tools_in_the_table_there_is_none() {
    let mut trainee = without_tools(0);
    trainee.ready();
    trainee.press("FULL");
    assert!(!has_soft(&mut trainee, "TOOL TABLE"));
    trainee.press("PROGRAM PGM_NR");
    let lines = trainee.screen().program.lines;
    let tables = lines.iter().filter(|line| line.text.starts_with("TOOL"));
    assert_eq!(tables.count(), 0, "{lines:#?}");
    trainee.press("0 ENT");
    assert_eq!(trainee.messages(), ["PROGRAM NOT FOUND"]);
}

/// "The number of tools in the tool table is defined in machine parameter MP7260" [000:9103]: with MP7260 = 5 there is TOOL.T
/// with the tools 0 to 5. A machine that has no file of it makes one.
#[test]
fn the_tool_table_is_made_with_the_tools_of_the_parameter() {
    let mut trainee = without_tools(5);
    trainee.ready();
    trainee.press("FULL");
    trainee.soft("TOOL TABLE");
    let prompt = trainee.screen().dialogue.prompt;
    assert!(prompt.starts_with("THE MACHINE HAS NO TOOL TABLE"), "{prompt}");
    trainee.press("ENT");
    let lines = trainee.screen().program.lines;
    let numbers: Vec<&str> = lines
        .iter()
        .skip(1)
        .filter_map(|line| line.text.split_whitespace().next())
        .collect();
    assert_eq!(numbers, ["0", "1", "2", "3", "4", "5"], "{lines:#?}");
    trainee.press("DOWN RIGHT").number("100").press("ENT END");
    // The machine has it from the next power-on.
    let trainee = trainee.killed();
    let tools = trainee.station.machine().tools.clone().unwrap();
    let lengths: Vec<f64> = tools.values().map(|tool| tool.shape.length).collect();
    assert_eq!(lengths, [0.0, 100.0, 0.0, 0.0, 0.0, 0.0]);
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
    assert_eq!(trainee.messages(), [""; 0]);
    assert_eq!(
        trainee.file("ERRORS.COM"),
        table.replace("\n1 0.01\n", "\n1 0.02\n")
    );
    // A head line is none of the points.
    trainee.press("UP UP UP").number("1").press("ENT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
}

/// Code number 105 296 is the entry of correction tables [000:3875-3887]: where there are none they are made, always with 64
/// points, at most one for each axis.
#[test]
fn correction_tables_are_made_by_their_code_number() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM MOD ENT").number("105296").press("ENT");
    let prompt = trainee.screen().dialogue.prompt;
    assert!(
        prompt.starts_with("THE MACHINE HAS NO CORRECTION TABLES"),
        "{prompt}"
    );
    trainee.press("ENT");
    assert_eq!(trainee.screen().program.total, 65);
    // Z over Y, from -90 mm on.
    trainee.soft("HEAD LINE");
    trainee
        .press("ENT ENT DOWN ENT DOWN ENT")
        .number("-90")
        .press("ENT END")
        .wait(0.1);
    assert_eq!(
        trainee.screen().program.lines[0].text,
        "Z OVER Y MM DATUM -90 DIST 16"
    );
    // Neighbours differ by 6.5536 mm / 64 = 0.1024 mm at most.
    trainee.press("DOWN").number("0.1").press("ENT");
    assert_eq!(trainee.messages(), [""; 0]);
    trainee.soft("NEW TABLE");
    assert_eq!(trainee.screen().program.total, 130);
    trainee.press("END");
    let file = trainee.file("CORRECTION.TAB");
    assert!(
        file.starts_with("Z OVER Y MM DATUM -90 DIST 16\n0 0.1\n1 0\n"),
        "{file}"
    );
    assert!(file.contains("\nX OVER X MM DATUM 0 DIST 16\n0 0\n"), "{file}");
    // The machine has them from now on.
    let trainee = trainee.killed();
    let tables = trainee.station.machine().files.correction_tables.clone().unwrap();
    assert_eq!(tables.error_mm(2, -90.0), 0.1);
}

/// The mill, whose Y goes as far as the manual's table does, compensating Y and Z (MP730).
fn compensating(files: &[(&str, &str)]) -> Trainee {
    let replaced = |folder: &std::path::Path, name: &str, from: &str, to: &str| {
        let text = std::fs::read_to_string(folder.join(name)).unwrap();
        assert!(text.contains(from), "{name}: {from}");
        std::fs::write(folder.join(name), text.replace(from, to)).unwrap();
    };
    let mut trainee = Trainee::with("mill", |folder| {
        replaced(folder, "parameters.mp", "MP730    : %00000", "MP730    : %00110");
        replaced(folder, "parameters.mp", "MP920.1  : -10", "MP920.1  : -110");
        replaced(
            folder,
            "plant.toml",
            "travel = [-20, 420]",
            "travel = [-120, 420]",
        );
        replaced(
            folder,
            "plant.toml",
            "limit_minus = { at = -15 }\nlimit_plus = { at = 415 }",
            "limit_minus = { at = -115 }\nlimit_plus = { at = 415 }",
        );
        for (name, text) in files {
            std::fs::write(folder.join(name), text).unwrap();
        }
    });
    trainee.ready();
    trainee
}

/// The files of the PLC, with the cursor on one of them, opened.
fn edit(trainee: &mut Trainee, name: &str) {
    trainee.press("PROGRAM MOD ENT").number("807667").press("ENT");
    trainee.soft("EDIT");
    trainee.down_to(name);
    trainee.soft("SELECT");
}

/// Makes ACHSE-Y.COM and CONFIG.CMA, and enters the first points of the manual's table [000:3809-3853].
fn enter_table(trainee: &mut Trainee) {
    trainee.press("PROGRAM MOD ENT").number("807667").press("ENT");
    trainee.soft("EDIT");
    for name in ["ACHSE-Y.COM", "CONFIG.CMA"] {
        trainee.soft("NEW FILE");
        trainee
            .give(&format!("{{\"text\":\"{name}\"}}"))
            .press("ENT")
            .wait(0.1);
    }
    trainee.down_to("ACHSE-Y.COM");
    trainee.soft("SELECT");
    assert!(trainee.screen().program.title.starts_with("FILE ACHSE-Y.COM"));
    // DATUM -90, DIST 16, Y=F() and Z=F().
    trainee.soft("HEAD LINE");
    trainee
        .press("ENT")
        .number("-90")
        .press("ENT DOWN DOWN DOWN ENT DOWN ENT END")
        .wait(0.1);
    assert_eq!(
        trainee.file("plc/ACHSE-Y.COM"),
        "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n"
    );
    // Line 0: +0 and -0.01; line 2: +0.005 and -0.02.
    trainee
        .press("RIGHT")
        .number("-0.01")
        .press("ENT ENT")
        .number("-0.02")
        .press("ENT");
    trainee.press("UP LEFT").number("0.005").press("ENT");
    let title = trainee.screen().program.title;
    assert!(title.ends_with("Y=F() Z=F()"), "{title}");
    // The third line stands at -90 + 2 · 2^16 · 0.1 µm = -76.8928.
    let lines = trainee.screen().program.lines;
    let words: Vec<&str> = lines[2].text.split_whitespace().collect();
    assert_eq!(words, ["2", "-76.8928", "0.005", "-0.02"]);
    assert_eq!(
        trainee.file("plc/ACHSE-Y.COM"),
        "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n0 Z=-0.01\n2 Y=0.005 Z=-0.02\n"
    );
}

/// The manual's example: ACHSE-Y and ACHSE-Z are assigned in CONFIG.CMA, line 0 is active [000:3787-3865]. MP730 selects Y
/// and Z: the error acts at once, and no more when the line is cleared.
#[test]
fn axis_errors_are_entered_assigned_and_activated() {
    let mut trainee = compensating(&[]);
    // Y to the third point of the table, -76.8928 mm from the machine datum.
    trainee.give(r#"{"action":"mode mdi"}"#);
    trainee.give(r#"{"action":"mdi L Y-76.8928 R0 F3000 M91"}"#);
    trainee.press("NC_START").wait(10.0);
    // How far the table of the machine stands from there, mm. The scales of the mill are right.
    let off = |trainee: &mut Trainee| {
        trainee.wait(1.0);
        trainee.station.host().plant().true_axis('Y').unwrap().position + 76.8928
    };
    let close = |is: f64, wanted: f64| assert!((is - wanted).abs() < 0.0005, "{is} is not {wanted}");
    let still = off(&mut trainee);
    assert!(still.abs() < 0.002, "{still}");
    enter_table(&mut trainee);
    trainee.press("END");
    trainee.soft("EDIT");
    trainee.down_to("CONFIG.CMA");
    trainee.soft("SELECT");
    trainee.press("RIGHT");
    trainee
        .give(r#"{"key":"A"}"#)
        .press("CE")
        .give(r#"{"text":"ACHSE-Y"}"#)
        .press("ENT")
        .wait(0.1);
    let active = |trainee: &Trainee| trainee.station.control().compensation_line();
    assert_eq!(active(&trainee), None);
    trainee.soft("SET ACTIV LINE");
    assert_eq!(active(&trainee), Some(0), "{:?}", trainee.messages());
    assert_eq!(trainee.file("plc/CONFIG.CMA"), "0 Y=ACHSE-Y\nACTIVE 0\n");
    assert!(
        trainee
            .file("machine.toml")
            .contains("compensation = \"plc/CONFIG.CMA\"")
    );
    assert!(trainee.screen().program.lines[0].text.contains(">>"));
    // There Y travels 0.005 mm too far: the control takes it off, at once.
    close(off(&mut trainee), still - 0.005);
    trainee.soft("CLEAR ACTIV LINE");
    assert_eq!(active(&trainee), None);
    close(off(&mut trainee), still);
    // A table that is not there cannot be active.
    trainee.press("RIGHT");
    trainee
        .give(r#"{"key":"A"}"#)
        .press("CE")
        .give(r#"{"text":"NONE"}"#)
        .press("ENT")
        .wait(0.1);
    assert!(!trainee.messages().is_empty());
    assert_eq!(trainee.file("plc/CONFIG.CMA"), "0 Y=ACHSE-Y\n");
}

/// DIST is 23 at most [000:3777], and a value belongs to a column: what cannot be read is not stored, also of a table that
/// nothing uses yet.
#[test]
fn a_table_that_cannot_be_read_is_not_stored() {
    let table = "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n0 Z=-0.01\n2 Y=0.005 Z=-0.02\n";
    let mut trainee = compensating(&[("plc/ACHSE-Y.COM", table)]);
    edit(&mut trainee, "ACHSE-Y.COM");
    trainee.soft("HEAD LINE");
    trainee.press("DOWN ENT").number("99").press("ENT");
    let said = trainee.messages();
    assert!(said[0].starts_with("ENTRY VALUE INCORRECT"), "{said:?}");
    assert_eq!(trainee.file("plc/ACHSE-Y.COM"), table);
    // The column of Z, in which there are values, goes with none of them.
    trainee.press("CE CE END UP UP UP UP DOWN DOWN DOWN DOWN ENT");
    let said = trainee.messages();
    assert!(said[0].starts_with("ENTRY VALUE INCORRECT"), "{said:?}");
    assert_eq!(trainee.file("plc/ACHSE-Y.COM"), table);
    trainee.press("CE END").wait(0.1);
    // Without its values it goes.
    trainee.press("RIGHT NO_ENT DOWN DOWN NO_ENT");
    trainee.soft("HEAD LINE");
    trainee.press("DOWN DOWN DOWN DOWN ENT");
    assert_eq!(trainee.messages(), [""; 0]);
    assert_eq!(
        trainee.file("plc/ACHSE-Y.COM"),
        "ACHSE-Y MM DATUM -90 DIST 16 Y\n2 Y=0.005\n"
    );
}

/// A file that came over the data interface with a line that cannot be read is not opened: it would go with the next entry.
#[test]
fn a_table_with_a_fault_is_not_opened() {
    let table = "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n0 Z=-0.01\n2 Y:0.005\n";
    let mut trainee = compensating(&[("plc/ACHSE-Y.COM", table)]);
    edit(&mut trainee, "ACHSE-Y.COM");
    let said = trainee.messages();
    assert!(said[0].contains("line 3"), "{said:?}");
    assert!(!trainee.screen().program.title.starts_with("FILE"));
    // Neither does it come while it is edited.
    trainee.write("plc/ACHSE-Y.COM", &table.replace(':', "="));
    trainee.press("CE");
    trainee.soft("SELECT");
    trainee.soft("HEAD LINE");
    trainee.write("plc/ACHSE-Y.COM", table);
    trainee.press("END").wait(0.1);
    assert!(
        trainee.messages()[0].contains("line 3"),
        "{:?}",
        trainee.messages()
    );
}

/// INSERT LINE makes a line at the cursor, and the active one stays the active one.
#[test]
fn a_line_of_the_assignment_comes_in_at_the_cursor() {
    let files = [("plc/CONFIG.CMA", "0 Y=ACHSE-Y\n1 Z=ACHSE-Z\nACTIVE 1\n")];
    let mut trainee = compensating(&files);
    edit(&mut trainee, "CONFIG.CMA");
    trainee.soft("INSERT LINE");
    assert_eq!(
        trainee.file("plc/CONFIG.CMA"),
        "0\n1 Y=ACHSE-Y\n2 Z=ACHSE-Z\nACTIVE 2\n"
    );
    let lines = trainee.screen().program.lines;
    assert!(lines[0].current, "{lines:#?}");
    // After the active one it is another matter.
    trainee.press("DOWN DOWN DOWN");
    trainee.soft("DELETE LINE");
    trainee.press("UP");
    trainee.soft("INSERT LINE");
    assert_eq!(trainee.file("plc/CONFIG.CMA"), "0\n1\n2 Y=ACHSE-Y\n");
}

/// The file went while it was edited: SET ACTIV LINE says so, and makes no empty one in its place.
#[test]
fn an_assignment_that_cannot_be_read_is_not_activated() {
    let mut trainee = compensating(&[("plc/CONFIG.CMA", "0 Y=NONE\n")]);
    edit(&mut trainee, "CONFIG.CMA");
    std::fs::remove_file(trainee.folder().join("plc/CONFIG.CMA")).unwrap();
    trainee.soft("SET ACTIV LINE");
    assert!(
        trainee.messages()[0].contains("cannot read"),
        "{:?}",
        trainee.messages()
    );
    assert!(!trainee.has("plc/CONFIG.CMA"));
}

#[test]
fn the_plane_of_the_swivel_axes_is_switched_by_hand() {
    let mut trainee = Trainee::at("gantry");
    trainee.ready();
    let key = |trainee: &mut Trainee| trainee.screen().soft_keys.keys[5].clone();
    assert_eq!(key(&mut trainee), "3D ROT");
    trainee.press("SK6").wait(0.1);
    let stands =
        |trainee: &mut Trainee| ["PROGRAM RUN", "MANUAL OPERATION", "B"].map(|name| trainee.menu_value(name));
    let shown = |trainee: &mut Trainee| trainee.screen().status.flags.contains(&"3D ROT".to_owned());
    // Nothing is on: B where it stands.
    let [run, by_hand, b] = stands(&mut trainee);
    assert_eq!([run, by_hand], ["INACTIVE", "INACTIVE"]);
    // Manual operation and program run are switched apart, and the position of B is edited.
    trainee.press("DOWN ENT").wait(0.1);
    assert_eq!(stands(&mut trainee), ["INACTIVE", "ACTIVE", &b]);
    trainee.press("DOWN ENT").number("30").press("ENT").wait(0.1);
    assert_eq!(stands(&mut trainee), ["INACTIVE", "ACTIVE", "+30.000"]);
    assert!(shown(&mut trainee));
    trainee.press("UP UP ENT").wait(0.1);
    assert_eq!(stands(&mut trainee), ["ACTIVE", "ACTIVE", "+30.000"]);
    trainee.press("DOWN ENT").wait(0.1);
    assert_eq!(stands(&mut trainee), ["ACTIVE", "INACTIVE", "+30.000"]);
    assert!(!shown(&mut trainee));
    trainee.press("END");
    // The mill has no swivel axes.
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    assert_eq!(key(&mut trainee), "");
}

/// "The 3D ROT soft key can be used to activate the swivelled machining plane for Manual and Program Run separately. The
/// position of the swivel axes can be edited" [000:4256]: each keeps its own positions but of the axis that is edited.
#[test]
fn an_axis_of_the_plane_is_edited_alone() {
    // After the head B a rotation about C.
    let mut trainee = Trainee::with("gantry", |folder| {
        let path = folder.join("parameters.mp");
        let list = std::fs::read_to_string(&path).unwrap();
        let with_c = list.replace("MP7540   : %000000", "MP7540   : %100000");
        assert_ne!(list, with_c);
        std::fs::write(path, with_c).unwrap();
    });
    trainee.ready();
    trainee.give(r#"{"action":"3d-rot run on B+10 C+20"}"#);
    trainee.give(r#"{"action":"3d-rot on B+30 C+40"}"#).wait(0.1);
    trainee.press("SK6").wait(0.1);
    let stands = |trainee: &mut Trainee| ["B", "C"].map(|name| trainee.menu_value(name));
    assert_eq!(stands(&mut trainee), ["+30.000", "+40.000"]);
    trainee.down_to("C");
    trainee.press("ENT").number("5").press("ENT").wait(0.1);
    // A, B and C of both.
    let planes = |trainee: &Trainee| {
        let channel = trainee.station.control().first();
        [true, false].map(|run| channel.plane(run))
    };
    assert_eq!(planes(&trainee), [Some([0.0, 10.0, 5.0]), Some([0.0, 30.0, 5.0])]);
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

/// What module 9035 tells the PLC of the screen in items 2 to 5 and 17 [000:14899-14916].
#[test]
fn the_plc_gets_what_the_screen_shows() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let screen = |trainee: &mut Trainee| {
        trainee.wait(0.1);
        trainee.station.control().first().screen().unwrap()
    };
    let by_hand = screen(&mut trainee);
    assert_eq!((by_hand.editing, by_hand.machine, by_hand.inch), (0, 0, false));
    // The machine screen is displayed (8) with positions (11) and without blocks (10), the editing screen is not (0).
    assert_eq!(by_hand.windows & 0b1101_0000_0001, 0b1001_0000_0000);
    // A program run shows blocks.
    trainee.press("FULL");
    assert_eq!(screen(&mut trainee).windows & 0b0101_0000_0001, 0b0101_0000_0000);
    // MOD lies over the machine screen, its tool table is 3; MM/INCH is item 17.
    trainee.press("MANUAL MOD");
    assert_eq!(screen(&mut trainee).machine, 1);
    trainee.press("END TOOL_DEF");
    assert_eq!(screen(&mut trainee).machine, 3);
    assert_eq!(screen(&mut trainee).file, 0, "no file of the editing screen");
    // A program is edited: file 1; its directory lies over the editing screen.
    trainee.write("programs/4711.H", "0 BEGIN PGM 4711 MM\n1 END PGM 4711 MM\n");
    trainee.press("END PROGRAM PGM_NR 4 7 1 1 ENT");
    let editing = screen(&mut trainee);
    assert_eq!(
        (editing.editing, editing.file, editing.windows & 0b1_0000_0001),
        (0, 1, 1)
    );
    trainee.press("PGM_NR");
    assert_eq!(screen(&mut trainee).editing, 2);
    // The tool table is a file of that screen (.T is 3), not something that lies over it.
    trainee.press("0 ENT");
    let tools = screen(&mut trainee);
    assert_eq!((tools.editing, tools.file), (0, 3));
    // The machine parameter editor is 3 there and the PLC editor 4; the machine screen has codes for neither, so it is MOD (1)
    // from which they were reached.
    for (number, code) in [("95148", 3), ("807667", 4)] {
        trainee.press("END PROGRAM MOD ENT").number(number).press("ENT");
        assert_eq!(
            (screen(&mut trainee).editing, screen(&mut trainee).machine),
            (code, 0)
        );
        trainee.press("END END MANUAL MOD");
        trainee.down_to("CODE NUMBER");
        trainee.press("ENT").number(number).press("ENT");
        assert_eq!(screen(&mut trainee).machine, 1);
        trainee.press("END END");
    }
    // A compensation table and its assignment are files of kind 7.
    trainee.write("plc/ACHSE-Y.COM", "ACHSE-Y MM DATUM -90 DIST 16 Y Z\n");
    trainee.write("plc/CONFIG.CMA", "0 Y=ACHSE-Y\n");
    for name in ["ACHSE-Y.COM", "CONFIG.CMA"] {
        edit(&mut trainee, name);
        let reported = screen(&mut trainee);
        assert_eq!((reported.editing, reported.file), (4, 7), "{name}");
        trainee.press("END END END END");
    }
    // A control that is switched on anew is told again.
    trainee.press("PROGRAM PGM_NR 4 7 1 1 ENT");
    let reported = screen(&mut trainee);
    trainee.give("{\"power\":false}").wait(1.0);
    trainee.give("{\"power\":true}").wait(1.0);
    assert_eq!(screen(&mut trainee).file, reported.file);
}
