//! A PLC program as formatted listing: line numbers, commands and comments in columns, errors and warnings below their lines.

use std::collections::BTreeMap;

use bahn_plc::{Compilation, Fault, Nesting, listed_code, nesting, split_comment};

use bahn_text::printable;

/// A file of a program.
#[derive(Debug, serde::Serialize)]
pub struct Listing<'a> {
    file: &'a str,
    lines: Vec<Line<'a>>,
}

#[derive(Debug, serde::Serialize)]
struct Line<'a> {
    line: usize,
    command: &'a str,
    operand: &'a str,
    comment: &'a str,
    /// How many structures and tables it stands in.
    depth: usize,
    errors: Vec<Entry>,
    warnings: Vec<Entry>,
}

impl<'a> Listing<'a> {
    /// Those of all files of a program.
    pub fn of(compilation: &'a Compilation) -> Vec<Listing<'a>> {
        let files = compilation.files.iter();
        files
            .map(|file| Listing::new(&file.name, &file.lines, compilation))
            .collect()
    }

    fn new(name: &'a str, lines: &'a [String], compilation: &Compilation) -> Listing<'a> {
        let of_file = |faults: &[Fault]| {
            let mut by_line: BTreeMap<usize, Vec<Entry>> = BTreeMap::new();
            for fault in faults.iter().filter(|fault| fault.file == name) {
                by_line
                    .entry(fault.span.line as usize)
                    .or_default()
                    .push(Entry::new(fault));
            }
            by_line
        };
        let mut errors = of_file(&compilation.errors);
        let mut warnings = of_file(&compilation.warnings);
        let mut depth = 0_usize;
        let mut line = |(index, line): (usize, &'a String)| {
            let (code, comment) = split_comment(line);
            let (command, operand) = split_command(code);
            let nesting = nesting(command);
            let outside = matches!(nesting, Nesting::Closes | Nesting::Both);
            let own_depth = depth.saturating_sub(outside.into());
            match nesting {
                Nesting::Closes => depth = depth.saturating_sub(1),
                Nesting::Opens => depth += 1,
                Nesting::Both | Nesting::Neither => {}
            }
            let line = index + 1;
            Line {
                line,
                command,
                operand,
                comment: comment.trim(),
                depth: own_depth,
                errors: errors.remove(&line).unwrap_or_default(),
                warnings: warnings.remove(&line).unwrap_or_default(),
            }
        };
        Listing {
            file: name,
            lines: lines.iter().enumerate().map(&mut line).collect(),
        }
    }

    /// The list as lines for people.
    pub fn text(&self) -> String {
        let lines: String = self.lines.iter().map(Line::text).collect();
        format!("{}\n{lines}", self.file)
    }
}

impl Line<'_> {
    fn text(&self) -> String {
        let (command, operand) = (self.command, self.operand);
        let code = listed_code(command, operand, self.depth);
        let row = if command.is_empty() {
            format!("{:>5}  {}", self.line, self.comment)
        } else {
            format!("{:>5}  {:<30} {}", self.line, code, self.comment)
        };
        let mut text = printable(row.trim_end()) + "\n";
        for (what, entries) in [("error", &self.errors), ("warning", &self.warnings)] {
            for entry in entries {
                text += &printable(&format!("       ^^^ {what} {} {}", entry.number, entry.message));
                text.push('\n');
            }
        }
        text
    }
}

/// The command and the operand of a line.
fn split_command(code: &str) -> (&str, &str) {
    let code = code.trim();
    let (command, operand) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
    (command, operand.trim())
}

/// An error or a warning.
#[derive(Debug, serde::Serialize)]
pub struct Entry {
    number: u8,
    file: String,
    line: u32,
    column: u32,
    message: String,
}

impl Entry {
    /// That of the compiler.
    pub fn new(fault: &Fault) -> Entry {
        Entry {
            number: fault.error.number(),
            file: fault.file.clone(),
            line: fault.span.line,
            column: fault.span.column,
            message: fault.message(),
        }
    }
}
