//! What lies around a document: open documents, files, settings.

use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_parameters::ControlModel;
use bahn_program::Program;
use bahn_reader::{Folders, called};
use bahn_text::{Files, meant, path_below};

use crate::settings::Settings;
use crate::text::Text;

/// Largest text that is looked at, 16 MiB: a program with half a million blocks.
pub(crate) const BYTES_MAX: usize = 16 << 20;

/// Files on the disk, as the command line reads them: they are read by their paths; what is too large is not.
pub trait Disk: Files {
    /// The control of the machine to whose folder a file belongs.
    fn model_of(&self, path: &Path) -> Option<ControlModel>;

    /// Whether there is a file.
    fn has(&self, path: &Path) -> bool;

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

    /// The file of a folder that one of these names means, with what the editor shows of it, else what lies on the disk.
    pub(crate) fn named(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let has = |name: &str| self.has(&folder.join(name));
        let name = meant(&[name.to_owned()], has, || self.names(folder))?;
        Some(folder.join(name))
    }

    /// The same of a folder or one below it, by a name with its folders.
    pub(crate) fn below(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let path = path_below(name)?;
        let (within, name) = path.rsplit_once('/').unwrap_or(("", &path));
        self.named(&folder.join(within), name)
    }

    /// The file that a call of this name means in a program.
    pub(crate) fn called(&self, name: &str, caller: &Path) -> Option<PathBuf> {
        called(self, caller.parent().unwrap_or(Path::new("")), name, caller)
    }

    /// The control that a file is for: the one of the settings, else that of its machine, else the usual one.
    pub(crate) fn model_of(&self, path: &Path) -> ControlModel {
        let set = self.settings.model;
        set.or_else(|| self.files.model_of(path)).unwrap_or_default()
    }
}

/// Programs as the editor shows them, else as they lie on the disk.
impl Folders for World {
    fn names(&self, folder: &Path) -> Vec<String> {
        let shown = self.open.keys().filter(|path| path.parent() == Some(folder));
        let shown = shown.filter_map(|path| path.file_name()?.to_str().map(str::to_owned));
        let mut names = self.files.names(folder);
        names.extend(shown);
        names
    }

    fn has(&self, path: &Path) -> bool {
        self.open.contains_key(path) || self.files.has(path)
    }

    fn load(&self, path: &Path) -> Result<Arc<Program>, String> {
        let bytes = self.read(path);
        let bytes = bytes.ok_or_else(|| format!("{} cannot be read", path.display()))?;
        if bytes.len() > BYTES_MAX {
            return Err(format!(
                "{} is too large to be looked at while it is edited",
                path.display()
            ));
        }
        let name = path.to_string_lossy().into_owned();
        Ok(Arc::new(Program::from_bytes(name, bytes)))
    }
}
