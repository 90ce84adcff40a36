//! From a place to a path: folder by folder, without regard to case, and never through a symbolic link.

use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use bahn_host::files;

use super::medium::Medium;
use super::place::is_name;
use super::{Attributes, Change, Entry, Place, StoreError};
use crate::FileType;

/// Folders in each other that are swept.
const DEPTH_MAX: usize = 12;

/// Kinds of things in a folder; what is neither is not there.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    File,
    Folder,
}

fn kind(metadata: &Metadata) -> Option<Kind> {
    match (metadata.is_file(), metadata.is_dir()) {
        (true, _) => Some(Kind::File),
        (_, true) => Some(Kind::Folder),
        _ => None,
    }
}

impl Medium {
    /// The folder of a drive.
    fn drive(&self, place: &Place) -> Result<&Path, StoreError> {
        let mut drives = self.drives.iter();
        let drive = drives.find(|(name, _)| *name == place.drive());
        let (_, folder) = drive.ok_or_else(|| StoreError::NoFolder(place.to_string()))?;
        Ok(folder)
    }

    /// The path of a folder that is there.
    pub(super) fn find_folder(&self, place: &Place) -> Result<PathBuf, StoreError> {
        let mut path = self.drive(place)?.to_owned();
        if self.limit.is_some() && !place.names().is_empty() {
            return Err(StoreError::NoFolder(place.to_string()));
        }
        for name in place.names() {
            path =
                spelled(&path, name, Kind::Folder).ok_or_else(|| StoreError::NoFolder(place.to_string()))?;
        }
        Ok(path)
    }

    /// The path of a file that is there; one that is stored as `NAME.<code>NC` is found, too.
    pub(super) fn find_file(&self, place: &Place) -> Result<PathBuf, StoreError> {
        let no_file = || StoreError::NoFile(place.to_string());
        let name = place.name().ok_or_else(no_file)?;
        let folder = self.find_folder(&place.folder().ok_or_else(no_file)?)?;
        if self.is_disabled(place) {
            return Err(no_file());
        }
        spelled(&folder, name, Kind::File)
            .or_else(|| nc_name(name).and_then(|name| spelled(&folder, &name, Kind::File)))
            .ok_or_else(no_file)
    }

    /// The path of a file or folder that is there.
    pub(super) fn find_any(&self, place: &Place) -> Result<PathBuf, StoreError> {
        self.find_file(place)
            .or_else(|error| self.find_folder(place).map_err(|_| error))
    }

    /// The path of a file to which this may be done.
    pub(super) fn own(&self, place: &Place, change: Change) -> Result<PathBuf, StoreError> {
        let path = match self.find_file(place) {
            Err(StoreError::NoFile(name)) if self.view(place).is_some() => {
                return Err(StoreError::Protected(name));
            }
            found => found?,
        };
        let by_itself = attributes(&path).is_some_and(|attributes| attributes.protected);
        if by_itself || self.is_protected(place) {
            return Err(StoreError::Protected(place.to_string()));
        }
        if self.busy().contains(&path) {
            return Err(StoreError::Busy(place.to_string()));
        }
        if (self.in_use.0)(place, change) {
            return Err(StoreError::InUse(place.to_string()));
        }
        Ok(path)
    }

    /// The path of something that is not there yet, in a folder that is; `old` may be there, spelled otherwise.
    pub(super) fn free(&self, place: &Place, old: Option<&Path>) -> Result<PathBuf, StoreError> {
        let exists = || StoreError::Exists(place.to_string());
        let name = place.name().ok_or_else(exists)?;
        if self.is_disabled(place) {
            return Err(StoreError::Protected(place.to_string()));
        }
        if self.is_too_long(place) {
            return Err(StoreError::BadName(place.to_string()));
        }
        let folder = self.find_folder(&place.folder().ok_or_else(exists)?)?;
        match self.find_any(place) {
            Ok(found) if old != Some(&found) => return Err(exists()),
            // What is shown there is in the way as a file would be.
            Err(_) if self.view(place).is_some() => return Err(exists()),
            Ok(_) | Err(_) => {}
        }
        let path = folder.join(name);
        // A link, a device or a file whose name is spelled as this one is in the way, too.
        if old != Some(&path) && fs::symlink_metadata(&path).is_ok() {
            return Err(exists());
        }
        if self.busy().contains(&path) {
            return Err(StoreError::Busy(place.to_string()));
        }
        Ok(path)
    }

    /// A disk has room for one more file.
    pub(super) fn has_room(&self, path: &Path) -> Result<(), StoreError> {
        let Some(limit) = self.limit else {
            return Ok(());
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        let begun = self.busy().iter().filter(|path| !path.exists()).count();
        if list(folder, false).len() + begun >= limit {
            return Err(StoreError::DirectoryFull);
        }
        Ok(())
    }
}

/// `NAME.EXT` as `NAME.<code>NC`, when the code is read as this extension.
fn nc_name(name: &str) -> Option<String> {
    let (stem, extension) = name.rsplit_once('.')?;
    let kind = FileType::of_extension(extension)?;
    (FileType::of_code(kind.code()) == Some(kind)).then(|| format!("{stem}.{}", kind.nc_extension()))
}

/// `NAME.<code>NC` as `NAME.EXT`; other names stay.
fn shown_name(name: &str) -> String {
    let kind = name.rsplit_once('.').and_then(|(stem, extension)| {
        let mut letters = extension.chars();
        let code = letters.next()?;
        let is_nc = letters.as_str().eq_ignore_ascii_case("NC");
        FileType::of_code(code)
            .filter(|_| is_nc)
            .map(|kind| format!("{stem}.{}", kind.extension()))
    });
    kind.unwrap_or_else(|| name.to_owned())
}

/// What is spelled like a name in a folder: letter by letter if possible, else the first by name that differs in
/// case only.
fn spelled(folder: &Path, name: &str, wanted: Kind) -> Option<PathBuf> {
    let is_wanted = |path: &Path| {
        let metadata = fs::symlink_metadata(path).ok();
        metadata.and_then(|metadata| kind(&metadata)) == Some(wanted)
    };
    let exact = folder.join(name);
    if is_wanted(&exact) {
        return Some(exact);
    }
    let entries = fs::read_dir(folder).ok()?;
    let mut alike: Vec<PathBuf> = entries
        .flatten()
        .filter(|entry| {
            let found = entry.file_name();
            found
                .to_str()
                .is_some_and(|found| found.eq_ignore_ascii_case(name))
        })
        .map(|entry| entry.path())
        .filter(|path| is_wanted(path))
        .collect();
    alike.sort();
    alike.into_iter().next()
}

/// What is in a folder, by name, each name once.
pub(super) fn list(folder: &Path, with_folders: bool) -> Vec<Entry> {
    let Ok(found) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut entries: Vec<(bool, Entry)> = found
        .flatten()
        .filter_map(|entry| {
            let stored = entry
                .file_name()
                .into_string()
                .ok()
                .filter(|name| is_name(name))?;
            let attributes = attributes(&entry.path())?;
            let name = match attributes.is_folder {
                true => stored.clone(),
                false => shown_name(&stored),
            };
            let is_listed = (with_folders || !attributes.is_folder) && is_name(&name);
            is_listed.then_some((name != stored, Entry { name, attributes }))
        })
        .collect();
    // Of two that are one name the one that is found comes first.
    entries.sort_by_cached_key(|(is_renamed, entry)| {
        let name = entry.name.to_ascii_uppercase();
        (name, *is_renamed, entry.name.clone())
    });
    let mut entries: Vec<Entry> = entries.into_iter().map(|(_, entry)| entry).collect();
    entries.dedup_by(|next, first| next.name.eq_ignore_ascii_case(&first.name));
    entries
}

/// What there is to be said of a path; nothing of links and devices.
pub(super) fn attributes(path: &Path) -> Option<Attributes> {
    let metadata = fs::symlink_metadata(path).ok()?;
    let is_folder = kind(&metadata)? == Kind::Folder;
    Some(Attributes {
        size: if is_folder { 0 } else { metadata.len() },
        modified: metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH),
        protected: metadata.permissions().readonly() || (!is_folder && is_protected_program(path)),
        is_folder,
    })
}

/// A part program whose first block says that it is protected [003:1015-1023].
fn is_protected_program(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let extension = shown_name(&name)
        .rsplit_once('.')
        .map(|(_, extension)| extension.to_owned());
    let is_program = extension.is_some_and(|extension| {
        let mut kinds = bahn_program::FILE_TYPES.iter();
        kinds.any(|kind| kind.extension.eq_ignore_ascii_case(&extension))
    });
    is_program && files::is_protected_program(path)
}

/// Takes write permission away, or gives it to the owner.
pub(super) fn set_read_only(path: &Path, on: bool) -> io::Result<()> {
    let mut permissions = fs::metadata(path)?.permissions();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = permissions.mode();
        permissions.set_mode(if on { mode & !0o222 } else { mode | 0o200 });
    }
    #[cfg(not(unix))]
    permissions.set_readonly(on);
    fs::set_permissions(path, permissions)
}

/// Sweeps what was left half written in a folder and those in it.
pub(super) fn sweep(folder: &Path) {
    sweep_to(folder, DEPTH_MAX);
}

fn sweep_to(folder: &Path, depth: usize) {
    bahn_host::files::sweep(folder);
    let Some(deeper) = depth.checked_sub(1) else {
        return;
    };
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            sweep_to(&entry.path(), deeper);
        }
    }
}
