//! A list of machine parameters that is empty or has faults is presented when the control is switched on; several lists,
//! their transfer, and everything of the machine as one file [000:463-467] [000:10007-10074].

use std::path::Path;

use crate::support::Trainee;
use bahn_host::backup::Restore;
use bahn_panel::{Input, TransferAction, TransferFiles};

/// The mill with something else in its list.
fn with(change: impl Fn(&str) -> String) -> Trainee {
    Trainee::with("mill", |folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(path, change(&text)).unwrap();
    })
}

fn current(trainee: &mut Trainee) -> String {
    let lines = trainee.screen().program.lines;
    lines
        .into_iter()
        .find(|line| line.current)
        .map(|line| line.text)
        .unwrap_or_default()
}

fn shows(trainee: &mut Trainee, text: &str) -> bool {
    let lines = trainee.screen().program.lines;
    lines.iter().any(|line| line.text.contains(text))
}

fn code(trainee: &mut Trainee, code: &str) {
    trainee.press("PROGRAM MOD");
    trainee.down_to("CODE NUMBER");
    trainee.press("ENT").number(code).press("ENT");
}

fn news(trainee: &mut Trainee, text: &str) {
    trainee.give(&format!("{{\"transfer\":\"{text}\"}}"));
}

/// "Missing or incorrect entries result in error messages that prompt you to correct your entry" [000:10050-10062].
#[test]
fn a_faulty_list_is_presented_and_the_control_goes_on_when_it_is_whole() {
    let mut trainee = with(|list| {
        // The feed of Y is no number, and a line names no parameter of the control.
        let list = list.replace("MP1020.1 : 3000", "MP1020.1 : fast ;manual feed");
        list + "MP9 : 1\n"
    });
    trainee.wait(0.1);
    let screen = trainee.screen();
    assert_eq!(screen.program.title, "MACHINE PARAMETERS");
    assert!(trainee.station.control().is_off());
    // The first fault has the cursor, with its number and text.
    assert!(current(&mut trainee).contains("fast"), "{:#?}", screen.program);
    assert!(shows(&mut trainee, "3 Entry value incorrect: MP1020.1"));
    // END prompts for it; nothing else has the keys.
    trainee.press("END");
    assert!(trainee.messages()[0].contains("3 Entry value incorrect"));
    trainee.press("CE MANUAL");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    trainee.press("CE").give(r#"{"power":true}"#).wait(0.1);
    assert!(trainee.station.control().is_off());
    trainee.number("600").press("ENT END");
    assert!(
        trainee.messages()[0].contains("1 Invalid MP number"),
        "{:?}",
        trainee.messages()
    );
    assert!(current(&mut trainee).ends_with("MP9 : 1"));
    // A comment belongs to a parameter, which this line has not.
    trainee.press("CE");
    trainee.soft(";");
    assert_eq!(trainee.messages(), ["KEY NON-FUNCTIONAL"]);
    assert_ne!(trainee.screen().dialogue.prompt, ";");
    trainee.press("CE DEL END");
    // It is whole: as after any power-on.
    trainee.ready();
    let list = trainee.file("parameters.mp");
    let line = list.lines().find(|line| line.starts_with("MP1020.1")).unwrap();
    assert!(
        line.contains(": 600 ") && line.ends_with(";manual feed"),
        "{line}"
    );
    assert!(!list.contains("MP9 "));
    assert_eq!(
        trainee.station.control().first().edited_list().get(1020, 1),
        Some(600.0)
    );
}

/// While the list is entered nobody goes to another moment, or begins a lesson: nothing goes on before it is whole.
#[test]
fn nobody_goes_elsewhere_while_the_list_is_entered() {
    let mut trainee = with(|list| list.replace("MP10     : %01111", "MP10 : ?"));
    trainee.wait(0.5);
    let refused = trainee.station.go_to(0.1).unwrap_err();
    assert_eq!(refused.to_string(), "KEY NON-FUNCTIONAL");
    let lesson = trainee.station.lessons()[0].0.clone();
    let refused = trainee.station.input(&Input::Lesson(Some(lesson))).unwrap_err();
    assert_eq!(refused.to_string(), "KEY NON-FUNCTIONAL");
    trainee.wait(0.1);
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
    assert!(trainee.station.control().is_off());
}

/// What the machine kept is what it was: the datum that was set before the list was damaged.
#[test]
fn what_is_kept_survives_a_faulty_list() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.give(r#"{"action":"datum X 12.5"}"#).wait(0.5);
    trainee.station.store().unwrap();
    let kept_datums = trainee.station.control().remember().datums;
    let list = trainee.file("parameters.mp");
    trainee.write("parameters.mp", &list.replace("MP10     : %01111", "MP10 : ?"));
    let kept = trainee.file("state/control.toml");
    let mut trainee = trainee.killed();
    trainee.wait(1.0);
    assert_eq!(trainee.file("state/control.toml"), kept);
    trainee.press("SK1").number("1111").press("END");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    assert_eq!(trainee.messages(), ["POWER INTERRUPTED"]);
    assert_eq!(trainee.station.control().remember().datums, kept_datums);
}

/// "If during commissioning no entries are made, the TNC will generate a standard machine parameter list when the END key is
/// pressed": a programming station (MP7210 = 1) with all other values at their minimum [000:10066-10070].
#[test]
fn an_empty_list_becomes_the_standard_list() {
    for missing in [false, true] {
        let mut trainee = Trainee::with("mill", |folder| {
            std::fs::write(folder.join("parameters.mp"), "").unwrap();
            if missing {
                std::fs::remove_file(folder.join("parameters.mp")).unwrap();
            }
        });
        trainee.wait(0.1);
        assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
        trainee.press("END");
        assert!(!trainee.station.control().is_off(), "{:?}", trainee.messages());
        let list = trainee.station.control().first().edited_list();
        assert_eq!((list.get(7210, 0), list.get(10, 0)), (Some(1.0), Some(0.0)));
        assert!(
            trainee
                .file("parameters.mp")
                .lines()
                .any(|line| line.starts_with("MP7210"))
        );
    }
}

/// Values of an empty list are entered by hand, and count [000:10011].
#[test]
fn an_empty_list_is_entered_by_hand() {
    let mut trainee = Trainee::with("mill", |folder| {
        std::fs::write(folder.join("parameters.mp"), "").unwrap();
    });
    trainee.wait(0.1);
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT").wait(0.1);
    trainee.number("750").press("END").wait(0.1);
    assert!(!trainee.station.control().is_off(), "{:?}", trainee.messages());
    let list = trainee.station.control().first().edited_list();
    assert_eq!(list.get(1020, 1), Some(750.0));
}

/// "The desired list can be selected in the machine parameter editor by pressing the PGM NAME key and the SELECT soft key. The
/// list which is active when you exit the editor goes into effect" [000:10072-10074].
#[test]
fn one_of_several_lists_is_selected() {
    let mut trainee = Trainee::with("mill", |folder| {
        let list = std::fs::read_to_string(folder.join("parameters.mp")).unwrap();
        let slow = list.replace("MP1020.1 : 3000", "MP1020.1 : 600");
        std::fs::write(folder.join("SLOW.MP"), slow).unwrap();
        std::fs::write(folder.join("WRONG.MP"), "MP1020.1 : x\n").unwrap();
    });
    trainee.ready();
    let starts = trainee.station.control().starts();
    let feed = |trainee: &Trainee| trainee.station.control().first().edited_list().get(1020, 1);
    code(&mut trainee, "95148");
    // What was entered into the list in force acts when another one is chosen, as with END.
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT").wait(0.1);
    trainee.number("2900").press("ENT PGM_NR");
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETER LISTS");
    assert!(current(&mut trainee).starts_with("parameters.mp") && current(&mut trainee).ends_with("ACTIVE"));
    // A faulty list goes into no effect, and what is wrong stands there.
    trainee.down_to("WRONG.MP");
    trainee.soft("SELECT");
    trainee.wait(0.1).press("END");
    assert!(
        trainee.messages()[0].contains("3 Entry value incorrect"),
        "{:?}",
        trainee.messages()
    );
    assert_eq!(trainee.station.control().starts(), starts);
    assert_eq!(feed(&trainee), Some(2900.0));
    assert!(trainee.file("parameters.mp").contains("MP1020.1 : 2900"));
    trainee.press("CE PGM_NR");
    trainee.down_to("SLOW.MP");
    trainee.soft("SELECT");
    trainee.wait(0.1);
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS  SLOW.MP");
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT").wait(0.1);
    assert!(current(&mut trainee).contains("600"));
    // What is entered belongs to this list.
    trainee.number("450").press("END").wait(0.1);
    assert_eq!(trainee.station.control().starts(), starts + 1);
    assert_eq!(feed(&trainee), Some(450.0));
    assert!(trainee.file("parameters.mp").contains("MP1020.1 : 2900"));
    // It stays selected over power-off.
    trainee.wait(0.5).station.store().unwrap();
    let mut trainee = trainee.killed();
    trainee.wait(0.1);
    assert_eq!(feed(&trainee), Some(450.0));
    // And back to the usual one.
    trainee.ready();
    code(&mut trainee, "95148");
    trainee.press("PGM_NR UP UP ENT").wait(0.1);
    trainee.press("END").wait(0.1);
    assert_eq!(feed(&trainee), Some(2900.0));
    assert_eq!(trainee.station.control().remember().parameter_list, None);
}

/// PGM NAME leaves a list as END does: "Missing or incorrect entries result in error messages that prompt you to correct your
/// entry" [000:10050-10062], and what is half typed belongs to the list in which it was typed.
#[test]
fn a_list_that_pgm_name_leaves_is_checked() {
    let mut trainee = Trainee::with("mill", |folder| {
        let list = std::fs::read_to_string(folder.join("parameters.mp")).unwrap();
        std::fs::write(folder.join("SLOW.MP"), list).unwrap();
    });
    trainee.ready();
    let before = trainee.file("parameters.mp");
    code(&mut trainee, "95148");
    // X follows the 5th axis, which there is not (MP10): no machine can be so [000:4467-4486].
    trainee.press("GOTO 8 5 0 ENT").wait(0.1);
    trainee.number("5").press("ENT PGM_NR");
    trainee.down_to("SLOW.MP");
    trainee.soft("SELECT");
    trainee.wait(0.1);
    assert!(
        trainee.messages().iter().any(|text| text.starts_with("MP850")),
        "{:?}",
        trainee.messages()
    );
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
    assert_eq!(trainee.file("parameters.mp"), before);
    // Corrected, it is left. What is typed there without ENT is taken, and does not appear in the other list.
    trainee.press("CE GOTO 8 5 0 ENT").wait(0.1);
    trainee.number("0").press("GOTO 1 0 2 0 POINT 1 ENT").wait(0.1);
    trainee.number("2800").press("PGM_NR");
    trainee.down_to("SLOW.MP");
    trainee.soft("SELECT");
    trainee.wait(0.1);
    assert_eq!(trainee.messages(), [""; 0]);
    let screen = trainee.screen();
    assert_eq!(
        (screen.program.title.as_str(), screen.dialogue.entry.as_str()),
        ("MACHINE PARAMETERS  SLOW.MP", "")
    );
    assert!(trainee.file("parameters.mp").contains("MP1020.1 : 2800"));
    let feed = |trainee: &Trainee| trainee.station.control().first().edited_list().get(1020, 1);
    assert_eq!(feed(&trainee), Some(2800.0));
    assert_eq!(trainee.station.control().remember().parameter_list, None);
    // What is typed and out of its range stays where it was typed.
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT").wait(0.1);
    trainee.number("999999").press("PGM_NR UP UP ENT").wait(0.1);
    assert!(
        trainee.messages()[0].contains("3 Entry value incorrect"),
        "{:?}",
        trainee.messages()
    );
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS  SLOW.MP");
    assert!(trainee.file("SLOW.MP").contains("MP1020.1 : 3000"));
}

/// "The data interface is activated by pressing the EXT key": FE1 with 9600 baud at first [000:10011].
#[test]
fn lists_are_transferred() {
    let mut trainee = Trainee::at("mill");
    let orders = trainee.station.transfer_orders();
    trainee.ready();
    news(&mut trainee, "connected 0");
    code(&mut trainee, "95148");
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT");
    trainee.press("EXT DOWN DOWN DOWN ENT");
    assert_eq!(trainee.screen().dialogue.prompt, "FILE NAME =");
    trainee.typed("NEW").press("ENT");
    let order = orders.try_recv().unwrap();
    assert_eq!(order.action, TransferAction::Read("NEW.MP".to_owned()));
    assert_eq!(
        (order.files, order.mode, order.kind),
        (TransferFiles::Lists, bahn_parameters::interfaces::Mode::Fe1, "MP")
    );
    news(&mut trainee, "ended complete");
    trainee.press("END DOWN ENT");
    assert!(shows(&mut trainee, "PARAMETERS.MP"));
    trainee.press("ENT");
    let order = orders.try_recv().unwrap();
    assert_eq!(
        order.action,
        TransferAction::Write(vec!["PARAMETERS.MP".to_owned()])
    );
    news(&mut trainee, "ended complete");
    // A list that came in the place of the one in force goes into effect when the editor is left.
    let list = trainee.file("parameters.mp");
    trainee.write(
        "parameters.mp",
        &list.replace("MP1020.1 : 3000", "MP1020.1 : 700"),
    );
    trainee.press("END END").wait(0.1);
    // It stands there as soon as the editor has the keys again.
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
    assert!(
        current(&mut trainee).contains(": 700"),
        "{}",
        current(&mut trainee)
    );
    trainee.press("END").wait(0.1);
    assert_eq!(
        trainee.station.control().first().edited_list().get(1020, 1),
        Some(700.0)
    );
}

/// In commissioning, too: the list comes over the data interface.
#[test]
fn a_list_comes_over_the_data_interface_while_commissioning() {
    let mut trainee = with(|_| "MP10 : x\n".to_owned());
    let orders = trainee.station.transfer_orders();
    news(&mut trainee, "connected 0");
    trainee
        .press("EXT DOWN DOWN DOWN ENT")
        .typed("PARAMETERS")
        .press("ENT");
    let order = orders.try_recv().unwrap();
    assert_eq!(order.action, TransferAction::Read("PARAMETERS.MP".to_owned()));
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/mill/parameters.mp");
    std::fs::copy(shipped, trainee.folder().join("parameters.mp")).unwrap();
    news(&mut trainee, "received PARAMETERS.MP");
    news(&mut trainee, "ended complete");
    trainee.press("END END END");
    trainee.ready();
}

/// BACKUP DATA sends all files as the one file $BACKUP; RESTORE DATA makes the machine what it was then [000:463-467].
#[test]
fn everything_is_backed_up_and_restored() {
    let mut trainee = Trainee::at("mill");
    let orders = trainee.station.transfer_orders();
    trainee.ready();
    news(&mut trainee, "connected 0");
    let (list, programs) = (trainee.file("parameters.mp"), trainee.file("programs/CIRCLE.H"));
    code(&mut trainee, "95148");
    trainee.press("MOD");
    trainee.soft("BACKUP DATA");
    let order = orders.try_recv().unwrap();
    assert_eq!(order.files, TransferFiles::Backup);
    assert_eq!(order.action, TransferAction::Write(vec!["$BACKUP.A".to_owned()]));
    let text = trainee.file("programs/$BACKUP.A");
    news(&mut trainee, "sent $BACKUP.A");
    news(&mut trainee, "ended complete");
    assert!(!trainee.has("programs/$BACKUP.A"));
    // Every kind of file is in it, and it reads as a backup.
    for path in [
        "parameters.mp",
        "plc/MAIN.PLC",
        "plc/MAIN.ER1",
        "programs/CIRCLE.H",
        "tools.tsv",
        "state/control.toml",
    ] {
        assert!(
            text.lines()
                .any(|line| line.starts_with("FILE ") && line.ends_with(path)),
            "{path}"
        );
    }
    let elsewhere = trainee.folder().join("elsewhere");
    let mut restore = Restore::new(&elsewhere);
    std::fs::create_dir(&elsewhere).unwrap();
    text.lines().for_each(|line| restore.line(line).unwrap());
    assert!(restore.commit().unwrap() > 10);
    // Software replacement: other files, then RESTORE DATA.
    trainee.write(
        "parameters.mp",
        &list.replace("MP1020.1 : 3000", "MP1020.1 : 700"),
    );
    trainee.write("programs/CIRCLE.H", "BEGIN PGM CIRCLE MM\nEND PGM CIRCLE MM\n");
    trainee.press("END END MOD");
    trainee.soft("RESTORE DATA");
    trainee.press("ENT");
    let order = orders.try_recv().unwrap();
    assert_eq!(order.action, TransferAction::Read("$BACKUP.A".to_owned()));
    trainee.write("programs/$BACKUP.A", &text);
    news(&mut trainee, "received $BACKUP.A");
    news(&mut trainee, "ended complete");
    assert_eq!(trainee.file("parameters.mp"), list);
    assert_eq!(trainee.file("programs/CIRCLE.H"), programs);
    assert!(!trainee.has("programs/$BACKUP.A"));
    trainee.ready();
    // A damaged backup changes nothing, and is said.
    code(&mut trainee, "95148");
    trainee.press("MOD");
    trainee.soft("RESTORE DATA");
    trainee.press("ENT");
    trainee.write("programs/$BACKUP.A", &text[..text.len() / 2]);
    news(&mut trainee, "received $BACKUP.A");
    news(&mut trainee, "ended complete");
    assert!(!trainee.messages().is_empty());
    assert_eq!(trainee.file("parameters.mp"), list);
    assert!(!trainee.station.control().is_off());
}

/// The lists of further channels are machine parameters as well: one that is missing or has faults is presented, the first one
/// first, and the control goes on when all are whole [000:10011] [000:10050-10066].
#[test]
fn a_faulty_list_of_a_further_channel_is_presented() {
    // Damages a line of a list, and mends it.
    let damage = |list: &str| list.replacen("MP1020.1 :", "MP1020.1 : fast ;", 1);
    for both in [false, true] {
        let mut whole = String::new();
        let mut trainee = Trainee::with("twin", |folder| {
            for name in if both {
                &["left.mp", "right.mp"][..]
            } else {
                &["right.mp"]
            } {
                let text = std::fs::read_to_string(folder.join(name)).unwrap();
                assert_ne!(text, damage(&text), "{name}");
                std::fs::write(folder.join(name), damage(&text)).unwrap();
            }
            whole = std::fs::read_to_string(folder.join("machine.toml")).unwrap();
        });
        trainee.wait(0.1);
        assert!(trainee.station.control().is_off());
        if both {
            assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
            trainee.number("600").press("ENT END").wait(0.1);
            assert!(trainee.station.control().is_off(), "{:?}", trainee.messages());
        }
        assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS  right.mp");
        assert!(
            current(&mut trainee).contains("fast"),
            "{:#?}",
            trainee.screen().program
        );
        trainee.press("END");
        assert!(trainee.messages()[0].contains("3 Entry value incorrect"));
        trainee.press("CE").number("600").press("ENT END");
        assert_eq!(trainee.station.control().channels(), 2);
        trainee.until(5.0, |screen| !screen.messages.is_empty());
        assert_eq!(trainee.messages(), ["POWER INTERRUPTED"]);
        assert_eq!(trainee.file("machine.toml"), whole);
    }
}

/// The right channel runs a program: no list is written or goes into effect, and the editor says so.
#[test]
fn no_list_goes_into_effect_while_another_channel_runs() {
    let mut trainee = Trainee::with("twin", |folder| {
        let list = std::fs::read_to_string(folder.join("left.mp")).unwrap();
        std::fs::write(folder.join("SLOW.MP"), list).unwrap();
    });
    trainee.ready();
    let before = trainee.file("left.mp");
    code(&mut trainee, "95148");
    trainee.press("GOTO 1 0 2 0 POINT 1 ENT").wait(0.1);
    trainee.number("450").press("ENT");
    // Its axes pass their reference marks, too.
    trainee.give(r#"{"action":"key START2 tap"}"#).wait(60.0);
    trainee.give(r#"{"action":"2: mode full"}"#).wait(0.5);
    trainee.give(r#"{"action":"2: select RIGHT.H"}"#);
    trainee.give(r#"{"action":"key START2 tap"}"#).wait(2.0);
    let runs = |trainee: &Trainee| trainee.station.control().channel(1).unwrap().is_active();
    let right = trainee.station.control().channel(1).unwrap();
    assert!(
        runs(&trainee),
        "{:?} {:?}",
        right.mode(),
        trainee.station.control().shown()
    );
    for list in ["", "SLOW.MP"] {
        if !list.is_empty() {
            trainee.press("CE PGM_NR");
            trainee.down_to(list);
            trainee.soft("SELECT");
            trainee.wait(0.1);
        }
        trainee.press("END").wait(0.1);
        assert!(
            trainee.messages().contains(&"KEY NON-FUNCTIONAL".to_owned()),
            "{:?}",
            trainee.messages()
        );
        assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
        assert_eq!(trainee.file("left.mp"), before);
        assert!(runs(&trainee));
    }
    // Nothing was entered: the other list is shown, and does not go into effect, either.
    trainee.press("CE CE");
    trainee.soft("QUIT");
}

/// An empty list of a TNC 155: OPERATING PARAMTERS ERASED, and the control asks for MP0 [001:2483-2499].
#[test]
fn an_empty_list_of_a_tnc_155_is_said_in_its_words() {
    let mut trainee = Trainee::with("mill", |folder| {
        let change = |name: &str, to: &dyn Fn(String) -> String| {
            let path = folder.join(name);
            let text = std::fs::read_to_string(&path).unwrap();
            std::fs::write(path, to(text)).unwrap();
        };
        change("machine.toml", &|text| text.replace("\"tnc415b\"", "\"tnc155\""));
        // Its boards have fewer inputs.
        change("plant.toml", &|text| {
            (128..=152).fold(text, |text, number| {
                text.replace(&format!("I{number}\""), &format!("I{}\"", number - 40))
            })
        });
        std::fs::write(folder.join("parameters.mp"), "").unwrap();
        std::fs::write(folder.join("plc/MAIN.PLC"), "       EM\n").unwrap();
    });
    trainee.wait(0.1);
    assert_eq!(trainee.messages(), ["OPERATING PARAMTERS ERASED"]);
    trainee.press("CE");
    assert_eq!(trainee.messages(), [""; 0]);
    assert_eq!(trainee.screen().dialogue.prompt, "MACHINE PARAMETER MP0 ?");
}
