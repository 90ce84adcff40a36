//! Changes of a data file: its lines, their order and its comments stay.
//!
//! Decision: A value that changes is written in the line that counts; a parameter that has none gets a line at the end.
//! A status that stands in the line is written as it is then. What makes the file wrong that was not wrong before is
//! refused, and so are all changes that come with it

use bahn_text::Severity;

use crate::check::check;
use crate::file::DataFile;
use crate::name::Name;
use crate::numbers::{ACTIVATE, FUNCTION};
use crate::status::Status;
use crate::value::Value;

/// What a parameter becomes.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Which.
    pub name: Name,
    /// Its new value, as somebody writes it; `None` leaves the value.
    pub value: Option<String>,
    /// Its new status; `None` leaves it.
    pub status: Option<Status>,
}

impl DataFile {
    /// The file with changes.
    ///
    /// # Errors
    /// Why one is refused.
    pub fn changed(&self, changes: &[Change]) -> Result<DataFile, String> {
        let mut file = self.clone();
        for change in changes {
            file = file.with(change)?;
        }
        let before: Vec<String> = check(self).errors().map(|fault| fault.words()).collect();
        let found = check(&file);
        let mut new = found.errors().filter(|fault| !before.contains(&fault.words()));
        match new.next() {
            Some(fault) => Err(format!(
                "line {} of the changed file: {}",
                fault.span.line,
                fault.words()
            )),
            None => Ok(file),
        }
    }

    fn with(&self, change: &Change) -> Result<DataFile, String> {
        let Change { name, .. } = *change;
        let mut memory = self.memory().clone();
        let said = |error: crate::memory::SpaceError| error.to_string();
        let place = memory.place(name).map_err(said)?;
        if let Some(status) = change.status {
            memory.set_status(name, status).map_err(said)?;
        }
        if let Some(value) = &change.value {
            let value: Value = value.parse().map_err(|error| format!("{name}: {error}"))?;
            memory.write(name, value).map_err(said)?;
        }
        let cell = memory.at(place);
        let entry = self.entry(place);
        let is_shown = change.status.is_some() || entry.is_some_and(|entry| entry.status.is_some());
        // Without a status the value stands as it was written: nothing else says that it is hexadecimal.
        let value = match (&change.value, is_shown) {
            (Some(value), false) => value.trim().to_ascii_uppercase(),
            _ => cell.written(),
        };
        let status = is_shown.then(|| format!(" {}", cell.status()));
        let content = value + &status.unwrap_or_default();
        let mut text = self.text().to_owned();
        match entry {
            Some(entry) => {
                let end = entry.status.as_ref().unwrap_or(&entry.value).end;
                text.replace_range(entry.value.start..end, &content);
            }
            None => {
                if !text.is_empty() && !text.ends_with('\n') {
                    text.push('\n');
                }
                if name
                    .of_channel()
                    .is_some_and(|(channel, _)| channel > self.active())
                {
                    text += &format!("q{FUNCTION}: {ACTIVATE}\n");
                }
                text += &format!("{name}: {content}\n");
            }
        }
        let file = DataFile::read(&self.encoding().write(&text));
        match file
            .faults()
            .iter()
            .find(|fault| fault.severity == Severity::Error)
        {
            Some(fault) if self.is_readable() => Err(fault.to_string()),
            _ => Ok(file),
        }
    }
}
