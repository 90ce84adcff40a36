//! BACKUP DATA and RESTORE DATA: everything of the machine as one file over the data interface [000:463-467].
//!
//! While it is on its way the file lies in the program memory, which the data interfaces read and write.
//!
//! Decision: Between BACKUP DATA or RESTORE DATA and the interface the backup is the file $BACKUP.A of the program
//! memory, which goes when the transfer ends. RESTORE DATA asks before, needs a machine that runs no program, and
//! switches the machine on anew. What was is backed up before, and comes back where no machine can be switched on
//! with what is restored; files that only the restored backup had stay then

use std::fs::File;
use std::io::BufReader;

use bahn_host::backup::{BACKUP_NAME, BackupError, Restore, back_up};
use bahn_host::files;
use bahn_parameters::MessageId;

use crate::page::Turn;
use crate::pages::ask::Choice;
use crate::pages::transfer;
use crate::site::Site;
use crate::transfer::{TransferAction, TransferFiles};

/// Its name in the program memory; programs of the manufacturer store it as `$BACKUP.ANC`.
fn name() -> String {
    format!("{BACKUP_NAME}.A")
}

/// BACKUP DATA: writes everything that the control keeps to the device.
pub(crate) fn save(site: &mut Site) -> Turn {
    let written = everything(site).and_then(|text| site.programs.write(&name(), text.as_bytes()));
    match written {
        Ok(()) => begun(TransferAction::Write(vec![name()]), site),
        Err(why) => Turn::Say(why),
    }
}

/// All files of the machine as they are now.
///
/// # Errors
/// In words: one of them cannot be written, read or carried.
pub(crate) fn everything(site: &mut Site) -> Result<String, String> {
    site.host.store().map_err(|error| error.to_string())?;
    let mut text = String::new();
    let count = back_up(&site.machine.root, &site.machine.folder.name, |line| {
        text.push_str(line);
        text.push('\n');
        Ok(())
    });
    count.map_err(|error| error.to_string())?;
    Ok(text)
}

/// RESTORE DATA replaces what is there: it is asked for.
pub(crate) fn ask_to_restore(site: &Site) -> Turn {
    if !site.is_idle() {
        return Turn::Say(site.message(MessageId::KeyNonFunctional));
    }
    let erase = site.message(MessageId::EraseOverread);
    let prompt = format!("{erase} {BACKUP_NAME}: {}", site.words("YES = ENT / NO = NO ENT"));
    let restore = site.words("RESTORE DATA");
    Turn::Open(Choice::confirm(prompt, restore, |site| {
        match begun(TransferAction::Read(name()), site) {
            Turn::Open(page) => Turn::Replace(page),
            Turn::Say(why) => Turn::CloseSaying(why),
            turn => turn,
        }
    }))
}

/// A transfer that does not begin leaves nothing.
fn begun(action: TransferAction, site: &mut Site) -> Turn {
    let turn = transfer::begin_with(TransferFiles::Backup, action, site);
    if !matches!(turn, Turn::Open(_)) {
        ended(site);
    }
    turn
}

/// The transfer is over: nothing of it stays in the program memory.
pub(crate) fn ended(site: &mut Site) {
    if site.programs.has(&name()) {
        // It is removed with the next one.
        let _ = site.programs.erase(&name());
    }
}

/// What was read in, ready to take the place of what is there.
///
/// # Errors
/// In words: it is damaged, or a program runs.
pub(crate) fn restored(site: &Site) -> Result<Restore, String> {
    if !site.is_idle() {
        return Err(site.message(MessageId::KeyNonFunctional));
    }
    let path = site.programs.path(&name()).unwrap_or_default();
    let file = File::open(&path).map_err(|error| files::cannot("read", &path, &error).to_string())?;
    let read = Restore::read(&site.machine.root, BufReader::new(file));
    let complete = |restore: Restore| match restore.is_complete() {
        true => Ok(restore),
        false => Err(BackupError::Incomplete),
    };
    read.and_then(complete).map_err(|error| error.to_string())
}
