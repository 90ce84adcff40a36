//! The directory of the PLC's source files: one is edited, or compiled as main program.

use super::editor::Editor;
use super::source;
use super::{compile, convert};
use crate::page::Turn;
use crate::pages::menu::{Item, Items, Menu};
use crate::site::Site;

/// Soft keys that make another form of the file [000:11330-11366].
const SOFT_KEYS: [&str; 6] = ["LISTING", "CROSSREF", "LISTING+CROSSREF", "", "", ""];

/// What a file is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// EDIT.
    Edit,
    /// COMPILE.
    Compile,
}

/// The directory, with the cursor on the file that is most likely meant.
pub(super) fn open(purpose: Purpose, site: &Site) -> Turn {
    let names = source::list(site);
    let stopped = site.control().plc().stopped().map(|error| error.file.as_str());
    let edited = stopped.or(site.plc.edited.as_deref());
    let wanted = match purpose {
        Purpose::Edit => edited.unwrap_or(source::main_file(site)),
        Purpose::Compile => source::main_file(site),
    };
    let at = names.iter().position(|name| name == wanted).unwrap_or(0);
    Turn::Open(Box::new(Menu::at(SourceFiles { purpose, names }, at)))
}

struct SourceFiles {
    purpose: Purpose,
    names: Vec<String>,
}

impl Items for SourceFiles {
    fn title(&self, site: &Site) -> String {
        match self.purpose {
            Purpose::Edit => site.words("PLC FILES: EDIT"),
            Purpose::Compile => site.words("PLC FILES: COMPILE"),
        }
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let main = source::main_file(site);
        let runtime = |name: &String| {
            let is_main = name == main;
            Item::new(
                name.clone(),
                if is_main {
                    site.words("RUNTIME PGM")
                } else {
                    String::new()
                },
            )
        };
        self.names.iter().map(runtime).collect()
    }

    fn own_keys(&self) -> [&'static str; 6] {
        match self.purpose {
            Purpose::Edit => SOFT_KEYS,
            Purpose::Compile => [""; 6],
        }
    }

    fn own_key(&mut self, key: &str, place: usize, site: &mut Site) -> Turn {
        match self.names.get(place) {
            Some(name) => convert::ask(name, key.starts_with("LISTING"), key.ends_with("CROSSREF"), site),
            None => Turn::Refused,
        }
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let Some(name) = self.names.get(place) else {
            return Turn::Refused;
        };
        match self.purpose {
            Purpose::Edit => {
                // Where the PLC was stopped: of a time out at the last jump [000:11919].
                let stopped = site.control().plc().stopped();
                let line = stopped
                    .filter(|error| error.file == *name)
                    .map_or(1, |error| error.line);
                match Editor::open(name, line as usize, site) {
                    Ok(editor) => Turn::Replace(Box::new(editor)),
                    Err(why) => Turn::Say(why),
                }
            }
            Purpose::Compile => compile::run(name, site),
        }
    }
}
