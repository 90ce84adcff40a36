//! The protocol with check characters: the operations of the manual as conversations, in both roles [000:17351-17512].
#![allow(clippy::unwrap_used, reason = "what fails here fails the test")]

mod support;

use bahn_link::blockwise::{DirectoryRequest, Peripheral, Reading, Rights, Want, Writing};
use bahn_link::{FileType, Memory, Mode, Settings};
use bahn_parameters::ControlModel;
use support::{Role, converse, ext, settings};

const ONE: &str = "0 BEGIN PGM 1 MM\n1 L X+1\n2 END PGM 1 MM\n";
const TWO: &str = "0 BEGIN PGM 2 MM\n1 END PGM 2 MM\n";

fn files(named: &[(&str, &str)]) -> Memory {
    let files = Memory::default();
    for (name, content) in named {
        files.put(name, content);
    }
    files
}

fn kind() -> FileType {
    FileType::of_code('H').unwrap()
}

fn reading(settings: Settings, files: &Memory, want: Want) -> Reading {
    Reading::new(settings, Box::new(files.clone()), want, kind())
}

fn selected(name: &str) -> Want {
    Want::Selected(name.into())
}

fn writing(settings: Settings, files: &Memory, names: &[&str]) -> Writing {
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    Writing::new(settings, Box::new(files.clone()), names, false)
}

fn device(settings: Settings, files: &Memory) -> Peripheral {
    Peripheral::new(settings, Box::new(files.clone()), Rights::ALL)
}

/// A conversation in which the control reads in, in both roles; returns what each reported and what the control has then.
fn reads(want: Want, there: &[(&str, &str)], script: &str) -> (Vec<String>, Vec<String>, Memory) {
    let settings = settings(Mode::Fe2);
    let stored = Memory::default();
    let control = converse(Role::Control, &mut reading(settings, &stored, want), script);
    let device = converse(Role::Device, &mut device(settings, &files(there)), script);
    (control, device, stored)
}

/// A conversation in which the control sends, in both roles.
fn sends(there: &[(&str, &str)], names: &[&str], script: &str) -> (Vec<String>, Vec<String>, Memory) {
    let settings = settings(Mode::Fe2);
    let stored = Memory::default();
    let control = converse(
        Role::Control,
        &mut writing(settings, &files(there), names),
        script,
    );
    let device = converse(Role::Device, &mut device(settings, &stored), script);
    (control, device, stored)
}

/// The pallet file PPP whose tenth line arrives damaged, byte for byte [000:17428-17432].
#[test]
fn a_pallet_file_with_a_nak() {
    let text: String = (1..=12).map(|line| format!("line {line}\n")).collect();
    let (head, tail) = (1..=9, 11..=12);
    let block = |line: i32| format!("T: STX \"line {line}\" ETB BCC DC1\nP: ACK\n");
    // What the device hears of the tenth line is damaged; the control has sent it well.
    let script = |tenth: &str| {
        format!(
            "T: SOH LPPPA ETB BCC DC1\nP: ACK\n{}T: STX \"line 10\" ETB {tenth} DC1\nP: NAK\n{}{}T: ETX EOT",
            head.clone().map(block).collect::<String>(),
            block(10),
            tail.clone().map(block).collect::<String>(),
        )
    };
    let settings = settings(Mode::Fe1);
    let there = files(&[("PPP.P", &text)]);
    let reported = converse(
        Role::Control,
        &mut writing(settings, &there, &["PPP.P"]),
        &script("BCC"),
    );
    assert_eq!(reported, ["sent PPP.P", "complete"]);
    let stored = Memory::default();
    let reported = converse(Role::Device, &mut device(settings, &stored), &script("BAD"));
    assert_eq!(reported, ["received PPP.P", "complete"]);
    assert_eq!(stored.get("PPP.P").unwrap(), text);
    // The check character of the header is 4B.
    assert_eq!(
        support::bytes("SOH LPPPA ETB BCC DC1"),
        [1, b'L', b'P', b'P', b'P', b'A', 0x17, 0x4B, 0x11]
    );
}

#[test]
fn output_of_all() {
    let (control, device, stored) = sends(
        &[("1.H", ONE), ("2.H", TWO)],
        &["1.H", "2.H"],
        r#"T: SOH H1A ETB BCC DC1
           P: ACK
           T: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
           P: ACK
           T: STX "1 L X+1" ETB BCC DC1
           P: ACK
           T: STX "2 END PGM 1 MM" ETB BCC DC1
           P: ACK
           T: ETX EOT
           T: SOH H2A ETB BCC DC1
           P: ACK
           T: STX "0 BEGIN PGM 2 MM" ETB BCC DC1
           P: ACK
           T: STX "1 END PGM 2 MM" ETB BCC DC1
           P: ACK
           T: ETX EOT"#,
    );
    assert_eq!(control, ["sent 1.H", "sent 2.H", "complete"]);
    assert_eq!(device, ["received 1.H", "complete", "received 2.H", "complete"]);
    assert_eq!(
        (stored.get("1.H").unwrap(), stored.get("2.H").unwrap()),
        (ONE.into(), TWO.into())
    );
}

/// A file that is not wanted is skipped, the next one offered at once [000:17483].
#[test]
fn output_with_confirmation() {
    let there = files(&[("1.H", ONE), ("2.H", TWO)]);
    let names = vec!["1.H".to_owned(), "2.H".to_owned()];
    let mut control = Writing::new(settings(Mode::Fe2), Box::new(there), names, true);
    let reported = converse(
        Role::Control,
        &mut control,
        r#"no
           yes
           T: SOH H2A ETB BCC DC1
           P: ACK
           T: STX "0 BEGIN PGM 2 MM" ETB BCC DC1
           P: ACK
           T: STX "1 END PGM 2 MM" ETB BCC DC1
           P: ACK
           T: ETX EOT"#,
    );
    assert_eq!(reported, ["output 1.H?", "output 2.H?", "sent 2.H", "complete"]);
}

const READ_ONE: &str = r#"T: SOH H1E ETB BCC DC1
    P: ACK
    P: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
    T: ACK
    P: STX "1 L X+1" ETB BCC DC1
    T: ACK
    P: STX "2 END PGM 1 MM" ETB BCC DC1
    T: ACK
    P: ETX
    T: EOT"#;

#[test]
fn read_selected() {
    let (control, device, stored) = reads(selected("1.H"), &[("1.H", ONE)], READ_ONE);
    assert_eq!(control, ["received 1.H", "complete"]);
    assert_eq!(device, ["sent 1.H", "complete"]);
    assert_eq!(stored.get("1.H").unwrap(), ONE);
}

const READ_ALL: &str = r#"T: SOH HE ETB BCC DC1
    P: ACK
    P: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
    T: ACK
    P: STX "1 L X+1" ETB BCC DC1
    T: ACK
    P: STX "2 END PGM 1 MM" ETB BCC DC1
    T: ACK
    P: ETX
    quiet-for-a-moment
    T: SOH HE ETB BCC DC1
    P: ACK
    P: STX "0 BEGIN PGM 2 MM" ETB BCC DC1
    T: ACK
    P: STX "1 END PGM 2 MM" ETB BCC DC1
    T: ACK
    P: ETX
    quiet-for-a-moment
    T: SOH HE ETB BCC DC1"#;

/// The last nameless header may be answered ETX, ACK ETX or EOT; ETX may stand between files or not, and an EOT after it.
#[test]
fn read_all() {
    let moment = "quiet-for-a-moment";
    for (last, end) in [
        ("P: ETX", "T: EOT"),
        ("P: ACK ETX", "T: EOT"),
        ("P: EOT", "T: EOT"),
    ] {
        for between in ["P: ETX\nquiet", "quiet", "P: ETX EOT"] {
            let script = READ_ALL
                .replace("P: ETX\n", "P: end\n")
                .replace(moment, "")
                .replace("P: end", between)
                + "\n"
                + last
                + "\n"
                + end;
            let stored = Memory::default();
            let mut control = reading(settings(Mode::Fe2), &stored, Want::All);
            let reported = converse(Role::Control, &mut control, &script);
            assert_eq!(
                reported,
                ["received 1.H", "received 2.H", "complete"],
                "{last} {between}"
            );
            assert_eq!(
                (stored.get("1.H").unwrap(), stored.get("2.H").unwrap()),
                (ONE.into(), TWO.into())
            );
        }
    }
    // The device sends ETX after each file, and alone when there is no more; EOT goes back to the first.
    let there = files(&[
        ("2.H", TWO),
        ("1.H", ONE),
        ("PLC.PLC", "x"),
        ("3.I", "%3 G71\nN1 %3 G71\n"),
    ]);
    let mut device = device(settings(Mode::Fe2), &there);
    let script = READ_ALL.replace(moment, "") + "\nP: ETX\nT: EOT\n";
    for _ in 0..2 {
        let reported = converse(Role::Device, &mut device, &script);
        assert_eq!(reported, ["sent 1.H", "sent 2.H", "complete"]);
    }
}

/// After the first block of each file the next one is asked for [000:17455-17458].
#[test]
fn directory() {
    let (control, device, stored) = reads(
        Want::Directory,
        &[("1.H", ONE), ("2.H", TWO)],
        r#"T: SOH HE ETB BCC DC1
           P: ACK
           P: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
           T: SOH HE ETB BCC DC1
           P: ACK
           P: STX "0 BEGIN PGM 2 MM" ETB BCC DC1
           T: SOH HE ETB BCC DC1
           P: ETX
           T: EOT"#,
    );
    assert_eq!(control, ["listed 1.H", "listed 2.H", "complete"]);
    assert_eq!(device, ["complete"]);
    assert_eq!(stored.get("1.H"), None);
}

#[test]
fn directory_of_fe1() {
    let ask = "T: DC3 ESC DC1 \"0 D\" CR LF\n";
    let answer = r#"P: "four lines" CR LF "that say" CR LF nothing CR LF "to the control" CR LF
        P: "  1 H 15                  3 P" CR LF
        P: "xxxxxx\"
        P: FREE: " 1500 sectors" CR LF"#;
    let answer = answer.replace("        P: \"xxxxxx\\\"\n", "");
    let mut control = DirectoryRequest::new(settings(Mode::Fe1));
    let reported = converse(Role::Control, &mut control, &format!("{ask}{answer}"));
    assert_eq!(reported, ["listed 15 3", "free 1500", "complete"]);
    // What the device answers the control understands.
    let mut device = device(
        settings(Mode::Fe1),
        &files(&[("15.H", ONE), ("NOTE.A", &"x".repeat(600))]),
    );
    let mut control = DirectoryRequest::new(settings(Mode::Fe1));
    let mut now = std::time::Duration::from_secs(1);
    for _ in 0..4 {
        pass(&mut control, &mut device, now);
        pass(&mut device, &mut control, now);
        now += std::time::Duration::from_millis(1);
    }
    let reported: Vec<String> = std::iter::from_fn(|| bahn_link::Protocol::event(&mut control))
        .map(|event| support::described(&event, ControlModel::Tnc415b))
        .collect();
    assert_eq!(
        reported,
        ["listed 15 1", "listed NOTE 2", "free 1577", "complete"]
    );
    // Nobody there.
    let reported = converse(
        Role::Control,
        &mut DirectoryRequest::new(settings(Mode::Fe1)),
        &format!("{ask}quiet"),
    );
    assert_eq!(reported, ["EXT. OUTPUT/INPUT NOT READY", "broken off"]);
}

fn pass(from: &mut dyn bahn_link::Protocol, to: &mut dyn bahn_link::Protocol, now: std::time::Duration) {
    let mut bytes = Vec::new();
    while from.has_output() {
        from.send(100, now, &mut bytes);
    }
    bytes.iter().for_each(|byte| to.receive(*byte, now));
}

/// The acknowledgement is kept back until the operator has answered; no is a new header at once [000:17495-17512].
#[test]
fn read_offered() {
    let (control, device, stored) = reads(
        Want::Offered,
        &[("1.H", ONE), ("2.H", TWO)],
        r#"T: SOH HE ETB BCC DC1
           P: ACK
           P: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
           no
           T: SOH HE ETB BCC DC1
           P: ACK
           P: STX "0 BEGIN PGM 2 MM" ETB BCC DC1
           yes
           T: ACK
           P: STX "1 END PGM 2 MM" ETB BCC DC1
           T: ACK
           P: ETX
           quiet
           T: SOH HE ETB BCC DC1
           P: ETX
           T: EOT"#,
    );
    assert_eq!(
        control,
        ["offered 1.H?", "offered 2.H?", "received 2.H", "complete"]
    );
    // Whoever is quiet after ETX has it.
    assert_eq!(device, ["sent 2.H", "complete", "complete"]);
    assert_eq!(
        (stored.get("1.H"), stored.get("2.H").unwrap()),
        (None, TWO.into())
    );
}

#[test]
fn a_file_that_is_there_is_replaced_after_a_question() {
    let there = files(&[("1.H", "old")]);
    let head = r#"T: SOH H1E ETB BCC DC1
        P: ACK
        P: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
        "#;
    let control = &mut reading(settings(Mode::Fe2), &there, selected("1.H"));
    let reported = converse(Role::Control, control, &format!("{head}no\nT: EOT"));
    assert_eq!(reported, ["overread 1.H?", "ERASE/OVERREAD", "broken off"]);
    assert_eq!(there.get("1.H").unwrap(), "old");

    let rest = READ_ONE.split_once("\n    T: ACK").unwrap().1;
    let control = &mut reading(settings(Mode::Fe2), &there, selected("1.H"));
    // The operator may think as long as he likes.
    let reported = converse(Role::Control, control, &format!("{head}quiet\nyes\nT: ACK{rest}"));
    assert_eq!(reported, ["overread 1.H?", "received 1.H", "complete"]);
    assert_eq!(there.get("1.H").unwrap(), ONE);

    there.protect("1.H");
    let control = &mut reading(settings(Mode::Fe2), &there, selected("1.H"));
    let reported = converse(Role::Control, control, &format!("{head}T: EOT"));
    assert_eq!(reported, ["PROTECTED PGM", "broken off"]);
    // Of all files the next one is read in.
    let all = head.replace("H1E", "HE");
    let control = &mut reading(settings(Mode::Fe2), &there, Want::All);
    let reported = converse(
        Role::Control,
        control,
        &format!("{all}yes\nT: SOH HE ETB BCC DC1\nP: ETX\nT: EOT"),
    );
    assert_eq!(reported, ["PROTECTED PGM", "protected 1.H?", "broken off"]);
}

/// What the device refuses: SOH ERR: nnn ETB BCC, which the control shows [000:17442-17450] [000:17603-17625].
#[test]
fn errors_of_the_device() {
    let there = files(&[("1.H", ONE), ("5.H", ONE)]);
    there.protect("5.H");
    for (header, error, shows) in [
        ("SOH H1X ETB BCC DC1", "001", None),
        ("SOH ETB BCC DC1", "001", None),
        ("SOH HA/BE ETB BCC DC1", "002", None),
        ("SOH HA ETB BCC DC1", "002", None),
        ("SOH H12345678901234567E ETB BCC DC1", "002", None),
        ("SOH H9E ETB BCC DC1", "010", Some("9.H")),
        ("SOH H5A ETB BCC DC1", "011", None),
    ] {
        let script = format!("T: {header}\nP: SOH \"ERR: {error}\" ETB BCC\nT: ACK EOT");
        let reported = converse(Role::Device, &mut device(settings(Mode::Fe1), &there), &script);
        assert_eq!(
            reported[..2],
            [format!("ERR: {error}"), "broken off".to_owned()],
            "{header}"
        );
        if let Some(name) = shows {
            let control = &mut reading(settings(Mode::Fe1), &Memory::default(), selected(name));
            assert_eq!(
                converse(Role::Control, control, &script),
                [format!("ERR: {error}"), "broken off".into()]
            );
        }
    }
    // It may have acknowledged the header, and DC1 may follow.
    let script = "T: SOH H9E ETB BCC DC1\nP: ACK SOH \"PROGRAM NOT PRESENT\" ETB BCC DC1\nT: ACK EOT";
    let control = &mut reading(settings(Mode::Fe1), &Memory::default(), selected("9.H"));
    assert_eq!(
        converse(Role::Control, control, script),
        ["PROGRAM NOT PRESENT", "broken off"]
    );
}

/// A program without END is stored nowhere.
#[test]
fn a_program_without_end() {
    let (control, device, stored) = sends(
        &[("1.H", "0 BEGIN PGM 1 MM\n")],
        &["1.H"],
        r#"T: SOH H1A ETB BCC DC1
           P: ACK
           T: STX "0 BEGIN PGM 1 MM" ETB BCC DC1
           P: ACK
           T: ETX EOT
           P: SOH "ERR: 004" ETB BCC
           T: ACK EOT"#,
    );
    assert_eq!(control, ["sent 1.H", "ERR: 004", "broken off"]);
    assert_eq!(device, ["ERR: 004", "broken off"]);
    assert_eq!(stored.get("1.H"), None);

    let script = READ_ONE.replace(
        r#"P: STX "2 END PGM 1 MM" ETB BCC DC1
    T: ACK
    P: ETX"#,
        "P: ETX\nquiet",
    );
    let control = &mut reading(settings(Mode::Fe2), &stored, selected("1.H"));
    assert_eq!(
        converse(Role::Control, control, &script),
        ["PROGRAM INCOMPLETE", "broken off"]
    );
    assert_eq!(stored.get("1.H"), None);
}

/// "The program name may contain up to 16 characters" [000:17482]: a longer one is not sent, and none is stored.
#[test]
fn names_have_sixteen_characters_at_most() {
    let (fits, long) = ("ABCDEFGHIJKLMNOP", "ABCDEFGHIJKLMNOPQ");
    assert_eq!((fits.len(), long.len()), (16, 17));
    let names = [fits, long].map(|name| format!("{name}.H"));
    let there = files(&[(&names[0], ONE), (&names[1], ONE)]);
    let control = &mut writing(settings(Mode::Fe2), &there, &[&names[0]]);
    let script = format!("T: SOH H{fits}A ETB BCC DC1\nEND\nT: EOT");
    assert_eq!(
        converse(Role::Control, control, &script),
        ["PROGRAM INCOMPLETE", "broken off"]
    );
    let control = &mut writing(settings(Mode::Fe2), &there, &[&names[1]]);
    let reported = converse(Role::Control, control, "");
    assert!(
        reported.len() == 2 && reported[0].contains(long) && reported[1] == "broken off",
        "{reported:?}"
    );
}

/// NAK three times from the device is E, three times to it M, silence is N [000:17584-17599].
#[test]
fn three_times_and_no_more() {
    let there = files(&[("1.H", ONE)]);
    let header = "T: SOH H1A ETB BCC DC1\n";
    let script = format!("{header}P: NAK\n{header}P: NAK\n{header}P: NAK\nT: EOT");
    let reported = converse(
        Role::Control,
        &mut writing(settings(Mode::Fe2), &there, &["1.H"]),
        &script,
    );
    assert_eq!(reported, ["TRANSFERRED DATA INCORRECT E", "broken off"]);

    let asked = "T: SOH H1E ETB BCC DC1\nP: ACK\n";
    let wrong = "P: STX \"0 BEGIN PGM 1 MM\" ETB BAD DC1\n";
    let script = format!("{asked}{wrong}T: NAK\n{wrong}T: NAK\n{wrong}T: NAK EOT");
    let control = &mut reading(settings(Mode::Fe2), &Memory::default(), selected("1.H"));
    assert_eq!(
        converse(Role::Control, control, &script),
        ["TRANSFERRED DATA INCORRECT M", "broken off"]
    );

    for (script, reported) in [
        (format!("{header}quiet\nT: EOT"), "TRANSFERRED DATA INCORRECT N"),
        (
            format!("{header}P: ACK\nT: STX \"0 BEGIN PGM 1 MM\" ETB BCC DC1\nquiet\nT: EOT"),
            "TRANSFERRED DATA INCORRECT N",
        ),
        (format!("{header}P: EOT"), "PROGRAM INCOMPLETE"),
        (format!("{header}pulled"), "PROGRAM INCOMPLETE"),
        (format!("{header}END\nT: EOT"), "PROGRAM INCOMPLETE"),
    ] {
        let control = &mut writing(settings(Mode::Fe2), &there, &["1.H"]);
        assert_eq!(
            converse(Role::Control, control, &script),
            [reported, "broken off"],
            "{script}"
        );
    }
    for (end, reported) in [
        ("quiet\nT: EOT", "PROGRAM INCOMPLETE"),
        ("P: EOT\nT: EOT", "PROGRAM INCOMPLETE"),
        ("pulled", "PROGRAM INCOMPLETE"),
        ("END\nT: EOT", "PROGRAM INCOMPLETE"),
    ] {
        let script = format!("{asked}P: STX \"0 BEGIN PGM 1 MM\" ETB BCC\nT: ACK\n{end}");
        let stored = Memory::default();
        let control = &mut reading(settings(Mode::Fe2), &stored, selected("1.H"));
        assert_eq!(
            converse(Role::Control, control, &script),
            [reported, "broken off"],
            "{script}"
        );
        assert_eq!(stored.get("1.H"), None);
    }

    // The device says 003 at the third wrong block, and its own third NAK ends, too.
    let wrong = "T: STX \"0 BEGIN PGM 1 MM\" ETB BAD DC1\n";
    let script = format!(
        "{header}P: ACK\n{wrong}P: NAK\n{wrong}P: NAK\n{wrong}P: SOH \"ERR: 003\" ETB BCC\nT: ACK EOT"
    );
    let stored = Memory::default();
    let reported = converse(Role::Device, &mut device(settings(Mode::Fe2), &stored), &script);
    assert_eq!(reported, ["ERR: 003", "broken off"]);
    // NAK three times is E on this side, too; what goes back is 003.
    let block = "P: STX \"0 BEGIN PGM 1 MM\" ETB BCC DC1\nT: NAK\n";
    let header_e = "T: SOH H1E ETB BCC DC1\nP: ACK\n";
    let script = format!("{header_e}{block}{block}{block}P: SOH \"ERR: 003\" ETB BCC\nT: ACK EOT");
    let reported = converse(Role::Device, &mut device(settings(Mode::Fe2), &there), &script);
    assert_eq!(reported, ["TRANSFERRED DATA INCORRECT E", "broken off"]);
    for end in ["quiet", "pulled", "T: EOT"] {
        let script = format!("{header}P: ACK\nT: STX \"0 BEGIN PGM 1 MM\" ETB BCC\nP: ACK\n{end}");
        let reported = converse(Role::Device, &mut device(settings(Mode::Fe2), &stored), &script);
        assert_eq!(reported, ["PROGRAM INCOMPLETE", "broken off"], "{end}");
        assert_eq!(stored.get("1.H"), None);
    }
}

/// A control may keep its acknowledgement back as long as it wants [000:17434-17438].
#[test]
fn a_device_is_patient() {
    let script = READ_ONE.replace("T: ACK\n    P: STX \"2", "quiet\nT: ACK\n    P: STX \"2");
    let reported = converse(
        Role::Device,
        &mut device(settings(Mode::Fe2), &files(&[("1.H", ONE)])),
        &script,
    );
    assert_eq!(reported, ["sent 1.H", "complete"]);
}

/// When the answer is overdue, LSV/2 may begin: a control that is gone does not keep the port.
#[test]
fn a_device_that_waits_in_vain_hears_an_enquiry() {
    let asked = "T: SOH H1E ETB BCC DC1\nP: ACK STX \"0 BEGIN PGM 1 MM\" ETB BCC DC1\n";
    for (silence, reported) in [
        (
            "quiet\n",
            &["TRANSFERRED DATA INCORRECT N", "broken off", "enquiry"][..],
        ),
        // In time it is noise.
        ("", &[]),
    ] {
        let mut device = device(settings(Mode::Fe2), &files(&[("1.H", ONE)]));
        let script = format!("{asked}{silence}T: ENQ");
        assert_eq!(
            converse(Role::Device, &mut device, &script),
            reported,
            "{silence}"
        );
        // The next control is heard.
        let reported = converse(Role::Device, &mut device, READ_ONE);
        assert_eq!(reported, ["sent 1.H", "complete"]);
    }
}

/// The check character of a header is 3F with a blank before ETB; without DC3 no DC1 is sent [000:17015-17017] [000:17399].
#[test]
fn freely_configured() {
    let settings = ext(ControlModel::Tnc415b, &[(5020, 162.0), (5030, 1.0)]);
    assert!(settings.printable_check && !settings.with_dc1);
    let there = files(&[("15.H", ONE)]);
    let mut control = writing(settings, &there, &["15.H"]);
    let mut said = Vec::new();
    bahn_link::Protocol::send(&mut control, 100, std::time::Duration::ZERO, &mut said);
    assert_eq!(said, [1, b'H', b'1', b'5', b'A', b' ', 0x17, 0x3B]);
    let mut control = reading(settings, &Memory::default(), selected("15.H"));
    let mut said = Vec::new();
    bahn_link::Protocol::send(&mut control, 100, std::time::Duration::ZERO, &mut said);
    assert_eq!(said, [1, b'H', b'1', b'5', b'E', b' ', 0x17, 0x3F]);

    // Other characters: STX is !, ETB is #, ACK is &.
    let settings = ext(
        ControlModel::Tnc415b,
        &[
            (5030, 1.0),
            (5200, 33.0),
            (5207, 35.0),
            (5208, 38.0),
            (5202, 66.0),
        ],
    );
    let script = "T: SOH B1E#\"$\"\n";
    let mut said = Vec::new();
    let mut control = reading(settings, &Memory::default(), selected("1.H"));
    bahn_link::Protocol::send(&mut control, 100, std::time::Duration::ZERO, &mut said);
    let expected = [1, b'B', b'1', b'E', b'#', 1 ^ b'B' ^ b'1' ^ b'E' ^ b'#'];
    assert_eq!(said[..6], expected, "{script}");
    bahn_link::Protocol::receive(&mut control, b'&', std::time::Duration::ZERO);
    let line = b"0 BEGIN PGM 1 MM";
    let check = line.iter().fold(b'!' ^ b'#', |check, byte| check ^ byte);
    for byte in [&b"!"[..], line, b"#", &[check]].concat() {
        bahn_link::Protocol::receive(&mut control, byte, std::time::Duration::ZERO);
    }
    said.clear();
    bahn_link::Protocol::send(&mut control, 100, std::time::Duration::ZERO, &mut said);
    assert_eq!(said, b"&");
}

/// Real senders: lines with CR LF in their blocks, no DC1, ETX and then silence; or EOT alone.
#[test]
fn what_real_senders_do() {
    for end in ["P: ETX\nT: EOT", "P: ETX EOT\nT: EOT", "P: EOT\nT: EOT"] {
        let script = format!(
            "T: SOH H1E ETB BCC DC1\nP: ACK\nP: STX \"0 BEGIN PGM 1 MM\" CR LF ETB BCC\nT: ACK\nP: STX \"1 L X+1\" CR LF ETB BCC\n\
             T: ACK\nP: STX \"2 END PGM 1 MM\" CR LF ETB BCC\nT: ACK\n{end}"
        );
        let stored = Memory::default();
        let reported = converse(
            Role::Control,
            &mut reading(settings(Mode::Fe2), &stored, selected("1.H")),
            &script,
        );
        assert_eq!(reported, ["received 1.H", "complete"], "{end}");
        assert_eq!(stored.get("1.H").unwrap(), ONE);
    }
    for end in ["T: ETX", "T: EOT", "T: ETX EOT"] {
        let script = format!(
            "T: SOH H1A ETB BCC\nP: ACK\nT: STX \"0 BEGIN PGM 1 MM\" CR LF ETB BCC\nP: ACK\nT: STX \"1 END PGM 1 MM\" CR LF ETB BCC\n\
             P: ACK\n{end}"
        );
        let stored = Memory::default();
        let reported = converse(Role::Device, &mut device(settings(Mode::Fe2), &stored), &script);
        assert_eq!(reported[..2], ["received 1.H", "complete"], "{end}");
    }
}
