//! Tables as text: a line with the names of the columns, and one line for each row.

use std::fmt;

/// What is wrong in a line of a table, from 1; 0 is the table as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableFault {
    /// The line.
    pub line: u32,
    /// What is wrong, in words.
    pub message: String,
}

impl fmt::Display for TableFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => f.write_str(&self.message),
            line => write!(f, "line {line}: {}", self.message),
        }
    }
}

/// Faulty lines that are named; behind them reading ends.
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
    columns: &'t Columns,
    fields: Vec<String>,
    /// Millimetres of a length of 1.
    pub unit_mm: f64,
}

/// Reads the rows of a table one after the other. All faults are named, up to [`FAULTS_MAX`].
pub(crate) fn read(
    text: &str,
    form: &Form,
    mut take: impl FnMut(&Row<'_>) -> Result<(), String>,
) -> Result<(), Vec<TableFault>> {
    let whole = |message: String| vec![TableFault { line: 0, message }];
    let text = text.trim_start_matches('\u{feff}');
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !is_comment(line))
        .peekable();
    let frame = lines.next_if(|(_, line)| first_word(line).eq_ignore_ascii_case("BEGIN"));
    let unit_mm = match frame {
        Some((_, line)) if line.to_ascii_uppercase().contains("INCH") => 25.4,
        _ => 1.0,
    };
    let Some((_, header)) = lines.next() else {
        return Err(whole("the table is empty".into()));
    };
    let columns = Columns::new(header, frame.is_some(), form).map_err(whole)?;
    let mut faults = Vec::new();
    for (number, line) in lines {
        if faults.len() == FAULTS_MAX {
            faults.push(TableFault {
                line: number,
                message: "too many faults: what follows is not read".to_owned(),
            });
            break;
        }
        if matches!(first_word(line).to_ascii_uppercase().as_str(), "[END]" | "END") {
            break;
        }
        let row = Row {
            columns: &columns,
            fields: columns.fields(line),
            unit_mm,
        };
        if let Err(message) = take(&row) {
            faults.push(TableFault {
                line: number,
                message,
            });
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

fn is_comment(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with([';', '#', '*'])
}

fn first_word(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or_default()
}

/// Where the columns are.
struct Columns {
    names: Vec<String>,
    layout: Layout,
}

enum Layout {
    /// A character stands between the columns.
    Separated(char),
    /// Blanks stand between the columns; the last one may contain blanks.
    Blanks,
    /// Columns begin under their names, counted in characters: a file of a control.
    Fixed(Vec<usize>),
}

impl Columns {
    fn new(header: &str, fixed: bool, form: &Form) -> Result<Columns, String> {
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
        let names: Vec<String> = names
            .into_iter()
            .map(|name| name.trim().to_ascii_uppercase())
            .collect();
        for needed in form.needed {
            if !names.iter().any(|name| name == needed) {
                return Err(format!(
                    "the first line must name the columns {}; there is no column {needed}",
                    form.example
                ));
            }
        }
        if let Some(known) = form.known
            && let Some(name) = names
                .iter()
                .find(|name| !name.is_empty() && !known.contains(&name.as_str()))
        {
            return Err(format!(
                "there is no column `{name}` here; there are {}",
                known.join(" ")
            ));
        }
        Ok(Columns { names, layout })
    }

    fn fields(&self, line: &str) -> Vec<String> {
        match &self.layout {
            Layout::Separated(separator) => line
                .split(*separator)
                .map(|field| field.trim().to_owned())
                .collect(),
            Layout::Blanks => {
                let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
                if words.len() > self.names.len() {
                    let rest = words.split_off(self.names.len().saturating_sub(1));
                    words.push(rest.join(" "));
                }
                words
            }
            Layout::Fixed(starts) => {
                let characters: Vec<char> = line.chars().collect();
                let ends = starts.iter().skip(1).copied().chain([usize::MAX]);
                let cut = |(start, end): (&usize, usize)| {
                    let end = end.min(characters.len());
                    characters
                        .get(*start..end)
                        .unwrap_or_default()
                        .iter()
                        .collect::<String>()
                        .trim()
                        .to_owned()
                };
                starts.iter().zip(ends).map(cut).collect()
            }
        }
    }
}

impl Row<'_> {
    /// The text of a column; empty when the table does not have it.
    pub fn text(&self, name: &str) -> &str {
        let at = self.columns.names.iter().position(|column| column == name);
        at.and_then(|at| self.fields.get(at)).map_or("", String::as_str)
    }

    /// A number as it is written; a column that is missing, empty or `-` is 0. A decimal comma is a point.
    pub fn number(&self, name: &str) -> Result<f64, String> {
        const GREATEST: f64 = 100_000.0;
        let text = self.text(name);
        if text.is_empty() || text == "-" {
            return Ok(0.0);
        }
        let value = text
            .replace(',', ".")
            .parse::<f64>()
            .map_err(|_| format!("{name}: `{text}` is no number"))?;
        if !(-GREATEST..=GREATEST).contains(&value) {
            return Err(format!("{name}: {text} is too large"));
        }
        Ok(value)
    }
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
