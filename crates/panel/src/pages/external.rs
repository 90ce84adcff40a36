//! EXT: programs are read in from a device and read out to it, while the machine goes on [003:6880-6930]
//! [000:17231-17349]. The menu is that of the TNC 360 on all controls; READ-OUT PROGRAM OFFERED is the output with
//! acknowledgement of later ones. Lists of machine parameters and files of the PLC go the same way, from their editors
//! [000:10011] [000:11386-11390].

use bahn_control::Mode;
use bahn_dialogue::Key;
use bahn_parameters::MessageId;

use crate::page::{Overlay, Page, Side, Turn, View};
use crate::pages::ask::Name;
use crate::pages::files::{Directory, Purpose};
use crate::pages::menu::{self, Item, Items};
use crate::pages::{list, parameters, plc, transfer};
use crate::programs::NAME_MAX;
use crate::screen::{Dialogue, Line, WindowKind};
use crate::site::Site;
use crate::transfer::{TransferDeed, TransferFiles};

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

/// EXT in the machine parameter editor.
pub(crate) fn of_lists(site: &Site) -> Turn {
    of(TransferFiles::Lists, site)
}

/// EXT in PLC PROGRAMMING.
pub(crate) fn of_plc(site: &Site) -> Turn {
    of(TransferFiles::Plc, site)
}

fn of(files: TransferFiles, site: &Site) -> Turn {
    match site.transfers.is_running() {
        true => transfer::show(),
        false => Turn::Open(Box::new(Menu { current: 0, files })),
    }
}

/// EXT: in PROGRAMMING AND EDITING the menu, or the transfer that is under way.
pub(crate) fn open(side: Side, site: &mut Site) -> Turn {
    match side {
        Side::Programming => of(TransferFiles::Programs, site),
        // A program that is executed while it is transferred is started by the computer (docs/dnc.md).
        Side::Machine if matches!(site.mode(), Mode::SingleBlock | Mode::FullSequence) => {
            Turn::Say(site.message(MessageId::ExtInOutputNotReady))
        }
        Side::Machine => Turn::Refused,
    }
}

/// The menu.
struct Menu {
    current: usize,
    files: TransferFiles,
}

/// The names of all files of a kind.
fn names(files: TransferFiles, site: &Site) -> Vec<String> {
    match files {
        TransferFiles::Lists => {
            let names = parameters::lists_of_machine(site);
            names.iter().map(|name| name.to_uppercase()).collect()
        }
        TransferFiles::Plc => plc::transferable(site),
        TransferFiles::Programs | TransferFiles::Backup => {
            let programs = site.programs.list().into_iter();
            programs.map(|entry| entry.name).collect()
        }
    }
}

/// A file by the name that is entered: with its type where that is not said. Of tables of the PLC the type is the letter
/// that they have at the interface, .S and .V [000:3867-3869].
fn named(name: &str, files: TransferFiles, site: &Site) -> String {
    match files {
        TransferFiles::Lists if !name.contains('.') => format!("{name}.MP"),
        TransferFiles::Lists => name.to_owned(),
        TransferFiles::Plc => plc::named_at_interface(name),
        TransferFiles::Programs | TransferFiles::Backup => site.with_ending(name),
    }
}

/// READ-OUT SELECTED of files that the directory of programs does not have.
struct Selected {
    names: Vec<String>,
    files: TransferFiles,
}

impl Items for Selected {
    fn title(&self, site: &Site) -> String {
        site.words("READ-OUT")
    }

    fn items(&self, _site: &Site) -> Vec<Item> {
        let names = self.names.iter();
        names.map(|name| Item::new(name.clone(), "")).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let Some(name) = self.names.get(place) else {
            return Turn::Refused;
        };
        match transfer::begin_with(self.files, TransferDeed::Write(vec![name.clone()]), site) {
            Turn::Open(page) => Turn::Replace(page),
            other => other,
        }
    }
}

impl Menu {
    fn choose(&self, site: &mut Site) -> Turn {
        let files = self.files;
        let deed = match self.current {
            0 => TransferDeed::Directory,
            1 => TransferDeed::ReadAll,
            2 => TransferDeed::ReadOffered,
            3 => return ask(files, site),
            4 if files == TransferFiles::Programs => {
                return Turn::Open(Box::new(Directory::new(Purpose::ReadOut, site)));
            }
            4 => {
                let names = names(files, site);
                return Turn::Open(Box::new(menu::Menu::new(Selected { names, files })));
            }
            5 => TransferDeed::Write(names(files, site)),
            _ => TransferDeed::WriteOffered(names(files, site)),
        };
        transfer::begin_with(files, deed, site)
    }
}

/// READ-IN SELECTED: by its name.
fn ask(files: TransferFiles, site: &Site) -> Turn {
    let prompt = match files {
        TransferFiles::Programs => site.words("PROGRAM NUMBER ="),
        _ => site.words("FILE NAME ="),
    };
    Turn::Open(Name::ask(prompt, NAME_MAX + 4, move |name, site| {
        let deed = TransferDeed::Read(named(&name, files, site));
        match transfer::begin_with(files, deed, site) {
            Turn::Open(page) => Turn::Replace(page),
            other => other,
        }
    }))
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
