//! The file service that all interfaces share: files of a machine, or of a folder that plays a disk.
//!
//! - [`Store`] lists, reads and changes files; a [`Place`] is where one is, a [`View`] one that lies elsewhere;
//! - what the machine has [`InUse`] is left as it is, and so is what is protected;
//! - a [`FileType`] is what the interfaces know of a file: its extension and its code letter.
//!
//! Names are compared without regard to case; symbolic links, devices and names that no control knows are not there. What is
//! being written has no name until it is committed. Nothing here knows a protocol.
//!
//! ```
//! use std::io::{Read, Write};
//! use bahn_store::{Existing, Store, StoreError};
//!
//! # let folder = std::env::temp_dir().join(format!("bahn-store-{}", std::process::id()));
//! # std::fs::create_dir_all(folder.join("plc"))?;
//! # std::fs::create_dir_all(folder.join("programs"))?;
//! let store = Store::of_machine(&folder.join("programs"), &folder.join("plc"))?;
//! let part = store.root().join("15.H")?;
//! let mut file = store.create(&part, Existing::Keep)?;
//! file.write_all(b"BEGIN PGM 15 MM\nEND PGM 15 MM\n")?;
//! assert!(store.list(&store.root())?.is_empty());
//! file.commit()?;
//! assert_eq!(store.list(&store.root())?[0].name, "15.H");
//!
//! let mut text = String::new();
//! store.open(&store.root().join("15.h")?)?.read_to_string(&mut text)?;
//! assert!(text.starts_with("BEGIN PGM 15"));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:7188] look like links"
)]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

mod entry;
mod error;
mod everywhere;
mod file_type;
mod files;
mod in_use;
mod lookup;
mod medium;
mod place;
#[cfg(test)]
mod tests;
mod views;

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

pub use error::StoreError;
pub use file_type::FileType;
pub use files::{Reading, Writing};
pub use in_use::{Change, InUse};
pub use place::{NAME_MAX, PLC, Place, TNC};
pub use views::View;

pub use entry::{Attributes, Entry, Existing};

use bahn_parameters::ParameterList;
use bahn_parameters::tables::FileTypes;
use medium::Medium;

/// Files on a disk of the FE 401 at most.
pub const DISK_FILES: usize = 256;

/// The file service. Clones are the same one: what one writes the other knows of.
#[derive(Clone, Debug)]
pub struct Store {
    medium: Arc<Medium>,
}

impl Store {
    /// Files of a machine: part programs and tables on drive `TNC:`, the PLC's on `PLC:`. What a killed process left half
    /// written is swept.
    ///
    /// # Errors
    /// When a folder is not there.
    pub fn of_machine(programs: &Path, plc: &Path) -> Result<Store, StoreError> {
        Store::of_machine_with(programs, plc, Vec::new(), InUse::never())
    }

    /// The same with files that lie elsewhere, and those that the machine may have in use.
    ///
    /// # Errors
    /// When a folder is not there.
    pub fn of_machine_with(
        programs: &Path,
        plc: &Path,
        views: Vec<View>,
        in_use: InUse,
    ) -> Result<Store, StoreError> {
        Store::over(&[(TNC, programs), (PLC, plc)], views, in_use, None)
    }

    /// The files of one folder, as a drive of this name.
    ///
    /// # Errors
    /// When the folder is not there.
    pub fn of_drive(name: &'static str, folder: &Path) -> Result<Store, StoreError> {
        Store::over(&[(name, folder)], Vec::new(), InUse::never(), None)
    }

    /// A disk: one folder without folders in it, with at most [`DISK_FILES`] files.
    ///
    /// # Errors
    /// When the folder is not there.
    pub fn of_disk(folder: &Path) -> Result<Store, StoreError> {
        Store::over(&[("", folder)], Vec::new(), InUse::never(), Some(DISK_FILES))
    }

    /// The same with what machine parameters say of files: the types that MP7224 disables and protects, and how long names are,
    /// MP7222. To be said before anybody else has the store.
    #[must_use]
    pub fn ruled_by(mut self, list: &ParameterList) -> Store {
        if let Some(medium) = Arc::get_mut(&mut self.medium) {
            medium.types = list.table_parameters().types;
            medium.name_max = Some(list.operation_parameters().file_name_max.into());
        }
        self
    }

    fn over(
        folders: &[(&'static str, &Path)],
        views: Vec<View>,
        in_use: InUse,
        limit: Option<usize>,
    ) -> Result<Store, StoreError> {
        let mut drives = Vec::new();
        for &(name, folder) in folders {
            let no_folder = || StoreError::NoFolder(folder.display().to_string());
            let folder = fs::canonicalize(folder).map_err(|_| no_folder())?;
            if !folder.is_dir() {
                return Err(no_folder());
            }
            lookup::sweep(&folder);
            drives.push((name, folder));
        }
        Ok(Store {
            medium: Arc::new(Medium {
                drives,
                views,
                in_use,
                limit,
                types: FileTypes::default(),
                name_max: None,
                busy: Mutex::default(),
                changes: AtomicU64::new(0),
            }),
        })
    }

    /// Where paths begin: the root of the first drive.
    pub fn root(&self) -> Place {
        Place::root(self.drives().next().unwrap_or_default())
    }

    /// Names of the drives, without colon.
    pub fn drives(&self) -> impl Iterator<Item = &'static str> {
        self.medium.drives.iter().map(|(name, _)| *name)
    }

    /// Counts what was changed through this service, so that whoever keeps what it has read knows when to read again.
    pub fn changes(&self) -> u64 {
        self.medium.changes.load(Ordering::Acquire)
    }

    /// What is in a folder, by name.
    ///
    /// # Errors
    /// When it is no folder.
    pub fn list(&self, folder: &Place) -> Result<Vec<Entry>, StoreError> {
        let is_disk = self.medium.limit.is_some();
        let mut entries = lookup::list(&self.medium.find_folder(folder)?, !is_disk);
        let views = self.medium.views.iter();
        for view in views.filter(|view| view.place.folder().as_ref() == Some(folder)) {
            let name = view.place.name().unwrap_or_default();
            let place = entries.partition_point(|entry| entry.name.to_ascii_uppercase().as_str() < name);
            let is_there = entries
                .get(place)
                .is_some_and(|entry| entry.name.eq_ignore_ascii_case(name));
            if let Some(attributes) = view.attributes().filter(|_| !is_there) {
                let name = name.to_owned();
                entries.insert(place, Entry { name, attributes });
            }
        }
        Ok(self.medium.seen(folder, entries))
    }

    /// What there is to be said of a file or folder.
    ///
    /// # Errors
    /// When it is not there.
    pub fn attributes(&self, place: &Place) -> Result<Attributes, StoreError> {
        let no_file = || StoreError::NoFile(place.to_string());
        let by_type = |attributes: Attributes| Attributes {
            protected: attributes.protected || self.medium.is_protected(place),
            ..attributes
        };
        match self.medium.find_any(place) {
            Ok(path) => lookup::attributes(&path).map(by_type).ok_or_else(no_file),
            Err(error) => self.medium.view(place).and_then(View::attributes).ok_or(error),
        }
    }

    /// Whether there is a file of this name.
    pub fn has(&self, place: &Place) -> bool {
        self.medium.find_file(place).is_ok()
            || self
                .medium
                .view(place)
                .is_some_and(|view| (view.bytes)().is_some())
    }

    /// Protects a file, or takes its protection away, as write permission. A program that its first block protects stays
    /// protected.
    ///
    /// # Errors
    /// When it is not there, or the medium does not do it.
    pub fn protect(&self, place: &Place, on: bool) -> Result<(), StoreError> {
        let path = self.medium.find_file(place)?;
        lookup::set_read_only(&path, on)
            .map_err(|error| StoreError::of_system(&error, &place.to_string()))?;
        self.medium.changed();
        Ok(())
    }

    /// Deletes a file.
    ///
    /// # Errors
    /// When it is not there, protected, being written or in use.
    pub fn delete(&self, place: &Place) -> Result<(), StoreError> {
        let path = self.medium.own(place, Change::Name)?;
        self.done(fs::remove_file(&path), &path, place)
    }

    /// Renames a file, or moves it to another folder, byte for byte.
    ///
    /// # Errors
    /// When it is not there, protected, being written or in use, or there is a file of the new name.
    pub fn rename(&self, from: &Place, to: &Place) -> Result<(), StoreError> {
        let old = self.medium.own(from, Change::Name)?;
        let new = self.medium.free(to, Some(&old))?;
        if old.parent() != new.parent() {
            self.medium.has_room(&new)?;
        }
        self.done(fs::rename(&old, &new), &new, from)
    }

    /// Copies a file, byte for byte; the copy is not protected by permission.
    ///
    /// # Errors
    /// When it is not there, or there is a file of the new name, or no room.
    pub fn copy(&self, from: &Place, to: &Place) -> Result<(), StoreError> {
        let mut source = self.open(from)?;
        let mut copy = self.create(to, Existing::Keep)?;
        std::io::copy(&mut source, &mut copy)
            .map_err(|error| StoreError::of_system(&error, &to.to_string()))?;
        copy.commit()
    }

    /// Makes a folder.
    ///
    /// # Errors
    /// When there is something of this name, or the store is a disk.
    pub fn make_folder(&self, place: &Place) -> Result<(), StoreError> {
        if self.medium.limit.is_some() {
            return Err(StoreError::BadName(place.to_string()));
        }
        let path = self.medium.free(place, None)?;
        self.done(fs::create_dir(&path), &path, place)
    }

    /// Removes an empty folder.
    ///
    /// # Errors
    /// When it is not there, is a drive, or is not empty.
    pub fn remove_folder(&self, place: &Place) -> Result<(), StoreError> {
        if place.name().is_none() {
            return Err(StoreError::Protected(place.to_string()));
        }
        let path = self.medium.find_folder(place)?;
        self.done(fs::remove_dir(&path), &path, place)
    }

    /// Whether there is a folder of this name, to go there.
    ///
    /// # Errors
    /// When there is none.
    pub fn enter(&self, place: &Place) -> Result<(), StoreError> {
        self.medium.find_folder(place).map(drop)
    }

    /// An action on the medium is finished, and counted.
    fn done(&self, result: std::io::Result<()>, path: &Path, place: &Place) -> Result<(), StoreError> {
        result.map_err(|error| StoreError::of_system(&error, &place.to_string()))?;
        bahn_host::files::sync_folder(path);
        self.medium.changed();
        Ok(())
    }
}
