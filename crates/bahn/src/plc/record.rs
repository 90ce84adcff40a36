//! Operands after every cycle, as a table.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::bench::Bench;
use crate::UsageError;
use crate::files::{self, NewFile};
use bahn_host::{Content, Operand};

/// A table being written.
pub(super) struct Record {
    path: PathBuf,
    file: NewFile,
    operands: Vec<Operand>,
}

impl Record {
    pub fn create(path: &Path, operands: Vec<Operand>) -> Result<Record, UsageError> {
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
    pub fn cycle(&mut self, bench: &Bench) -> Result<(), UsageError> {
        let values = self.operands.iter().map(|operand| match bench.read(*operand) {
            Content::Number(value) => value.to_string(),
            Content::Text(text) => format!("\"{}\"", text.replace('"', "\"\"")),
        });
        let values = values.collect();
        self.row(&bench.cycle.to_string(), values)
    }

    pub fn finish(self) -> Result<(), UsageError> {
        Ok(self.file.finish()?)
    }

    fn row(&mut self, first: &str, values: Vec<String>) -> Result<(), UsageError> {
        let separator = if values.is_empty() { "" } else { "," };
        writeln!(self.file, "{first}{separator}{}", values.join(","))
            .map_err(|error| files::cannot("write", &self.path, &error).into())
    }
}
