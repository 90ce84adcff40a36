//! EXT: programs are read in from a device and read out to it, while the machine goes on [003:6880-6930]
//! [000:17231-17349]. The menu is that of the TNC 360 on all controls; READ-OUT PROGRAM OFFERED is the output with
//! acknowledgement of later ones. Lists of machine parameters and files of the PLC go the same way, from their editors
//! [000:10011] [000:11386-11390].
//!
//! Decision: EXT in the editor of lists and in PLC PROGRAMMING has the menu of programs; there .S means .CMA and .V
//! means .COM, a name without type a .MP or .PLC
//!
//! Decision: EXT has the menu of the TNC 360 on all controls; one transfer at a time; ERASE/OVERREAD of a program
//! that runs is answered with NO ENT (also `panel/src/station/transfers.rs`)

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_screen::programs::NAME_MAX;
use bahn_screen::{Dialogue, Line, WindowKind};
use bahn_tnc::Mode;

use crate::page::{Overlay, Page, Side, Turn, View};
use crate::pages::ask::Name;
use crate::pages::files::{Directory, Purpose};
use crate::pages::menu::{self, Item, Items};
use crate::pages::{list, transfer};
use crate::site::Site;
use crate::transfer::{TransferAction, TransferFiles};

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

/// What an editor transfers.
#[derive(Clone, Copy)]
pub(crate) struct Own {
    /// The kind of files that it transfers.
    pub files: TransferFiles,
    /// The names of all of them.
    pub names: fn(&Site) -> Vec<String>,
    /// One by the name that is entered: with its type where that is not said.
    pub named: fn(&str, &Site) -> String,
}

/// What the directory of programs and tables transfers.
const PROGRAMS: Own = Own {
    files: TransferFiles::Programs,
    names: |site| site.programs.list().into_iter().map(|entry| entry.name).collect(),
    named: |name, site| site.with_ending(name),
};

/// EXT: the menu, or the transfer that is under way.
pub(crate) fn of(own: Own, site: &Site) -> Turn {
    match site.transfers.is_running() {
        true => transfer::show(),
        false => Turn::Open(Box::new(Menu { current: 0, own })),
    }
}

/// EXT: in PROGRAMMING AND EDITING the menu, or the transfer that is under way.
pub(crate) fn open(side: Side, site: &mut Site) -> Turn {
    match side {
        Side::Programming => of(PROGRAMS, site),
        // A program that is executed while it is transferred is started by the computer (docs/dnc.md).
        Side::Machine if matches!(site.mode(), Mode::SingleBlock | Mode::FullSequence) => {
            Turn::Say(site.message(MessageId::ExtInOutputNotReady))
        }
        Side::Machine => Turn::Refused,
    }
}

struct Menu {
    current: usize,
    own: Own,
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
        match transfer::begin_with(self.files, TransferAction::Write(vec![name.clone()]), site) {
            Turn::Open(page) => Turn::Replace(page),
            other => other,
        }
    }
}

impl Menu {
    fn choose(&self, site: &mut Site) -> Turn {
        let Own { files, names, .. } = self.own;
        let action = match self.current {
            0 => TransferAction::Directory,
            1 => TransferAction::ReadAll,
            2 => TransferAction::ReadOffered,
            3 => return ask(self.own, site),
            4 if files == TransferFiles::Programs => {
                return Turn::Open(Box::new(Directory::new(Purpose::ReadOut, site)));
            }
            4 => {
                let names = names(site);
                return Turn::Open(Box::new(menu::Menu::new(Selected { names, files })));
            }
            5 => TransferAction::Write(names(site)),
            _ => TransferAction::WriteOffered(names(site)),
        };
        transfer::begin_with(files, action, site)
    }
}

/// READ-IN SELECTED: by its name.
fn ask(own: Own, site: &Site) -> Turn {
    let prompt = match own.files {
        TransferFiles::Programs => site.words("PROGRAM NUMBER ="),
        _ => site.words("FILE NAME ="),
    };
    Turn::Open(Name::ask(prompt, NAME_MAX + 4, move |name, site| {
        let action = TransferAction::Read((own.named)(&name, site));
        match transfer::begin_with(own.files, action, site) {
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
