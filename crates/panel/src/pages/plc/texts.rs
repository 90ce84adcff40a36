//! SELECT .DI1/.ER1: which file has the texts of the PLC's messages, and which its dialogues [000:11213-11241].

use bahn_host::{LoadedMachine, files};

use super::source;
use crate::page::Turn;
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
/// The file that names what belongs to a machine.
const MACHINE: &str = "machine.toml";

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
    let path = source::named(name, site);
    let text = files::read_table(&site.machine.root.join(MACHINE)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text).into_owned();
    let entry = key_of(name).and_then(|key| entry_of(&text, key));
    entry.is_some_and(|entry| entry == path)
}

/// The value of an entry: a string of either kind, in one line.
fn entry_of<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let line = text.lines().find(|line| is_entry(line, key))?;
    let value = line.split_once('=')?.1.trim_start();
    let quote = value.chars().next().filter(|first| matches!(first, '"' | '\''))?;
    value.get(1..)?.split(quote).next()
}

fn is_entry(line: &str, key: &str) -> bool {
    line.split('=').next().map(str::trim) == Some(key)
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
        match self.names.get(place).map(|name| select(name, site)) {
            Some(Ok(())) => Turn::CloseSaying(site.words("THE TEXTS COUNT WHEN THE MACHINE IS STARTED ANEW")),
            Some(Err(why)) => Turn::Say(why),
            None => Turn::Refused,
        }
    }
}

/// The machine has the texts of a file when it is started anew; its `machine.toml` names it, whose other lines stay.
fn select(name: &str, site: &Site) -> Result<(), String> {
    let key = key_of(name).unwrap_or_default();
    let path = site.machine.root.join(MACHINE);
    let before = files::read_table(&path).map_err(|error| error.to_string())?;
    let text = with_entry(&String::from_utf8_lossy(&before), key, &source::named(name, site));
    files::write_whole(&path, text.as_bytes()).map_err(|error| error.to_string())?;
    let why = match LoadedMachine::load(&site.machine.root) {
        Ok(Ok(_)) => return Ok(()),
        Ok(Err(faults)) => faults
            .first()
            .map_or_else(String::new, |fault| format!("{}: {}", fault.title, fault.label)),
        Err(error) => error.to_string(),
    };
    // A machine that could not be switched on again stays as it is.
    files::write_whole(&path, &before).map_err(|error| error.to_string())?;
    Err(why)
}

/// The text with another value of an entry, which stands before the first table when it is new.
fn with_entry(text: &str, key: &str, value: &str) -> String {
    let entry = format!("{key} = \"{value}\"");
    let lines: Vec<&str> = text.lines().collect();
    let own = lines.iter().position(|line| is_entry(line, key));
    let table = lines.iter().position(|line| line.trim_start().starts_with('['));
    let mut lines: Vec<String> = lines.into_iter().map(str::to_owned).collect();
    match own {
        Some(at) => {
            if let Some(line) = lines.get_mut(at) {
                let comment = line.find('#').and_then(|at| line.get(at..));
                *line = comment.map_or_else(|| entry.clone(), |comment| format!("{entry}  {comment}"));
            }
        }
        None => lines.insert(table.unwrap_or(lines.len()), entry),
    }
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_is_a_string_of_either_kind() {
        let text = "plc_messages='plc/A.ER1'\nplc_dialogues  =  \"plc/O'NEIL.DI1\"  # \"plc/B.DI1\"\nplc_other = 7\n";
        assert_eq!(entry_of(text, "plc_messages"), Some("plc/A.ER1"));
        assert_eq!(entry_of(text, "plc_dialogues"), Some("plc/O'NEIL.DI1"));
        assert_eq!((entry_of(text, "plc_other"), entry_of(text, "plc")), (None, None));
    }

    #[test]
    fn an_entry_takes_another_value_and_the_rest_stays() {
        let text = "name = \"M\"\nplc_messages = \"plc/A.ER1\"   # messages\n\n[datum]\nX = 1\n";
        let other = "name = \"M\"\nplc_messages = \"plc/B.ER1\"  # messages\n\n[datum]\nX = 1\n";
        assert_eq!(with_entry(text, "plc_messages", "plc/B.ER1"), other);
        let new = "name = \"M\"\nplc_messages = \"plc/A.ER1\"   # messages\n\nplc_dialogues = \"plc/D.DI1\"\n[datum]\nX = 1\n";
        assert_eq!(with_entry(text, "plc_dialogues", "plc/D.DI1"), new);
    }
}
