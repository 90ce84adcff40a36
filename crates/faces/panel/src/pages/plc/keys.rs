//! Soft keys that take the place of others until one of them is pressed.

use bahn_dialogue::Key;

use crate::page::{Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::site::Site;

/// Soft key that leaves the rows.
const END: &str = "END";

/// The rows, the last soft key of each of which is END.
pub(super) struct Keys {
    rows: Vec<Vec<&'static str>>,
    chosen: Later,
}

impl Keys {
    /// Asks for one of these; an END among them ends its row.
    pub fn ask(names: &'static [&'static str], chosen: &Later) -> Box<Keys> {
        let rows = names.split(|name| *name == END);
        let row = |names: &[&'static str]| {
            let mut row = names.to_vec();
            row.resize(7, "");
            row.push(END);
            row
        };
        Box::new(Keys {
            rows: rows.map(row).collect(),
            chosen: chosen.clone(),
        })
    }
}

impl Page for Keys {
    fn key(&mut self, key: Key, _site: &mut Site) -> Turn {
        match key {
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        self.rows.iter().map(|row| list::soft_keys(row, site)).collect()
    }

    fn soft_key(&mut self, row: usize, place: usize, _site: &mut Site) -> Turn {
        let name = self.rows.get(row).map_or("", |row| list::name_at(row, place));
        if name != END {
            self.chosen.set(name);
        }
        Turn::Close
    }

    fn show(&self, _site: &Site, _lines: usize) -> View {
        View::default()
    }
}
