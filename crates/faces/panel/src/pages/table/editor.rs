//! A table that is edited: its text, how it is shown, and how a cell is changed.

use std::path::PathBuf;

use bahn_dialogue::Key;
use bahn_host::{
    CellContent, PlainTable, TableForm, TextTable, canonical, delete_line, files, set_line, with_column,
};
use bahn_text::decode;
use bahn_tnc::Command;

use super::cells::{element_value, read, with_line};
use super::{POCKET_FILE, TOOL_FILE, store};
use crate::page::Turn;
use crate::pages::ask::{Choice, Later, Name};
use crate::site::Site;

/// Millimetres of an inch.
pub(super) const INCH_MM: f64 = 25.4;
/// Characters of a cell at most.
pub(super) const CELL_MAX: usize = 32;
/// Characters of a line in the window: columns beyond it are reached with the arrow keys.
pub(super) const WIDTH: usize = 76;

/// Contour cycles after which what tools and PLC have changed is shown.
const RENEWED: u32 = 200;

/// A table that is edited.
pub(super) struct TableEditor {
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) form: TableForm,
    pub(super) text: String,
    /// As it is shown: brought up to date, with the columns of the control.
    pub(super) shown: PlainTable,
    pub(super) inches: bool,
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) entry: Option<String>,
    /// EDIT ON: keys change cells.
    pub(super) edits: bool,
    pub(super) asked: Asked,
    pub(super) fresh: Fresh,
}

/// What the operator is asked for.
#[derive(Default)]
pub(super) struct Asked {
    /// The line that GOTO asks for.
    pub(super) line: Later,
    /// RESET POCKET TABLE was confirmed.
    pub(super) reset: Later,
}

/// How new the lines are.
pub(super) struct Fresh {
    /// The program memory as the file was read.
    version: u64,
    /// Cycles until its lines are looked at again.
    rest: u32,
}

impl Fresh {
    /// They were read from this state of the program memory.
    pub(super) fn of(version: u64) -> Fresh {
        Fresh {
            version,
            rest: RENEWED,
        }
    }

    /// They were written: this state of the program memory is known.
    pub(super) fn written(&mut self, version: u64) {
        self.version = version;
    }

    /// A cycle has passed; whether they are to be looked at again.
    pub(super) fn passes(&mut self, version: u64) -> bool {
        self.rest = self.rest.saturating_sub(1);
        let is_due = self.version != version || self.rest == 0;
        if is_due {
            *self = Fresh::of(version);
        }
        is_due
    }
}

impl TableEditor {
    pub(super) fn read(
        name: &str,
        path: PathBuf,
        form: TableForm,
        site: &Site,
    ) -> Result<TableEditor, String> {
        let bytes = files::read_table(&path).map_err(|error| error.to_string())?;
        let mut editor = TableEditor {
            name: name.to_owned(),
            path,
            form,
            text: decode(&bytes),
            shown: PlainTable {
                kind: form,
                names: Vec::new(),
                rows: Vec::new(),
            },
            inches: false,
            row: 0,
            column: 1,
            entry: None,
            edits: true,
            asked: Asked::default(),
            fresh: Fresh::of(site.programs.version()),
        };
        editor.renew(site)?;
        Ok(editor)
    }

    /// Its lines as they are now: in use, tools change their pockets and lives, and the PLC writes.
    pub(super) fn renew(&mut self, site: &Site) -> Result<(), String> {
        let table = TextTable::read(&self.text).map_err(|fault| fault.to_string())?;
        self.inches = table.in_inches();
        let mut shown = PlainTable::new(self.form, &table);
        if self.is_of_machine() {
            shown.bring_up_to_date(&site.control().remember());
        }
        let key = self.form.key();
        if let Some(columns) = self.form.shown(site.parameters()) {
            let names: Vec<String> = [key.to_owned()].into_iter().chain(columns).collect();
            shown.choose(&names);
        }
        self.shown = shown;
        self.row = self.row.min(self.shown.rows.len().saturating_sub(1));
        self.column = self.column.min(self.shown.names.len().saturating_sub(1)).max(1);
        Ok(())
    }

    pub(super) fn is_of_machine(&self) -> bool {
        matches!(self.name.as_str(), TOOL_FILE | POCKET_FILE)
    }

    /// Number of the line under the cursor.
    pub(super) fn line(&self) -> Option<String> {
        let key = self.shown.names.iter().position(|name| name == self.form.key())?;
        self.shown.rows.get(self.row)?.get(key).cloned()
    }

    pub(super) fn column_name(&self) -> &str {
        self.shown.names.get(self.column).map_or("", String::as_str)
    }

    /// Takes what was entered into the cell.
    pub(super) fn take(&mut self, value: &str, site: &mut Site) -> Turn {
        let (Some(line), column) = (self.line().filter(|_| self.edits), self.column_name().to_owned()) else {
            return Turn::Refused;
        };
        match self.set(&line, &column, value, site) {
            Ok(()) => {
                self.entry = None;
                Turn::Done
            }
            Err(why) => Turn::Say(why),
        }
    }

    /// Sets a cell: checked as a whole, on the medium, then in the control.
    pub(super) fn set(
        &mut self,
        line: &str,
        column: &str,
        value: &str,
        site: &mut Site,
    ) -> Result<(), String> {
        let value = value.replace(',', ".");
        let mut text = with_column(&self.text, self.form, column)?;
        if self.form == TableForm::Pocket && self.is_of_machine() {
            // The file takes over where the tools are now.
            for row in self.shown.rows.clone() {
                text = self.with_row(&text, &row)?;
            }
        }
        let written = self.in_unit_of_file(column, &value);
        let (text, _) = set_line(&text, self.form, line, &[(column, &written)])?;
        self.store(text, site)?;
        self.tell(line, column, &value, site);
        self.renew(site)
    }

    /// A text with all cells of a row as they are shown.
    pub(super) fn with_row(&self, text: &str, row: &[String]) -> Result<String, String> {
        let key = self.form.key();
        let cells = self.shown.names.iter().zip(row);
        let line = cells.clone().find(|(name, _)| *name == key).map(|(_, line)| line);
        let values: Vec<(&str, &str)> = cells
            .filter(|(name, value)| *name != key && (!value.is_empty() || *name == "T"))
            .map(|(name, value)| (name.as_str(), value.as_str()))
            .collect();
        let Some(line) = line else {
            return Ok(text.to_owned());
        };
        let (text, _) = set_line(text, self.form, line, &values)?;
        Ok(text)
    }

    /// A value as the file has it: lengths of a table in inches are shown in millimetres.
    pub(super) fn in_unit_of_file(&self, column: &str, value: &str) -> String {
        let is_length = self.form.content(column) == CellContent::Length;
        match value.parse::<f64>() {
            Ok(mm) if self.inches && is_length => format!("{:.6}", mm / INCH_MM),
            _ => value.to_owned(),
        }
    }

    /// The new text, when it has no fault, whole or not at all.
    fn store(&mut self, text: String, site: &mut Site) -> Result<(), String> {
        store(&self.name, &self.path, self.form, &text, site)?;
        self.fresh.written(site.programs.version());
        self.text = text;
        Ok(())
    }

    /// The control takes over a cell of a table that it uses.
    pub(super) fn tell(&self, line: &str, column: &str, value: &str, site: &mut Site) {
        let Some(kind) = self.form.kind() else { return };
        let in_use = match self.form {
            TableForm::Datum => site.control().first().datum_table_name() == Some(self.name.as_str()),
            _ => self.is_of_machine(),
        };
        let named = |own: &Option<bahn_plc::Column>| own.is_some_and(|own| canonical(own.name) == column);
        let element = kind.columns().iter().position(named);
        let number = element_value(self.form, column, value);
        if let (true, Some(element), Some(number), Ok(line)) = (in_use, element, number, line.parse()) {
            site.command(Command::Table(kind, line, element, number));
        }
    }

    /// RESET POCKET TABLE: no pocket holds a tool; what the pockets are stays (inferred) [000:9058-9073].
    pub(super) fn reset_pockets(&mut self, site: &mut Site) -> Result<(), String> {
        let mut text = with_column(&self.text, self.form, "T")?;
        let lines: Vec<String> = self.lines().collect();
        for line in &lines {
            (text, _) = set_line(&text, self.form, line, &[("T", "")])?;
        }
        self.store(text, site)?;
        for line in &lines {
            self.tell(line, "T", "", site);
        }
        self.renew(site)
    }

    /// The numbers of all lines.
    fn lines(&self) -> impl Iterator<Item = String> {
        let key = self.shown.names.iter().position(|name| name == self.form.key());
        let rows = self.shown.rows.iter();
        rows.filter_map(move |row| row.get(key?).cloned())
    }

    pub(super) fn insert(&self, site: &Site) -> Turn {
        let prompt = format!("{} {} =", site.words("NEW LINE"), self.form.key());
        let (path, form, name) = (self.path.clone(), self.form, self.name.clone());
        let in_use = self.is_of_machine();
        Turn::Open(Name::ask(prompt, 8, move |line, site| {
            let text = with_line(&path, form, &line);
            match text.and_then(|text| store(&name, &path, form, &text, site)) {
                Ok(()) if in_use => Turn::CloseSaying(site.words("THE NEW LINE COUNTS FROM POWER-ON")),
                Ok(()) => Turn::Close,
                Err(why) => Turn::Say(why),
            }
        }))
    }

    pub(super) fn delete(&self, site: &Site) -> Turn {
        let Some(line) = self.line() else {
            return Turn::Refused;
        };
        let prompt = format!(
            "{} {line}: {}",
            self.form.key(),
            site.words("ERASE = ENT / END = NO ENT")
        );
        let (path, form, name) = (self.path.clone(), self.form, self.name.clone());
        Turn::Open(Choice::confirm(prompt, site.words("ERASE"), move |site| {
            let text = read(&path).and_then(|text| delete_line(&text, form, &line));
            let stored = text.and_then(|text| store(&name, &path, form, &text, site));
            stored.map_or_else(Turn::CloseSaying, |()| Turn::Close)
        }))
    }

    /// A letter or digit of a cell.
    pub(super) fn typed(&mut self, key: Key) -> Turn {
        let Some(character) = key.character().filter(|_| self.edits) else {
            return Turn::Refused;
        };
        let is_number = self.form.content(self.column_name()) != CellContent::Text;
        let entry = self.entry.get_or_insert_default();
        if entry.len() >= CELL_MAX {
            return Turn::Refused;
        }
        if key == Key::Sign && entry.starts_with('-') {
            entry.remove(0);
        } else if key == Key::Sign && is_number {
            entry.insert(0, '-');
        } else {
            entry.push(character);
        }
        Turn::Done
    }
}
