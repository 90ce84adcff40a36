//! Files by their name alone, for interfaces that know no folders: in the folder of the drive and in those below it.

use std::collections::HashSet;
use std::fs;

use bahn_host::files::EPROM;

use super::place::is_name;
use super::{Entry, Place, Store, StoreError};

/// Folders that are looked into at most.
const FOLDERS_MAX: usize = 1000;

impl Store {
    /// All files, folder by folder from the root of the drive on; of several of one name the first.
    pub fn everywhere(&self) -> Vec<(Place, Entry)> {
        let mut names = HashSet::new();
        let mut found = Vec::new();
        for folder in self.folders() {
            let entries = self.list(&folder).unwrap_or_default();
            for entry in entries.into_iter().filter(|entry| !entry.attributes.is_folder) {
                if names.insert(entry.name.to_ascii_uppercase()) {
                    found.extend(folder.join(&entry.name).map(|place| (place, entry)));
                }
            }
        }
        found
    }

    /// Where the file of a name lies, or would if it were made: in the folder of the drive.
    ///
    /// # Errors
    /// When it is no name.
    pub fn whereabouts(&self, name: &str) -> Result<Place, StoreError> {
        let own = self.root().join(name)?;
        if self.has(&own) {
            return Ok(own);
        }
        let below = self.folders().into_iter().skip(1);
        let mut places = below.filter_map(|folder| folder.join(name).ok());
        Ok(places.find(|place| self.has(place)).unwrap_or(own))
    }

    /// The folders of the drive: its root, those in it by name, those in them, and so on. A disk has its root only. What is in
    /// the EPROM of the PLC is no file of the drive.
    fn folders(&self) -> Vec<Place> {
        let mut folders = vec![self.root()];
        let mut next = 0;
        while let Some(folder) = folders.get(next).filter(|_| self.medium.limit.is_none()).cloned() {
            next += 1;
            let Ok(path) = self.medium.find_folder(&folder) else {
                continue;
            };
            let entries = fs::read_dir(path).into_iter().flatten().flatten();
            let mut names: Vec<String> = entries
                .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
                .filter_map(|entry| entry.file_name().into_string().ok())
                .filter(|name| is_name(name) && name != EPROM)
                .collect();
            names.sort_by_cached_key(|name| (name.to_ascii_uppercase(), name.clone()));
            let room = FOLDERS_MAX.saturating_sub(folders.len());
            let below = names.iter().filter_map(|name| folder.join(name).ok());
            folders.extend(below.take(room));
        }
        folders
    }
}
