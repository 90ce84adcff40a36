//! A compensation table (.COM): the errors of some axes over the points of one, line by line as the manual shows it
//! [000:3809-3853]. Only the kinks are entered.

use std::collections::BTreeMap;
use std::path::Path;

use bahn_dialogue::Key;
use bahn_parameters::PLC_AXIS_NAMES as AXES;
use bahn_screen::{Dialogue, Line, WindowKind};
use bahn_servo::ErrorTable;

use super::head::{self, Field};
use super::text::{ErrorFile, Kind};
use crate::entry::Entry;
use crate::page::{Page, Turn, View};
use crate::pages::list;
use crate::site::Site;

/// Soft keys of the editor [000:3829].
const SOFT_KEYS: [&str; 8] = [
    "BEGIN",
    "LAST LINE",
    "PAGE UP",
    "PAGE DOWN",
    "INSERT LINE",
    "DELETE LINE",
    "HEAD LINE",
    "END",
];
/// Words of the head line before its columns.
const COLUMNS: usize = 6;
/// Width of number, position and column in the window.
const WIDTHS: [usize; 3] = [5, 12, 11];

/// Editor of a compensation table (.COM): points, and corrections at them.
struct Table {
    name: String,
    file: ErrorFile,
    head: Vec<String>,
    /// Where the points stand.
    places: Option<ErrorTable>,
    points: BTreeMap<usize, BTreeMap<String, String>>,
    row: usize,
    column: usize,
    entry: Entry,
    /// The head line lies open.
    heads: bool,
}

/// Opens the table of a name; in words, why it cannot be read.
pub(super) fn open(name: &str, path: &Path) -> Result<Turn, String> {
    let mut table = Table {
        name: name.to_owned(),
        file: ErrorFile::new(Kind::Table, path),
        head: Vec::new(),
        places: None,
        points: BTreeMap::new(),
        row: 0,
        column: 0,
        entry: Entry::default(),
        heads: false,
    };
    table.renew()?;
    Ok(Turn::Replace(Box::new(table)))
}

impl Table {
    /// What stands in the file; a name of an axis may be written in small letters.
    fn renew(&mut self) -> Result<(), String> {
        let lines = self.file.lines()?;
        let mut lines = lines.iter().map(|line| line.split_whitespace());
        let words = lines.next().into_iter().flatten().enumerate();
        let head = words.map(|(place, word)| match place < COLUMNS {
            true => word.to_owned(),
            false => word.to_uppercase(),
        });
        self.head = head.collect();
        let [datum, exponent] = [3, 5].map(|place| self.head.get(place).map_or("", String::as_str));
        let (datum, exponent) = (
            datum.parse().unwrap_or_default(),
            exponent.parse().unwrap_or_default(),
        );
        self.places = ErrorTable::new(datum, exponent, &[]);
        self.points.clear();
        for mut words in lines {
            let number = words.next().and_then(|word| word.parse().ok());
            let cells = words.map(|word| word.split_once('='));
            let (Some(number), Some(cells)) = (number, cells.collect::<Option<Vec<_>>>()) else {
                return Err(format!("{}: a line of it is none of a table", self.name));
            };
            let cells = cells
                .into_iter()
                .map(|(axis, value)| (axis.to_uppercase(), value.to_owned()));
            self.points.entry(number).or_default().extend(cells);
        }
        self.column = self.column.min(self.columns().len().saturating_sub(1));
        Ok(())
    }

    fn columns(&self) -> &[String] {
        self.head.get(COLUMNS..).unwrap_or_default()
    }

    fn written(&self) -> String {
        let mut text = format!("{}\n", self.head.join(" "));
        for (number, cells) in &self.points {
            let cells: String = cells
                .iter()
                .map(|(axis, value)| format!(" {axis}={value}"))
                .collect();
            text += &format!("{number}{cells}\n");
        }
        text
    }

    /// Changes the points; what does not fit stays as it was.
    fn change(&mut self, what: impl FnOnce(&mut Table), site: &mut Site) -> Turn {
        let before = self.points.clone();
        what(self);
        match self.file.store(&self.written(), site) {
            Ok(()) => {
                self.entry = Entry::default();
                Turn::Done
            }
            Err(why) => {
                self.points = before;
                Turn::Say(why)
            }
        }
    }

    /// Sets the cell, or empties it.
    fn set(&mut self, value: Option<f64>, site: &mut Site) -> Turn {
        let (row, Some(axis)) = (self.row, self.columns().get(self.column).cloned()) else {
            return Turn::Refused;
        };
        self.change(
            |table| {
                let cells = table.points.entry(row).or_default();
                match value {
                    Some(value) => drop(cells.insert(axis, value.to_string())),
                    None => drop(cells.remove(&axis)),
                }
                if cells.is_empty() {
                    table.points.remove(&row);
                }
            },
            site,
        )
    }

    /// A line comes in between, or goes: those after it move by one point.
    fn shift(&mut self, on: bool, site: &mut Site) -> Turn {
        let row = self.row;
        if on && self.points.contains_key(&(ErrorTable::POINTS_MAX - 1)) {
            return Turn::Refused;
        }
        self.change(
            |table| {
                let old = std::mem::take(&mut table.points);
                let place = |number: usize| match (on, number < row) {
                    (_, true) => Some(number),
                    (true, false) => Some(number + 1),
                    (false, false) if number == row => None,
                    (false, false) => Some(number - 1),
                };
                let moved = old
                    .into_iter()
                    .filter_map(|(number, cells)| Some((place(number)?, cells)));
                table.points = moved.collect();
            },
            site,
        )
    }

    fn head_line(&mut self) -> Turn {
        self.heads = true;
        let columns = (0..AXES.len()).map(|axis| Field::Column(axis, COLUMNS));
        let fields = [Field::Number("DATUM", 3), Field::Number("DIST", 5)];
        head::open(self.file.clone(), 0, fields.into_iter().chain(columns).collect())
    }

    fn go(&mut self, rows: isize) -> Turn {
        self.row = list::moved(self.row, rows, ErrorTable::POINTS_MAX);
        self.entry = Entry::default();
        Turn::Done
    }

    fn line(&self, point: usize) -> Line {
        let [number, position, width] = WIDTHS;
        let places = self.places.as_ref();
        let place = format!("{:.4}", places.map_or(0.0, |places| places.position_mm(point)));
        let place = place.trim_end_matches('0').trim_end_matches('.');
        let head = format!("{point:<number$}{place:<position$}");
        let cells = self.points.get(&point);
        let columns = self.columns();
        let value = |axis| cells.and_then(|cells| cells.get(axis)).map_or("", String::as_str);
        let values = columns.iter().map(value);
        list::cells(head, values, width, (point == self.row).then_some(self.column))
    }
}

impl Page for Table {
    fn file(&self) -> Option<&str> {
        Some(&self.name)
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(rows) = list::way_of_key(key) {
            return self.go(rows);
        }
        match key {
            Key::Left => self.column = self.column.saturating_sub(1),
            Key::Right => self.column = list::moved(self.column, 1, self.columns().len()),
            Key::Ent => {
                let Some(value) = self.entry.value() else {
                    return self.go(1);
                };
                let turn = self.set(Some(value), site);
                if matches!(turn, Turn::Done) {
                    self.go(1);
                }
                return turn;
            }
            Key::NoEnt => return self.set(None, site),
            Key::End | Key::Del => return Turn::Close,
            key if self.entry.key(key) => {}
            _ => return Turn::Refused,
        }
        Turn::Done
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "INSERT LINE" => self.shift(true, site),
            "DELETE LINE" => self.shift(false, site),
            "HEAD LINE" => self.head_line(),
            name => list::way_of(name).map_or(Turn::Close, |rows| self.go(rows)),
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let axis = |name: &String| format!("{name}=F()");
        let columns: Vec<String> = self.columns().iter().map(axis).collect();
        let head = self.head.get(1..COLUMNS).unwrap_or_default().join(" ");
        let title = format!(
            "{} {}  {head}  {}",
            site.words("FILE"),
            self.name,
            columns.join(" ")
        );
        let cursor = (self.row, ErrorTable::POINTS_MAX);
        View {
            window: Some(list::window(title, WindowKind::Table, cursor, lines, |point| {
                self.line(point)
            })),
            dialogue: Dialogue {
                prompt: site.words("COMPENSATION VALUE ?"),
                entry: self.entry.text(),
                open: true,
            },
        }
    }

    fn tick(&mut self, _site: &mut Site) -> Turn {
        match std::mem::take(&mut self.heads).then(|| self.renew()) {
            Some(Err(why)) => Turn::Say(why),
            _ => Turn::Done,
        }
    }
}
