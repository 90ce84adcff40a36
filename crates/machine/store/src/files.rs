//! Files that are being read and written.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::PathBuf;

use bahn_host::files::{MAX_PROGRAM_BYTES, NewFile};

use super::{Change, Existing, Place, Store, StoreError, lookup};

impl Store {
    /// Opens a file to read it piece by piece. It is what it was when it was opened, also when it is replaced meanwhile.
    ///
    /// # Errors
    /// When it is not there.
    pub fn open(&self, place: &Place) -> Result<Reading, StoreError> {
        let path = match self.medium.find_file(place) {
            Ok(path) => path,
            Err(error) => {
                let bytes = self
                    .medium
                    .view(place)
                    .and_then(|view| (view.bytes)())
                    .ok_or(error)?;
                return Ok(Reading {
                    length: bytes.len() as u64,
                    source: Source::Bytes(io::Cursor::new(bytes)),
                });
            }
        };
        let open = File::open(&path).and_then(|file| Ok((file.metadata()?.len(), file)));
        let (length, file) = open.map_err(|error| StoreError::of_system(&error, &place.to_string()))?;
        Ok(Reading {
            source: Source::File(file),
            length,
        })
    }

    /// Begins a file, which appears under its name when it is committed. Nobody else writes it meanwhile.
    ///
    /// # Errors
    /// When there is one that stays, is protected, being written or in use, or there is no room.
    pub fn create(&self, place: &Place, existing: Existing) -> Result<Writing, StoreError> {
        let found = match self.medium.find_file(place) {
            Ok(_) if existing == Existing::Keep => return Err(StoreError::Exists(place.to_string())),
            Ok(_) => Some(self.medium.own(place, Change::Content)?),
            Err(StoreError::NoFile(name)) if self.medium.view(place).is_some() => {
                return Err(StoreError::Protected(name));
            }
            Err(StoreError::NoFile(_)) => None,
            Err(error) => return Err(error),
        };
        // A file stays where it is, but for one with the extension of the personal computer.
        let is_same = |path: &PathBuf| {
            let stored = path.file_name().and_then(|name| name.to_str());
            stored
                .zip(place.name())
                .is_some_and(|(stored, name)| stored.eq_ignore_ascii_case(name))
        };
        let (path, superseded) = match found {
            Some(path) if is_same(&path) => (path, None),
            found => (self.medium.free(place, found.as_deref())?, found),
        };
        if superseded.is_none() && !path.exists() {
            self.medium.has_room(&path)?;
        }
        if !self.medium.busy().insert(path.clone()) {
            return Err(StoreError::Busy(place.to_string()));
        }
        let mut writing = Writing {
            store: self.clone(),
            place: place.clone(),
            path,
            superseded,
            file: None,
            length: 0,
        };
        let file = NewFile::create(&writing.path);
        writing.file = Some(file.map_err(|error| StoreError::Medium(error.to_string()))?);
        Ok(writing)
    }
}

/// A file that is being read.
#[derive(Debug)]
pub struct Reading {
    source: Source,
    length: u64,
}

#[derive(Debug)]
enum Source {
    File(File),
    /// The text of a view, which is no file of the medium.
    Bytes(io::Cursor<Vec<u8>>),
}

impl Reading {
    /// Bytes of the file when it was opened.
    pub fn length(&self) -> u64 {
        self.length
    }
}

impl Read for Reading {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match &mut self.source {
            Source::File(file) => file.read(buffer),
            Source::Bytes(bytes) => bytes.read(buffer),
        }
    }
}

/// A file that is being written: dropped, nothing of it is left.
#[derive(Debug)]
pub struct Writing {
    store: Store,
    place: Place,
    path: PathBuf,
    /// The file with the extension of the personal computer that the new one replaces.
    superseded: Option<PathBuf>,
    /// Until it is committed.
    file: Option<NewFile>,
    length: u64,
}

impl Writing {
    /// Where it will be.
    pub fn place(&self) -> &Place {
        &self.place
    }

    /// Bytes written so far.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Puts the file under its name, in one step, when it is on the medium.
    ///
    /// # Errors
    /// When it became protected meanwhile, or came into use, or the medium does not take it: what was there stays.
    pub fn commit(mut self) -> Result<(), StoreError> {
        let protected = lookup::attributes(&self.path).is_some_and(|found| found.protected);
        if protected {
            return Err(StoreError::Protected(self.place.to_string()));
        }
        let medium = &self.store.medium;
        let is_there = medium.find_file(&self.place).is_ok();
        if is_there && (medium.in_use.0)(&self.place, Change::Content) {
            return Err(StoreError::InUse(self.place.to_string()));
        }
        let Some(file) = self.file.take() else {
            return Ok(());
        };
        file.finish()
            .map_err(|error| StoreError::Medium(error.to_string()))?;
        if let Some(superseded) = &self.superseded {
            // If it stays it is after the new one.
            let _ = fs::remove_file(superseded);
        }
        self.store.medium.changed();
        Ok(())
    }
}

impl Write for Writing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.length.saturating_add(bytes.len() as u64) > MAX_PROGRAM_BYTES {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        let file = self.file.as_mut().ok_or(io::ErrorKind::NotConnected)?;
        let written = file.write(bytes)?;
        self.length += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        // Its half goes before its name is free again.
        self.file = None;
        self.store.medium.busy().remove(&self.path);
    }
}
