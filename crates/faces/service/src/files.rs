//! The files of the machine: part programs and tables on drive `TNC:`, the PLC's on `PLC:`.

use std::io::Write as _;

use bahn_panel::{Station, TransferFiles};
use bahn_store::{Entry, Existing, Place, Reading, Store, StoreError};

use crate::error::ServiceError;
use crate::service::MachineService;
use crate::tables;

impl MachineService {
    /// What is in a folder, by name; the empty path is the root of the part programs.
    ///
    /// # Errors
    /// When it is no folder.
    pub fn list(&self, folder: &str) -> Result<Vec<Entry>, ServiceError> {
        Ok(self.shared.store.list(&self.place(folder)?)?)
    }

    /// Opens a file to read it piece by piece.
    ///
    /// # Errors
    /// When it is not there.
    pub fn open(&self, path: &str) -> Result<Reading, ServiceError> {
        Ok(self.shared.store.open(&self.place(path)?)?)
    }

    /// Stores a file, whole or not at all; one of its name is replaced, unless it is protected or in use.
    ///
    /// # Errors
    /// When it may not be replaced, or the medium does not take it.
    pub fn store_file(&self, path: &str, bytes: &[u8]) -> Result<(), ServiceError> {
        let place = self.place(path)?;
        let store = self.store()?;
        let mut file = store.create(&place, Existing::Replace)?;
        let written = file.write_all(bytes);
        written.map_err(|error| match error.kind() {
            std::io::ErrorKind::FileTooLarge | std::io::ErrorKind::StorageFull => StoreError::DiskFull,
            _ => StoreError::Medium(format!("{place}: {error}")),
        })?;
        file.commit()?;
        self.files_changed();
        Ok(())
    }

    /// Deletes a file, unless it is protected or in use.
    ///
    /// # Errors
    /// When it may not be deleted, or is not there.
    pub fn delete(&self, path: &str) -> Result<(), ServiceError> {
        let place = self.place(path)?;
        self.store()?.delete(&place)?;
        self.files_changed();
        Ok(())
    }

    /// Renames a file, or moves it to another folder, unless it is protected or in use.
    ///
    /// # Errors
    /// When it may not be renamed, is not there, or there is a file of the new name.
    pub fn rename(&self, from: &str, to: &str) -> Result<(), ServiceError> {
        let (from, to) = (self.place(from)?, self.place(to)?);
        self.store()?.rename(&from, &to)?;
        self.files_changed();
        Ok(())
    }

    /// The file service itself, for a protocol whose files come and go piece by piece. It refuses what is protected or in use;
    /// who has changed files says so by [`MachineService::files_changed`].
    ///
    /// # Errors
    /// When one may only look.
    pub fn store(&self) -> Result<&Store, ServiceError> {
        self.operates()?;
        Ok(&self.shared.store)
    }

    /// The file service of what the panel transfers: files of the PLC and lists of machine parameters lie among others, each
    /// in a folder of its own; `None` where there is none.
    ///
    /// # Errors
    /// When one may only look.
    pub fn store_of(&self, files: TransferFiles) -> Result<Option<&Store>, ServiceError> {
        self.operates()?;
        Ok(match files {
            TransferFiles::Programs | TransferFiles::Backup => Some(&self.shared.store),
            TransferFiles::Plc => self.shared.plc_files.as_ref(),
            TransferFiles::Lists => self.shared.lists.as_ref(),
        })
    }

    /// A value of the tool table as it is written there, by the number of the tool and the name of the column.
    pub fn tool_value(&self, tool: u32, column: &str) -> Option<String> {
        tables::tool_value(self.shared.folders.tools.as_ref()?, tool, column)
    }

    /// Files were changed: the control reads them anew.
    pub fn files_changed(&self) {
        // A machine that has ended reads nothing any more.
        let _ = self.look(Station::programs_changed);
    }

    fn place(&self, path: &str) -> Result<Place, ServiceError> {
        let root = self.shared.store.root();
        match path.is_empty() {
            true => Ok(root),
            false => Ok(root.join(path)?),
        }
    }
}
