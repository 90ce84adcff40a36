//! The standard protocol: the operations of the manual as conversations, in both roles [000:17240-17349].
#![allow(clippy::unwrap_used, reason = "what fails here fails the test")]

mod support;

use bahn_link::blockwise::{Rights, Want};
use bahn_link::standard::{Peripheral, Reading, Writing};
use bahn_link::{FileType, Memory, Mode, Settings};
use bahn_parameters::ControlModel;
use support::{Role, converse, ext, settings};

const ONE: &str = "0 BEGIN PGM 1 MM\n1 L X+1\n2 END PGM 1 MM\n";
const TWO: &str = "0 BEGIN PGM 2 MM\n1 END PGM 2 MM\n";
/// The programs as they go over the line.
const SENT_ONE: &str = r#"NUL*50 "0 BEGIN PGM 1 MM" CR LF "1 L X+1" CR LF "2 END PGM 1 MM" CR LF"#;
const SENT_TWO: &str = r#"NUL*50 "0 BEGIN PGM 2 MM" CR LF "1 END PGM 2 MM" CR LF"#;

fn files(named: &[(&str, &str)]) -> Memory {
    let files = Memory::default();
    for (name, content) in named {
        files.put(name, content);
    }
    files
}

fn both() -> Memory {
    files(&[("1.H", ONE), ("2.H", TWO)])
}

fn reading(settings: Settings, files: &Memory, want: Want) -> Reading {
    let kind = FileType::of_code('H').unwrap();
    Reading::new(settings, Box::new(files.clone()), want, kind)
}

fn writing(settings: Settings, files: &Memory, names: &[&str], confirmed: bool) -> Writing {
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    Writing::new(settings, Box::new(files.clone()), names, confirmed)
}

fn device(settings: Settings, files: &Memory) -> Peripheral {
    Peripheral::new(settings, Box::new(files.clone()), Rights::ALL)
}

/// Standard protocol, with EOT and DC3.
fn ext1() -> Settings {
    ext(ControlModel::Tnc415b, &[(5020, 168.0), (5030, 0.0)])
}

#[test]
fn output_begins_with_fifty_nul_and_ends_with_etx_eot() {
    for (settings, end) in [(ext1(), "ETX EOT"), (settings(Mode::Me), "ETX")] {
        let script = format!("T: {SENT_ONE} {end}");
        let reported = converse(
            Role::Control,
            &mut writing(settings, &both(), &["1.H"], false),
            &script,
        );
        assert_eq!(reported, ["sent 1.H", "complete"]);
        let stored = Memory::default();
        let reported = converse(Role::Device, &mut device(settings, &stored), &script);
        assert_eq!(reported, ["received 1.H", "complete"]);
        assert_eq!(stored.get("1.H").unwrap(), ONE);
    }
    assert_eq!(
        support::bytes(SENT_ONE).iter().filter(|byte| **byte == 0).count(),
        50
    );
}

/// Nothing stands between the files [000:17281].
#[test]
fn output_of_all() {
    let script = format!("T: {SENT_ONE} {SENT_TWO} ETX EOT");
    let reported = converse(
        Role::Control,
        &mut writing(ext1(), &both(), &["1.H", "2.H"], false),
        &script,
    );
    assert_eq!(reported, ["sent 1.H", "sent 2.H", "complete"]);
    let stored = Memory::default();
    let reported = converse(Role::Device, &mut device(ext1(), &stored), &script);
    assert_eq!(reported, ["received 1.H", "received 2.H", "complete"]);
    assert_eq!(
        (stored.get("1.H").unwrap(), stored.get("2.H").unwrap()),
        (ONE.into(), TWO.into())
    );
}

#[test]
fn output_with_confirmation() {
    let script = format!("no\nyes\nT: {SENT_TWO} ETX EOT");
    let reported = converse(
        Role::Control,
        &mut writing(ext1(), &both(), &["1.H", "2.H"], true),
        &script,
    );
    assert_eq!(reported, ["output 1.H?", "output 2.H?", "sent 2.H", "complete"]);
}

/// After DC3 come 12 characters at most, and DC1 lets it go on where it stopped [000:17045-17050].
#[test]
fn a_sender_stops_at_dc3() {
    use bahn_link::{AFTER_DC3, DC1, DC3, Protocol as _};
    let mut control = writing(ext1(), &both(), &["1.H", "2.H"], false);
    let now = std::time::Duration::ZERO;
    let mut all = Vec::new();
    let mut turns = 0;
    while control.has_output() {
        let before = all.len();
        // A channel that takes everything; DC3 comes while it is in transit.
        control.send(10_000, now, &mut all);
        control.receive(DC3, now);
        assert!(all.len() - before <= AFTER_DC3);
        assert!(!control.has_output());
        let stopped = all.len();
        control.send(10_000, now, &mut all);
        assert_eq!(all.len(), stopped);
        control.receive(DC1, now);
        turns += 1;
    }
    assert_eq!(all, support::bytes(&format!("{SENT_ONE} {SENT_TWO} ETX EOT")));
    assert!(turns > 10);
}

#[test]
fn read_selected() {
    let script = format!("T: DC1\nP: {SENT_ONE} ETX\nT: EOT");
    let stored = Memory::default();
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &stored, Want::Selected("1.H".into())),
        &script,
    );
    assert_eq!(reported, ["received 1.H", "complete"]);
    assert_eq!(stored.get("1.H").unwrap(), ONE);
    let reported = converse(Role::Device, &mut device(ext1(), &stored), &script);
    assert_eq!(reported, ["sent 1.H", "complete"]);
    // ME never sends EOT.
    let me = settings(Mode::Me);
    let stored = Memory::default();
    let script = format!("T: DC1\nP: {SENT_ONE} ETX");
    let reported = converse(
        Role::Control,
        &mut reading(me, &stored, Want::Selected("1.H".into())),
        &script,
    );
    assert_eq!(reported, ["received 1.H", "complete"]);
}

/// The control reads every program and looks for the name; ETX after the last one ends without a message and nothing is
/// stored [000:17326-17334].
#[test]
fn another_name() {
    let stored = Memory::default();
    let script = format!("T: DC1\nP: {SENT_ONE} {SENT_TWO} ETX\nT: EOT");
    let want = |name: &str| Want::Selected(name.into());
    assert_eq!(
        converse(Role::Control, &mut reading(ext1(), &stored, want("2.H")), &script),
        ["received 2.H", "complete"]
    );
    assert_eq!(stored.get("1.H"), None);
    let stored = Memory::default();
    assert_eq!(
        converse(
            Role::Control,
            &mut reading(ext1(), &stored, want("100.H")),
            &script
        ),
        ["complete"]
    );
    assert_eq!(
        (stored.get("1.H"), stored.get("2.H"), stored.get("100.H")),
        (None, None, None)
    );
    // Without ETX the control waits in silence until END.
    let script = format!("T: DC1\nP: {SENT_ONE}\nquiet\nEND\nT: EOT");
    assert_eq!(
        converse(
            Role::Control,
            &mut reading(ext1(), &stored, want("100.H")),
            &script
        ),
        ["complete"]
    );
}

/// DC1 again only after ETX; several programs before one ETX need none [000:17336-17343].
#[test]
fn read_all() {
    for (script, role) in [
        (
            format!("T: DC1\nP: {SENT_ONE} ETX\nT: DC1\nP: {SENT_TWO} ETX\nT: DC1\nP: ETX\nT: EOT"),
            None,
        ),
        (
            format!("T: DC1\nP: {SENT_ONE} ETX\nT: DC1\nP: {SENT_TWO} ETX\nT: DC1\nquiet\nT: EOT"),
            None,
        ),
        (
            format!("T: DC1\nP: {SENT_ONE} {SENT_TWO} ETX\nT: DC1\nP: EOT\nT: EOT"),
            None,
        ),
        (
            format!("T: DC1\nP: {SENT_ONE} {SENT_TWO} ETX\nT: DC1\npulled"),
            None,
        ),
        (
            format!("T: DC1\nP: {SENT_ONE} {SENT_TWO} ETX\nT: DC1\nP: ETX\nT: EOT"),
            Some(Role::Device),
        ),
    ] {
        let stored = Memory::default();
        let reported = converse(Role::Control, &mut reading(ext1(), &stored, Want::All), &script);
        assert_eq!(reported, ["received 1.H", "received 2.H", "complete"], "{script}");
        assert_eq!(
            (stored.get("1.H").unwrap(), stored.get("2.H").unwrap()),
            (ONE.into(), TWO.into())
        );
        if let Some(role) = role {
            // EOT goes back to the first.
            let mut device = device(ext1(), &stored);
            for _ in 0..2 {
                assert_eq!(
                    converse(role, &mut device, &script),
                    ["sent 1.H", "sent 2.H", "complete"]
                );
            }
        }
    }
}

/// The device is stopped by DC3 while the operator thinks; what he does not want is read, but not stored
/// [000:17345-17349].
#[test]
fn read_offered() {
    let script = format!(
        "T: DC1\nP: {SENT_ONE}\nT: DC3\nno\nT: DC1\nP: {SENT_TWO} ETX\nT: DC3\nyes\nT: DC1 DC1\nP: ETX\nT: EOT"
    );
    let stored = Memory::default();
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &stored, Want::Offered),
        &script,
    );
    assert_eq!(
        reported,
        ["offered 1.H?", "offered 2.H?", "received 2.H", "complete"]
    );
    assert_eq!(
        (stored.get("1.H"), stored.get("2.H").unwrap()),
        (None, TWO.into())
    );
    // By RTS no character goes.
    let by_rts = ext(ControlModel::Tnc415b, &[(5020, 172.0), (5030, 0.0)]);
    let script = format!("T: DC1\nP: {SENT_TWO} ETX\nyes\nT: DC1\nP: ETX\nT: EOT");
    let reported = converse(
        Role::Control,
        &mut reading(by_rts, &Memory::default(), Want::Offered),
        &script,
    );
    assert_eq!(reported, ["offered 2.H?", "received 2.H", "complete"]);
}

#[test]
fn directory() {
    let script = format!("T: DC1\nP: {SENT_ONE} {SENT_TWO} ETX\nT: EOT");
    let stored = Memory::default();
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &stored, Want::Directory),
        &script,
    );
    assert_eq!(reported, ["listed 1.H", "listed 2.H", "complete"]);
    assert_eq!(stored.get("1.H"), None);
    // END at once [000:17275].
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &stored, Want::Directory),
        "T: DC1\nEND\nT: ETX EOT",
    );
    assert_eq!(reported, ["complete"]);
}

#[test]
fn a_file_that_is_there() {
    let there = files(&[("1.H", "old")]);
    let want = || Want::Selected("1.H".into());
    let head = format!("T: DC1\nP: {SENT_ONE} ETX\nT: DC3\n");
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &there, want()),
        &format!("{head}no\nT: EOT"),
    );
    assert_eq!(reported, ["overread 1.H?", "ERASE/OVERREAD", "broken off"]);
    assert_eq!(there.get("1.H").unwrap(), "old");
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &there, want()),
        &format!("{head}yes\nT: DC1 EOT"),
    );
    assert_eq!(reported, ["overread 1.H?", "received 1.H", "complete"]);
    assert_eq!(there.get("1.H").unwrap(), ONE);
    there.protect("1.H");
    let script = format!("T: DC1\nP: {SENT_ONE}\nT: EOT");
    let reported = converse(Role::Control, &mut reading(ext1(), &there, want()), &script);
    assert_eq!(reported, ["PROTECTED PGM", "broken off"]);
}

/// ESC 1 n of the magnetic tape unit, and what should have been one [000:17597-17598] [000:17627-17637].
#[test]
fn errors_of_the_device() {
    for (sequence, message) in [
        ("ESC 10", "TRANSFERRED DATA INCORRECT"),
        ("ESC 11", "DATA CARRIER MISSING"),
        ("ESC 12", "DATA CARRIER WRITE-PROTECTED"),
        ("ESC 13", "WRONG OPERATING MODE"),
        ("ESC 14", "WRONG PROGRAM DATA"),
        ("ESC 15", "DATA CARRIER EMPTY"),
        ("ESC 16", "PROGRAM INCOMPLETE"),
        ("ESC 17", "ME: END OF TAPE"),
        ("ESC 18", "TRANSFERRED DATA INCORRECT L"),
        ("ESC 1A", "TRANSFERRED DATA INCORRECT L"),
        ("ESC 2", "TRANSFERRED DATA INCORRECT K"),
    ] {
        let me = settings(Mode::Me);
        let script = format!("T: DC1\nP: {sequence}");
        let reported = converse(
            Role::Control,
            &mut reading(me, &Memory::default(), Want::All),
            &script,
        );
        assert_eq!(reported, [message, "broken off"], "{sequence}");
        // While it sends.
        let mut control = writing(me, &both(), &["1.H"], false);
        bahn_link::Protocol::send(&mut control, 7, std::time::Duration::ZERO, &mut Vec::new());
        for byte in support::bytes(sequence) {
            bahn_link::Protocol::receive(&mut control, byte, std::time::Duration::ZERO);
        }
        let reported = converse(Role::Control, &mut control, "");
        assert_eq!(reported, [message, "broken off"], "{sequence}");
    }
}

/// Half a program is stored nowhere, on neither side.
#[test]
fn what_is_broken_off_leaves_nothing() {
    let half = r#""0 BEGIN PGM 1 MM" CR LF "1 L X+1" CR LF"#;
    for end in ["pulled", "END\nT: EOT", "P: ETX\nT: EOT", "P: EOT\nT: EOT"] {
        let stored = Memory::default();
        let script = format!("T: DC1\nP: {half}\n{end}");
        let reported = converse(Role::Control, &mut reading(ext1(), &stored, Want::All), &script);
        assert_eq!(reported, ["PROGRAM INCOMPLETE", "broken off"], "{end}");
        assert_eq!(stored.get("1.H"), None);
    }
    for end in ["pulled", "T: ETX", "T: EOT"] {
        let stored = Memory::default();
        let reported = converse(
            Role::Device,
            &mut device(ext1(), &stored),
            &format!("T: {half}\n{end}"),
        );
        assert_eq!(reported, ["PROGRAM INCOMPLETE", "broken off"], "{end}");
        assert_eq!(stored.get("1.H"), None);
    }
}

/// Files without their name in the first line are read in one at a time, as they come [000:16939].
#[test]
fn a_text_file() {
    let stored = Memory::default();
    let script = "T: DC1\nP: NUL*3 \"any text\" CR LF CR LF last\nP: ETX\nT: EOT";
    let reported = converse(
        Role::Control,
        &mut reading(ext1(), &stored, Want::Selected("NOTE.A".into())),
        script,
    );
    assert_eq!(reported, ["received NOTE.A", "complete"]);
    assert_eq!(stored.get("NOTE.A").unwrap(), "any text\n\nlast\n");
}
