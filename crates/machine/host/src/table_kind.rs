//! The kinds of tables in the NC memory: what their columns are, how they are recognised, checked and written anew.

use std::path::Path;

use bahn_parameters::ParameterList;
use bahn_parameters::tables::{POCKET_ELEMENTS, TOOL_ELEMENTS, shown_elements};
use bahn_plc::TableKind;
use bahn_text::Diagnostic;
use bahn_tnc::Remembered;

use crate::columns::{TextRow, TextTable, canonical, quoted};
use crate::{machine_folder, pocket_table, point_table, tool_table};

/// A kind of table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableForm {
    /// Tool table, .T: a tool a line.
    Tool,
    /// Pocket table, .TCH: a pocket of the magazine a line.
    Pocket,
    /// Datum table, .D: shifts for cycle 7.
    Datum,
    /// Pallet file, .P: program and datums for each pallet.
    Pallet,
    /// Point table, .PNT: digitized points.
    Point,
}

/// What stands in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// A length: millimetres, or inches in a table of inches.
    Length,
    /// A number without unit, or in degrees or minutes.
    Number,
    /// Text, marks, bits.
    Text,
}

use Content::{Length, Number, Text};

/// A column that a control knows.
pub type KnownColumn = (&'static str, Content);

/// MP7266 [000:9118-9139], with the columns by which tools have pockets without a pocket table, and the angle of
/// later controls.
const TOOL: &[KnownColumn] = &[
    ("T", Number),
    ("NAME", Text),
    ("L", Length),
    ("R", Length),
    ("R2", Length),
    ("DL", Length),
    ("DR", Length),
    ("DR2", Length),
    ("TL", Text),
    ("RT", Text),
    ("TIME1", Number),
    ("TIME2", Number),
    ("CUR.TIME", Number),
    ("DOC", Text),
    ("CUT", Number),
    ("LTOL", Length),
    ("RTOL", Length),
    ("DIRECT", Text),
    ("PLC", Text),
    ("L-OFFS", Length),
    ("R-OFFS", Length),
    ("LBREAK", Length),
    ("RBREAK", Length),
    ("P", Text),
    ("ST", Text),
    ("T-ANGLE", Number),
];

/// Columns of the pocket table, which MP7267 orders [000:9145-9149].
const POCKET: &[KnownColumn] = &[
    ("P", Number),
    ("T", Text),
    ("ST", Text),
    ("F", Text),
    ("L", Text),
    ("PLC", Text),
];

/// [000:15414-15420]. 4 and 5 may turn: they have no unit here.
const DATUM: &[KnownColumn] = &[
    ("NR", Number),
    ("X", Length),
    ("Y", Length),
    ("Z", Length),
    ("4", Number),
    ("5", Number),
    ("DOC", Text),
];

/// Columns of the pallet file [000:15332-15340].
const PALLET: &[KnownColumn] = &[("NR", Number), ("PGM", Text), ("DATUM", Text), ("DOC", Text)];

const POINT: &[KnownColumn] = &[
    ("NR", Number),
    ("X", Length),
    ("Y", Length),
    ("Z", Length),
    ("DOC", Text),
];

impl TableForm {
    /// All kinds, in the order of their declaration.
    pub const ALL: [TableForm; 5] = [
        TableForm::Tool,
        TableForm::Pocket,
        TableForm::Datum,
        TableForm::Pallet,
        TableForm::Point,
    ];

    /// Its name: `tool`, `pocket`, `datum`, `pallet`, `point`.
    pub fn name(self) -> &'static str {
        match self {
            TableForm::Tool => "tool",
            TableForm::Pocket => "pocket",
            TableForm::Datum => "datum",
            TableForm::Pallet => "pallet",
            TableForm::Point => "point",
        }
    }

    /// The ending of its files on a control [000:6836-6846].
    pub fn ending(self) -> &'static str {
        match self {
            TableForm::Tool => "T",
            TableForm::Pocket => "TCH",
            TableForm::Datum => "D",
            TableForm::Pallet => "P",
            TableForm::Point => "PNT",
        }
    }

    /// The ending by which MP7224 protects and disables its files: pockets belong to the tools (inferred).
    pub fn protected_with(self) -> &'static str {
        match self {
            TableForm::Pocket => TableForm::Tool.ending(),
            other => other.ending(),
        }
    }

    /// The columns that a control knows, the first is the number of the line.
    pub fn columns(self) -> &'static [KnownColumn] {
        match self {
            TableForm::Tool => TOOL,
            TableForm::Pocket => POCKET,
            TableForm::Datum => DATUM,
            TableForm::Pallet => PALLET,
            TableForm::Point => POINT,
        }
    }

    /// The column with the number of the line.
    pub fn key(self) -> &'static str {
        self.columns().first().map_or("NR", |(name, _)| name)
    }

    /// What stands in a column; text in one that no control of this kind knows.
    pub fn content(self, column: &str) -> Content {
        let known = self.columns().iter().find(|(name, _)| *name == column);
        known.map_or(Text, |(_, content)| *content)
    }

    /// The kind of a table: by the ending of its file, else by its frame, else by its columns.
    pub fn of(path: &Path, table: &TextTable) -> Option<TableForm> {
        let by_ending = |ending: &str| {
            let mut all = TableForm::ALL.into_iter();
            all.find(|kind| kind.ending().eq_ignore_ascii_case(ending))
        };
        let ending = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let frame = table.frame.as_deref().unwrap_or_default();
        let framed = frame.split_whitespace().filter_map(|word| word.split_once('.'));
        let has = |name: &str| table.place(name).is_some();
        by_ending(&ending)
            .or_else(|| framed.filter_map(|(_, ending)| by_ending(ending)).next())
            .or(match () {
                () if has("T") && has("R") => Some(TableForm::Tool),
                () if has("P") && has("T") => Some(TableForm::Pocket),
                () if has("PGM") => Some(TableForm::Pallet),
                () if has("NR") => Some(TableForm::Datum),
                () => None,
            })
    }

    /// The columns that a control shows of it (MP7266, MP7267), but the first; `None` for all of them.
    pub fn shown(self, parameters: &ParameterList) -> Option<Vec<String>> {
        let tables = parameters.table_parameters();
        let shown = match self {
            TableForm::Tool => shown_elements(&tables.tool_columns, &TOOL_ELEMENTS),
            TableForm::Pocket => shown_elements(&tables.pocket_columns, &POCKET_ELEMENTS),
            _ => return None,
        };
        let shown: Vec<String> = shown.into_iter().map(str::to_owned).collect();
        (!shown.is_empty()).then_some(shown)
    }

    /// The table as PLC and programs see it, when they do.
    pub fn kind(self) -> Option<TableKind> {
        match self {
            TableForm::Tool => Some(TableKind::Tool),
            TableForm::Pocket => Some(TableKind::Pocket),
            TableForm::Datum => Some(TableKind::Datum),
            TableForm::Pallet | TableForm::Point => None,
        }
    }

    /// All faults of a table.
    ///
    /// # Errors
    /// The faults with their lines and columns.
    pub fn check(self, text: &str) -> Result<(), Vec<Diagnostic>> {
        match self {
            TableForm::Tool => tool_table::parse(text).map(drop),
            TableForm::Pocket => pocket_table::parse(text).map(drop),
            TableForm::Datum => machine_folder::check_datum_table(text),
            TableForm::Pallet => machine_folder::check_pallet_file(text),
            TableForm::Point => point_table::parse(text).map(drop),
        }
    }
}

/// A table taken out of its file: millimetres, and the names of the control for its columns.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainTable {
    /// Kind of table that its columns belong to.
    pub kind: TableForm,
    /// Names of the columns.
    pub names: Vec<String>,
    /// The fields of each row, as many as columns.
    pub rows: Vec<Vec<String>>,
}

impl PlainTable {
    /// The table of a file; lengths in inches become millimetres.
    pub fn new(kind: TableForm, table: &TextTable) -> PlainTable {
        let named = (0..).zip(&table.names).filter(|(_, name)| !name.is_empty());
        let columns: Vec<(usize, &str)> = named.map(|(at, name)| (at, canonical(name))).collect();
        let inches = table.in_inches();
        let field = |row: &TextRow, at: usize, name: &str| {
            let text = row.cells.get(at).map_or("", |cell| cell.text.as_str());
            match kind.content(name) {
                Length if inches => in_mm(text),
                _ => text.to_owned(),
            }
        };
        let row = |row: &TextRow| columns.iter().map(|(at, name)| field(row, *at, name)).collect();
        PlainTable {
            kind,
            rows: table.rows.iter().map(row).collect(),
            names: columns.iter().map(|(_, name)| (*name).to_owned()).collect(),
        }
    }

    /// Sets a column of the row with this text in a key column; nothing when there is no such row. A column that the table
    /// does not have comes behind the others.
    pub fn set(&mut self, key: &str, line: &str, column: &str, value: &str) {
        let place = |name: &str| self.names.iter().position(|own| own == name);
        let Some(key) = place(key) else { return };
        let is_meant = |row: &Vec<String>| row.get(key).is_some_and(|text| text == line);
        let Some(row) = self.rows.iter().position(is_meant) else {
            return;
        };
        let column = place(column).unwrap_or_else(|| {
            self.names.push(column.to_owned());
            for row in &mut self.rows {
                row.push(String::new());
            }
            self.names.len() - 1
        });
        let row = self.rows.get_mut(row);
        if let Some(field) = row.and_then(|row| row.get_mut(column)) {
            value.clone_into(field);
        }
    }

    /// Tool and pocket table: tools have changed their pockets, their lives were counted, the PLC has written.
    pub fn bring_up_to_date(&mut self, remembered: &Remembered) {
        let table = self;
        let key = table.kind.key();
        let kind = match table.kind {
            TableForm::Tool => TableKind::Tool,
            TableForm::Pocket => TableKind::Pocket,
            _ => return,
        };
        let written = remembered.written.iter().filter(|element| element.table == kind);
        let written: Vec<(String, &str, String)> = written
            .filter_map(|element| {
                let column = kind.columns().get(element.element)?.as_ref()?;
                Some((
                    element.line.to_string(),
                    canonical(column.name),
                    element.value.to_string(),
                ))
            })
            .collect();
        for (line, column, value) in &written {
            table.set(key, line, column, value);
        }
        let moved = remembered.pockets.iter();
        let moved: Vec<(String, Option<u16>)> = moved
            .map(|moved| (moved.tool.to_string(), moved.pocket))
            .collect();
        if table.kind == TableForm::Tool {
            for (tool, pocket) in &moved {
                table.set(
                    key,
                    tool,
                    "P",
                    &pocket.map(|pocket| pocket.to_string()).unwrap_or_default(),
                );
            }
            return;
        }
        for (tool, _) in &moved {
            table.set("T", tool, "T", "");
        }
        for (tool, pocket) in moved.iter().filter_map(|(tool, pocket)| Some((tool, (*pocket)?))) {
            table.set(key, &pocket.to_string(), "T", tool);
        }
    }

    /// Takes in every column that a control knows, in its order; what others there are stays behind them.
    pub fn complete(&mut self) {
        let known = self.kind.columns().iter().map(|(name, _)| (*name).to_owned());
        let mut names: Vec<String> = known.collect();
        names.extend(
            self.names
                .iter()
                .filter(|name| self.kind.columns().iter().all(|(known, _)| known != name))
                .cloned(),
        );
        self.choose(&names);
    }

    /// The columns in another order; one that the table does not have is empty.
    pub fn choose(&mut self, names: &[String]) {
        let places: Vec<Option<usize>> = names
            .iter()
            .map(|name| self.names.iter().position(|own| own == name))
            .collect();
        for row in &mut self.rows {
            let field = |place: &Option<usize>| place.and_then(|at| row.get(at).cloned()).unwrap_or_default();
            *row = places.iter().map(field).collect();
        }
        self.names = names.to_vec();
    }

    /// Fields with a character between them: a tab, a comma or a semicolon.
    pub fn separated(&self, separator: char) -> String {
        let lines = [&self.names].into_iter().chain(&self.rows);
        let line = |fields: &Vec<String>| {
            let fields: Vec<String> = fields.iter().map(|field| quoted(field, separator)).collect();
            fields.join(&separator.to_string()) + "\n"
        };
        lines.map(line).collect()
    }

    /// A file as controls write it: columns under their names, framed by the name of the table.
    pub fn of_control(&self, name: &str) -> String {
        let width = |at: usize| {
            let fields = self
                .rows
                .iter()
                .filter_map(|row| row.get(at))
                .chain(self.names.get(at));
            fields
                .map(|field| field.chars().count())
                .max()
                .unwrap_or_default()
        };
        let widths: Vec<usize> = (0..self.names.len()).map(width).collect();
        let line = |fields: &Vec<String>| {
            let padded = fields
                .iter()
                .zip(&widths)
                .map(|(field, width)| format!("{field:<width$}"));
            padded.collect::<Vec<_>>().join(" ").trim_end().to_owned() + "\n"
        };
        let rows: String = self.rows.iter().map(line).collect();
        let (ending, names) = (self.kind.ending(), line(&self.names));
        format!("BEGIN {} .{ending} MM\n{names}{rows}[END]\n", name.to_uppercase())
    }
}

/// A length in inches as millimetres, to a hundredth of a micrometre; what is no number stays.
fn in_mm(text: &str) -> String {
    match text.replace(',', ".").parse::<f64>() {
        Ok(inches) => {
            let mm = format!("{:.5}", inches * 25.4);
            mm.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        Err(_) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is converted to and fro says the same.
    #[test]
    fn formats_carry_all_fields() {
        let text = "T;NAME;L;R;CUT.;DOC\n1;\"MILL; LONG\";80,5;10;3;first\n2;;62;4;;say \"so\"\n";
        let read = TextTable::read(text).unwrap();
        let plain = PlainTable::new(TableForm::Tool, &read);
        assert_eq!(plain.names, ["T", "NAME", "L", "R", "CUT", "DOC"]);
        assert_eq!(plain.rows[0], ["1", "MILL; LONG", "80,5", "10", "3", "first"]);
        for written in [
            plain.separated('\t'),
            plain.separated(';'),
            plain.separated(','),
            plain.of_control("tool"),
        ] {
            let again = TextTable::read(&written).unwrap();
            assert_eq!(PlainTable::new(TableForm::Tool, &again), plain, "{written}");
        }
    }

    /// 1.5 inches are 38.1 mm; numbers without unit stay.
    #[test]
    fn inches_become_millimetres() {
        let text = "BEGIN TOOL .T INCH\nT  L     R     TIME1\n3  +1.5  +0.25 15\n[END]\n";
        let plain = PlainTable::new(TableForm::Tool, &TextTable::read(text).unwrap());
        assert_eq!(plain.rows, [["3", "38.1", "6.35", "15"]]);
        assert!(
            plain
                .of_control("tool")
                .starts_with("BEGIN TOOL .T MM\nT L    R    TIME1\n3 38.1 6.35 15\n")
        );
    }

    #[test]
    fn kinds_are_recognised() {
        let kind = |name: &str, text: &str| TableForm::of(Path::new(name), &TextTable::read(text).unwrap());
        assert_eq!(kind("TOOL.T", "A B\n"), Some(TableForm::Tool));
        assert_eq!(
            kind("x.txt", "BEGIN TOOL_P .TCH MM\nP T\n"),
            Some(TableForm::Pocket)
        );
        assert_eq!(kind("tools.tsv", "T L R P\n"), Some(TableForm::Tool));
        assert_eq!(kind("pockets.tsv", "P T ST\n"), Some(TableForm::Pocket));
        assert_eq!(kind("a.csv", "NR,PGM\n"), Some(TableForm::Pallet));
        assert_eq!(kind("a.csv", "NR,X\n"), Some(TableForm::Datum));
        assert_eq!(kind("a.PNT", "NR X Y Z\n"), Some(TableForm::Point));
        assert_eq!(kind("a.csv", "A,B\n"), None);
    }
}
