//! The keys of the table editor, and what it shows.

use bahn_dialogue::Key;
use bahn_host::TableForm;
use bahn_parameters::MessageId;
use bahn_screen::{Dialogue, Line, Mark, WindowKind};

use super::cells::{is_mark, read};
use super::editor::{CELL_MAX, TableEditor, WIDTH};
use super::{POCKET_FILE, TOOL_FILE, is_open_to_all, pockets, tools};
use crate::entry::Entry;
use crate::page::{Overlay, Page, Turn, View};
use crate::pages::ask::Choice;
use crate::pages::list;
use crate::site::Site;

impl TableEditor {
    /// ENT: what was entered is taken; an empty entry sets a mark; then the next cell has the cursor.
    fn enter(&mut self, site: &mut Site) -> Turn {
        let turn = match self.entry.clone() {
            Some(entry) => self.take(&entry, site),
            None if is_mark(self.form, self.column_name()) => {
                let mark = self.column_name().get(..1).unwrap_or_default().to_owned();
                self.take(&mark, site)
            }
            None => Turn::Done,
        };
        if matches!(turn, Turn::Done) {
            self.go(0, 1);
        }
        turn
    }

    fn go(&mut self, rows: isize, columns: isize) -> Turn {
        self.row = list::moved(self.row, rows, self.shown.rows.len());
        self.column = list::moved(self.column, columns, self.shown.names.len()).max(1);
        self.entry = None;
        Turn::Done
    }

    /// What is open is taken before the cursor goes on.
    fn leave_cell(&mut self, rows: isize, columns: isize, site: &mut Site) -> Turn {
        if let Some(entry) = self.entry.clone()
            && let turn = self.take(&entry, site)
            && !matches!(turn, Turn::Done)
        {
            return turn;
        }
        self.go(rows, columns)
    }

    /// The actual position of an axis: into its column, or that of the tool axis into the length [003:1857].
    fn capture(&mut self, site: &Site) -> Turn {
        let letter = match (self.form, self.column_name()) {
            (TableForm::Tool, "L") => site.tool_axis().map(bahn_path::Axis::letter),
            (TableForm::Datum | TableForm::Point, name) => {
                let snapshot = site.control().snapshot();
                let place = name
                    .parse::<usize>()
                    .ok()
                    .and_then(|number| number.checked_sub(1));
                let mut axes = snapshot.axes.iter();
                axes.find(|axis| Some(axis.index) == place || name.starts_with(axis.letter))
                    .map(|axis| axis.letter)
            }
            _ => None,
        };
        match letter.and_then(|letter| site.captured(letter)) {
            Some(value) => {
                self.entry = Some(Entry::of(value).text());
                Turn::Done
            }
            None => Turn::Refused,
        }
    }

    fn is_pocket_table(&self) -> bool {
        self.form == TableForm::Pocket && self.is_of_machine()
    }

    /// NEXT LINE: the first column of the line below.
    fn next_line(&mut self, site: &mut Site) -> Turn {
        let turn = self.leave_cell(1, 0, site);
        if matches!(turn, Turn::Done) {
            self.column = 1;
        }
        turn
    }

    /// RESET POCKET TABLE asks before.
    fn ask_to_reset(&self, site: &Site) -> Turn {
        if !self.edits {
            return Turn::Refused;
        }
        let words = site.words("RESET POCKET TABLE");
        let prompt = format!("{words}: {}", site.words("ERASE = ENT / END = NO ENT"));
        let reset = self.asked.reset.clone();
        Turn::Open(Choice::confirm(prompt, words, move |_site| {
            reset.set("");
            Turn::Close
        }))
    }

    fn goto(&self, site: &Site) -> Turn {
        self.asked.line.ask(site.words("GOTO: NUMBER ="), 8)
    }

    /// What the control asks for a column.
    fn prompt(&self, site: &Site) -> String {
        match (self.form, self.column_name()) {
            (TableForm::Tool, "L") => site.words("TOOL LENGTH L?"),
            (TableForm::Tool, "R") => site.words("TOOL RADIUS R?"),
            (TableForm::Tool, "R2") => site.words("TOOL RADIUS R2?"),
            (TableForm::Tool, "NAME") => site.words("TOOL NAME?"),
            (TableForm::Tool, "DL") => site.words("TOOL LENGTH OVERSIZE?"),
            (TableForm::Tool, "DR") => site.words("TOOL RADIUS OVERSIZE?"),
            (TableForm::Tool, "TL") => site.words("TOOL LOCKED? YES=ENT/NO=NOENT"),
            (TableForm::Tool, "RT") => site.words("ALTERNATE TOOL?"),
            (TableForm::Tool, "TIME1" | "TIME2") => site.words("MAXIMUM TOOL AGE?"),
            (TableForm::Tool, "CUR.TIME") => site.words("CURRENT TOOL AGE?"),
            // The TNC 360 has blanks in it [003:1908].
            (TableForm::Tool | TableForm::Pocket, "ST") => match site.control().model().has_windows() {
                true => site.words("SPECIAL TOOL? YES=ENT/NO=NOENT"),
                false => site.words("SPECIAL TOOL? YES = ENT / NO = NO ENT"),
            },
            (TableForm::Tool, "P") => site.words("POCKET NUMBER?"),
            (TableForm::Pocket, "T") => site.words("TOOL NUMBER?"),
            (TableForm::Pocket, "F") => site.words("FIXED POCKET? YES=ENT/NO=NOENT"),
            (TableForm::Pocket, "L") => site.words("POCKET LOCKED? YES=ENT/NO=NOENT"),
            (_, "PLC") => site.words("PLC STATUS?"),
            (_, "DOC") => site.words("COMMENT?"),
            (_, name) => format!("{name}?"),
        }
    }

    /// The columns in sight: the first one, and those around the cursor that fit, with their widths.
    fn columns_in_sight(&self) -> Vec<(usize, usize)> {
        let width = |at: usize| {
            let cells = self.shown.rows.iter().filter_map(|row| row.get(at));
            let cells = cells.chain(self.shown.names.get(at));
            cells
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or_default()
                .clamp(3, 20)
        };
        let widths: Vec<usize> = (0..self.shown.names.len()).map(width).collect();
        let total = |from: usize, to: usize| -> usize {
            let all = widths.iter().enumerate();
            all.filter(|(at, _)| *at == 0 || (from..to).contains(at))
                .map(|(_, width)| width + 1)
                .sum()
        };
        let mut from = 1;
        while from < self.column && total(from, self.column + 1) > WIDTH {
            from += 1;
        }
        let all = (0..).zip(widths.iter().copied());
        all.filter(|(at, _)| *at == 0 || (*at >= from && total(from, at + 1) <= WIDTH))
            .collect()
    }

    /// A line of cells, and where the cursor stands in it.
    fn row_line(&self, place: usize, row: &[String], columns: &[(usize, usize)]) -> Line {
        let is_current = place == self.row;
        let mut line = Line {
            current: is_current,
            ..Line::default()
        };
        for (at, width) in columns {
            let is_cursor = is_current && *at == self.column;
            let cell = row.get(*at).map_or("", String::as_str);
            let cell = self.entry.as_deref().filter(|_| is_cursor).unwrap_or(cell);
            let from = line.text.chars().count();
            line.text += &format!("{cell:<width$} ");
            if is_cursor {
                let mark = if self.entry.is_some() {
                    Mark::Entry
                } else {
                    Mark::Cursor
                };
                line.marks.push((from, from + width, mark));
            }
        }
        line
    }
}

/// Its soft keys; after them stand the table that belongs to this one, and END.
const SOFT_KEYS: [&str; 6] = [
    "BEGIN",
    "LAST LINE",
    "PAGE UP",
    "PAGE DOWN",
    "INSERT LINE",
    "DELETE LINE",
];

impl Page for TableEditor {
    fn overlay(&self) -> Overlay {
        Overlay::Table
    }

    fn file(&self) -> Option<&str> {
        Some(&self.name)
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if let Some(rows) = list::way_of_key(key) {
            return self.leave_cell(rows, 0, site);
        }
        match key {
            Key::Left => self.leave_cell(0, -1, site),
            Key::Right => self.leave_cell(0, 1, site),
            Key::Ent => self.enter(site),
            Key::NoEnt => self.take("", site),
            Key::Ce if self.entry.is_some() => {
                self.entry = None;
                Turn::Done
            }
            Key::Del if self.entry.is_some() => {
                self.entry = None;
                Turn::Done
            }
            Key::End => match self.leave_cell(0, 0, site) {
                Turn::Done => Turn::Close,
                turn => turn,
            },
            Key::Del => Turn::Close,
            Key::Goto => self.goto(site),
            Key::Capture if self.edits => self.capture(site),
            key => self.typed(key),
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let other = match self.name.as_str() {
            TOOL_FILE if is_open_to_all(POCKET_FILE, site) => site.words("POCKET TABLE"),
            POCKET_FILE => site.words("TOOL TABLE"),
            _ => String::new(),
        };
        let mut keys = list::soft_keys(&SOFT_KEYS, site);
        keys.extend([other, site.words("END")]);
        let reset = match self.is_pocket_table() {
            true => site.words("RESET POCKET TABLE"),
            false => String::new(),
        };
        let edit = match self.edits {
            true => site.words("EDIT OFF"),
            false => site.words("EDIT ON"),
        };
        vec![keys, vec![reset, edit, site.words("NEXT LINE")]]
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        if row == 1 {
            return match place {
                0 => self.ask_to_reset(site),
                1 => {
                    self.edits = !self.edits;
                    self.entry = None;
                    Turn::Done
                }
                _ => self.next_line(site),
            };
        }
        match list::name_at(&SOFT_KEYS, place) {
            "INSERT LINE" | "DELETE LINE" if !self.edits => Turn::Refused,
            "INSERT LINE" => self.insert(site),
            "DELETE LINE" => self.delete(site),
            _ if place == SOFT_KEYS.len() => {
                let other = if self.name == TOOL_FILE {
                    pockets(site)
                } else {
                    tools(site)
                };
                match other {
                    Turn::Open(page) => Turn::Replace(page),
                    other => other,
                }
            }
            name => match list::way_of(name) {
                Some(rows) => self.leave_cell(rows, 0, site),
                None => self.key(Key::End, site),
            },
        }
    }

    fn text(&mut self, text: &str, _site: &mut Site) -> Turn {
        if text.chars().count() > CELL_MAX || text.contains(char::is_control) {
            return Turn::Refused;
        }
        self.entry = Some(text.to_owned());
        Turn::Done
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let columns = self.columns_in_sight();
        let rows = lines.saturating_sub(1);
        let heading = Line {
            marks: vec![(0, WIDTH, Mark::Quiet)],
            ..self.row_line(usize::MAX, &self.shown.names, &columns)
        };
        let line = |place| {
            let row = self.shown.rows.get(place);
            row.map_or_else(Line::default, |row| self.row_line(place, row, &columns))
        };
        let (title, cursor) = (format!("{}  MM", self.name), (self.row, self.shown.rows.len()));
        let mut window = list::window(title, WindowKind::Table, cursor, rows, line);
        window.lines.insert(0, heading);
        View {
            window: Some(window),
            dialogue: Dialogue {
                prompt: self.prompt(site),
                entry: self.entry.clone().unwrap_or_default(),
                open: true,
            },
        }
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        if self.asked.reset.take().is_some()
            && let Err(why) = self.reset_pockets(site)
        {
            return Turn::Say(why);
        }
        if let Some(line) = self.asked.line.take() {
            let key = self.shown.names.iter().position(|name| name == self.form.key());
            let is_meant = |row: &Vec<String>| key.and_then(|key| row.get(key)) == Some(&line);
            match self.shown.rows.iter().position(is_meant) {
                Some(row) => self.row = row,
                None => return Turn::Say(site.message(MessageId::EntryValueIncorrect)),
            }
        }
        if !self.fresh.passes(site.programs.version()) {
            return Turn::Done;
        }
        match read(&self.path) {
            Ok(text) => self.text = text,
            Err(why) => return Turn::CloseSaying(why),
        }
        self.renew(site).map_or_else(Turn::CloseSaying, |()| Turn::Done)
    }
}
