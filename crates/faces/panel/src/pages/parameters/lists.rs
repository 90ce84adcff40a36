//! PGM NAME in the editor: which of several lists is edited, and goes into effect when the editor is left
//! [000:10072-10074].

use super::file;
use crate::page::Turn;
use crate::pages::ask::Later;
use crate::pages::menu::{Item, Items, Menu};
use crate::site::Site;

/// The lists there are.
struct Lists {
    names: Vec<String>,
    chosen: Later,
}

/// Asks for one of the lists, with the cursor on the one that is edited.
pub(super) fn ask(edited: &str, chosen: &Later, site: &Site) -> Turn {
    let names = file::names(site);
    let at = names.iter().position(|name| name == edited).unwrap_or(0);
    let chosen = chosen.clone();
    Turn::Open(Box::new(Menu::at(Lists { names, chosen }, at)))
}

impl Items for Lists {
    fn title(&self, site: &Site) -> String {
        site.words("MACHINE PARAMETER LISTS")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let in_force = file::in_force(site);
        let active = |name: &String| match *name == in_force {
            true => site.words("ACTIVE"),
            false => String::new(),
        };
        let names = self.names.iter();
        names.map(|name| Item::new(name.clone(), active(name))).collect()
    }

    fn choose(&mut self, place: usize, _site: &mut Site) -> Turn {
        let Some(name) = self.names.get(place) else {
            return Turn::Refused;
        };
        self.chosen.set(name);
        Turn::Close
    }
}
