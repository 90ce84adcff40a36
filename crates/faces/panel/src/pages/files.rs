//! Program management: the directory, in which a file is chosen, made, copied, renamed, erased and protected
//! [003:981-1023].
//!
//! Decision: How long names and how many files may be holds for what is made at the panel; what is there already is
//! shown and runs
//!
//! Decision: What MP7224.0 disables is hidden on the panel and not erased
//!
//! Decision: Code number 86357 takes the protection by MP7224.1 from one file, until the control is switched off: the manual has one
//! code for protected files and does not say that it passes over those of a type [000:6938]
//!
//! Decision: A name without a type is the program that is there, else one in the language of PROGRAM INPUT; the
//! control knows a program in DIN/ISO by its name with type

use bahn_dialogue::Key;
use bahn_machine::MachineFolder;
use bahn_parameters::MessageId;
use bahn_parameters::code_numbers::CANCEL_PROTECTION;
use bahn_screen::frames;
use bahn_screen::programs::{Denial, Entry, NAME_MAX, is_executed, is_program};
use bahn_screen::{Dialogue, Line, WindowKind};
use bahn_tnc::{Command, Control, RunState};

use crate::page::{Overlay, Page, Turn, View};
use crate::pages::ask::{Choice, Name};
use crate::pages::transfer;
use crate::pages::{list, table};
use crate::site::Site;
use crate::transfer::TransferAction;

/// What a file is chosen for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// It is to run.
    Run,
    /// It is to be edited.
    Edit,
    /// It is to be tested.
    Test,
    /// It is to be read out: EXT [003:6906].
    ReadOut,
    /// It is to be erased: CL PGM [003:985-990].
    Erase,
    /// Its protection is to be taken away: code number 86 357 [003:7028].
    Unprotect,
}

/// The directory of the program memory.
pub(crate) struct Directory {
    purpose: Purpose,
    entries: Vec<Entry>,
    /// The memory as it was listed.
    version: u64,
    current: usize,
    typed: String,
}

impl Directory {
    /// The directory as it is now.
    pub fn new(purpose: Purpose, site: &Site) -> Directory {
        let mut directory = Directory {
            purpose,
            entries: Vec::new(),
            version: 0,
            current: 0,
            typed: String::new(),
        };
        directory.list(site);
        directory
    }

    fn list(&mut self, site: &Site) {
        self.version = site.programs.version();
        self.entries = site.programs.list();
        match self.purpose {
            Purpose::Edit => self.entries.extend(table::of_machine(site)),
            Purpose::Erase | Purpose::ReadOut => {}
            Purpose::Run | Purpose::Test => self.entries.retain(|entry| is_executed(&entry.name)),
            Purpose::Unprotect => self.entries.retain(|entry| is_program(&entry.name)),
        }
        self.entries
            .retain(|entry| !table::is_disabled(&entry.name, site));
        for entry in &mut self.entries {
            entry.protected |= table::is_protected(&entry.name, site);
        }
        self.current = list::moved(self.current, 0, self.entries.len());
    }

    /// The name that is typed, else the one that is highlighted.
    fn name(&self, site: &Site) -> Option<String> {
        match self.typed.is_empty() {
            true => self.entries.get(self.current).map(|entry| entry.name.clone()),
            false => Some(site.with_ending(&self.typed)),
        }
    }

    fn choose(&self, site: &mut Site) -> Turn {
        let Some(name) = self.name(site) else {
            return Turn::Refused;
        };
        if table::is_disabled(&name, site) {
            return Turn::Say(site.message(MessageId::ProgramNotFound));
        }
        let there = site.programs.has(&name);
        let chosen = match self.purpose {
            Purpose::Erase => return erase(name, site),
            Purpose::ReadOut if there => {
                return match transfer::begin(TransferAction::Write(vec![name]), site) {
                    Turn::Open(page) => Turn::Replace(page),
                    other => other,
                };
            }
            Purpose::ReadOut => false,
            Purpose::Unprotect => {
                return match unprotect(&name, site) {
                    Ok(()) => Turn::Done,
                    Err(denial) => Turn::Say(said(denial, site)),
                };
            }
            Purpose::Edit if self.typed == "0" => return table::tools(site),
            Purpose::Edit if table::is_of_machine(&name, site) => return table::open(&name, site),
            Purpose::Edit if !there => return create(name, site),
            Purpose::Edit if table::is_table(&name) => return table::open(&name, site),
            // The dialogue writes the control's own languages alone.
            Purpose::Edit
                if site
                    .programs
                    .read(&name)
                    .is_some_and(|own| own.dialect().is_some()) =>
            {
                return Turn::Say(site.message(MessageId::BlockNotSupported));
            }
            Purpose::Edit => {
                site.settings.edited = Some(name);
                true
            }
            Purpose::Run => there && site.command(Command::Select(selection(&name).to_owned())),
            Purpose::Test => {
                if there {
                    site.settings.edited = Some(name);
                }
                there
            }
        };
        match chosen {
            true => Turn::Close,
            false => Turn::Say(site.message(MessageId::ProgramNotFound)),
        }
    }

    fn copy(&self, site: &Site) -> Turn {
        let Some(old) = self.name(site) else {
            return Turn::Refused;
        };
        let prompt = format!("{} {}", site.words("DESTINATION FILE ="), ending(&old));
        Turn::Open(Name::ask(prompt, NAME_MAX, move |new, site| {
            let new = like(&new, &old);
            let may = may_be_called(&new, site).and_then(|()| has_room(&new, site));
            done(may.and_then(|()| site.programs.copy(&old, &new)), site)
        }))
    }

    fn rename(&self, site: &Site) -> Turn {
        let Some(old) = self.name(site) else {
            return Turn::Refused;
        };
        if is_needed(&old, site.control(), &site.machine.folder) {
            return in_use(site);
        }
        let prompt = format!("{} {}", site.words("NEW FILE NAME ="), ending(&old));
        Turn::Open(Name::ask(prompt, NAME_MAX, move |new, site| {
            let new = like(&new, &old);
            let renamed = match table::is_protected(&old, site) {
                true => Err(Denial::Message(MessageId::ProtectedPgm)),
                false => may_be_called(&new, site).and_then(|()| site.programs.rename(&old, &new)),
            };
            if renamed.is_ok() && site.settings.edited.as_ref() == Some(&old) {
                site.settings.edited = Some(new);
            }
            done(renamed, site)
        }))
    }

    fn protect(&self, site: &Site) -> Turn {
        match self.name(site).map(|name| site.programs.protect(&name, true)) {
            Some(Ok(())) => Turn::Done,
            Some(Err(denial)) => Turn::Say(said(denial, site)),
            None => Turn::Refused,
        }
    }

    /// The key P protects, and asks before it takes protection away.
    fn turn_protection(&self, site: &Site) -> Turn {
        let name = self.name(site);
        let mut entries = self.entries.iter();
        match entries.any(|entry| name.as_ref() == Some(&entry.name) && entry.protected) {
            true => self.cancel_protection(site),
            false => self.protect(site),
        }
    }

    /// The soft key UNPROTECT asks for the code number before.
    fn cancel_protection(&self, site: &Site) -> Turn {
        let Some(name) = self.name(site) else {
            return Turn::Refused;
        };
        let prompt = site.words("CODE NUMBER =");
        Turn::Open(Name::ask(prompt, NAME_MAX, move |code, site| {
            if code.parse() != Ok(CANCEL_PROTECTION) {
                return Turn::Say(site.message(MessageId::EntryValueIncorrect));
            }
            let unprotected = unprotect(&name, site);
            done(unprotected, site)
        }))
    }
}

/// The name by which the control knows a program: with its type where that is not plain language.
pub(crate) fn selection(name: &str) -> &str {
    match name.rsplit_once('.') {
        Some((stem, ending)) if ending.eq_ignore_ascii_case("H") => stem,
        _ => name,
    }
}

/// Whether a program that the control has by some name is a file of the memory: without a type it may be any.
pub(crate) fn is_same(own: &str, name: &str) -> bool {
    match own.contains('.') {
        true => own.eq_ignore_ascii_case(name),
        false => own.eq_ignore_ascii_case(stem(name)),
    }
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

fn ending(name: &str) -> String {
    name.rsplit_once('.')
        .map_or_else(String::new, |(_, ending)| format!(".{ending}"))
}

/// The type of a file in the directory: programs in DIN/ISO of a TNC 360 are indicated with "ISO", others there have no
/// type [003:977].
fn kind_of(name: &str, site: &Site) -> String {
    let own = ending(name);
    match site.control().model().has_windows() || !is_program(name) {
        true => own,
        false if own.eq_ignore_ascii_case(".I") => "ISO".to_owned(),
        false => String::new(),
    }
}

/// A new name with the type of an old one, when it says none.
fn like(new: &str, old: &str) -> String {
    match new.contains('.') {
        true => new.to_owned(),
        false => format!("{new}{}", ending(old)),
    }
}

/// Characters of a new name without its type: eight on the TNC 360 and before [003:979], later as MP7222 says
/// [000:6847-6852].
fn name_max(site: &Site) -> usize {
    usize::from(site.parameters().operation_parameters().file_name_max)
}

/// A new file may have this name.
fn may_be_called(name: &str, site: &Site) -> Result<(), Denial> {
    match site.programs.path(name).is_some() && stem(name).len() <= name_max(site) {
        true => Ok(()),
        false => Err(Denial::Message(MessageId::EntryValueIncorrect)),
    }
}

/// The memory takes one more file: a TNC 360 up to 32 programs [003:977], a TNC 407 and later up to 100 files [000:171],
/// unless `files_max` of the machine says another number, or 0 for any.
fn has_room(name: &str, site: &Site) -> Result<(), Denial> {
    let files = site.programs.list();
    let model = site.control().model();
    let of_model = model.limits().files_max as usize;
    let most = site.machine.folder.files_max.unwrap_or(of_model);
    let counted = files
        .iter()
        .filter(|file| model.has_windows() || is_program(&file.name));
    let counts = model.has_windows() || is_program(name);
    match most == 0 || !counts || counted.count() < most {
        true => Ok(()),
        false => Err(Denial::Message(MessageId::FurtherProgramEntryImpossible)),
    }
}

/// A new file: programs have a unit [003:2085-2121].
fn create(name: String, site: &mut Site) -> Turn {
    let may = may_be_called(&name, site).and_then(|()| has_room(&name, site));
    if let Err(denial) = may {
        return Turn::Say(said(denial, site));
    }
    if !frames::has_unit(&name) {
        return created(&name, false, site);
    }
    let names = ["MM".to_owned(), "INCH".to_owned()];
    Turn::Replace(Choice::ask(
        site.words("MM = ENT / INCH = NO ENT"),
        names,
        move |mm, site| created(&name, !mm, site),
    ))
}

fn created(name: &str, inch: bool, site: &mut Site) -> Turn {
    match site.programs.create(name, inch) {
        Ok(()) if table::is_table(name) => table::open(name, site),
        Ok(()) => {
            site.settings.edited = Some(name.to_owned());
            Turn::Close
        }
        Err(denial) => Turn::CloseSaying(said(denial, site)),
    }
}

/// Asks before a file is erased [003:985-990].
fn erase(name: String, site: &mut Site) -> Turn {
    if !site.programs.has(&name) {
        return Turn::Say(site.message(MessageId::ProgramNotFound));
    }
    if is_needed(&name, site.control(), &site.machine.folder) {
        return in_use(site);
    }
    let prompt = format!("{name}: {}", site.words("ERASE = ENT / END = NO ENT"));
    Turn::Open(Choice::confirm(prompt, site.words("ERASE"), move |site| {
        // It may have been started meanwhile.
        if is_needed(&name, site.control(), &site.machine.folder) {
            return in_use(site);
        }
        let erased = match table::is_protected(&name, site) {
            true => Err(Denial::Message(MessageId::ProtectedPgm)),
            false => site.programs.erase(&name),
        };
        if erased.is_ok() && site.settings.edited.as_ref() == Some(&name) {
            site.settings.edited = None;
        }
        done(erased, site)
    }))
}

/// Takes away the protection by the type of a file, and that of a program by its first block.
fn unprotect(name: &str, site: &mut Site) -> Result<(), Denial> {
    let by_type = table::is_protected(name, site);
    if by_type {
        site.settings.unprotected.insert(name.to_owned());
    }
    match site.programs.protect(name, false) {
        Err(_) if by_type => Ok(()),
        result => result,
    }
}

/// A program runs, or the machine is not switched on again without the file.
pub(crate) fn is_needed(name: &str, control: &Control, folder: &MachineFolder) -> bool {
    let mut named = [&folder.datum_table, &folder.pallets].into_iter().flatten();
    runs(name, control) || named.any(|own| own.eq_ignore_ascii_case(name))
}

/// A program run, interrupted or not, has the file.
pub(crate) fn runs(name: &str, control: &Control) -> bool {
    let selected = control.selected_program().is_some_and(|own| is_same(own, name));
    let called = || {
        control.reader().is_some_and(|run| {
            let mut programs = (0..).map_while(|index| run.program(index));
            programs.any(|own| is_same(file_name(own.name()), name))
        })
    };
    control.run_state() != RunState::Idle && is_executed(name) && (selected || called())
}

/// A program may be named by its path.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

fn in_use(site: &Site) -> Turn {
    Turn::Say(site.words("BACKGROUND PROGRAMMING NOT POSSIBLE"))
}

fn done(result: Result<(), Denial>, site: &Site) -> Turn {
    match result {
        Ok(()) => Turn::Close,
        Err(denial) => Turn::CloseSaying(said(denial, site)),
    }
}

fn said(denial: Denial, site: &Site) -> String {
    match denial {
        Denial::Message(id) => site.message(id),
        Denial::Words(words) => words,
    }
}

impl Page for Directory {
    fn overlay(&self) -> Overlay {
        Overlay::Directory
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            self.current = list::moved(self.current, lines, self.entries.len());
            return Turn::Done;
        }
        let edits = self.purpose == Purpose::Edit;
        match key {
            Key::Ent => {
                let turn = self.choose(site);
                // The number of the next one to be erased begins anew.
                if self.purpose == Purpose::Erase {
                    self.typed.clear();
                }
                return turn;
            }
            Key::ClPgm if edits => {
                return self.name(site).map_or(Turn::Refused, |name| erase(name, site));
            }
            Key::P if edits && !site.control().model().has_soft_keys() => return self.turn_protection(site),
            Key::End | Key::Del | Key::NoEnt | Key::PgmNr | Key::ClPgm => return Turn::Close,
            Key::Ce if !self.typed.is_empty() => self.typed.clear(),
            _ => match key.character() {
                Some(character) if self.typed.len() < NAME_MAX => self.typed.push(character),
                _ => return Turn::Refused,
            },
        }
        Turn::Done
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let mut keys = vec![String::new(); 8];
        let edits = self.purpose == Purpose::Edit;
        let select = match self.purpose {
            Purpose::Erase => site.words("ERASE"),
            Purpose::Unprotect => site.words("UNPROTECT"),
            Purpose::ReadOut => site.words("READ-OUT"),
            _ => site.words("SELECT"),
        };
        let named = [
            (0, true, select),
            (1, edits, site.words("COPY")),
            (2, edits, site.words("RENAME")),
            (3, edits, site.words("ERASE")),
            (4, edits, site.words("PROTECT")),
            (5, edits, site.words("UNPROTECT")),
            (7, true, site.words("END")),
        ];
        for (place, there, text) in named {
            if let Some(key) = keys.get_mut(place).filter(|_| there) {
                *key = text;
            }
        }
        vec![keys]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 => self.choose(site),
            1 => self.copy(site),
            2 => self.rename(site),
            3 => self.name(site).map_or(Turn::Refused, |name| erase(name, site)),
            4 => self.protect(site),
            5 => self.cancel_protection(site),
            _ => Turn::Close,
        }
    }

    fn text(&mut self, text: &str, _site: &mut Site) -> Turn {
        match text.is_ascii() && text.len() <= NAME_MAX {
            true => {
                text.clone_into(&mut self.typed);
                Turn::Done
            }
            false => Turn::Refused,
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let row = |place: usize, entry: &Entry| Line {
            text: format!(
                "{:<16} {:<5} {:>10} {}",
                stem(&entry.name),
                kind_of(&entry.name, site),
                entry.size,
                if entry.protected { "P" } else { "" }
            )
            .trim_end()
            .to_owned(),
            current: place == self.current,
            ..Line::default()
        };
        let line = |place| {
            let entry = self.entries.get(place);
            entry.map_or_else(Line::default, |entry| row(place, entry))
        };
        let (title, cursor) = (
            site.words("PROGRAM DIRECTORY"),
            (self.current, self.entries.len()),
        );
        View {
            window: Some(list::window(title, WindowKind::List, cursor, lines, line)),
            dialogue: Dialogue {
                prompt: match self.purpose {
                    Purpose::Erase => site.words("ERASE PROGRAM ="),
                    Purpose::Unprotect => site.words("CANCEL PROTECTION OF PROGRAM ="),
                    _ => site.words("PROGRAM NUMBER ="),
                },
                entry: self.typed.clone(),
                open: true,
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        if self.version != site.programs.version() {
            self.list(site);
        }
        Turn::Done
    }
}
