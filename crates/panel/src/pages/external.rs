//! EXT: programs are read in from a device and read out to it, while the machine goes on [003:6880-6930]
//! [000:17231-17349]. The menu is that of the TNC 360 on all controls; READ-OUT PROGRAM OFFERED is the output with
//! acknowledgement of later ones.

use bahn_control::Mode;
use bahn_dialogue::Key;
use bahn_parameters::MessageId;

use crate::page::{Page, Side, Turn, View};
use crate::pages::ask::Name;
use crate::pages::files::{Directory, Purpose, with_ending};
use crate::pages::list;
use crate::pages::supplementary::order;
use crate::programs::NAME_MAX;
use crate::screen::{Dialogue, Line, WindowKind};
use crate::site::Site;
use crate::transfer::{TransferDeed, TransferNews};

/// The lines of the menu [003:6893-6910].
const MENU: [&str; 7] = [
    "PROGRAM DIRECTORY",
    "READ-IN ALL PROGRAMS",
    "READ-IN PROGRAM OFFERED",
    "READ-IN SELECTED PROGRAM",
    "READ-OUT SELECTED PROGRAM",
    "READ-OUT ALL PROGRAMS",
    "READ-OUT PROGRAM OFFERED",
];

/// EXT: in PROGRAMMING AND EDITING the menu, or the transfer that is under way.
pub(crate) fn open(side: Side, site: &mut Site) -> Turn {
    match side {
        Side::Programming if site.transfers.is_running() => Turn::Open(Box::new(Transfer::default())),
        Side::Programming => Turn::Open(Box::new(Menu::default())),
        // A program that is executed while it is transferred is started by the computer (docs/dnc.md).
        Side::Machine if matches!(site.mode(), Mode::SingleBlock | Mode::FullSequence) => {
            Turn::Say(site.message(MessageId::ExtInOutputNotReady))
        }
        Side::Machine => Turn::Refused,
    }
}

/// The menu.
#[derive(Default)]
struct Menu {
    current: usize,
}

impl Menu {
    fn choose(&self, site: &mut Site) -> Turn {
        let all = |site: &Site| -> Vec<String> {
            let programs = site.programs.list().into_iter();
            programs.map(|entry| entry.name).collect()
        };
        match self.current {
            0 => begin(TransferDeed::Directory, site),
            1 => begin(TransferDeed::ReadAll, site),
            2 => begin(TransferDeed::ReadOffered, site),
            3 => Turn::Open(Name::ask(
                site.words("PROGRAM NUMBER ="),
                NAME_MAX + 4,
                |name, site| match begin(TransferDeed::Read(with_ending(&name, site)), site) {
                    Turn::Open(page) => Turn::Replace(page),
                    other => other,
                },
            )),
            4 => Turn::Open(Box::new(Directory::new(Purpose::ReadOut, site))),
            5 => begin(TransferDeed::Write(all(site)), site),
            _ => begin(TransferDeed::WriteOffered(all(site)), site),
        }
    }
}

/// Begins a transfer and shows it.
pub(crate) fn begin(deed: TransferDeed, site: &mut Site) -> Turn {
    if matches!(&deed, TransferDeed::Write(names) | TransferDeed::WriteOffered(names) if names.is_empty()) {
        return Turn::Say(site.message(MessageId::ProgramNotFound));
    }
    let begun = order(deed, site).and_then(|order| site.transfers.begin(order));
    match begun {
        Ok(()) => Turn::Open(Box::new(Transfer::default())),
        Err(message) => Turn::Say(site.message(message)),
    }
}

impl Page for Menu {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            self.current = list::moved(self.current, lines, MENU.len());
            return Turn::Done;
        }
        match key {
            Key::Ent => self.choose(site),
            Key::NoEnt | Key::End | Key::Del | Key::Ext => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![site.words("SELECT"), site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        self.key(if place == 0 { Key::Ent } else { Key::End }, site)
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let line = |place: usize| Line {
            text: MENU.get(place).map_or_else(String::new, |name| site.words(name)),
            current: place == self.current,
            ..Line::default()
        };
        let cursor = (self.current, MENU.len());
        let title = site.words("EXTERNAL DATA TRANSFER");
        View {
            window: Some(list::window(title, WindowKind::List, cursor, lines, line)),
            dialogue: Dialogue {
                prompt: site.words("SELECTION = ENT / END = NO ENT"),
                ..Dialogue::default()
            },
        }
    }
}

/// A transfer that is under way, or over: what has come and gone, and what is asked.
#[derive(Default)]
struct Transfer {
    current: usize,
}

impl Transfer {
    /// The name at the cursor, where it is one on the medium of the device.
    fn listed(&self, site: &Site) -> Option<String> {
        match site.transfers.told.get(self.current) {
            Some(TransferNews::Listed(name, _)) => Some(name.clone()),
            _ => None,
        }
    }
}

impl Page for Transfer {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        let done = |taken: bool| if taken { Turn::Done } else { Turn::Refused };
        if let Some(lines) = list::way_of_key(key) {
            self.current = list::moved(self.current, lines, site.transfers.told.len());
            return Turn::Done;
        }
        match (key, site.transfers.is_running()) {
            (Key::Ent | Key::NoEnt, true) => done(site.transfers.answer(key == Key::Ent)),
            (Key::End, true) => done(site.transfers.end()),
            // A program of the directory is read in.
            (Key::Ent, false) => match self.listed(site) {
                Some(name) => {
                    let turn = begin(TransferDeed::Read(with_ending(&name, site)), site);
                    match turn {
                        Turn::Open(page) => Turn::Replace(page),
                        other => other,
                    }
                }
                None => Turn::Close,
            },
            (Key::NoEnt | Key::End | Key::Del | Key::Ext, false) => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let asks = site.transfers.question.is_some();
        let read = !site.transfers.is_running() && self.listed(site).is_some();
        let first = match (asks, read) {
            (true, _) => "ENT".to_owned(),
            (false, true) => site.words("READ-IN"),
            _ => String::new(),
        };
        let second = if asks { "NO ENT" } else { "" };
        vec![vec![first, second.to_owned(), site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        let key = [Key::Ent, Key::NoEnt].get(place).copied();
        self.key(key.unwrap_or(Key::End), site)
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let told = &site.transfers.told;
        let line = |place: usize| Line {
            text: told
                .get(place)
                .map_or_else(String::new, |news| text_of(news, site)),
            current: place == self.current,
            ..Line::default()
        };
        let prompt = match (&site.transfers.question, site.transfers.is_running()) {
            (Some(question), _) => text_of(question, site),
            (None, true) => site.words("DATA TRANSFER RUNS: END BREAKS IT OFF"),
            (None, false) => site.words("DATA TRANSFER HAS ENDED"),
        };
        let title = site.words("EXTERNAL DATA TRANSFER");
        View {
            window: Some(list::window(
                title,
                WindowKind::List,
                (self.current, told.len()),
                lines,
                line,
            )),
            dialogue: Dialogue {
                prompt,
                ..Dialogue::default()
            },
        }
    }
}

/// News as a line of the window, or as a question.
fn text_of(news: &TransferNews, site: &Site) -> String {
    let behind = |name: &String, words| format!("{name}  {}", site.words(words));
    let asked =
        |words, name: &String, answers| format!("{} {name}: {}", site.words(words), site.words(answers));
    match news {
        TransferNews::Connected(_) => String::new(),
        TransferNews::Listed(name, Some(sectors)) => format!("{name:<20}{sectors:>6}"),
        TransferNews::Listed(name, None) => name.clone(),
        TransferNews::Free(sectors) => format!("FREE: {sectors}"),
        TransferNews::Received(name) => behind(name, "READ IN"),
        TransferNews::Sent(name) => behind(name, "READ OUT"),
        TransferNews::Overread(name) => asked("ERASE/OVERREAD", name, "YES = ENT / NO = NO ENT"),
        TransferNews::Offered(name) => asked("READ-IN", name, "YES = ENT / NO = NO ENT"),
        TransferNews::Output(name) => asked("READ-OUT", name, "YES = ENT / NO = NO ENT"),
        TransferNews::Protected(name) => asked("PROTECTED PGM", name, "CONTINUE = ENT / END = NO ENT"),
        TransferNews::Message(text) => crate::texts::translate(site.language(), text),
        TransferNews::Ended(true) => site.words("COMPLETE"),
        TransferNews::Ended(false) => site.words("NOT COMPLETE"),
    }
}
