//! Code number 105 296: the correction tables of nonlinear axis errors, point by point [000:3885-3960].

use std::path::PathBuf;

use bahn_control::CorrectionTables;
use bahn_dialogue::Key;
use bahn_host::{decode, files};
use bahn_parameters::MessageId;

use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::pages::list;
use crate::screen::{Dialogue, Line, Mark, WindowKind};
use crate::site::Site;

/// Its soft keys.
const SOFT_KEYS: [&str; 3] = ["PAGE UP", "PAGE DOWN", "END"];

/// The file of the correction tables.
struct Corrections {
    path: PathBuf,
    name: String,
    lines: Vec<String>,
    current: usize,
    entry: Entry,
}

/// Opens the correction tables, when the machine has some.
pub(crate) fn open(site: &Site) -> Turn {
    let Some(name) = &site.machine.folder.correction_tables else {
        return Turn::Say(site.words("THE MACHINE HAS NO CORRECTION TABLES (.COM)"));
    };
    let path = site.machine.root.join(name);
    match files::read_table(&path) {
        Ok(bytes) => Turn::Open(Box::new(Corrections {
            path,
            name: name.clone(),
            lines: decode(&bytes).lines().map(str::to_owned).collect(),
            current: 0,
            entry: Entry::default(),
        })),
        Err(error) => Turn::Say(error.to_string()),
    }
}

/// Where the value of a point stands in its line: the second of two words.
fn value_at(line: &str) -> Option<std::ops::Range<usize>> {
    let mut words = line.split_whitespace();
    let (point, value) = (words.next()?, words.next()?);
    let is_point = words.next().is_none() && point.parse::<u32>().is_ok() && value.parse::<f64>().is_ok();
    let start = line.find(point)? + point.len();
    let start = start + line.get(start..)?.find(value)?;
    is_point.then_some(start..start + value.len())
}

impl Corrections {
    fn take(&mut self, value: f64, site: &mut Site) -> Turn {
        let mut lines = self.lines.clone();
        let line = lines.get_mut(self.current);
        let Some((line, at)) = line.and_then(|line| value_at(line).map(|at| (line, at))) else {
            return Turn::Refused;
        };
        line.replace_range(at, &value.to_string());
        let text = lines.join("\n") + "\n";
        if let Err(error) = CorrectionTables::read(&text) {
            let incorrect = site.message(MessageId::EntryValueIncorrect);
            return Turn::Say(format!("{incorrect}: {}", error.what));
        }
        if let Err(error) = files::write_whole(&self.path, text.as_bytes()) {
            return Turn::Say(error.to_string());
        }
        self.lines = lines;
        self.entry = Entry::default();
        self.go(1);
        Turn::Say(site.words("THE CORRECTION COUNTS FROM POWER-ON"))
    }

    fn go(&mut self, lines: isize) -> Turn {
        self.current = list::moved(self.current, lines, self.lines.len());
        Turn::Done
    }
}

impl Page for Corrections {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(lines) = list::way_of_key(key) {
            return self.go(lines);
        }
        match key {
            Key::Ent => match self.entry.value() {
                Some(value) => self.take(value, site),
                None => self.go(1),
            },
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            key if self.entry.key(key) => Turn::Done,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, _site: &mut Site) -> Turn {
        let way = list::way_of(list::name_at(&SOFT_KEYS, place));
        way.map_or(Turn::Close, |lines| self.go(lines))
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let line = |place: usize| {
            let text = self.lines.get(place).map_or("", String::as_str);
            let cursor = value_at(text).filter(|_| place == self.current);
            Line {
                text: text.to_owned(),
                current: place == self.current,
                marks: cursor
                    .map(|at| (at.start, at.end, Mark::Cursor))
                    .into_iter()
                    .collect(),
            }
        };
        let cursor = (self.current, self.lines.len());
        View {
            window: Some(list::window(
                self.name.clone(),
                WindowKind::Table,
                cursor,
                lines,
                line,
            )),
            dialogue: Dialogue {
                prompt: site.words("CORRECTION ="),
                entry: self.entry.text(),
                open: true,
            },
        }
    }
}
