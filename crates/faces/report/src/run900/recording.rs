//! Parameters over time, as a table whose last column says what happened.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use bahn_control900::Control900;
use bahn_host::files::{self, NewFile};
use bahn_system900::{AxisParameter, Memory, Name};

use crate::ReportError;

/// A table being written: a row for each interpolation cycle, or less often.
pub struct Recording900 {
    path: PathBuf,
    file: NewFile,
    names: Vec<Name>,
    every_us: u64,
    due_us: u64,
    line: String,
    /// What happened since the last row.
    events: String,
}

/// What is recorded where nobody says what: nominal position and lag of each axis with a letter.
pub fn usual_parameters(memory: &Memory) -> Vec<Name> {
    let mut names = Vec::new();
    for channel in 1..=memory.channels() {
        for (_, physical) in memory.axes_of(channel) {
            for parameter in [AxisParameter::NominalPosition, AxisParameter::Lag] {
                let place = Memory::axis_place(physical, parameter);
                names.extend(place.map(|place| memory.name_of(place)));
            }
        }
    }
    names
}

impl Recording900 {
    /// Begins a table; `every_us` of 0 records every cycle.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn create(
        path: &Path,
        names: Vec<Name>,
        every_us: u64,
        memory: &Memory,
    ) -> Result<Recording900, ReportError> {
        let mut recording = Recording900 {
            path: path.to_owned(),
            file: NewFile::create(path)?,
            names,
            every_us,
            due_us: 0,
            line: "time [s]".to_owned(),
            events: String::new(),
        };
        for name in &recording.names {
            let written = match memory.unit(*name) {
                "" => write!(recording.line, ",{name}"),
                unit => write!(recording.line, ",{name} [{unit}]"),
            };
            written.unwrap_or_default();
        }
        recording.line.push_str(",event");
        recording.write_line()?;
        Ok(recording)
    }

    /// Something happened.
    pub fn event(&mut self, event: &str) {
        if !self.events.is_empty() {
            self.events.push_str("; ");
        }
        let plain = |c: char| if c.is_control() || c == ',' { ' ' } else { c };
        self.events.extend(event.chars().map(plain));
    }

    /// Takes a row when it is time; what is cleared is empty.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn cycle(&mut self, control: &Control900) -> Result<(), ReportError> {
        let now_us = control.now_us();
        if now_us < self.due_us {
            return Ok(());
        }
        self.due_us = now_us + self.every_us;
        self.line.clear();
        let _ = write!(self.line, "{:.6}", now_us as f64 * 1e-6);
        for name in &self.names {
            self.line.push(',');
            if let Ok(Some(value)) = control.number(*name) {
                let _ = write!(self.line, "{value}");
            }
        }
        self.line.push(',');
        self.line.push_str(&self.events);
        self.events.clear();
        self.write_line()
    }

    /// Completes the table.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(self) -> Result<(), ReportError> {
        Ok(self.file.finish()?)
    }

    fn write_line(&mut self) -> Result<(), ReportError> {
        self.line.push('\n');
        let written = self.file.write_all(self.line.as_bytes());
        written.map_err(|error| files::cannot("write", &self.path, &error).into())
    }
}
