//! HELP: what a message means and what cures it, and the help files of the machine [000:7042-7073].

use std::sync::Arc;

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_screen::texts;
use bahn_screen::{Line, Window, WindowKind};
use bahn_tnc::{Command, Message};

use crate::page::{Page, Turn, View};
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::{list, table};
use crate::site::Site;

/// Ending of help files [000:6842].
const ENDING: &str = ".HLP";
/// W270: no help file is selected, the cursor is on a line without a number [000:7048].
const NO_FILE: i32 = -1;
const NO_NUMBER: i32 = -2;
/// Characters of a line of an explanation.
const WIDTH: usize = 72;
/// Soft keys of a help file, and of an explanation.
const FILE_KEYS: [&str; 3] = ["PAGE UP", "PAGE DOWN", "END"];
const EXPLANATION_KEYS: [&str; 2] = ["HELP FILES", "END"];

/// The key HELP: the message that is shown, else the help files.
pub(crate) fn key(note: Option<&str>, site: &mut Site) -> Turn {
    let language = site.language();
    let model = site.control().model();
    let of_control = || {
        let shown = site.control().shown().last()?;
        let text = texts::translate(language, &site.control().shown_text(shown));
        Some((text, id_of(&shown.message)))
    };
    let Some((text, id)) = note.map(|note| (note.to_owned(), None)).or_else(of_control) else {
        return files(site);
    };
    // Messages of axes have a letter where their text has a #.
    let begins = |id: &&MessageId| {
        let own = texts::translate(language, id.text(model));
        let fixed = own.split('#').next().unwrap_or_default();
        !fixed.is_empty() && text.starts_with(fixed)
    };
    match id.or_else(|| MessageId::ALL.iter().find(begins).copied()) {
        Some(id) => Turn::Open(Box::new(Explanation::of(&text, id, site))),
        None => files(site),
    }
}

fn id_of(message: &Message) -> Option<MessageId> {
    match message {
        Message::Plain(id) => Some(*id),
        // Its text says it.
        _ => None,
    }
}

/// The machine has a help file that is not disabled.
pub(crate) fn is_there(site: &Site) -> bool {
    !names(site).is_empty()
}

/// The help files, but those that MP7224.0 disables.
fn names(site: &Site) -> Vec<String> {
    let entries = site.programs.list().into_iter();
    let names = entries.map(|entry| entry.name);
    names
        .filter(|name| name.to_ascii_uppercase().ends_with(ENDING) && !table::is_disabled(name, site))
        .collect()
}

/// The help files of the machine: one is opened at once, several are chosen from.
pub(crate) fn files(site: &mut Site) -> Turn {
    let names = names(site);
    match names.as_slice() {
        [] => Turn::Say(site.words("NO HELP FILE")),
        [name] => open(name, site),
        _ => Turn::Open(Box::new(Menu::new(HelpFiles { names }))),
    }
}

fn open(name: &str, site: &mut Site) -> Turn {
    if site.plc.help.upgrade().is_some() {
        // In the other mode beside this one [000:7066].
        return Turn::Say(site.words("BACKGROUND PROGRAMMING NOT POSSIBLE"));
    }
    let Some(text) = site.programs.text(name) else {
        return Turn::Say(site.message(MessageId::ProgramNotFound));
    };
    let mut file = HelpFile {
        name: name.to_owned(),
        lines: text.lines().map(str::to_owned).collect(),
        current: 0,
        open: Arc::new(()),
    };
    site.plc.help = Arc::downgrade(&file.open);
    file.go(0, site);
    Turn::Open(Box::new(file))
}

/// PGM NAME selects among several.
struct HelpFiles {
    names: Vec<String>,
}

impl Items for HelpFiles {
    fn title(&self, site: &Site) -> String {
        site.words("HELP")
    }

    fn items(&self, _site: &Site) -> Vec<Item> {
        self.names
            .iter()
            .map(|name| Item::new(name.clone(), ""))
            .collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        self.names
            .get(place)
            .map_or(Turn::Refused, |name| open(name, site))
    }
}

/// A help file; the number of the line under the cursor is told to the PLC.
struct HelpFile {
    name: String,
    lines: Vec<String>,
    current: usize,
    /// It lies open as long as this is there, however the page is left.
    open: Arc<()>,
}

/// `#1234 text`: a command of the machine, 0 to 9999.
fn number_of(line: &str) -> Option<i32> {
    let digits: String = line
        .strip_prefix('#')?
        .chars()
        .take_while(char::is_ascii_digit)
        .collect();
    digits.parse().ok().filter(|number| (0..=9999).contains(number))
}

impl HelpFile {
    fn go(&mut self, lines: isize, site: &mut Site) -> Turn {
        self.current = list::moved(self.current, lines, self.lines.len());
        let number = self.lines.get(self.current).and_then(|line| number_of(line));
        tell(number.unwrap_or(NO_NUMBER), site);
        Turn::Done
    }

    fn close(site: &mut Site) -> Turn {
        tell(NO_FILE, site);
        Turn::Close
    }
}

/// A help file that is no more open, as its mode was left with it, is none for the PLC.
pub(crate) fn follow(site: &mut Site) {
    if site.plc.help_reported && site.plc.help.upgrade().is_none() {
        tell(NO_FILE, site);
    }
}

/// W270 of the PLC.
fn tell(number: i32, site: &mut Site) {
    site.plc.help_reported = number != NO_FILE;
    if let Ok(command) = format!("W270={number}").parse::<Command>() {
        site.command(command);
    }
}

impl Page for HelpFile {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines, site);
        }
        match key {
            Key::End | Key::Del | Key::NoEnt | Key::Help | Key::Mod => HelpFile::close(site),
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&FILE_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::way_of(list::name_at(&FILE_KEYS, place)) {
            Some(lines) => self.go(lines, site),
            None => HelpFile::close(site),
        }
    }

    fn show(&self, _site: &Site, lines: usize) -> View {
        let line = |place: usize| Line {
            text: self.lines.get(place).cloned().unwrap_or_default(),
            current: place == self.current,
            ..Line::default()
        };
        let cursor = (self.current, self.lines.len());
        View::of(list::window(
            self.name.clone(),
            WindowKind::Text,
            cursor,
            lines,
            line,
        ))
    }
}

/// What a message means.
struct Explanation {
    title: String,
    lines: Vec<String>,
    first: usize,
}

impl Explanation {
    fn of(text: &str, id: MessageId, site: &Site) -> Explanation {
        let mut lines = Vec::new();
        for (heading, words) in [
            (site.words("CAUSE:"), id.cause()),
            (site.words("CURE:"), id.remedy()),
        ] {
            lines.push(heading);
            lines.extend(wrapped(&texts::translate(site.language(), words)));
        }
        Explanation {
            title: text.to_owned(),
            lines,
            first: 0,
        }
    }
}

/// A text in lines of the window's width, broken between words.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let full = lines
            .last()
            .is_some_and(|line| line.chars().count() + word.chars().count() >= WIDTH);
        if full {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            line.push_str(if line.is_empty() { "  " } else { " " });
            line.push_str(word);
        }
    }
    lines
}

impl Page for Explanation {
    fn key(&mut self, key: Key, _site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            self.first = list::moved(self.first, lines, self.lines.len());
            return Turn::Done;
        }
        match key {
            Key::End | Key::Del | Key::NoEnt | Key::Ent | Key::Help => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&EXPLANATION_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&EXPLANATION_KEYS, place) {
            "HELP FILES" => files(site),
            _ => Turn::Close,
        }
    }

    /// It has no cursor: the keys move its first line.
    fn show(&self, _site: &Site, lines: usize) -> View {
        let line = |text: &String| Line {
            text: text.clone(),
            ..Line::default()
        };
        View::of(Window {
            title: self.title.clone(),
            kind: WindowKind::Text,
            lines: self.lines.iter().skip(self.first).take(lines).map(line).collect(),
            first: self.first,
            total: self.lines.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_help_files_have_numbers() {
        assert_eq!(number_of("#0012 Release the tool"), Some(12));
        assert_eq!(number_of("#9999"), Some(9999));
        for line in ["", "12", "#", "#12345", "# 12"] {
            assert_eq!(number_of(line), None, "{line}");
        }
    }

    #[test]
    fn words_are_wrapped() {
        let text = "word ".repeat(40);
        let lines = wrapped(&text);
        assert!(lines.len() > 2 && lines.iter().all(|line| line.chars().count() <= WIDTH + 2));
        assert_eq!(lines.join(" ").split_whitespace().count(), 40);
    }
}
