//! Operands after every cycle, as a table.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::bench::Bench;
use crate::ReportError;
use bahn_host::files::{self, NewFile};
use bahn_host::{Content, Operand};

/// A table being written.
pub struct Record {
    path: PathBuf,
    file: NewFile,
    operands: Vec<Operand>,
}

impl Record {
    /// Begins a table of operands.
    ///
    /// # Errors
    /// When the file cannot be created.
    pub fn create(path: &Path, operands: Vec<Operand>) -> Result<Record, ReportError> {
        let mut record = Record {
            path: path.to_owned(),
            file: NewFile::create(path)?,
            operands,
        };
        let names = record.operands.iter().map(Operand::to_string).collect();
        record.row("cycle", names)?;
        Ok(record)
    }

    /// Writes the row of a cycle.
    pub fn cycle(&mut self, bench: &Bench) -> Result<(), ReportError> {
        let values = self.operands.iter().map(|operand| match bench.read(*operand) {
            Content::Number(value) => value.to_string(),
            Content::Text(text) => format!("\"{}\"", text.replace('"', "\"\"")),
        });
        let values = values.collect();
        self.row(&bench.cycle.to_string(), values)
    }

    /// The table is whole.
    ///
    /// # Errors
    /// When it could not be written.
    pub fn finish(self) -> Result<(), ReportError> {
        Ok(self.file.finish()?)
    }

    fn row(&mut self, first: &str, values: Vec<String>) -> Result<(), ReportError> {
        let separator = if values.is_empty() { "" } else { "," };
        writeln!(self.file, "{first}{separator}{}", values.join(","))
            .map_err(|error| files::cannot("write", &self.path, &error).into())
    }
}
