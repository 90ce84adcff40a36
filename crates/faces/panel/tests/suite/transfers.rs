//! EXT at the panel: orders go out, and what happens at the line comes back.

use std::sync::mpsc::Receiver;

use crate::support::Trainee;
use bahn_panel::{Star, TransferAction, TransferOrder};
use bahn_parameters::interfaces::Mode;

/// A trainee with RS-232-C connected, at the menu of EXT.
fn connected() -> (Trainee, Receiver<TransferOrder>) {
    let mut trainee = Trainee::at("mill");
    let orders = trainee.station.transfer_orders();
    trainee.ready();
    news(&mut trainee, "connected 0");
    trainee.press("PROGRAM EXT");
    (trainee, orders)
}

fn news(trainee: &mut Trainee, text: &str) {
    trainee.give(&format!("{{\"transfer\":\"{text}\"}}"));
}

fn actions(orders: &Receiver<TransferOrder>) -> Vec<TransferAction> {
    orders.try_iter().map(|order| order.action).collect()
}

fn lines(trainee: &mut Trainee) -> Vec<String> {
    let window = trainee.screen().program;
    window.lines.into_iter().map(|line| line.text).collect()
}

#[test]
fn the_menu_is_that_of_the_manual() {
    let (mut trainee, _orders) = connected();
    assert_eq!(trainee.screen().dialogue.prompt, "SELECTION = ENT / END = NO ENT");
    // [003:6893-6900], and the output with acknowledgement [000:17283].
    assert_eq!(
        lines(&mut trainee),
        [
            "PROGRAM DIRECTORY",
            "READ-IN ALL PROGRAMS",
            "READ-IN PROGRAM OFFERED",
            "READ-IN SELECTED PROGRAM",
            "READ-OUT SELECTED PROGRAM",
            "READ-OUT ALL PROGRAMS",
            "READ-OUT PROGRAM OFFERED",
        ]
    );
    trainee.press("NO_ENT");
    assert_ne!(trainee.screen().program.title, "EXTERNAL DATA TRANSFER");
}

#[test]
fn every_line_of_the_menu_orders_what_it_says() {
    let (mut trainee, orders) = connected();
    trainee.write("programs/7.I", "%7 G71 *\nN99999 %7 G71 *\n");
    for (down, action) in [
        (0, TransferAction::Directory),
        (1, TransferAction::ReadAll),
        (2, TransferAction::ReadOffered),
    ] {
        trainee.press(&"DOWN ".repeat(down)).press("ENT");
        assert_eq!(actions(&orders), [action]);
        news(&mut trainee, "ended complete");
        trainee.press("END END EXT");
    }
    trainee.press("DOWN DOWN DOWN ENT 1 5 ENT");
    assert_eq!(actions(&orders), [TransferAction::Read("15.H".into())]);
    news(&mut trainee, "ended complete");
    trainee.press("END DOWN ENT 7 POINT I ENT");
    assert_eq!(actions(&orders), [TransferAction::Write(vec!["7.I".into()])]);
    news(&mut trainee, "sent 7.I");
    news(&mut trainee, "ended complete");
    assert_eq!(lines(&mut trainee), ["7.I  READ OUT", "COMPLETE"]);
    trainee.press("END DOWN ENT");
    let all = actions(&orders);
    let TransferAction::Write(names) = &all[0] else {
        panic!("{all:?}");
    };
    assert!(names.contains(&"7.I".to_owned()) && names.len() > 1, "{names:?}");
}

#[test]
fn the_interface_is_the_one_that_mod_says() {
    let (mut trainee, orders) = connected();
    news(&mut trainee, "connected 1");
    trainee.press("END MOD");
    trainee.down_to("DATA INTERFACES");
    trainee.press("ENT");
    trainee.down_to("RS-422 INTERFACE");
    trainee.press("RIGHT");
    trainee.down_to("ASSIGNMENT: FILES");
    trainee.press("RIGHT END END EXT ENT");
    let order = orders.try_recv().unwrap();
    assert_eq!((order.port, order.mode, order.baud), (1, Mode::Fe2, 9600));
}

#[test]
fn the_machine_goes_on_and_a_program_that_runs_is_not_replaced() {
    let (mut trainee, orders) = connected();
    trainee.write(
        "programs/15.H",
        "BEGIN PGM 15 MM\nL X+50 R0 F500\nL X+0 R0 F500\nEND PGM 15 MM\n",
    );
    trainee.press("END FULL PGM_NR 1 5 ENT NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    trainee.press("PROGRAM EXT DOWN ENT");
    assert_eq!(actions(&orders), [TransferAction::ReadAll]);
    news(&mut trainee, "received 14.H");
    // ERASE/OVERREAD of the program that runs is refused without a question, that of another one is asked.
    news(&mut trainee, "overread 15.H");
    assert_eq!(actions(&orders), [TransferAction::Answer(false)]);
    assert_eq!(trainee.messages(), ["15.H: BACKGROUND PROGRAMMING NOT POSSIBLE"]);
    trainee.press("CE");
    news(&mut trainee, "overread 16.H");
    assert_eq!(
        trainee.screen().dialogue.prompt,
        "ERASE/OVERREAD 16.H: YES = ENT / NO = NO ENT"
    );
    trainee.press("ENT");
    assert_eq!(actions(&orders), [TransferAction::Answer(true)]);
    assert_eq!(trainee.screen().status.star, Star::Steady);
    // Another transfer has to wait, whatever page was left meanwhile.
    trainee.press("TEST EXT");
    assert_eq!(lines(&mut trainee), ["14.H  READ IN"]);
    trainee.press("END");
    assert_eq!(actions(&orders), [TransferAction::End]);
    news(&mut trainee, "message PROGRAM INCOMPLETE");
    news(&mut trainee, "ended incomplete");
    assert_eq!(trainee.messages(), ["PROGRAM INCOMPLETE"]);
    assert_eq!(
        lines(&mut trainee),
        ["14.H  READ IN", "PROGRAM INCOMPLETE", "NOT COMPLETE"]
    );
    trainee.until(60.0, |screen| screen.status.star == Star::Off);
}

#[test]
fn a_program_of_the_directory_is_read_in() {
    let (mut trainee, orders) = connected();
    trainee.press("ENT");
    for line in ["listed 15.H 2", "listed 16.H 4", "free 1200", "ended complete"] {
        news(&mut trainee, line);
    }
    trainee.press("DOWN");
    let shown = lines(&mut trainee);
    assert_eq!(
        (shown[0].split_whitespace().collect::<Vec<_>>(), shown[2].as_str()),
        (vec!["15.H", "2"], "FREE: 1200")
    );
    actions(&orders);
    trainee.press("ENT");
    assert_eq!(actions(&orders), [TransferAction::Read("16.H".into())]);
}

/// In German; a code after a message stays.
#[test]
fn messages_are_in_the_language_of_the_dialogue() {
    let (mut trainee, _orders) = connected();
    trainee.press("END MANUAL MOD");
    trainee.down_to("DIALOGUE LANGUAGE");
    trainee.press("ENT MOD PROGRAM EXT ENT");
    news(&mut trainee, "message TRANSFERRED DATA INCORRECT E");
    let said = trainee.messages();
    assert!(
        said[0].ends_with(" E") && !said[0].contains("INCORRECT"),
        "{said:?}"
    );
}
