//! Tables are changed in their text: comments, order and other columns stay as they are.

use crate::columns::{TextRow, TextTable};
use crate::table_kind::{PlainTable, TableForm};

/// What became of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineChange {
    /// The line was in the table.
    Changed,
    /// The line was appended.
    Added,
}

/// The text of a table with other values in a line, by the names of their columns. A line that is not there comes behind
/// the others.
///
/// ```
/// use bahn_host::{LineChange, TableForm, set_line};
/// let text = "; of the mill\nT L R\n1 80 5 ; long\n";
/// let (changed, what) = set_line(text, TableForm::Tool, "1", &[("R", "5.5")])?;
/// assert_eq!((changed.lines().next(), what), (Some("; of the mill"), LineChange::Changed));
/// assert!(changed.contains("1 80 5.5"));
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// When the table cannot be read, does not have a column, or a value cannot stand there.
pub fn set_line(
    text: &str,
    kind: TableForm,
    line: &str,
    values: &[(&str, &str)],
) -> Result<(String, LineChange), String> {
    let table = TextTable::read(text).map_err(|fault| fault.to_string())?;
    let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    let Some(at) = place(&table, kind, line) else {
        let end = line_end(text);
        let key = [(kind.key(), line)].into_iter();
        let all: Vec<(&str, &str)> = key.chain(values.iter().copied()).collect();
        let line = table.new_line(&all)? + end;
        let after = table.rows.last().map_or(table.header_line, |row| row.line) as usize;
        if let Some(last) = lines.get_mut(after - 1).filter(|last| !last.ends_with('\n')) {
            last.push_str(end);
        }
        lines.insert(after, line);
        return Ok((lines.concat(), LineChange::Added));
    };
    if let Some(line) = lines.get_mut(at) {
        let mut text = line.trim_end_matches(['\r', '\n']).to_owned();
        let tail = line.get(text.len()..).unwrap_or_default().to_owned();
        for (name, value) in values {
            text = table.line_with(&text, name, value)?;
        }
        *line = text + &tail;
    }
    Ok((lines.concat(), LineChange::Changed))
}

/// The text of a table without a line.
///
/// # Errors
/// When the table cannot be read, or there is no such line.
pub fn delete_line(text: &str, kind: TableForm, line: &str) -> Result<String, String> {
    let table = TextTable::read(text).map_err(|fault| fault.to_string())?;
    let at = place(&table, kind, line).ok_or_else(|| format!("there is no line {line}"))?;
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    lines.remove(at);
    Ok(lines.concat())
}

/// The text of a table that has a column, when it did not. Where tabs, commas or semicolons stand between columns it comes
/// after the others; any other table is written anew, with tabs and in millimetres.
///
/// # Errors
/// When the table cannot be read.
pub fn with_column(text: &str, kind: TableForm, name: &str) -> Result<String, String> {
    let table = TextTable::read(text).map_err(|fault| fault.to_string())?;
    if table.place(name).is_some() {
        return Ok(text.to_owned());
    }
    if let Some(separator) = table.separator() {
        let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
        let header = (table.header_line as usize).checked_sub(1);
        if let Some(line) = header.and_then(|at| lines.get_mut(at)) {
            let names = line.trim_end_matches(['\r', '\n']).len();
            line.insert_str(names, &format!("{separator}{name}"));
        }
        return Ok(lines.concat());
    }
    let mut plain = PlainTable::new(kind, &table);
    let names: Vec<String> = plain.names.iter().cloned().chain([name.to_owned()]).collect();
    plain.choose(&names);
    Ok(plain.separated('\t'))
}

/// Where a line of the table stands among those of the text, from 0.
fn place(table: &TextTable, kind: TableForm, line: &str) -> Option<usize> {
    let is_wanted = |row: &&TextRow| table.cell(row, kind.key()).is_some_and(|cell| cell.text == line);
    table.rows.iter().find(is_wanted).map(|row| row.line as usize - 1)
}

fn line_end(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests fail by panic")]

    use super::*;

    #[test]
    fn a_column_is_added_once() {
        for (text, expected) in [
            ("T\tL\tR\n; own\n1\t80\t5\n", "T\tL\tR\tNAME\n; own\n1\t80\t5\n"),
            ("T;L;R\r\n1;80;5\r\n", "T;L;R;NAME\r\n1;80;5\r\n"),
            ("T L R\n1 80 5\n", "T\tL\tR\tNAME\n1\t80\t5\t\n"),
        ] {
            let added = with_column(text, TableForm::Tool, "NAME").unwrap();
            assert_eq!(added, expected);
            assert_eq!(with_column(&added, TableForm::Tool, "NAME").unwrap(), added);
            assert_eq!(TableForm::Tool.check(&added), Ok(()));
            let (set, change) = set_line(&added, TableForm::Tool, "1", &[("NAME", "END MILL")]).unwrap();
            assert_eq!(change, LineChange::Changed);
            let table = TextTable::read(&set).unwrap();
            let row = &table.rows[0];
            assert_eq!(table.cell(row, "NAME").unwrap().text, "END MILL");
            assert_eq!(
                delete_line(&set, TableForm::Tool, "1")
                    .unwrap()
                    .matches("80")
                    .count(),
                0
            );
        }
    }
}
