//! What was done to control and machine, in the form of a script.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::UsageError;
use crate::files::{self, NewFile};

pub(super) struct Log {
    path: PathBuf,
    file: NewFile,
}

impl Log {
    pub fn create(path: &Path, title: &str) -> Result<Log, UsageError> {
        let mut log = Log {
            path: path.to_owned(),
            file: NewFile::create(path)?,
        };
        let title: String = title.chars().filter(|c| !c.is_control()).collect();
        log.write(&format!("; {title}; bahn run --replay repeats it"))?;
        Ok(log)
    }

    /// Notes what was done before the cycle of this time.
    pub fn note(&mut self, time_us: u64, what: &str) -> Result<(), UsageError> {
        self.write(&format!(
            "{}.{:06}: {what}",
            time_us / 1_000_000,
            time_us % 1_000_000
        ))
    }

    pub fn finish(self) -> Result<(), UsageError> {
        self.file.finish()
    }

    fn write(&mut self, line: &str) -> Result<(), UsageError> {
        writeln!(self.file, "{line}").map_err(|error| files::cannot("write", &self.path, &error))
    }
}
