//! The journal of the non-volatile markers and bytes in a file.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use bahn_exchange::{Exchange, Image, JOURNAL_LENGTH, Retention, RetentionError, RetentionStorage};

use crate::{HostError, files, kept};

/// What survives power-off, kept while a program runs. No other process may have it meanwhile.
pub struct Retained {
    path: PathBuf,
    damage: Option<String>,
    retention: Retention<FileStorage>,
    started: Instant,
}

impl Retained {
    /// Opens or begins a journal.
    ///
    /// # Errors
    /// When another process has it, or it cannot be read or written, or is something else.
    pub fn open(path: &Path) -> Result<Retained, HostError> {
        let there = kept::open(path)?;
        let is_new = there.is_none();
        let file = there.map_or_else(|| kept::make(path), Ok)?;
        if !kept::lock(&file, path)? {
            return Err(HostError::new(format!(
                "{} is in use: the machine it belongs to is switched on",
                path.display()
            )));
        }
        let storage = FileStorage {
            path: path.to_owned(),
            file,
            is_new,
            aside: None,
        };
        let retention = Retention::open(storage)
            .map_err(|error| HostError::new(format!("{}: {error}", path.display())))?;
        let aside = || {
            let aside = retention.storage().aside.as_ref();
            aside.map_or(String::new(), |aside| {
                format!("\n  the damaged file is kept: {}", aside.display())
            })
        };
        let damage = retention.damage();
        Ok(Retained {
            path: path.to_owned(),
            damage: damage.map(|damage| format!("{}: {damage}{}", path.display(), aside())),
            retention,
            started: Instant::now(),
        })
    }

    /// What is damaged in it, and where the damaged file is kept; in words.
    pub fn damage(&self) -> Option<&str> {
        self.damage.as_deref()
    }

    /// Both images as at power-on.
    pub fn restore(&self) -> Exchange {
        let mut exchange = Exchange::default();
        self.retention.restore(&mut exchange);
        exchange
    }

    /// Writes what changed, at most every 200 ms.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn tick(&mut self, image: &Image) -> Result<(), HostError> {
        let now = u64::try_from(self.started.elapsed().as_micros()).unwrap_or(u64::MAX);
        self.retention
            .tick(image, now)
            .map_err(|error| self.error(&error))
    }

    /// Writes what changed at once.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn flush(&mut self, image: &Image) -> Result<(), HostError> {
        self.retention.flush(image).map_err(|error| self.error(&error))
    }

    fn error(&self, error: &RetentionError) -> HostError {
        HostError::new(format!("{}: {error}", self.path.display()))
    }
}

/// The journal in its file, which stays open.
struct FileStorage {
    path: PathBuf,
    file: File,
    is_new: bool,
    /// Where a damaged journal is kept.
    aside: Option<PathBuf>,
}

impl RetentionStorage for FileStorage {
    fn read(&mut self) -> io::Result<Option<Vec<u8>>> {
        if self.is_new {
            return Ok(None);
        }
        let mut content = Vec::new();
        // One more byte shows that it is longer.
        let length = JOURNAL_LENGTH as u64 + 1;
        (&self.file).take(length).read_to_end(&mut content)?;
        Ok(Some(content))
    }

    fn write(&mut self, at: usize, bytes: &[u8]) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(at as u64))?;
        self.file.write_all(bytes)?;
        if std::mem::take(&mut self.is_new) {
            self.file.sync_all()?;
            files::sync_folder(&self.path);
            return Ok(());
        }
        self.file.sync_data()
    }

    fn set_aside(&mut self, journal: &[u8]) -> io::Result<()> {
        self.aside = Some(kept::set_aside(&self.path, journal)?);
        Ok(())
    }
}
