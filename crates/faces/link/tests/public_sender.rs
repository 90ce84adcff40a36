//! Conversations recorded with a sender for the TNC 407 and 410 that is public: a program in Python that drips blocks over
//! EXT1 or sends a file by the standard protocol. Here they are played in our own words.
#![allow(clippy::unwrap_used, reason = "what fails here fails the test")]

mod support;

use bahn_link::blockwise::{self, Rights, Want};
use bahn_link::{FileType, Memory, Mode, Protocol, Settings, standard};
use bahn_parameters::ControlModel;
use support::{Role, converse, ext, settings};

const SADDLE: &str = "0 BEGIN PGM SADDLE MM\n1 L X+1\n2 END PGM SADDLE MM\n";
/// What the sender makes of it, with NULs of its own count before it.
const TEXT: &str = r#"NUL*3 "0 BEGIN PGM SADDLE MM" CR LF "1 L X+1" CR LF "2 END PGM SADDLE MM" CR LF"#;

/// MP5020 = 104: 7 data bits, DC3, even parity, 2 stop bits, as the sender is set up.
fn ext1(protocol: f64) -> Settings {
    ext(ControlModel::Tnc415b, &[(5020, 104.0), (5030, protocol)])
}

fn saddle() -> Want {
    Want::Selected("SADDLE.H".into())
}

fn kind() -> FileType {
    FileType::of_code('H').unwrap()
}

/// It waits for the header, acknowledges it, and sends each line with CR LF in its block and no DC1 after it; its ETX is
/// answered with EOT. A block that comes wrong it sends again.
#[test]
fn drips_over_ext1() {
    for settings in [ext1(1.0), settings(Mode::Fe1), settings(Mode::Fe2)] {
        let stored = Memory::default();
        let mut control = blockwise::Reading::new(settings, Box::new(stored.clone()), saddle(), kind());
        let script = r#"
            T: SOH HSADDLEE ETB BCC DC1
            P: ACK
            P: STX "0 BEGIN PGM SADDLE MM" CR LF ETB BCC
            T: ACK
            P: STX "1 L X+2" CR LF ETB BAD
            T: NAK
            P: STX "1 L X+1" CR LF ETB BCC
            T: ACK
            P: STX "2 END PGM SADDLE MM" CR LF ETB BCC
            T: ACK
            P: ETX
            T: EOT"#;
        let reported = converse(Role::Control, &mut control, script);
        assert_eq!(reported, ["received SADDLE.H", "complete"]);
        assert_eq!(stored.get("SADDLE.H").unwrap(), SADDLE);
    }
}

/// It waits for DC1, sends few NULs, and waits for EOT, which ME alone never sends.
#[test]
fn sends_when_it_is_asked() {
    for (settings, end) in [(ext1(0.0), "T: EOT"), (settings(Mode::Me), "quiet")] {
        let stored = Memory::default();
        let mut control = standard::Reading::new(settings, Box::new(stored.clone()), saddle(), kind());
        let script = format!("T: DC1\nP: {TEXT} ETX\n{end}");
        let reported = converse(Role::Control, &mut control, &script);
        assert_eq!(reported, ["received SADDLE.H", "complete"]);
        assert_eq!(stored.get("SADDLE.H").unwrap(), SADDLE);
    }
}

fn device(settings: Settings, stored: &Memory) -> standard::Peripheral {
    standard::Peripheral::new(settings, Box::new(stored.clone()), Rights::ALL)
}

/// With the option not to wait it sends to a port that obeys, and waits for EOT all the same.
#[test]
fn sends_unasked() {
    for (settings, end) in [(ext1(0.0), "P: EOT"), (settings(Mode::Me), "quiet")] {
        let stored = Memory::default();
        let script = format!("T: {TEXT} ETX\nquiet\n{end}");
        let reported = converse(Role::Device, &mut device(settings, &stored), &script);
        assert_eq!(reported, ["received SADDLE.H", "complete"]);
        assert_eq!(stored.get("SADDLE.H").unwrap(), SADDLE);
    }
    // A control has its own EOT, and who goes on at once needs none.
    for (end, more) in [
        ("ETX EOT", ""),
        (
            "ETX",
            "T: DC1\nP: NUL*50 \"0 BEGIN PGM SADDLE MM\" CR LF \"1 L X+1\" CR LF \"2 END PGM SADDLE MM\" CR LF ETX",
        ),
    ] {
        let stored = Memory::default();
        let script = format!("T: {TEXT} {end}\n{more}");
        converse(Role::Device, &mut device(ext1(0.0), &stored), &script);
        assert_eq!(stored.get("SADDLE.H").unwrap(), SADDLE);
    }
    // EOT comes when nothing else has come for a moment, and once.
    let mut device = device(ext1(0.0), &Memory::default());
    let second = std::time::Duration::from_secs(1);
    for byte in support::bytes(&format!("{TEXT} ETX")) {
        device.receive(byte, second);
    }
    assert!(!device.has_output());
    let deadline = device.deadline().unwrap();
    assert!(deadline > second && deadline < second * 2);
    device.clock(deadline);
    let mut said = Vec::new();
    device.send(10, deadline, &mut said);
    assert_eq!(said, support::bytes("EOT"));
    assert_eq!(device.deadline(), None);
}
