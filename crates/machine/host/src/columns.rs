//! Tables as text: a line with the names of the columns, and one line for each row.

use bahn_text::{Diagnostic, Span, without_mark};

/// What is wrong with a row, and in which of its columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RowFault {
    /// First character and number of characters; zeros for the row as a whole.
    columns: (u32, u32),
    message: String,
}

impl From<String> for RowFault {
    fn from(message: String) -> RowFault {
        RowFault {
            columns: (0, 0),
            message,
        }
    }
}

/// Faulty lines that are named; after them reading ends.
const FAULTS_MAX: usize = 100;

/// What a kind of table looks like.
pub(crate) struct Form {
    /// Columns without which it is no such table.
    pub needed: &'static [&'static str],
    /// The columns that it may have; `None` when others are passed over.
    pub known: Option<&'static [&'static str]>,
    /// The columns of an example.
    pub example: &'static str,
}

/// A row of a table.
pub(crate) struct Row<'t> {
    names: &'t [String],
    cells: &'t [Cell],
    /// Millimetres of a length of 1.
    pub unit_mm: f64,
}

/// A table as it is written, whatever it means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextTable {
    /// `BEGIN NAME .T MM` of a file of a control.
    pub frame: Option<String>,
    /// The names of the columns in capitals, as the file writes them.
    pub names: Vec<String>,
    /// The line of the names, from 1.
    pub header_line: u32,
    /// Its rows.
    pub rows: Vec<TextRow>,
    layout: Layout,
}

/// A row of a table as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextRow {
    /// Its line in the file, from 1.
    pub line: u32,
    /// Its fields; there may be fewer than columns.
    pub cells: Vec<Cell>,
}

/// A field of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// What stands there, without blanks around it.
    pub text: String,
    /// The character in its line where it begins, from 1.
    pub column: u32,
}

impl TextTable {
    /// Reads a table, whatever its columns are called.
    ///
    /// # Errors
    /// When it is empty.
    pub fn read(text: &str) -> Result<TextTable, Diagnostic> {
        let text = without_mark(text);
        let mut lines = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !is_comment(line))
            .peekable();
        let frame = lines.next_if(|(_, line)| first_word(line).eq_ignore_ascii_case("BEGIN"));
        let Some((header_line, header)) = lines.next() else {
            return Err(Diagnostic::error(Span::FILE, "the table is empty"));
        };
        let (names, layout) = layout(header, frame.is_some());
        let rows = lines
            .take_while(|(_, line)| {
                !matches!(first_word(line).to_ascii_uppercase().as_str(), "[END]" | "END")
            })
            .map(|(line, text)| TextRow {
                line,
                cells: layout.cells(text, names.len()),
            });
        let rows = rows.collect();
        Ok(TextTable {
            frame: frame.map(|(_, line)| line.trim().to_owned()),
            names,
            header_line,
            rows,
            layout,
        })
    }

    /// Its lengths are in inches.
    pub fn in_inches(&self) -> bool {
        let frame = self.frame.as_deref().unwrap_or_default();
        // After BEGIN and the name, which may be INCH.
        let mut words = frame.split_whitespace().skip(2);
        words.any(|word| word.trim_matches(['[', ']']).eq_ignore_ascii_case("INCH"))
    }

    /// The character between its columns, when there is one.
    pub(crate) fn separator(&self) -> Option<char> {
        match self.layout {
            Layout::Separated(separator) => Some(separator),
            Layout::Blanks | Layout::Fixed(_) => None,
        }
    }

    /// The place of a column by any of its names.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|column| canonical(column) == name)
    }

    /// The field of a row.
    pub fn cell<'t>(&self, row: &'t TextRow, name: &str) -> Option<&'t Cell> {
        row.cells.get(self.place(name)?)
    }

    /// A line of the text with another value in a column.
    ///
    /// # Errors
    /// When the table does not have the column, or the value cannot stand there.
    pub(crate) fn line_with(&self, line: &str, name: &str, value: &str) -> Result<String, String> {
        let place = self
            .place(name)
            .ok_or_else(|| format!("the table has no column {name}; `bahn table convert` can add it"))?;
        self.layout.with(line, self.names.len(), place, value)
    }

    /// A new line for the table, with these values by the names of their columns.
    ///
    /// # Errors
    /// As [`TextTable::line_with`].
    pub(crate) fn new_line(&self, values: &[(&str, &str)]) -> Result<String, String> {
        let mut line = self.layout.blank(self.names.len());
        for (name, value) in values {
            line = self.line_with(&line, name, value)?;
        }
        Ok(line.trim_end_matches(' ').to_owned())
    }
}

/// Reads the rows of a table one after the other. All faults are named, up to [`FAULTS_MAX`].
pub(crate) fn read(
    text: &str,
    form: &Form,
    mut take: impl FnMut(&Row<'_>) -> Result<(), RowFault>,
) -> Result<(), Vec<Diagnostic>> {
    let table = TextTable::read(text).map_err(|fault| vec![fault])?;
    let unit_mm = if table.in_inches() { 25.4 } else { 1.0 };
    form.fits(&table)
        .map_err(|message| vec![Diagnostic::error(Span::FILE, message)])?;
    let names: Vec<String> = table
        .names
        .iter()
        .map(|name| canonical(name).to_owned())
        .collect();
    let mut faults = Vec::new();
    for row in &table.rows {
        if faults.len() == FAULTS_MAX {
            let message = "too many faults: what follows is not read";
            faults.push(Diagnostic::error(Span::line(row.line as usize), message));
            break;
        }
        let read = Row {
            names: &names,
            cells: &row.cells,
            unit_mm,
        };
        if let Err(RowFault { columns, message }) = take(&read) {
            let (line, (column, length)) = (row.line, columns);
            faults.push(Diagnostic::error(Span { line, column, length }, message));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

impl Form {
    fn fits(&self, table: &TextTable) -> Result<(), String> {
        for needed in self.needed {
            if table.place(needed).is_none() {
                return Err(format!(
                    "the first line must name the columns {}; there is no column {needed}",
                    self.example
                ));
            }
        }
        let Some(known) = self.known else { return Ok(()) };
        let unknown = |name: &&String| !name.is_empty() && !known.contains(&canonical(name));
        match table.names.iter().find(unknown) {
            Some(name) => Err(format!(
                "there is no column `{name}` here; there are {}",
                known.join(" ")
            )),
            None => Ok(()),
        }
    }
}

/// The name of a column by the one that a control gives it. Later controls write `CUR_TIME`, `TT:L-OFFS`, `CUT.`.
pub fn canonical(name: &str) -> &str {
    match name {
        "CUT." => "CUT",
        "DIRECT." | "DIR." => "DIRECT",
        "CUR_TIME" => "CUR.TIME",
        "TT:L-OFFS" | "L_OFFS" => "L-OFFS",
        "TT:R-OFFS" | "R_OFFS" => "R-OFFS",
        "T_ANGLE" => "T-ANGLE",
        other => other,
    }
}

fn is_comment(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with([';', '#', '*'])
}

fn first_word(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or_default()
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Layout {
    /// A character stands between the columns.
    Separated(char),
    /// Blanks stand between the columns; the last one may contain blanks.
    Blanks,
    /// Columns begin under their names, counted in characters: a file of a control.
    Fixed(Vec<usize>),
}

/// Names and places of the columns.
fn layout(header: &str, fixed: bool) -> (Vec<String>, Layout) {
    let separator = ['\t', ';', ',']
        .into_iter()
        .find(|separator| header.contains(*separator));
    let (names, layout): (Vec<&str>, Layout) = match separator {
        Some(separator) => (header.split(separator).collect(), Layout::Separated(separator)),
        None if fixed => (
            header.split_whitespace().collect(),
            Layout::Fixed(column_starts(header)),
        ),
        None => (header.split_whitespace().collect(), Layout::Blanks),
    };
    let names = names.into_iter().map(|name| name.trim().to_ascii_uppercase());
    (names.collect(), layout)
}

/// The pieces of a line between characters, trimmed, with the places where they begin.
fn pieces(characters: &[char], bounds: impl Iterator<Item = (usize, usize)>) -> Vec<Cell> {
    let cell = |(start, end): (usize, usize)| {
        let end = end.min(characters.len());
        let piece = characters.get(start..end).unwrap_or_default();
        let blanks = piece.iter().take_while(|c| c.is_whitespace()).count();
        let skipped = if blanks == piece.len() { 0 } else { blanks };
        Cell {
            text: piece.iter().collect::<String>().trim().to_owned(),
            column: u32::try_from(start + skipped + 1).unwrap_or(u32::MAX),
        }
    };
    bounds.map(cell).collect()
}

impl Layout {
    /// Where the fields of a line are, from and to.
    fn bounds(&self, characters: &[char], columns: usize) -> Vec<(usize, usize)> {
        match self {
            Layout::Separated(separator) => {
                let mut ends = Vec::new();
                let (mut quoted, mut begins) = (false, true);
                for (at, character) in characters.iter().enumerate() {
                    // Quotes keep a separator within a field, as other programs write it.
                    quoted ^= *character == '"' && *separator != '\t' && (begins || quoted);
                    begins = character == separator;
                    if begins && !quoted {
                        ends.push(at);
                    }
                }
                ends.push(characters.len());
                let starts = [0].into_iter().chain(ends.iter().map(|end| end + 1));
                starts.zip(ends.iter().copied()).collect()
            }
            Layout::Blanks => {
                let text: String = characters.iter().collect();
                let starts = column_starts(&text);
                let kept = starts.len().min(columns);
                let ends = starts.iter().skip(1).take(kept.saturating_sub(1)).copied();
                let ends: Vec<usize> = ends.chain([characters.len()]).collect();
                starts.into_iter().zip(ends).collect()
            }
            Layout::Fixed(starts) => {
                let ends = starts.iter().skip(1).copied().chain([usize::MAX]);
                starts.iter().copied().zip(ends).collect()
            }
        }
    }

    fn cells(&self, line: &str, columns: usize) -> Vec<Cell> {
        let characters: Vec<char> = line.chars().collect();
        let mut cells = pieces(&characters, self.bounds(&characters, columns).into_iter());
        if matches!(self, Layout::Separated(separator) if *separator != '\t') {
            for cell in &mut cells {
                let inner = cell
                    .text
                    .strip_prefix('"')
                    .and_then(|text| text.strip_suffix('"'));
                if let Some(inner) = inner {
                    cell.text = inner.replace("\"\"", "\"");
                }
            }
        }
        cells
    }

    /// A line with another value in a column; the others stay where they are.
    fn with(&self, line: &str, columns: usize, place: usize, value: &str) -> Result<String, String> {
        let forbidden = match self {
            Layout::Separated(_) => false,
            Layout::Blanks => value.contains(char::is_whitespace) && place + 1 < columns,
            Layout::Fixed(_) => false,
        };
        if forbidden || value.contains(['\n', '\r', '\t']) {
            return Err(format!("`{value}` cannot stand in a column of this table"));
        }
        if let Layout::Fixed(starts) = self {
            return with_fixed(line, starts, place, value);
        }
        let mut cells: Vec<String> = self
            .cells(line, columns)
            .into_iter()
            .map(|cell| cell.text)
            .collect();
        cells.resize(columns.max(cells.len()), String::new());
        if let Some(cell) = cells.get_mut(place) {
            value.clone_into(cell);
        }
        Ok(match self {
            Layout::Separated(separator) => {
                let cells: Vec<String> = cells.iter().map(|cell| quoted(cell, *separator)).collect();
                cells.join(&separator.to_string())
            }
            _ => {
                let cells = cells
                    .into_iter()
                    .map(|cell| if cell.is_empty() { "-".to_owned() } else { cell });
                cells.collect::<Vec<_>>().join(" ")
            }
        })
    }

    /// A line without any value.
    fn blank(&self, columns: usize) -> String {
        match self {
            Layout::Separated(separator) => separator.to_string().repeat(columns.saturating_sub(1)),
            Layout::Blanks | Layout::Fixed(_) => String::new(),
        }
    }
}

/// A line whose columns begin under their names. A value must leave a blank before the next column.
fn with_fixed(line: &str, starts: &[usize], place: usize, value: &str) -> Result<String, String> {
    let start = starts.get(place).copied().unwrap_or_default();
    let width = starts.get(place + 1).map(|next| next - start - 1);
    let length = value.chars().count();
    if width.is_some_and(|width| length > width) {
        return Err(format!("`{value}` is longer than its column"));
    }
    let mut characters: Vec<char> = line.chars().collect();
    let end = width.map_or(start + length, |width| start + width);
    characters.resize(characters.len().max(end), ' ');
    if width.is_none() {
        characters.truncate(end);
    }
    for (at, slot) in characters.iter_mut().enumerate().skip(start).take(end - start) {
        *slot = value.chars().nth(at - start).unwrap_or(' ');
    }
    Ok(characters.into_iter().collect::<String>().trim_end().to_owned())
}

impl Row<'_> {
    fn cell(&self, name: &str) -> Option<&Cell> {
        let at = self.names.iter().position(|column| column == name);
        self.cells.get(at?)
    }

    /// The text of a column; empty when the table does not have it.
    pub fn text(&self, name: &str) -> &str {
        self.cell(name).map_or("", |cell| cell.text.as_str())
    }

    /// What is wrong with a column.
    pub fn fault(&self, name: &str, what: &str) -> RowFault {
        RowFault {
            columns: self.cell(name).map_or((0, 0), |cell| {
                let length = u32::try_from(cell.text.chars().count()).unwrap_or(u32::MAX);
                (cell.column, length.max(1))
            }),
            message: format!("{name}: {what}"),
        }
    }

    /// A number as it is written; a column that is missing, empty or `-` is 0. A decimal comma is a point.
    pub fn number(&self, name: &str) -> Result<f64, RowFault> {
        const GREATEST: f64 = 100_000.0;
        let text = self.text(name);
        if text.is_empty() || text == "-" {
            return Ok(0.0);
        }
        let value = text
            .replace(',', ".")
            .parse::<f64>()
            .map_err(|_| self.fault(name, &format!("`{text}` is no number")))?;
        if !(-GREATEST..=GREATEST).contains(&value) {
            return Err(self.fault(name, &format!("{text} is too large")));
        }
        Ok(value)
    }

    /// A number that is not negative and not greater than another one.
    pub fn up_to(&self, name: &str, most: f64) -> Result<f64, RowFault> {
        match self.number(name)? {
            value if (0.0..=most).contains(&value) => Ok(value),
            _ => Err(self.fault(name, &format!("{} is not from 0 to {most}", self.text(name)))),
        }
    }

    /// A mark: empty, `-`, 0 or N is none; the letter of the column, 1, Y and J set it.
    pub fn mark(&self, name: &str) -> Result<bool, RowFault> {
        match self.text(name).to_ascii_uppercase().as_str() {
            "" | "-" | "0" | "N" => Ok(false),
            "1" | "Y" | "J" | "+" => Ok(true),
            text if name.starts_with(text) => Ok(true),
            text => {
                let letter = name.get(..1).unwrap_or_default();
                Err(self.fault(name, &format!("`{text}` is neither empty nor {letter}")))
            }
        }
    }

    /// Eight bits for the PLC: `%10110111`, or the number [000:9063].
    pub fn byte(&self, name: &str) -> Result<u8, RowFault> {
        let text = self.text(name);
        let value = match text.strip_prefix('%') {
            Some(bits) => u8::from_str_radix(bits, 2).ok().filter(|_| bits.len() <= 8),
            None if matches!(text, "" | "-") => Some(0),
            None => text.parse().ok(),
        };
        value.ok_or_else(|| self.fault(name, &format!("`{text}` is no byte from %00000000 to %11111111")))
    }
}

/// A field that holds the separator stands in quotes.
pub(crate) fn quoted(field: &str, separator: char) -> String {
    if separator != '\t' && (field.contains(separator) || field.starts_with('"')) {
        return format!("\"{}\"", field.replace('"', "\"\""));
    }
    field.to_owned()
}

/// Character positions where the words of a line begin.
fn column_starts(line: &str) -> Vec<usize> {
    let mut before = ' ';
    let mut starts = Vec::new();
    for (at, character) in line.chars().enumerate() {
        if before.is_whitespace() && !character.is_whitespace() {
            starts.push(at);
        }
        before = character;
    }
    starts
}
