//! The journal of the non-volatile markers and bytes in a file.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use bahn_exchange::{Exchange, Image, Retention, RetentionStorage};

use crate::{UsageError, files};

/// How the journal begins.
const MARK: &[u8] = b"BPR1";

/// What survives power-off, kept while a program runs.
pub(crate) struct Retained {
    path: PathBuf,
    retention: Retention<FileStorage>,
    started: Instant,
}

impl Retained {
    /// Opens or begins a journal.
    pub fn open(path: &Path) -> Result<Retained, UsageError> {
        let mut storage = FileStorage(path.to_owned());
        let content = storage
            .read()
            .map_err(|error| files::cannot("read", path, &error))?;
        // Power-off may leave a part of the mark or zeros; anything else is a file of somebody else.
        let begins_right = content.iter().zip(MARK).all(|(byte, mark)| byte == mark);
        if !begins_right && content.iter().any(|byte| *byte != 0) {
            return Err(UsageError::new(format!(
                "{} is no file of retained PLC memory",
                path.display()
            )));
        }
        Ok(Retained {
            path: path.to_owned(),
            retention: Retention::open(storage).map_err(|error| UsageError::new(error.to_string()))?,
            started: Instant::now(),
        })
    }

    /// Both images as at power-on.
    pub fn restore(&self) -> Exchange {
        let mut exchange = Exchange::default();
        self.retention.restore(&mut exchange);
        exchange
    }

    /// Writes what changed, at most every 200 ms.
    pub fn tick(&mut self, image: &Image) -> Result<(), UsageError> {
        let now = u64::try_from(self.started.elapsed().as_micros()).unwrap_or(u64::MAX);
        self.retention
            .tick(image, now)
            .map_err(|error| self.error(&error))
    }

    /// Writes what changed at once.
    pub fn flush(&mut self, image: &Image) -> Result<(), UsageError> {
        self.retention.flush(image).map_err(|error| self.error(&error))
    }

    fn error(&self, error: &impl std::fmt::Display) -> UsageError {
        UsageError::new(format!("{}: {error}", self.path.display()))
    }
}

struct FileStorage(PathBuf);

impl RetentionStorage for FileStorage {
    fn read(&mut self) -> io::Result<Vec<u8>> {
        match fs::read(&self.0) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            result => result,
        }
    }

    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        let is_new = !self.0.exists();
        let mut file = OpenOptions::new().append(true).create(true).open(&self.0)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        if is_new {
            files::sync_folder(&self.0);
        }
        Ok(())
    }

    fn replace(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut file =
            files::NewFile::create(&self.0).map_err(|error| io::Error::other(error.to_string()))?;
        file.write_all(bytes)?;
        file.finish().map_err(|error| io::Error::other(error.to_string()))
    }
}
