//! Program management by keys [003:981-1023], and the tables of the machine.

use crate::support::Trainee;
use bahn_panel::{Mark, Star, WindowKind};
use bahn_parameters::{ControlModel, ListText};

/// What is highlighted in the window.
fn current(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    lines.into_iter().find(|line| line.current).unwrap().text
}

/// Goes down in the directory to a program.
fn highlight(trainee: &mut Trainee, name: &str) {
    for _ in 0..50 {
        if current(trainee).starts_with(name) {
            return;
        }
        trainee.press("DOWN");
    }
    panic!("no {name}");
}

/// The line of a program in the directory.
fn line_of(trainee: &mut Trainee, name: &str) -> Option<String> {
    let lines = trainee.screen().program.lines;
    lines
        .into_iter()
        .map(|line| line.text)
        .find(|text| text.starts_with(name))
}

#[test]
fn a_program_is_made_copied_renamed_and_erased() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 4 7 1 1 ENT");
    assert_eq!(trainee.screen().dialogue.prompt, "MM = ENT / INCH = NO ENT");
    trainee.press("NO_ENT");
    assert_eq!(
        trainee.file("programs/4711.H"),
        "BEGIN PGM 4711 INCH\nEND PGM 4711 INCH\n"
    );
    assert_eq!(trainee.screen().program.title, "4711.H");

    // COPY keeps the type, and the copy knows its name.
    trainee.press("PGM_NR");
    highlight(&mut trainee, "4711");
    trainee.press("SK2 A 1 ENT");
    assert_eq!(
        trainee.file("programs/A1.H"),
        "BEGIN PGM A1 INCH\nEND PGM A1 INCH\n"
    );
    assert!(line_of(&mut trainee, "A1 ").is_some());
    // RENAME: what is there already is no new name.
    highlight(&mut trainee, "A1");
    trainee.press("SK3 4 7 1 1 ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE SK3 B 2 ENT");
    assert_eq!(
        trainee.file("programs/B2.H"),
        "BEGIN PGM B2 INCH\nEND PGM B2 INCH\n"
    );
    assert!(!trainee.has("programs/A1.H"));

    // CL PGM asks before it erases.
    trainee.press("END CL_PGM");
    highlight(&mut trainee, "B2");
    trainee.press("ENT");
    assert_eq!(
        trainee.screen().dialogue.prompt,
        "B2.H: ERASE = ENT / END = NO ENT"
    );
    trainee.press("NO_ENT");
    assert!(trainee.has("programs/B2.H"));
    trainee.press("ENT ENT");
    assert!(!trainee.has("programs/B2.H"));
    // A name that leads out of the memory.
    trainee.press("END PGM_NR POINT POINT ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
}

#[test]
fn a_protected_program_stays() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR");
    highlight(&mut trainee, "CIRCLE");
    let line = line_of(&mut trainee, "CIRCLE").unwrap();
    let bytes = trainee.file("programs/CIRCLE.H").len();
    let words: Vec<&str> = line.split_whitespace().collect();
    assert_eq!(words, ["CIRCLE", ".H", bytes.to_string().as_str()]);
    trainee.press("SK5");
    assert!(line_of(&mut trainee, "CIRCLE").unwrap().ends_with(" P"));
    // Erase and rename are refused, a copy is not.
    trainee.press("SK4 ENT");
    assert_eq!(trainee.messages(), ["PROTECTED PGM"]);
    trainee.press("CE SK3 X 1 ENT");
    assert_eq!(trainee.messages(), ["PROTECTED PGM"]);
    assert!(trainee.has("programs/CIRCLE.H"));
    // Only the code number takes it away.
    trainee.press("CE SK6 1 2 3 ENT");
    assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"]);
    trainee.press("CE CE").number("86357").press("ENT");
    assert!(
        line_of(&mut trainee, "CIRCLE")
            .unwrap()
            .ends_with(&bytes.to_string())
    );
    // The file is as it was.
    assert_eq!(trainee.file("programs/CIRCLE.H").len(), bytes);
}

/// A subprogram that a run has called is its program as the main program is: nobody edits it meanwhile.
#[test]
fn a_called_program_is_not_edited_while_it_runs() {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/8.H", "BEGIN PGM 8 MM\nCALL PGM 9\nEND PGM 8 MM\n");
    trainee.write("programs/9.H", "BEGIN PGM 9 MM\nSTOP\nEND PGM 9 MM\n");
    trainee.ready();
    trainee.press("FULL PGM_NR 8 ENT NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Blinking);
    trainee.press("PROGRAM PGM_NR 9 ENT STOP");
    assert_eq!(trainee.messages(), ["BACKGROUND PROGRAMMING NOT POSSIBLE"]);
    assert!(trainee.file("programs/9.H").contains("\nSTOP\nEND"));
}

#[test]
fn the_program_that_runs_cannot_be_erased() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("FULL PGM_NR C I R C L E ENT NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.press("PROGRAM PGM_NR");
    highlight(&mut trainee, "CIRCLE");
    for key in ["SK4", "SK3", "CL_PGM"] {
        trainee.press(key);
        let said = trainee.messages().pop().unwrap();
        assert_eq!(said, "BACKGROUND PROGRAMMING NOT POSSIBLE", "{key}");
        trainee.press("CE");
    }
    // Another one can.
    highlight(&mut trainee, "INDEX");
    trainee.press("SK4 ENT");
    assert!(!trainee.has("programs/INDEX.H"));
}

#[test]
fn the_tool_table_is_program_0() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 0 ENT");
    let screen = trainee.screen();
    assert_eq!(screen.program.kind, WindowKind::Table);
    assert!(screen.program.title.starts_with("TOOL.T"));
    // The columns of MP7266, the key first.
    let heading: Vec<String> = screen.program.lines[0]
        .text
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    assert_eq!(heading[..5], ["T", "NAME", "L", "R", "R2"]);
    assert_eq!(screen.dialogue.prompt, "TOOL NAME?");

    // Tool 2: L from 95 to 96.5, R is wrong.
    trainee.press("DOWN RIGHT");
    assert_eq!(trainee.screen().dialogue.prompt, "TOOL LENGTH L?");
    trainee.number("96.5");
    let line = trainee.screen().program.lines[2].clone();
    assert!(line.current && line.marks[0].2 == Mark::Entry);
    trainee.press("ENT").number("-1").press("ENT");
    assert!(
        trainee.messages()[0].starts_with("ENTRY VALUE INCORRECT"),
        "{:?}",
        trainee.messages()
    );
    trainee.press("CE CE");
    let file = trainee.file("tools.tsv");
    assert_eq!(file.lines().nth(2).unwrap(), "2\t96.5\t10\t0\tEND MILL D20");
    // A column that the file does not have comes with its first value; other cells stay.
    trainee
        .press("GOTO 1 ENT")
        .press("RIGHT RIGHT")
        .number("0.05")
        .press("ENT");
    let file = trainee.file("tools.tsv");
    assert_eq!(file.lines().next().unwrap(), "T\tL\tR\tR2\tNAME\tDL");
    assert_eq!(
        file.lines().nth(1).unwrap(),
        "1\t70\t31.5\t0\tFACE MILL D63\t0.05"
    );
    // It counts in the control at once, and is there after power-off.
    trainee.wait(0.2);
    let length = |trainee: &Trainee| {
        let remembered = trainee.station.control().remember();
        remembered.written.len()
    };
    assert_eq!(length(&trainee), 0, "the file says it");
    let mut trainee = trainee.killed();
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 0 ENT DOWN RIGHT");
    assert!(current(&mut trainee).contains("96.5"));
}

#[test]
fn lines_of_the_pocket_table_are_marked() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 0 ENT SK7");
    let screen = trainee.screen();
    assert!(screen.program.title.starts_with("TOOL_P.TCH"));
    assert_eq!(screen.dialogue.prompt, "TOOL NUMBER?");
    // A tool is in one pocket only.
    trainee.press("2 ENT");
    assert!(trainee.messages()[0].starts_with("ENTRY VALUE INCORRECT"));
    trainee.press("CE CE RIGHT RIGHT");
    assert_eq!(trainee.screen().dialogue.prompt, "FIXED POCKET? YES=ENT/NO=NOENT");
    trainee.press("ENT");
    let file = trainee.file("pockets.tsv");
    let first: Vec<&str> = file.lines().nth(1).unwrap().split('\t').collect();
    assert_eq!(first[..4], ["1", "1", "", "F"]);
    trainee.press("LEFT NO_ENT");
    let file = trainee.file("pockets.tsv");
    assert_eq!(file.lines().nth(1).unwrap().split('\t').nth(3), Some(""));
}

#[test]
fn a_datum_table_is_made_and_filled() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR Z E R O POINT D ENT");
    let screen = trainee.screen();
    assert_eq!(
        (screen.program.title.as_str(), screen.program.total),
        ("ZERO.D  MM", 1)
    );
    // The actual position of X, and a line of its own.
    let actual: f64 = trainee.position('X').parse().unwrap();
    trainee.press("CAPTURE ENT").number("-5").press("ENT");
    trainee.press("SK5 3 ENT");
    assert_eq!(trainee.screen().program.total, 2);
    let file = trainee.file("programs/ZERO.D");
    let rows: Vec<&str> = file.lines().skip(1).collect();
    assert_eq!(rows[0], format!("0\t{actual:.3}\t-5\t0\t0\t0\t"));
    assert!(rows[1].starts_with("3\t"));
    trainee.press("SK2 SK6 ENT");
    assert_eq!(trainee.screen().program.total, 1);
}

/// What is done to the program that is edited counts for its editor, too.
#[test]
fn a_program_that_is_protected_is_not_edited() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR 9 ENT ENT");
    trainee.press("STOP END");
    assert!(trainee.file("programs/9.H").contains("STOP"));
    trainee.press("PGM_NR");
    highlight(&mut trainee, "9");
    trainee.press("SK5 END");
    let before = trainee.file("programs/9.H");
    assert!(before.contains("BEGIN PGM 9 MM P"));
    trainee.press("STOP");
    assert_eq!(trainee.messages(), ["PROTECTED PGM"]);
    assert_eq!(trainee.file("programs/9.H"), before);
}

/// What the operator chose is a file; one that cannot be read is said once and kept, and the panel has what it had at
/// first.
#[test]
fn settings_that_cannot_be_read_are_said_and_kept() {
    let mut trainee = Trainee::with("mill", |folder| {
        std::fs::create_dir_all(folder.join("state")).unwrap();
        std::fs::write(folder.join("state/panel.json"), "{\"inch\": tru").unwrap();
    });
    trainee.until(5.0, |screen| screen.messages.len() > 1);
    let said = "WHAT THE OPERATOR HAS CHOSEN CANNOT BE READ: panel.json -> panel.unread.json: ";
    let messages = trainee.messages();
    assert!(messages.iter().any(|text| text.starts_with(said)), "{messages:?}");
    assert_eq!(trainee.file("state/panel.unread.json"), "{\"inch\": tru");
    assert!(!trainee.has("state/panel.json"));
    trainee.press("CE CE").wait(1.0);
    let mut again = trainee.killed();
    again.until(5.0, |screen| !screen.messages.is_empty());
    let messages = again.messages();
    assert!(
        !messages.iter().any(|text| text.starts_with(said)),
        "{messages:?}"
    );
}

/// The cycles of the machine builder are programs; where one of them cannot be read there are none, and that is said.
#[cfg(target_os = "linux")]
#[test]
fn cycles_of_the_machine_builder_that_cannot_be_read_are_said() {
    let mut trainee = Trainee::at("mill");
    // A file that is there, and whose medium fails at the first byte.
    let failing = trainee.folder().join("programs/99999968.H");
    std::os::unix::fs::symlink("/proc/self/mem", failing).unwrap();
    trainee.ready();
    trainee.press("PROGRAM").wait(0.2);
    let messages = trainee.messages();
    let said = "CYCLES OF THE MACHINE BUILDER CANNOT BE READ: ";
    assert!(messages.iter().any(|text| text.starts_with(said)), "{messages:?}");
    trainee.press("CE PGM_NR 7 ENT ENT").wait(0.2);
    assert_eq!(trainee.screen().program.title, "7.H");
}

/// Program names of a TNC 360 have up to eight characters [003:979]; MP7222 allows 8, 12 or 16 later [000:6847-6852].
#[test]
fn names_are_as_long_as_mp7222_says() {
    for (machine, value, longest) in [
        ("mill-tnc360", "0", 8),
        ("mill", "0", 8),
        ("mill", "1", 12),
        ("mill", "2", 16),
    ] {
        let mut trainee = Trainee::with(machine, |folder| {
            let path = folder.join("parameters.mp");
            let list = std::fs::read_to_string(&path).unwrap();
            let old = list.lines().find(|line| line.starts_with("MP7222 ")).unwrap();
            std::fs::write(&path, list.replace(old, &format!("MP7222 : {value}"))).unwrap();
        });
        trainee.ready();
        let names = [longest, longest + 1].map(|length| "1234567890123456789"[..length].to_owned());
        trainee
            .press("PROGRAM PGM_NR")
            .give(&format!("{{\"text\":\"{}\"}}", names[0]));
        trainee.press("ENT ENT");
        assert!(
            trainee.has(&format!("programs/{}.H", names[0])),
            "{machine} {value}"
        );
        if names[1].len() <= 16 {
            trainee
                .press("PGM_NR")
                .give(&format!("{{\"text\":\"{}\"}}", names[1]));
            trainee.press("ENT");
            assert_eq!(trainee.messages(), ["ENTRY VALUE INCORRECT"], "{machine} {value}");
        }
    }
}

/// A TNC 360 stores up to 32 programs [003:977]; `files_max` of the machine lifts it.
#[test]
fn a_tnc_360_stores_32_programs() {
    for lifted in [false, true] {
        let mut trainee = Trainee::with("mill-tnc360", |folder| {
            let there = std::fs::read_dir(folder.join("programs")).unwrap().flatten();
            let there = there.filter(|file| file.path().extension().is_some_and(|ending| ending == "H"));
            for number in there.count()..31 {
                let text = format!("BEGIN PGM {number} MM\nEND PGM {number} MM\n");
                std::fs::write(folder.join(format!("programs/{number}.H")), text).unwrap();
            }
            if lifted {
                let path = folder.join("machine.toml");
                let text = std::fs::read_to_string(&path).unwrap();
                std::fs::write(&path, format!("files_max = 0\n{text}")).unwrap();
            }
        });
        trainee.ready();
        trainee.press("PROGRAM PGM_NR 9 0 1 ENT ENT");
        assert!(trainee.has("programs/901.H"), "the 32nd");
        trainee.press("PGM_NR 9 0 2 ENT");
        let full = trainee.messages() == ["FURTHER PROGRAM ENTRY IMPOSSIBLE"];
        assert_eq!(full, !lifted, "{:?}", trainee.messages());
    }
}

/// A TNC 407 and later store up to 100 files of all types [000:171]: programs, tables and texts count alike.
#[test]
fn a_tnc_407_stores_100_files() {
    for model in ["tnc407", "tnc415b"] {
        let mut trainee = Trainee::with("mill", |folder| {
            let there = std::fs::read_dir(folder.join("programs")).unwrap().flatten();
            let there = there.filter(|file| file.path().is_file()).count();
            for number in there..99 {
                std::fs::write(folder.join(format!("programs/{number}.A")), "").unwrap();
            }
            let path = folder.join("machine.toml");
            let text = std::fs::read_to_string(&path).unwrap();
            std::fs::write(
                &path,
                text.replace("model = \"tnc415b\"", &format!("model = \"{model}\"")),
            )
            .unwrap();
            // The list of the mill without what the model does not have.
            let path = folder.join("parameters.mp");
            let own = model.parse::<ControlModel>().unwrap();
            let mut list = ListText::from_bytes(own, &std::fs::read(&path).unwrap());
            while let Some(line) = list.faults().last().map(|fault| fault.span.line as usize) {
                list.remove_line(line);
            }
            std::fs::write(&path, list.to_bytes()).unwrap();
        });
        trainee.ready();
        assert_eq!(trainee.station.control().model().id(), model);
        trainee.press("PROGRAM PGM_NR 9 0 1 ENT ENT");
        assert!(
            trainee.has("programs/901.H"),
            "the 100th: {:?}",
            trainee.messages()
        );
        trainee.press("PGM_NR 9 0 2 ENT");
        assert_eq!(trainee.messages(), ["FURTHER PROGRAM ENTRY IMPOSSIBLE"]);
        assert!(!trainee.has("programs/902.H"));
    }
}

/// In the directory of a TNC 360 programs in DIN/ISO are indicated with "ISO" [003:977].
#[test]
fn iso_programs_are_indicated() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.write("programs/12.H", "BEGIN PGM 12 MM\nEND PGM 12 MM\n");
    trainee.write("programs/13.I", "%13 G71\nN9999 %13 G71\n");
    trainee.ready();
    trainee.press("PROGRAM PGM_NR");
    let words = |trainee: &mut Trainee, name: &str| {
        let line = line_of(trainee, name).unwrap();
        line.split_whitespace().nth(1).unwrap().to_owned()
    };
    assert_eq!(words(&mut trainee, "13 "), "ISO");
    assert!(words(&mut trainee, "12 ").parse::<u32>().is_ok(), "its size");
}

/// RESET POCKET TABLE empties the pockets, EDIT OFF protects the cells, NEXT LINE goes to the beginning of the line below
/// [000:9058-9073].
#[test]
fn the_soft_keys_of_the_pocket_table() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("SK8");
    trainee.soft("POCKET TABLE");
    let tools = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        let cells = lines
            .iter()
            .skip(1)
            .map(|line| line.text.split_whitespace().nth(1).map(str::to_owned));
        cells
            .flatten()
            .filter(|cell| cell.parse::<u32>().is_ok_and(|tool| tool > 0))
            .count()
    };
    assert!(tools(&mut trainee) > 0);
    let place = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        let at = lines.iter().position(|line| line.current).unwrap();
        (at, lines[at].marks[0].0)
    };
    let (first, column) = place(&mut trainee);
    trainee.press("RIGHT");
    assert!(place(&mut trainee).1 > column);
    trainee.soft("NEXT LINE");
    assert_eq!(place(&mut trainee), (first + 1, column));
    trainee.soft("EDIT OFF");
    trainee.press("7");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE");
    trainee.soft("EDIT ON");
    trainee.soft("RESET POCKET TABLE");
    trainee.press("NO_ENT");
    assert!(tools(&mut trainee) > 0, "not confirmed");
    trainee.soft("RESET POCKET TABLE");
    trainee.press("ENT").wait(0.3);
    assert_eq!(trainee.messages(), [""; 0]);
    assert_eq!(tools(&mut trainee), 0, "{:#?}", trainee.screen().program);
}

/// Tool tables that MP7224.0 disables stay closed [000:9101].
#[test]
fn disabled_tables_stay_closed() {
    let mut trainee = Trainee::with("mill", |folder| {
        let path = folder.join("parameters.mp");
        let list = std::fs::read_to_string(&path).unwrap();
        let old = list.lines().find(|line| line.starts_with("MP7224.0 ")).unwrap();
        std::fs::write(&path, list.replace(old, "MP7224.0 : %00000100")).unwrap();
    });
    trainee.ready();
    assert!(!trainee.screen().soft_keys.keys.contains(&"TOOL TABLE".to_owned()));
    trainee.press("ENT");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE TOOL_DEF");
    assert_eq!(trainee.messages(), ["PROGRAM NOT FOUND"]);
    trainee.press("CE FULL");
    assert!(!trainee.screen().soft_keys.keys.contains(&"TOOL TABLE".to_owned()));
}
