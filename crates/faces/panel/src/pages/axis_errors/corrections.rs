//! Code number 105 296: the correction tables of nonlinear axis errors, point by point [000:3885-3960].

use bahn_dialogue::Key;
use bahn_host::files;
use bahn_parameters::PLC_AXIS_NAMES as AXES;
use bahn_screen::{Dialogue, Line, Mark, WindowKind};
use bahn_tnc::CorrectionTables;

use super::head::{self, Field};
use super::text::{ErrorFile, Kind, NEW_HEAD, act, text_of};
use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::pages::ask::Choice;
use crate::pages::{description, list};
use crate::site::Site;

const SOFT_KEYS: [&str; 6] = [
    "PAGE UP",
    "PAGE DOWN",
    "HEAD LINE",
    "NEW TABLE",
    "DELETE TABLE",
    "END",
];

/// The file of the correction tables.
struct Corrections {
    file: ErrorFile,
    name: String,
    lines: Vec<String>,
    current: usize,
    entry: Entry,
    /// The head line lies open.
    heads: bool,
}

/// The entry of machine.toml that names the file.
const KEY: &str = "correction_tables";
/// Its name where the machine had none (inferred).
const NEW: &str = "CORRECTION.TAB";

/// Opens the correction tables; where there are none they are made.
pub(crate) fn open(site: &Site) -> Turn {
    match description::value(KEY, site) {
        Some(name) => opened(&name, site).map_or_else(Turn::Say, Turn::Open),
        None => {
            let ask = site.words("THE MACHINE HAS NO CORRECTION TABLES: MAKE THEM = ENT / END = NO ENT");
            Turn::Open(Choice::confirm(ask, "ENT".to_owned(), |site| match made(site) {
                Ok(page) => Turn::Replace(page),
                Err(why) => Turn::CloseSaying(why),
            }))
        }
    }
}

/// A table without an error, of one axis.
fn new_table(axis: &str) -> Vec<String> {
    let points = (0..CorrectionTables::POINTS).map(|point| format!("{point} 0"));
    std::iter::once(format!("{axis} OVER {axis} {NEW_HEAD}"))
        .chain(points)
        .collect()
}

fn made(site: &mut Site) -> Result<Box<dyn Page>, String> {
    let path = site.machine.root.join(NEW);
    if !path.exists() {
        let axis = AXES.first().copied().unwrap_or_default();
        let text = text_of(&new_table(axis));
        files::write_whole(&path, text.as_bytes()).map_err(|error| error.to_string())?;
    }
    let machine = description::set(KEY, NEW, site)?;
    act(machine, site);
    opened(NEW, site)
}

fn opened(name: &str, site: &Site) -> Result<Box<dyn Page>, String> {
    let file = ErrorFile::new(Kind::Corrections, &site.machine.root.join(name));
    let lines = file.lines()?;
    Ok(Box::new(Corrections {
        file,
        name: name.to_owned(),
        lines,
        current: 0,
        entry: Entry::default(),
        heads: false,
    }))
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
        let turn = self.store(lines, site);
        if matches!(turn, Turn::Done) {
            self.entry = Entry::default();
            self.go(1);
        }
        turn
    }

    /// Other lines: on the medium, and they act.
    fn store(&mut self, lines: Vec<String>, site: &mut Site) -> Turn {
        match self.file.store(&text_of(&lines), site) {
            Ok(()) => {
                self.lines = lines;
                Turn::Done
            }
            Err(why) => Turn::Say(why),
        }
    }

    /// The lines of the table under the cursor: from its head on to the next one.
    fn table(&self) -> std::ops::Range<usize> {
        let is_head = |line: &String| line.contains(" OVER ");
        let before = self.lines.get(..=self.current).unwrap_or_default();
        let from = before.iter().rposition(is_head).unwrap_or(0);
        let after = self.lines.iter().skip(from + 1).position(is_head);
        from..after.map_or(self.lines.len(), |at| from + 1 + at)
    }

    fn head_line(&mut self) -> Turn {
        if self.lines.is_empty() {
            return Turn::Refused;
        }
        self.heads = true;
        let fields = vec![
            Field::Axis("AXIS", 0),
            Field::Axis("OVER", 2),
            Field::Number("DATUM", 5),
            Field::Number("DIST", 7),
        ];
        head::open(self.file.clone(), self.table().start, fields)
    }

    /// A table of the first axis that has none: one for each axis at most [000:3883].
    fn new_table(&mut self, site: &mut Site) -> Turn {
        let has = |axis: &str| {
            self.lines
                .iter()
                .any(|line| line.starts_with(&format!("{axis} OVER ")))
        };
        let Some(axis) = AXES.iter().find(|axis| !has(axis)) else {
            return Turn::Refused;
        };
        let at = self.lines.len();
        let lines = [self.lines.clone(), new_table(axis)].concat();
        let turn = self.store(lines, site);
        if matches!(turn, Turn::Done) {
            self.current = at;
        }
        turn
    }

    fn delete_table(&mut self, site: &mut Site) -> Turn {
        let mut lines = self.lines.clone();
        lines.drain(self.table());
        let turn = self.store(lines, site);
        self.go(0);
        turn
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

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "HEAD LINE" => self.head_line(),
            "NEW TABLE" => self.new_table(site),
            "DELETE TABLE" => self.delete_table(site),
            name => list::way_of(name).map_or(Turn::Close, |lines| self.go(lines)),
        }
    }

    fn tick(&mut self, _site: &mut Site) -> Turn {
        if !std::mem::take(&mut self.heads) {
            return Turn::Done;
        }
        match self.file.lines() {
            Ok(lines) => {
                self.lines = lines;
                Turn::Done
            }
            Err(why) => Turn::Say(why),
        }
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
