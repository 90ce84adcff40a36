//! SELECT .DI1/.ER1: which file has the texts of the PLC's messages, and which its dialogues [000:11213-11241].

use bahn_host::LoadedMachine;
use bahn_tnc::Renewed;

use super::source;
use crate::page::Turn;
use crate::pages::description;
use crate::pages::menu::{Item, Items, Menu};
use crate::site::Site;

/// Endings of messages and dialogues, in the first language and in English, with what `machine.toml` calls them
/// [000:11335-11342].
const KINDS: [(&str, &str); 4] = [
    ("ER1", "plc_messages"),
    ("ERE", "plc_messages"),
    ("DI1", "plc_dialogues"),
    ("DIE", "plc_dialogues"),
];

/// The files there are.
pub(super) fn open(site: &Site) -> Turn {
    let names: Vec<String> = source::list(site)
        .into_iter()
        .filter(|name| is_text(name))
        .collect();
    match names.is_empty() {
        true => Turn::Say(site.words("NO .DI1 OR .ER1 FILE")),
        false => Turn::Open(Box::new(Menu::new(TextFiles { names }))),
    }
}

/// A file of messages or dialogues, by its name.
pub(super) fn is_text(name: &str) -> bool {
    key_of(name).is_some()
}

fn key_of(name: &str) -> Option<&'static str> {
    let (_, ending) = name.rsplit_once('.')?;
    let kind = KINDS.iter().find(|(own, _)| own.eq_ignore_ascii_case(ending));
    kind.map(|(_, key)| *key)
}

struct TextFiles {
    names: Vec<String>,
}

/// The file that is in use has the folder of the PLC before its name.
pub(super) fn is_active(name: &str, site: &Site) -> bool {
    let entry = key_of(name).and_then(|key| description::value(key, site));
    entry.is_some_and(|entry| entry == source::named(name, site))
}

/// The control has the texts of the files as they are now.
///
/// # Errors
/// In words: one of the files cannot be read.
pub(super) fn renew(site: &mut Site) -> Result<(), String> {
    take(description::loaded(site)?, site);
    Ok(())
}

fn take(machine: LoadedMachine, site: &mut Site) {
    site.host.renew(Renewed::Texts {
        messages: machine.plc_messages,
        dialogues: machine.plc_dialogues,
    });
}

impl Items for TextFiles {
    fn title(&self, site: &Site) -> String {
        site.words("PLC MESSAGES AND DIALOGUES")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let item = |name: &String| {
            let active = match is_active(name, site) {
                true => site.words("ACTIVE"),
                false => String::new(),
            };
            Item::new(name.clone(), active)
        };
        self.names.iter().map(item).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let Some(name) = self.names.get(place) else {
            return Turn::Refused;
        };
        let key = key_of(name).unwrap_or_default();
        // They stand there at once [000:11237-11240].
        match description::set(key, &source::named(name, site), site) {
            Ok(machine) => {
                take(machine, site);
                Turn::Done
            }
            Err(why) => Turn::Say(why),
        }
    }
}
