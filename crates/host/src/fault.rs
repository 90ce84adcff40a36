//! Faults of files at their places.

use std::path::PathBuf;

use bahn_program::{Operation, Program};

/// Something to be said about a place in a file.
#[derive(Clone, Debug)]
pub struct FileFault {
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, as the title of the report.
    pub title: String,
    /// The file in which it is.
    pub path: PathBuf,
    /// Line and characters of the file that are meant.
    pub marked: Marked,
    /// What exactly is wrong; may be empty.
    pub label: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Where that was opened which is meant, in the same file.
    pub opened: Option<Marked>,
}

impl FileFault {
    /// Line and fault, in words.
    pub fn at_line(&self) -> String {
        format!("line {}: {}", self.marked.line, self.label)
    }
}

/// How bad a fault is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// It keeps the file from being used.
    Error,
    /// It is accepted, but looks wrong.
    Warning,
}

/// A line of a file with the characters that are meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Marked {
    /// Line in the file, from 1.
    pub line: u32,
    /// What stands in the line.
    pub text: String,
    /// First character, from 1, and number of characters; `None` for the whole line.
    pub columns: Option<(u32, u32)>,
}

impl Marked {
    /// The line of a block, and what of it cannot be read if that is so.
    pub fn of_block(program: &Program, block: u32) -> Marked {
        let chunk = program.decode(block / Program::CHUNK_SIZE);
        let (line, columns) = match chunk
            .blocks
            .get((block % Program::CHUNK_SIZE) as usize)
            .map(|b| &b.operation)
        {
            Some(Operation::Invalid(invalid)) => (
                invalid.error.line,
                Some((invalid.error.column, invalid.error.length)),
            ),
            _ => (0, None),
        };
        let line = program.line_of(block) + line;
        Marked {
            line,
            text: program.text_of_line(line),
            columns,
        }
    }
}
