//! The assignment (.CMA): in each line the table of each axis, and which line is active [000:3781] [000:3855-3865].

use std::path::Path;

use bahn_dialogue::Key;
use bahn_parameters::PLC_AXIS_NAMES as AXES;
use bahn_screen::programs::NAME_MAX;
use bahn_screen::{Line, WindowKind};
use bahn_tnc::CompensationAssignment;

use super::text::{ErrorFile, Kind, text_of};
use crate::page::{Page, Turn, View};
use crate::pages::ask::Name;
use crate::pages::{description, list};
use crate::site::Site;

/// Its soft keys [000:3862], and those that make lines.
const SOFT_KEYS: [&str; 8] = [
    "SET ACTIV LINE",
    "CLEAR ACTIV LINE",
    "INSERT LINE",
    "DELETE LINE",
    "",
    "",
    "",
    "END",
];
/// The entry of machine.toml that names the file in use.
const KEY: &str = "compensation";
/// Width of a column.
const WIDTH: usize = 12;

/// Editor of an assignment (.CMA): the tables of the axes, a set a line.
struct Assignment {
    name: String,
    file: ErrorFile,
    rows: Vec<[String; 5]>,
    active: Option<usize>,
    row: usize,
    column: usize,
    /// A name is asked for.
    asks: bool,
}

/// Opens the assignment of a name; in words, why it cannot be read.
pub(super) fn open(name: &str, path: &Path) -> Result<Turn, String> {
    let mut assignment = Assignment {
        name: name.to_owned(),
        file: ErrorFile::new(Kind::Assignment, path),
        rows: Vec::new(),
        active: None,
        row: 0,
        column: 0,
        asks: false,
    };
    assignment.renew()?;
    Ok(Turn::Replace(Box::new(assignment)))
}

fn text(rows: &[[String; 5]], active: Option<usize>) -> String {
    let row = |(number, cells): (usize, &[String; 5])| {
        let cells = AXES.iter().zip(cells).filter(|(_, name)| !name.is_empty());
        let cells: String = cells.map(|(axis, name)| format!(" {axis}={name}")).collect();
        format!("{number}{cells}")
    };
    let mut lines: Vec<String> = rows.iter().enumerate().map(row).collect();
    lines.extend(active.map(|active| format!("ACTIVE {active}")));
    text_of(&lines)
}

impl Assignment {
    fn renew(&mut self) -> Result<(), String> {
        let read = CompensationAssignment::read(&self.file.lines()?.join("\n"));
        let read = read.map_err(|error| error.to_string())?;
        let names = |line: &bahn_parameters::PerPlcAxis<Option<String>>| {
            let mut names = <[String; 5]>::default();
            for (name, own) in names.iter_mut().zip(line.iter()) {
                *name = own.clone().unwrap_or_default();
            }
            names
        };
        self.rows = read.lines.iter().map(names).collect();
        self.active = read.active;
        self.row = self.row.min(self.rows.len().saturating_sub(1));
        Ok(())
    }

    /// Writes other lines; a file in use acts at once.
    fn take(&mut self, rows: Vec<[String; 5]>, active: Option<usize>, site: &mut Site) -> Turn {
        match self
            .file
            .store(&text(&rows, active), site)
            .and_then(|()| self.renew())
        {
            Ok(()) => Turn::Done,
            Err(why) => Turn::Say(why),
        }
    }

    /// SET ACTIV LINE: the file is the one in use from now on, and this line of it acts.
    fn activate(&mut self, site: &mut Site) -> Turn {
        if self.rows.get(self.row).is_none() {
            return Turn::Refused;
        }
        let own = self.file.named(site);
        if description::value(KEY, site).as_ref() == Some(&own) {
            return self.take(self.rows.clone(), Some(self.row), site);
        }
        // Its line and the entry that names it go together, or neither does.
        let text = text(&self.rows, Some(self.row));
        let named = |site: &Site| description::set(KEY, &own, site);
        let stored = self.file.store_by(named, &text, site);
        match stored.and_then(|()| self.renew()) {
            Ok(()) => Turn::Done,
            Err(why) => Turn::Say(why),
        }
    }

    /// A line comes in at the cursor; the active one stays active.
    fn insert(&mut self, site: &mut Site) -> Turn {
        let at = self.row.min(self.rows.len());
        let mut rows = self.rows.clone();
        rows.insert(at, Default::default());
        let active = self.active.map(|active| active + usize::from(active >= at));
        self.take(rows, active, site)
    }

    /// The active line keeps its place when one before it goes.
    fn delete(&mut self, site: &mut Site) -> Turn {
        if self.row >= self.rows.len() {
            return Turn::Refused;
        }
        let mut rows = self.rows.clone();
        rows.remove(self.row);
        let active = self.active.filter(|active| *active != self.row);
        let active = active.map(|active| active - usize::from(active > self.row));
        self.take(rows, active, site)
    }

    /// The name of a table, without its type; none empties the cell.
    fn ask(&mut self, key: Key, site: &Site) -> Turn {
        self.asks = true;
        let axis = AXES.get(self.column).copied().unwrap_or_default();
        let (file, rows) = (self.file.clone(), self.rows.clone());
        let (row, column, active) = (self.row, self.column, self.active);
        let mut ask = Name::ask(
            format!("{axis}: {}", site.words("FILE NAME =")),
            NAME_MAX,
            move |name, site| {
                let mut rows = rows.clone();
                let cell = rows.get_mut(row).and_then(|cells| cells.get_mut(column));
                if let Some(cell) = cell {
                    name.trim_end_matches(".COM").clone_into(cell);
                }
                match file.store(&text(&rows, active), site) {
                    Ok(()) => Turn::Close,
                    Err(why) => Turn::Say(why),
                }
            },
        );
        ask.begin(key);
        Turn::Open(ask)
    }

    fn line(&self, place: usize) -> Line {
        let active = if self.active == Some(place) { ">>" } else { "" };
        let head = format!("{place:<4}{active:<4}");
        let names = self.rows.get(place).into_iter().flatten().map(String::as_str);
        list::cells(head, names, WIDTH, (place == self.row).then_some(self.column))
    }
}

impl Page for Assignment {
    fn file(&self) -> Option<&str> {
        Some(&self.name)
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(rows) = list::way_of_key(key) {
            self.row = list::moved(self.row, rows, self.rows.len());
            return Turn::Done;
        }
        match key {
            Key::Left => self.column = self.column.saturating_sub(1),
            Key::Right => self.column = list::moved(self.column, 1, AXES.len()),
            Key::End | Key::Del => return Turn::Close,
            Key::NoEnt => {
                let mut rows = self.rows.clone();
                let Some(cell) = rows
                    .get_mut(self.row)
                    .and_then(|cells| cells.get_mut(self.column))
                else {
                    return Turn::Refused;
                };
                cell.clear();
                return self.take(rows, self.active, site);
            }
            key if key.character().is_some() && self.row < self.rows.len() => return self.ask(key, site),
            _ => return Turn::Refused,
        }
        Turn::Done
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "SET ACTIV LINE" => self.activate(site),
            "CLEAR ACTIV LINE" => self.take(self.rows.clone(), None, site),
            "INSERT LINE" => self.insert(site),
            "DELETE LINE" => self.delete(site),
            _ => Turn::Close,
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let axes: String = AXES.iter().map(|axis| format!("{axis:<WIDTH$}")).collect();
        let title = format!("{} {}  {}", site.words("FILE"), self.name, axes.trim_end());
        let cursor = (self.row, self.rows.len());
        View::of(list::window(title, WindowKind::Table, cursor, lines, |place| {
            self.line(place)
        }))
    }

    /// A name was entered meanwhile.
    fn tick(&mut self, _site: &mut Site) -> Turn {
        match std::mem::take(&mut self.asks).then(|| self.renew()) {
            Some(Err(why)) => Turn::Say(why),
            _ => Turn::Done,
        }
    }
}
