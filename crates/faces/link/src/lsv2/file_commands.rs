//! Telegrams about files and folders.
//!
//! Decision: A file that a host uploads replaces one of its name in one step, with `T_FD`; whatever breaks the upload
//! off leaves the old one. Files of a machine have names of 40 characters without blanks, compared without regard to
//! case (also `store/src/`)

use std::time::UNIX_EPOCH;

use super::peer::Features;
use super::session::{Answer, Session, Task};
use super::transfer::{BINARY, MERGE, Receiving, Sending};
use super::{Command, ErrorNumber, Level, Telegram};
use bahn_store::{Attributes, Existing, PLC, Place, StoreError};

/// Names of attributes in `R_DI`, four characters each, and their values (public).
const ATTRIBUTE_NAMES: usize = 32 * 4;
const ATTRIBUTES: usize = 32;
/// Free room that is reported: nobody counts it (public: controls report such a figure, too).
const FREE: u32 = u32::MAX;

fn done() -> Answer {
    Ok(Telegram::new(Command::T_OK))
}

/// What the store says, as the number of an error; what cannot be done to a file has another one for each action.
fn number(error: &StoreError, protected: ErrorNumber) -> ErrorNumber {
    match error {
        StoreError::Protected(_) => protected,
        other => ErrorNumber::from(other),
    }
}

impl Session {
    /// Where a path leads; the PLC's files need their own login.
    pub(super) fn place(&self, path: &str) -> Result<Place, ErrorNumber> {
        let place = self
            .folder
            .join(path)
            .map_err(|error| ErrorNumber::from(&error))?;
        match place.drive() == PLC && !self.has(Level::FilePlc) {
            true => Err(ErrorNumber::NO_PRIVILEGE),
            false => Ok(place),
        }
    }

    fn place_in(&self, telegram: &Telegram) -> Result<Place, ErrorNumber> {
        let path = telegram.fields().string().ok_or(ErrorNumber::BAD_FORMAT)?;
        self.place(&path)
    }

    fn features(&self) -> Features {
        self.site.device.identity().features
    }
}

/// A file or folder as `S_FI` and `S_DR` report it: size, time, attributes, name.
fn entry(telegram: Telegram, name: &str, attributes: &Attributes, features: Features) -> Telegram {
    let since_1970 = attributes.modified.duration_since(UNIX_EPOCH).unwrap_or_default();
    telegram
        .long(u32::try_from(attributes.size).unwrap_or(u32::MAX))
        .long(u32::try_from(since_1970.as_secs()).unwrap_or(u32::MAX))
        .long(features.encode(attributes))
        .string(name)
}

/// `R_DI`: the current folder.
pub(super) fn folder(session: &mut Session, telegram: &Telegram) -> Answer {
    let path = session.folder.to_string();
    let path = if path.ends_with('\\') { path } else { path + "\\" };
    Ok(Telegram::new(telegram.command.answer())
        .long(FREE)
        .raw(&[0; ATTRIBUTE_NAMES])
        .raw(&[0; ATTRIBUTES])
        .string(&path))
}

/// `C_DC`: goes to a folder; an empty path stays.
pub(super) fn change_folder(session: &mut Session, telegram: &Telegram) -> Answer {
    if telegram.fields().string().is_none_or(|path| path.is_empty()) {
        return done();
    }
    let place = session.place_in(telegram)?;
    let entered = session.site.device.store().enter(&place);
    entered.map_err(|error| ErrorNumber::from(&error))?;
    session.folder = place;
    done()
}

/// `C_DM`: makes a folder.
pub(super) fn make_folder(session: &mut Session, telegram: &Telegram) -> Answer {
    let place = session.place_in(telegram)?;
    let made = session.site.device.store().make_folder(&place);
    made.map_err(|error| number(&error, ErrorNumber::NO_NEW_FILE))?;
    done()
}

/// `C_DD`: removes an empty folder; that in which a client is only where controls do so, who is in the one above then
/// (public).
pub(super) fn remove_folder(session: &mut Session, telegram: &Telegram) -> Answer {
    let place = session.place_in(telegram)?;
    if place.holds(&session.folder) && !session.features().removes_own_folder {
        return Err(ErrorNumber::FOLDER_NOT_EMPTY);
    }
    let store = session.site.device.store();
    store
        .remove_folder(&place)
        .map_err(|error| number(&error, ErrorNumber::FOLDER_NOT_EMPTY))?;
    while store.enter(&session.folder).is_err() {
        let Some(above) = session.folder.folder() else {
            break;
        };
        session.folder = above;
    }
    done()
}

/// `R_DR`: what is in the folder, 0 one in a telegram, 1 many, 2 the drives.
pub(super) fn list(session: &mut Session, telegram: &Telegram) -> Answer {
    let answer = telegram.command.answer();
    let telegrams = match telegram.fields().byte().unwrap_or(0) {
        2 => vec![drives(session, answer)],
        mode @ (0 | 1) => {
            let listed = session.site.device.store().list(&session.folder);
            let entries = listed.map_err(|error| ErrorNumber::from(&error))?;
            let features = session.features();
            let telegrams = entries
                .iter()
                .map(|one| entry(Telegram::new(answer), &one.name, &one.attributes, features));
            match mode {
                0 => telegrams.collect(),
                _ => many(telegrams, session.block),
            }
        }
        _ => return Err(ErrorNumber::WRONG_PARAMETER),
    };
    let mut telegrams = std::collections::VecDeque::from(telegrams);
    let first = telegrams.pop_front();
    if first.is_some() {
        session.task = Task::Listing(telegrams);
    }
    Ok(first.unwrap_or(Telegram::new(Command::T_FD)))
}

/// As many entries in a telegram as a block holds, each at an even place (inferred).
fn many(entries: impl Iterator<Item = Telegram>, block: usize) -> Vec<Telegram> {
    let mut telegrams: Vec<Telegram> = Vec::new();
    for mut entry in entries {
        if entry.data.len() % 2 == 1 {
            entry.data.push(0);
        }
        match telegrams.last_mut() {
            Some(last) if last.data.len() + entry.data.len() + 10 <= block => {
                last.data.append(&mut entry.data)
            }
            _ => telegrams.push(entry),
        }
    }
    telegrams
}

/// The drives, 17 bytes each: size, time, attributes, name with colon (public).
fn drives(session: &Session, answer: Command) -> Telegram {
    let drives = session.site.device.store().drives();
    drives.fold(Telegram::new(answer), |telegram, drive| {
        telegram
            .long(FREE)
            .long(0)
            .long(Features::SHOWN)
            .string(&format!("{drive}:"))
    })
}

/// `R_FI`: what there is to be said of a file or folder.
pub(super) fn file(session: &mut Session, telegram: &Telegram) -> Answer {
    let place = session.place_in(telegram)?;
    let attributes = session.site.device.store().attributes(&place);
    let attributes = attributes.map_err(|error| match error {
        // Clients make a folder when this says that there is no such file.
        StoreError::NoFolder(_) => ErrorNumber::NO_FILE,
        other => ErrorNumber::from(&other),
    })?;
    let drive = || format!("{}:", place.drive());
    let name = place.name().map_or_else(drive, str::to_owned);
    let answer = Telegram::new(telegram.command.answer());
    Ok(entry(answer, &name, &attributes, session.features()))
}

/// `R_FL`: sends a file.
pub(super) fn send(session: &mut Session, telegram: &Telegram) -> Answer {
    let place = session.place_in(telegram)?;
    let flags = flags(telegram);
    let file = session.site.device.store().open(&place);
    let file = file.map_err(|error| ErrorNumber::from(&error))?;
    let mut sending = Sending::new(file, flags & BINARY != 0);
    let first = sending.next(session.block)?;
    session.task = Task::Sending(sending);
    // An empty file is one empty block: clients wait for a block first (public).
    Ok(first.unwrap_or(Telegram::new(telegram.command.answer())))
}

/// The byte after the name.
fn flags(telegram: &Telegram) -> u8 {
    let mut fields = telegram.fields();
    fields.string();
    fields.byte().unwrap_or(0)
}

/// `C_FL`: takes a file. It has its name when `T_FD` has come; one of this name is replaced then, in one step.
pub(super) fn receive(session: &mut Session, telegram: &Telegram) -> Answer {
    let place = session.place_in(telegram)?;
    let flags = flags(telegram);
    if flags & MERGE != 0 {
        return Err(ErrorNumber::WRONG_PARAMETER);
    }
    let file = session.site.device.store().create(&place, Existing::Replace);
    let file = file.map_err(|error| number(&error, ErrorNumber::NO_NEW_FILE))?;
    session.task = Task::Receiving(Receiving::new(file, flags & BINARY != 0));
    done()
}

/// `C_FD`: deletes a file.
pub(super) fn delete(session: &mut Session, telegram: &Telegram) -> Answer {
    let place = session.place_in(telegram)?;
    let deleted = session.site.device.store().delete(&place);
    deleted.map_err(|error| match error {
        StoreError::Protected(_) | StoreError::Busy(_) | StoreError::InUse(_) => ErrorNumber::NO_DELETE,
        other => ErrorNumber::from(&other),
    })?;
    done()
}

fn two_places(session: &Session, telegram: &Telegram) -> Result<(Place, Place), ErrorNumber> {
    let mut fields = telegram.fields();
    let mut next = || fields.string().ok_or(ErrorNumber::BAD_FORMAT);
    let (from, to) = (next()?, next()?);
    Ok((session.place(&from)?, session.place(&to)?))
}

/// `C_FR`: renames a file, or moves it.
pub(super) fn rename(session: &mut Session, telegram: &Telegram) -> Answer {
    let (from, to) = two_places(session, telegram)?;
    let renamed = session.site.device.store().rename(&from, &to);
    renamed.map_err(|error| number(&error, ErrorNumber::NO_RENAME))?;
    done()
}

/// `C_FC`: copies a file.
pub(super) fn copy(session: &mut Session, telegram: &Telegram) -> Answer {
    let (from, to) = two_places(session, telegram)?;
    let copied = session.site.device.store().copy(&from, &to);
    copied.map_err(|error| number(&error, ErrorNumber::NO_NEW_FILE))?;
    done()
}

/// `C_FA`: changes the attributes of a file: bits as `R_FI` reports them, then its name (inferred). Its protection follows.
pub(super) fn change_attributes(session: &mut Session, telegram: &Telegram) -> Answer {
    let mut fields = telegram.fields();
    let bits = fields.long().ok_or(ErrorNumber::BAD_FORMAT)?;
    let path = fields.string().ok_or(ErrorNumber::BAD_FORMAT)?;
    let place = session.place(&path)?;
    let protect = session.features().is_protected(bits);
    let changed = session.site.device.store().protect(&place, protect);
    changed.map_err(|error| number(&error, ErrorNumber::NO_ATTRIBUTE))?;
    done()
}
