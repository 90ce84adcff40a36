//! RESTORE DATA and commissioning where something fails: the machine stays on, and what it keeps is kept
//! [000:463-467] [000:10011].

use crate::support::Trainee;
use bahn_host::backup::back_up;
use bahn_panel::Station;

/// A backup of the machine as it would be with something else in one of its files.
fn backup_with(trainee: &mut Trainee, name: &str, text: &str) -> String {
    trainee.station.store().unwrap();
    let before = trainee.file(name);
    trainee.write(name, text);
    let mut lines = String::new();
    back_up(trainee.folder(), "mill", |line| {
        lines += &format!("{line}\n");
        Ok(())
    })
    .unwrap();
    trainee.write(name, &before);
    lines
}

/// RESTORE DATA with a backup that comes from a device.
fn restore(trainee: &mut Trainee, backup: &str) {
    let orders = trainee.station.transfer_orders();
    trainee.give(r#"{"transfer":"connected 0"}"#);
    trainee.press("PROGRAM MOD");
    trainee.down_to("CODE NUMBER");
    trainee.press("ENT").number("95148").press("ENT MOD");
    trainee.soft("RESTORE DATA");
    trainee.press("ENT");
    assert!(orders.try_recv().is_ok());
    trainee.write("programs/$BACKUP.A", backup);
    trainee.give(r#"{"transfer":"received $BACKUP.A"}"#);
    trainee.give(r#"{"transfer":"ended complete"}"#);
}

/// What the control kept, so that its check sum is wrong.
fn damaged(kept: &str) -> String {
    kept.replace("tool = ", "tool = 1")
}

/// The machine is on with what it had, and keeps what is done from now on: over power-off a datum and a retained marker are
/// what they were made.
fn is_on_and_keeps(mut trainee: Trainee) {
    assert!(!trainee.station.control().is_off());
    trainee.wait(0.5).press("CE CE CE MANUAL");
    trainee.give(r#"{"action":"datum X 12.5"}"#);
    trainee.give(r#"{"action":"M1000=1"}"#).wait(0.5);
    trainee.station.store().unwrap();
    let datums = trainee.station.control().remember().datums;
    let mut trainee = trainee.killed();
    trainee.wait(0.1);
    assert_eq!(trainee.station.control().remember().datums, datums);
    let marker = "M1000".parse().unwrap();
    assert!(trainee.station.control().exchange().plc().bit(marker));
}

/// Every check sum of the backup is right, but its machine.toml names no machine: nothing of it is restored.
#[test]
fn a_backup_with_which_no_machine_can_be_changes_nothing() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let description = trainee.file("machine.toml");
    let circle = trainee.file("programs/CIRCLE.H");
    trainee.write("programs/CIRCLE.H", "BEGIN PGM CIRCLE MM\nEND PGM CIRCLE MM\n");
    let backup = backup_with(&mut trainee, "machine.toml", "model = \"tnc999\"\n");
    trainee.write("programs/CIRCLE.H", &circle);
    restore(&mut trainee, &backup);
    assert!(!trainee.messages().is_empty());
    assert_eq!(trainee.file("machine.toml"), description);
    assert_eq!(trainee.file("programs/CIRCLE.H"), circle);
    is_on_and_keeps(trainee);
}

/// The machine can be loaded, but what the control remembered cannot be read.
#[test]
fn a_backup_whose_state_cannot_be_read_changes_nothing() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.station.store().unwrap();
    let kept = trainee.file("state/control.toml");
    let backup = backup_with(&mut trainee, "state/control.toml", &damaged(&kept));
    restore(&mut trainee, &backup);
    let said = trainee.messages().join(" ");
    assert!(said.contains("control.toml"), "{said}");
    assert_eq!(trainee.file("state/control.toml"), kept);
    is_on_and_keeps(trainee);
}

/// The first message is that of power-on; what of the operator's choice cannot be read is said as at any power-on.
#[test]
fn what_cannot_be_read_of_the_settings_of_a_backup_is_said() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.press("MOD");
    trainee.down_to("PROGRAM INPUT");
    trainee.press("ENT END");
    let backup = backup_with(&mut trainee, "state/panel.json", "{");
    restore(&mut trainee, &backup);
    let said = trainee.messages().join(" ");
    assert!(
        said.contains("WHAT THE OPERATOR HAS CHOSEN CANNOT BE READ"),
        "{said}"
    );
}

/// The list is whole, but what the control kept was damaged meanwhile: the editor stays, and END tries again.
#[test]
fn the_list_stays_presented_while_what_is_kept_cannot_be_read() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    trainee.station.store().unwrap();
    let list = trainee.file("parameters.mp");
    trainee.write("parameters.mp", &list.replace("MP10     : %01111", "MP10 : ?"));
    let mut trainee = trainee.killed();
    trainee.wait(0.1);
    let kept = trainee.file("state/control.toml");
    trainee.write("state/control.toml", &damaged(&kept));
    trainee.press("SK1").number("1111").press("END").wait(0.1);
    let said = trainee.messages().join(" ");
    assert!(said.contains("control.toml"), "{said}");
    assert_eq!(trainee.screen().program.title, "MACHINE PARAMETERS");
    assert!(trainee.station.control().is_off());
    trainee.write("state/control.toml", &kept);
    trainee.press("CE END");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    assert_eq!(trainee.messages(), ["POWER INTERRUPTED"]);
}

/// A list that is there and cannot be read is no empty one: nobody writes over it.
#[test]
fn a_list_that_cannot_be_read_is_a_fault_of_the_folder() {
    let trainee = Trainee::at("mill");
    let (station, folder) = trainee.apart();
    drop(station);
    let list = folder.join("parameters.mp");
    std::fs::remove_file(&list).unwrap();
    std::fs::create_dir(&list).unwrap();
    let refused = bahn_panel::load(&folder).err().unwrap();
    // More than 16 MiB are no list, either.
    std::fs::remove_dir(&list).unwrap();
    std::fs::File::create(&list)
        .unwrap()
        .set_len((16 << 20) + 1)
        .unwrap();
    let too_large = bahn_panel::load(&folder).err().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    for text in [refused, too_large] {
        assert!(text.contains("parameters.mp"), "{text}");
    }
}

/// The list cannot be presented: the machine is loaded anew when the supply is switched on once more, not by itself.
#[test]
fn what_cannot_be_presented_is_tried_again_with_the_supply() {
    let trainee = Trainee::with("mill", |folder| {
        std::fs::write(folder.join("parameters.mp"), "MP10 : x\n").unwrap();
    });
    let (station, folder) = trainee.apart();
    drop(station);
    let list = folder.join("parameters.mp");
    let machine = bahn_panel::load(&folder).unwrap();
    std::fs::remove_file(&list).unwrap();
    std::fs::create_dir(&list).unwrap();
    let mut station = Station::power_on(machine).unwrap();
    let title = |station: &mut Station| station.screen().program.title.clone();
    station.cycle().unwrap();
    assert_ne!(title(&mut station), "MACHINE PARAMETERS");
    assert_eq!(station.screen().messages.len(), 1);
    std::fs::remove_dir(&list).unwrap();
    std::fs::write(&list, "MP10 : y\n").unwrap();
    for _ in 0..10 {
        station.cycle().unwrap();
    }
    assert_ne!(title(&mut station), "MACHINE PARAMETERS");
    station
        .input(&bahn_panel::Input::Power(bahn_panel::Switch::On))
        .unwrap();
    station.cycle().unwrap();
    assert_eq!(title(&mut station), "MACHINE PARAMETERS");
    drop(station);
    std::fs::remove_dir_all(&folder).unwrap();
}
