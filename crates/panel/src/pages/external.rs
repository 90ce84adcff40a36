//! EXT: programs are read in from a device and read out to it, while the machine goes on [003:6880-6930]
//! [000:17231-17349]. The menu is that of the TNC 360 on all controls; READ-OUT PROGRAM OFFERED is the output with
//! acknowledgement of later ones.

use bahn_control::Mode;
use bahn_dialogue::Key;
use bahn_parameters::MessageId;

use crate::page::{Overlay, Page, Side, Turn, View};
use crate::pages::ask::Name;
use crate::pages::files::{Directory, Purpose};
use crate::pages::{list, transfer};
use crate::programs::NAME_MAX;
use crate::screen::{Dialogue, Line, WindowKind};
use crate::site::Site;
use crate::transfer::TransferDeed;

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
        Side::Programming if site.transfers.is_running() => transfer::show(),
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
            0 => transfer::begin(TransferDeed::Directory, site),
            1 => transfer::begin(TransferDeed::ReadAll, site),
            2 => transfer::begin(TransferDeed::ReadOffered, site),
            3 => Turn::Open(Name::ask(
                site.words("PROGRAM NUMBER ="),
                NAME_MAX + 4,
                |name, site| match transfer::begin(TransferDeed::Read(site.with_ending(&name)), site) {
                    Turn::Open(page) => Turn::Replace(page),
                    other => other,
                },
            )),
            4 => Turn::Open(Box::new(Directory::new(Purpose::ReadOut, site))),
            5 => transfer::begin(TransferDeed::Write(all(site)), site),
            _ => transfer::begin(TransferDeed::WriteOffered(all(site)), site),
        }
    }
}

impl Page for Menu {
    fn overlay(&self) -> Overlay {
        Overlay::Directory
    }

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
