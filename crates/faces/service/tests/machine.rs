//! A machine that is on, by its one face: who may do what, what runs is left alone, what has happened.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use std::io::Read as _;
use std::time::Duration;

use bahn_service::{
    Content, EventKind, HostMessage, Input, Key, Operand, Place, Role, RunState, ServiceError, StoreError,
    TransferFiles,
};
use support::Mill;

const BLOCKS: &[u8] = b"BEGIN PGM NEW MM\nEND PGM NEW MM\n";

fn operand(text: &str) -> Operand {
    text.parse().unwrap()
}

#[test]
fn who_may_look_changes_nothing() {
    let mill = Mill::new();
    let looks = mill.machine.with_role(Role::Look);
    // Nobody gets more than whom he has the handle from.
    assert_eq!(looks.with_role(Role::Operate).role(), Role::Look);
    let m1900 = operand("M1900");
    let tried = [
        looks.input(Input::Key(Key::Ce)),
        looks.press("CE"),
        looks.steps(1).map(drop),
        looks.write(m1900, "1"),
        looks.set_parameter(7230, 0, "1", true),
        looks.store_file("NEW.H", BLOCKS),
        looks.delete("CIRCLE.H"),
        looks.rename("CIRCLE.H", "OTHER.H"),
        looks.store().map(drop),
        looks.store_of(TransferFiles::Lists).map(drop),
        looks.to_plc(HostMessage::Double(1)),
        looks.transfer_orders().map(drop),
        looks.print_digitized(true),
    ];
    assert_eq!(tried, std::array::from_fn(|_| Err(ServiceError::OnlyLooks)));
    // He sees everything.
    assert!(
        looks
            .list("")
            .unwrap()
            .iter()
            .any(|entry| entry.name == "CIRCLE.H")
    );
    assert_eq!(looks.read(vec![m1900]), Ok(vec![Content::Number(0)]));
    assert_eq!(looks.state().unwrap().axes.len(), 4);
    assert!(looks.parameter(7230, 0).is_ok() && looks.screen_with_picture().is_ok());
}

/// The panel says BACKGROUND PROGRAMMING NOT POSSIBLE where such a program is erased or edited.
#[test]
fn a_program_that_runs_is_left_as_it_is() {
    let mill = Mill::new();
    mill.ready();
    mill.run("CIRCLE");
    let machine = &mill.machine;
    let in_use = Err(ServiceError::File(StoreError::InUse("TNC:\\CIRCLE.H".to_owned())));
    assert_eq!(machine.store_file("CIRCLE.H", BLOCKS), in_use);
    // In whatever letters it is written.
    assert!(machine.delete("circle.h").is_err());
    assert_eq!(machine.delete("CIRCLE.H"), in_use);
    assert_eq!(machine.rename("CIRCLE.H", "OTHER.H"), in_use);
    // What a protocol has of the service itself is bound by the same rule.
    let place = Place::root("TNC").join("CIRCLE.H").unwrap();
    assert!(machine.store().unwrap().delete(&place).is_err());
    // It can be read, and another one stored.
    let mut text = String::new();
    machine
        .open("CIRCLE.H")
        .unwrap()
        .read_to_string(&mut text)
        .unwrap();
    assert!(text.contains("BEGIN PGM CIRCLE"));
    assert_eq!(machine.store_file("NEW.H", BLOCKS), Ok(()));
    assert_eq!(std::fs::read(mill.folder.join("programs/NEW.H")).unwrap(), BLOCKS);
    while machine.state().unwrap().run != RunState::Idle {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(machine.rename("CIRCLE.H", "OTHER.H"), Ok(()));
    assert_eq!(machine.delete("OTHER.H"), Ok(()));
}

#[test]
fn a_protected_program_is_left_as_it_is() {
    let mill = Mill::new();
    let machine = &mill.machine;
    // The mark P of the first block [003:1015-1023].
    let text = b"BEGIN PGM NEW MM P\nEND PGM NEW MM P\n";
    machine.store_file("NEW.H", text).unwrap();
    let protected = Err(ServiceError::File(StoreError::Protected(
        "TNC:\\NEW.H".to_owned(),
    )));
    assert_eq!(machine.store_file("NEW.H", BLOCKS), protected);
    assert_eq!(machine.delete("NEW.H"), protected);
    assert_eq!(machine.rename("NEW.H", "OTHER.H"), protected);
    assert_eq!(std::fs::read(mill.folder.join("programs/NEW.H")).unwrap(), text);
}

#[test]
fn operands_are_read_together_and_written_where_they_may_be() {
    let mill = Mill::new();
    let machine = &mill.machine;
    // No program of the mill has these.
    machine.write(operand("W900"), "$0102").unwrap();
    machine.write(operand("S3"), "\"AB\"").unwrap();
    // The high byte of a word lies at its address [000:12099].
    let read = machine.read(["W900", "B900", "B901"].map(operand).to_vec());
    assert_eq!(read.unwrap(), [0x0102, 1, 2].map(Content::Number));
    let text = machine.read(vec![operand("S3")]);
    assert_eq!(text.unwrap(), [Content::Text("AB".to_owned())]);
    assert!(matches!(
        machine.write(operand("M1900"), "2"),
        Err(ServiceError::BadValue(_))
    ));
    // Inputs are the machine's.
    assert!(matches!(
        machine.write(operand("I0"), "1"),
        Err(ServiceError::Refused(_))
    ));
}

#[test]
fn machine_parameters_are_changed_until_power_off_or_for_good() {
    let mill = Mill::new();
    let machine = &mill.machine;
    let list = || std::fs::read_to_string(mill.folder.join("parameters.mp")).unwrap();
    let before = list();
    let value = machine.parameter(7230, 0).unwrap();
    let other = if value == "0" { "1" } else { "0" };
    machine.set_parameter(7230, 0, other, false).unwrap();
    assert_eq!(
        (machine.parameter(7230, 0).unwrap().as_str(), list()),
        (other, before.clone())
    );
    machine.set_parameter(7230, 0, other, true).unwrap();
    let after = list();
    let lines = before.lines().zip(after.lines());
    let changed: Vec<&str> = lines
        .filter(|(old, new)| old != new)
        .map(|(_, new)| new)
        .collect();
    assert!(changed.len() <= 1 && after.lines().count() - before.lines().count() <= 1);
    assert!(
        after
            .lines()
            .any(|line| line.starts_with("MP7230") && line.contains(other)),
        "{changed:?}"
    );
    assert_eq!(
        machine.parameter(9999, 0),
        Err(ServiceError::NoParameter(9999, 0))
    );
    assert!(matches!(
        machine.set_parameter(7230, 0, "900", false),
        Err(ServiceError::BadValue(_))
    ));
}

#[test]
fn keys_and_messages_have_numbers_in_the_log_book() {
    let mut mill = Mill::new();
    mill.until(|screen| !screen.messages.is_empty());
    mill.machine.press("CE").unwrap();
    let reported = mill.machine.events(0);
    let said: Vec<_> = reported
        .events
        .iter()
        .map(|event| (event.number, event.kind, event.text.as_str()))
        .collect();
    let expected = [
        (1, EventKind::Message, "POWER INTERRUPTED"),
        (2, EventKind::Key, "CE"),
    ];
    assert_eq!((reported.missed, &said[..2]), (0, &expected[..]));
    let last = said.len() as u64;
    assert_eq!(mill.machine.events(last).events, []);
    mill.machine.press("MANUAL").unwrap();
    let events = mill.machine.events(last).events;
    assert!(
        events
            .iter()
            .any(|event| event.text == "MANUAL" && event.number > last)
    );
    // Of a machine that has ended it is what was; nothing else is answered any more.
    mill.end();
    assert_eq!(mill.machine.events(0).events[..2], reported.events[..2]);
    assert_eq!(
        mill.machine.press("CE"),
        Err(ServiceError::Refused("the station has ended".to_owned()))
    );
}
