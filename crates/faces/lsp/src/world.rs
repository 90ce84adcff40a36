//! What lies around a document: open documents, files, settings.

use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_parameters::ControlModel;
use bahn_text::Files;

use crate::settings::Settings;
use crate::text::Text;

/// Files on the disk, as the command line reads them: they are read by their paths; what is too large is not.
pub trait Disk: Files {
    /// The file that a call of this name means in a program.
    fn called(&self, name: &str, caller: &Path) -> Option<PathBuf>;

    /// The control of the machine to whose folder a file belongs.
    fn model_of(&self, path: &Path) -> Option<ControlModel>;

    /// The names of the files of a folder.
    fn names(&self, folder: &Path) -> Vec<String>;
}

/// What a document sees around it, at one moment.
#[derive(Clone)]
pub(crate) struct World {
    pub(crate) files: Arc<dyn Disk>,
    pub(crate) settings: Arc<Settings>,
    /// Texts that are open in the editor: they count, not those on the disk.
    pub(crate) open: Arc<HashMap<PathBuf, Arc<Text>>>,
}

impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("settings", &self.settings)
            .finish_non_exhaustive()
    }
}

impl World {
    /// The bytes of a file as the editor shows it, else as it lies on the disk.
    pub(crate) fn read(&self, path: &Path) -> Option<Vec<u8>> {
        match self.open.get(path) {
            Some(text) => Some(text.text.as_bytes().to_vec()),
            None => Some(self.files.read(path.to_str()?)?.bytes),
        }
    }

    /// The control that a file is for: the one of the settings, else that of its machine, else the usual one.
    pub(crate) fn model_of(&self, path: &Path) -> ControlModel {
        let set = self.settings.model;
        set.or_else(|| self.files.model_of(path)).unwrap_or_default()
    }
}
