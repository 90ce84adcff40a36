//! PROGRAMMING AND EDITING [003:1692-1790].

use std::sync::Arc;

use bahn_dialogue::Key;
use bahn_program::Program;

use crate::page::{Page, Turn, View};
use crate::pages::files::{Directory, Purpose};
use crate::pages::run::listing;
use crate::screen::{Window, WindowKind};
use crate::site::Site;

/// A program is edited.
pub(crate) struct Programming {
    open: Option<(String, Arc<Program>)>,
    cursor: u32,
}

impl Programming {
    /// With the program that was edited last.
    pub fn new(site: &mut Site) -> Programming {
        let name = site.settings.edited.clone();
        let open = name.and_then(|name| Some((name.clone(), site.programs.read(&name)?)));
        Programming { open, cursor: 0 }
    }
}

impl Page for Programming {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::ClPgm => Turn::Open(Box::new(Directory::new(Purpose::Erase, site))),
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Edit, site))),
            _ => Turn::Refused,
        }
    }

    fn show(&self, _site: &Site, lines: usize) -> View {
        match &self.open {
            Some((name, program)) => View::of(listing(name, program, self.cursor, lines)),
            None => View::of(Window {
                kind: WindowKind::Program,
                ..Window::default()
            }),
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let open = self.open.as_ref().map(|(name, _)| name.as_str());
        if open != site.settings.edited.as_deref() {
            *self = Programming::new(site);
        }
        Turn::Done
    }
}
