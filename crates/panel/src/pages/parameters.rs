//! The machine parameter editor: the whole list (95 148), those of the operator (123), USER PARAMETERS [000:9969-10065].
//!
//! What is entered is checked against the list; END writes the file with its comments and lets the control take over what has
//! changed, with the reset or the reference run that it needs.

use std::collections::{BTreeMap, BTreeSet};

use bahn_control::{Command, RunState};
use bahn_dialogue::Key;
use bahn_host::{LoadedMachine, files};
use bahn_parameters::{Definition, ListText, MessageId, ParameterId, ParameterList, Reaction};

use crate::page::{Overlay, Page, Turn, View};
use crate::pages::ask::Later;
use crate::pages::list;
use crate::screen::{Dialogue, Line, Mark, WindowKind};
use crate::site::Site;

/// Characters of a value at most: a sign, 32 binary digits, blanks.
const VALUE_MAX: usize = 40;
/// Lines below the list: what the value under the cursor means.
const MEANING: usize = 4;
/// Its soft keys.
const SOFT_KEYS: [&str; 8] = ["%", "$", "PAGE UP", "PAGE DOWN", "FIND", ";", "QUIT", "END"];
/// Characters of a comment at most (inferred).
const COMMENT_MAX: usize = 60;

/// A line of the editor.
struct Row {
    definition: &'static Definition,
    /// The dialogue of the machine builder (MP7340).
    dialogue: Option<String>,
}

/// The editor.
struct Parameters {
    title: String,
    rows: Vec<Row>,
    list: ParameterList,
    changed: BTreeSet<ParameterId>,
    /// Comments that were entered [000:10017].
    comments: BTreeMap<ParameterId, String>,
    current: usize,
    entry: Option<String>,
    comment: Later,
    goto: Later,
    find: Later,
}

/// The whole list.
pub(crate) fn all(site: &Site) -> Turn {
    editor(site, |_| true)
}

/// What the manual lets the operator change.
pub(crate) fn of_code(site: &Site) -> Turn {
    editor(site, |definition| definition.user)
}

/// Up to sixteen that the machine builder has chosen, with his dialogues [000:6907-6926].
pub(crate) fn user(site: &Site) -> Turn {
    let list = site.parameters();
    let row = |own: bahn_parameters::operation::UserParameter| {
        let definition = Definition::named(list.model(), own.id).ok()?;
        let dialogues = &site.machine.plc_dialogues;
        Some(Row {
            definition,
            dialogue: dialogues.get(usize::from(own.dialogue_line)).cloned(),
        })
    };
    let rows: Vec<Row> = list.user_parameters().into_iter().filter_map(row).collect();
    opened(rows, site)
}

fn editor(site: &Site, is_meant: impl Fn(&Definition) -> bool) -> Turn {
    let all = Definition::all(site.parameters().model()).iter();
    let rows = all
        .filter(|definition| is_meant(definition))
        .map(|definition| Row {
            definition,
            dialogue: None,
        });
    opened(rows.collect(), site)
}

/// Parameters are edited while no program runs.
fn opened(rows: Vec<Row>, site: &Site) -> Turn {
    if site.control().run_state() != RunState::Idle {
        return Turn::Say(site.message(MessageId::KeyNonFunctional));
    }
    if rows.is_empty() {
        return Turn::Say(site.words("NO USER PARAMETERS"));
    }
    Turn::Open(Box::new(Parameters {
        title: site.words("MACHINE PARAMETERS"),
        rows,
        list: site.parameters().clone(),
        changed: BTreeSet::new(),
        comments: BTreeMap::new(),
        current: 0,
        entry: None,
        comment: Later::default(),
        goto: Later::default(),
        find: Later::default(),
    }))
}

impl Parameters {
    fn row(&self) -> Option<&Row> {
        self.rows.get(self.current)
    }

    /// The value of a parameter as it is best written.
    fn value(&self, definition: &Definition) -> String {
        let id = definition.id;
        let value = self
            .list
            .get(id.number, id.index.unwrap_or(0))
            .unwrap_or_default();
        definition.format_value(value)
    }

    /// Takes what was entered, when the list allows it.
    fn take(&mut self, site: &Site) -> Turn {
        let (Some(row), Some(entry)) = (self.row(), self.entry.clone()) else {
            return Turn::Done;
        };
        let id = row.definition.id;
        // A comment may stand behind the value, or alone.
        let (value, comment) = match entry.split_once(';') {
            Some((value, comment)) => (value.trim(), Some(comment.trim())),
            None => (entry.as_str(), None),
        };
        if let Some(comment) = comment {
            self.comments.insert(id, comment.to_owned());
            if value.is_empty() {
                self.entry = None;
                return Turn::Done;
            }
        }
        match self.list.assign(&format!("{id}={value}")) {
            Ok(_) => {
                self.changed.insert(id);
                self.entry = None;
                Turn::Done
            }
            Err(error) => {
                let text = crate::texts::translate(site.language(), error.control_text());
                Turn::Say(format!("{} {text}: {error}", error.number()))
            }
        }
    }

    fn go(&mut self, rows: isize, site: &Site) -> Turn {
        let turn = self.take(site);
        if matches!(turn, Turn::Done) {
            self.current = list::moved(self.current, rows, self.rows.len());
        }
        turn
    }

    /// END: what has changed is checked as a whole, written and taken over.
    fn finish(&mut self, site: &mut Site) -> Turn {
        let turn = self.take(site);
        let is_changed = !self.changed.is_empty() || !self.comments.is_empty();
        if !matches!(turn, Turn::Done) || !is_changed {
            return if matches!(turn, Turn::Done) {
                Turn::Close
            } else {
                turn
            };
        }
        if site.control().run_state() != RunState::Idle {
            return Turn::Say(site.message(MessageId::KeyNonFunctional));
        }
        let found = self.list.inconsistencies();
        // No control is switched on with such a list: it is not written, and the editor stays open.
        if let Some(found) = found.iter().find(|found| found.impossible) {
            return Turn::Say(format!("{}: {}", found.id, found.rule));
        }
        if let Err(why) = self.write(site) {
            return Turn::Say(why);
        }
        self.take_over(site);
        match found.iter().find(|found| self.changed.contains(&found.id)) {
            Some(found) => Turn::CloseSaying(format!("{}: {}", found.id, found.rule)),
            None => Turn::Close,
        }
    }

    /// The file of the list in force, whole or not at all; its comments stay.
    fn write(&self, site: &Site) -> Result<(), String> {
        let selected = site.control().remember().parameter_list;
        let name = selected.unwrap_or_else(|| site.machine.folder.parameters.clone());
        let path = site.machine.root.join(&name);
        let bytes = files::read_table(&path).map_err(|error| error.to_string())?;
        let mut text = ListText::from_bytes(self.list.model(), &bytes);
        for id in &self.changed {
            let value = self
                .list
                .get(id.number, id.index.unwrap_or(0))
                .unwrap_or_default();
            text.set(*id, value).map_err(|error| error.to_string())?;
        }
        for (id, comment) in &self.comments {
            text.set_comment(*id, comment);
        }
        let bytes = text.to_bytes();
        // A list with which the machine could not be switched on again is refused.
        let loaded = LoadedMachine::load_with_file(&site.machine.root, &name, &bytes);
        if let Err(faults) = loaded.map_err(|error| error.to_string())? {
            let fault = faults
                .first()
                .map(|fault| format!("{}: {}", fault.title, fault.label));
            return Err(fault.unwrap_or_default());
        }
        files::write_whole(&path, &bytes).map_err(|error| error.to_string())
    }

    /// The control takes over what has changed: at once, with the reference marks, with a reset, in this order.
    fn take_over(&self, site: &mut Site) {
        let mut changed: Vec<&Definition> = self
            .changed
            .iter()
            .filter_map(|id| Definition::named(self.list.model(), *id).ok())
            .collect();
        changed.sort_by_key(|definition| match definition.reaction {
            Reaction::None => 0,
            Reaction::ReferenceMarks => 1,
            Reaction::Reset => 2,
        });
        for definition in changed {
            let text = format!("{}={}", definition.id, self.value(definition));
            if let Ok(command) = text.parse::<Command>() {
                site.command(command);
            }
        }
    }

    /// GOTO goes to a number, or the next greater one.
    fn goto(&mut self, text: &str) -> bool {
        let (number, index) = text.split_once('.').unwrap_or((text, "0"));
        let (Ok(number), Ok(index)) = (number.parse::<u16>(), index.parse::<u8>()) else {
            return false;
        };
        let from = (number, index);
        let key = |row: &Row| (row.definition.id.number, row.definition.id.index.unwrap_or(0));
        let found = self.rows.iter().position(|row| key(row) >= from);
        self.current = found.unwrap_or(self.rows.len().saturating_sub(1));
        true
    }

    /// FIND goes to the next line that has a word in its name.
    fn find(&mut self, word: &str) -> bool {
        let word = word.to_lowercase();
        let count = self.rows.len();
        let order = (1..=count).map(|way| (self.current + way) % count.max(1));
        let has = |place: &usize| {
            let row = self.rows.get(*place);
            row.is_some_and(|row| row.definition.name.to_lowercase().contains(&word))
        };
        let found = order.into_iter().find(has);
        if let Some(place) = found {
            self.current = place;
        }
        found.is_some()
    }

    fn typed(&mut self, key: Key) -> Turn {
        let entry = self.entry.clone().unwrap_or_default();
        let hexadecimal = entry.starts_with('$');
        let character = match key {
            Key::Sign => {
                let other = match entry.strip_prefix('-') {
                    Some(rest) => rest.to_owned(),
                    None => format!("-{entry}"),
                };
                self.entry = Some(other);
                return Turn::Done;
            }
            Key::Point => '.',
            key => match key.character() {
                Some(digit) if digit.is_ascii_digit() => digit,
                Some(letter @ 'A'..='F') if hexadecimal => letter,
                _ => return Turn::Refused,
            },
        };
        if entry.len() >= VALUE_MAX {
            return Turn::Refused;
        }
        self.entry = Some(format!("{entry}{character}"));
        Turn::Done
    }

    /// A binary or hexadecimal number begins.
    fn radix(&mut self, sign: char) -> Turn {
        let digits: String = self.entry.take().unwrap_or_default();
        let digits = digits.trim_start_matches(['%', '$', '-']);
        self.entry = Some(format!("{sign}{digits}"));
        Turn::Done
    }

    fn line(&self, place: usize, row: &Row) -> Line {
        let current = place == self.current;
        let value = self.value(row.definition);
        let entry = self.entry.as_ref().filter(|_| current);
        let shown = entry.map_or(value.as_str(), String::as_str);
        let mut text = match &row.dialogue {
            Some(dialogue) => format!("{dialogue:<34}: {shown}"),
            None => row.definition.line(shown),
        };
        let id = row.definition.id;
        if self.changed.contains(&id) || self.comments.contains_key(&id) {
            text.push_str(" *");
        }
        if let Some(comment) = self.comments.get(&id) {
            text.push_str(&format!(" ; {comment}"));
        }
        let from = text
            .find(": ")
            .map_or(0, |at| text.chars().take(at + 2).count().min(at + 2));
        let mark = if entry.is_some() {
            Mark::Entry
        } else {
            Mark::Cursor
        };
        Line {
            marks: match current {
                true => vec![(from, from + shown.chars().count(), mark)],
                false => Vec::new(),
            },
            text,
            current,
        }
    }

    /// What the value under the cursor means, and its range.
    fn meaning(&self) -> Vec<Line> {
        let Some(row) = self.row() else {
            return Vec::new();
        };
        let definition = row.definition;
        let value = self
            .list
            .get(definition.id.number, definition.id.index.unwrap_or(0));
        let range = definition.range_text().map(|[least, greatest]| {
            format!("{}: {least} .. {greatest} {}", definition.name, definition.unit)
        });
        let means = definition.meaning(value.unwrap_or_default());
        let lines = range.into_iter().chain(means);
        let quiet = |text: String| Line {
            marks: vec![(0, text.chars().count(), Mark::Quiet)],
            text,
            current: false,
        };
        lines.take(MEANING).map(quiet).collect()
    }
}

impl Page for Parameters {
    fn overlay(&self) -> Overlay {
        Overlay::Table
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Up => self.go(-1, site),
            Key::Down | Key::Ent => self.go(1, site),
            Key::End => self.finish(site),
            Key::Ce | Key::NoEnt | Key::Del if self.entry.is_some() => {
                self.entry = None;
                Turn::Done
            }
            Key::Del => Turn::Close,
            Key::Goto => self.goto.ask(site.words("GOTO: NUMBER ="), 8),
            key => self.typed(key),
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "%" => self.radix('%'),
            "$" => self.radix('$'),
            "FIND" => self.find.ask(site.words("FIND ="), 24),
            ";" => self.comment.ask(";".to_owned(), COMMENT_MAX),
            "QUIT" => Turn::Close,
            name => match list::way_of(name) {
                Some(rows) => self.go(rows, site),
                None => self.finish(site),
            },
        }
    }

    fn text(&mut self, text: &str, _site: &mut Site) -> Turn {
        let fits = |character: char| character.is_ascii_hexdigit() || "%$-. ".contains(character);
        let (value, comment) = text.split_once(';').unwrap_or((text, ""));
        let is_short = value.len() <= VALUE_MAX && comment.chars().count() <= COMMENT_MAX;
        if !is_short || !value.chars().all(fits) {
            return Turn::Refused;
        }
        self.entry = Some(text.to_owned());
        Turn::Done
    }

    fn show(&self, _site: &Site, lines: usize) -> View {
        let rows = lines.saturating_sub(MEANING);
        let line = |place| {
            let row = self.rows.get(place);
            row.map_or_else(Line::default, |row| self.line(place, row))
        };
        let cursor = (self.current, self.rows.len());
        let mut window = list::window(self.title.clone(), WindowKind::Table, cursor, rows, line);
        window.lines.extend(self.meaning());
        let prompt = self.row().map(|row| format!("{} =", row.definition.id));
        View {
            window: Some(window),
            dialogue: Dialogue {
                prompt: prompt.unwrap_or_default(),
                entry: self.entry.clone().unwrap_or_default(),
                open: true,
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let gone = self.goto.take().is_some_and(|text| !self.goto(&text));
        let lost = self.find.take().is_some_and(|word| !self.find(&word));
        if let (Some(comment), Some(row)) = (self.comment.take(), self.rows.get(self.current)) {
            self.comments.insert(row.definition.id, comment);
        }
        match gone || lost {
            true => Turn::Say(site.message(MessageId::EntryValueIncorrect)),
            false => Turn::Done,
        }
    }
}
