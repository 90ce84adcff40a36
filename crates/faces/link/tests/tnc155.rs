//! The protocol with check characters as a TNC 155 speaks it.
#![allow(clippy::unwrap_used, reason = "what fails here fails the test")]

mod support;

use bahn_link::blockwise::{Peripheral, Reading, Rights, Want, Writing};
use bahn_link::{FileType, Memory, Mode};
use bahn_parameters::equipment::{Equipment, Release};
use bahn_parameters::{ControlModel, ParameterList};
use support::{Role, converse};

const ONE: &str = "0 BEGIN PGM 1 MM\n1 L X+1\n2 END PGM 1 MM\n";

/// The control reads program 1; what stands behind check characters is put in.
const READ_ONE: &str = r#"T: SOH %1E ETB BCC{dc1}
    P: ACK
    P: STX "0 BEGIN PGM 1 MM" ETB BCC{dc1}
    T: ACK
    P: STX "1 L X+1" ETB BCC{dc1}
    T: ACK
    P: STX "2 END PGM 1 MM" ETB BCC{dc1}
    T: ACK
    P: ETX
    T: EOT"#;

/// The TNC 155 knows programs by their number only: % stands before it, and it shows no letter after its messages
/// [001:2080-2126] [001:2036-2052].
#[test]
fn a_tnc_155() {
    for (level, dc1) in [(4, " DC1"), (5, ""), (8, "")] {
        a_tnc_155_of_level(level, dc1);
    }
}

/// DC1 stands behind headers and blocks below software level 05; from there on ACK and NAK alone control the flow, whatever MP222
/// says [001:1946-1948].
fn a_tnc_155_of_level(level: u8, dc1: &str) {
    let mut list = ParameterList::reference(ControlModel::Tnc155);
    for (number, value) in [(222, 168.0), (223, 1.0), (92, 1.0)] {
        list.set(number, 0, value).unwrap();
    }
    let mut equipment = Equipment::default();
    equipment.release = Release::read(ControlModel::Tnc155, &level.to_string()).ok();
    let list = list.with_equipment(equipment);
    let settings = bahn_link::Settings::of(&list, Mode::Ext1);
    assert!(!settings.stop_by_rts);
    let script = READ_ONE.replace("{dc1}", dc1);
    let stored = Memory::default();
    let kind = FileType::of_code('H').unwrap();
    let files = || Box::new(stored.clone());
    let device = || Peripheral::new(settings, files(), Rights::ALL);
    let reported = converse(
        Role::Control,
        &mut Reading::new(settings, files(), Want::Selected("1.H".into()), kind),
        &script,
    );
    assert_eq!(reported, ["received 1.H", "complete"]);
    assert_eq!(stored.get("1.H").unwrap(), ONE);
    let reported = converse(Role::Device, &mut device(), &script);
    assert_eq!(reported, ["sent 1.H", "complete"]);
    // What comes gets its type by its first line.
    for (line, last, name) in [
        ("0 BEGIN PGM 7 MM", "1 END PGM 7 MM", "7.H"),
        ("%7 G71", "N99999 %7 G71", "7.I"),
    ] {
        let script = format!(
            "T: SOH %7A ETB BCC{dc1}\nP: ACK\nT: STX \"{line}\" ETB BCC{dc1}\nP: ACK\nT: STX \"{last}\" ETB BCC{dc1}\nP: ACK\nT: ETX"
        );
        converse(Role::Device, &mut device(), &script);
        assert_eq!(stored.get(name).unwrap(), format!("{line}\n{last}\n"));
    }
    let header = format!("T: SOH %1A ETB BCC{dc1}\n");
    let script = format!("{header}P: NAK\n{header}P: NAK\n{header}P: NAK\nT: EOT");
    let mut control = Writing::new(settings, files(), vec!["1.H".to_owned()], false);
    converse(Role::Control, &mut control, &script);
    let shown = bahn_link::Shown::Control(bahn_parameters::MessageId::TransferredDataIncorrect, Some('E'));
    assert_eq!(shown.text(ControlModel::Tnc155), "TRANSFERRED DATA INCORRECT");
}
