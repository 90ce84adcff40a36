//! A menu: lines to choose from, each with what it stands at.

use bahn_dialogue::Key;
use bahn_screen::{Line, WindowKind};

use crate::page::{Overlay, Page, Turn, View};
use crate::pages::list;
use crate::site::Site;

/// Soft keys of a menu, before and after those of its own.
const SOFT_KEYS: [&str; 2] = ["SELECT", "END"];

/// A line of a menu.
pub(crate) struct Item {
    /// What can be chosen or set in this line.
    pub name: String,
    /// What it stands at.
    pub value: String,
}

impl Item {
    /// A line with a value.
    pub fn new(name: impl Into<String>, value: impl Into<String>) -> Item {
        Item {
            name: name.into(),
            value: value.into(),
        }
    }
}

/// What a menu has to say, and what a choice comes to.
pub(crate) trait Items: Send {
    /// What stands above the lines.
    fn title(&self, site: &Site) -> String;
    /// Its lines as they are now.
    fn items(&self, site: &Site) -> Vec<Item>;
    /// A line is chosen by ENT.
    fn choose(&mut self, place: usize, site: &mut Site) -> Turn;
    /// Any other key on a line.
    fn key(&mut self, _place: usize, _key: Key, _site: &mut Site) -> Turn {
        Turn::Refused
    }
    /// Soft keys of its own; what has no name is not there.
    fn own_keys(&self, _site: &Site) -> [&'static str; 6] {
        [""; 6]
    }
    /// A soft key of its own on a line.
    fn own_key(&mut self, _name: &str, _place: usize, _site: &mut Site) -> Turn {
        Turn::Refused
    }
    /// What it is to module 9035.
    fn overlay(&self) -> Overlay {
        Overlay::None
    }
    /// The menu is closed: what is unfinished ends.
    fn leave(&mut self, _site: &mut Site) {}
    /// What is asked meanwhile.
    fn prompt(&self, _site: &Site) -> String {
        String::new()
    }
}

/// Lines of which one has the cursor.
pub(crate) struct Menu<I> {
    items: I,
    current: usize,
}

impl<I: Items> Menu<I> {
    /// A menu that begins with its first line.
    pub fn new(items: I) -> Menu<I> {
        Menu { items, current: 0 }
    }

    /// A menu that begins with another line.
    pub fn at(items: I, current: usize) -> Menu<I> {
        Menu { items, current }
    }

    fn close(&mut self, site: &mut Site) -> Turn {
        self.items.leave(site);
        Turn::Close
    }
}

impl<I: Items> Page for Menu<I> {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        let count = self.items.items(site).len();
        if let Some(lines) = list::way_of_key(key) {
            self.current = list::moved(self.current, lines, count);
            return Turn::Done;
        }
        match key {
            Key::Ent if count > 0 => self.items.choose(self.current, site),
            Key::End | Key::NoEnt | Key::Del | Key::Mod => self.close(site),
            key => self.items.key(self.current, key, site),
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let [select, end] = SOFT_KEYS.map(|name| site.words(name));
        let own = list::soft_keys(&self.items.own_keys(site), site);
        vec![[vec![select], own, vec![end]].concat()]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        let own = self.items.own_keys(site);
        match place.checked_sub(1) {
            None => self.items.choose(self.current, site),
            Some(place) => match own.get(place) {
                Some(name) => self.items.own_key(name, self.current, site),
                None => self.close(site),
            },
        }
    }

    fn overlay(&self) -> Overlay {
        self.items.overlay()
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let items = self.items.items(site);
        let line = |place: usize| {
            let item = items.get(place);
            let text = item.map(|item| format!("{:<34} {}", item.name, item.value));
            Line {
                text: text.unwrap_or_default().trim_end().to_owned(),
                current: place == self.current,
                ..Line::default()
            }
        };
        let (title, cursor) = (self.items.title(site), (self.current, items.len()));
        let mut view = View::of(list::window(title, WindowKind::List, cursor, lines, line));
        view.dialogue.prompt = self.items.prompt(site);
        view
    }
}
