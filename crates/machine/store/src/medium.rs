//! What a store has its files on.

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use bahn_parameters::tables::{FILE_TYPES, FileTypes};

use super::entry::Entry;
use super::in_use::InUse;
use super::place::{Place, TNC};
use super::views::View;

/// Folders with what is written and shown there.
#[derive(Debug)]
pub(super) struct Medium {
    /// Name of the drive, and its folder without symbolic links.
    pub(super) drives: Vec<(&'static str, PathBuf)>,
    /// Files at most, and no folders: a disk.
    pub(super) limit: Option<usize>,
    /// What is shown beside them.
    pub(super) views: Vec<View>,
    /// What the machine has in use.
    pub(super) in_use: InUse,
    /// Types of files that MP7224 disables and protects [000:6857-6880].
    pub(super) types: FileTypes,
    /// Characters of a name before its ending at most: MP7222 [000:6847-6852].
    pub(super) name_max: Option<usize>,
    /// What is being written.
    pub(super) busy: Mutex<HashSet<PathBuf>>,
    pub(super) changes: AtomicU64,
}

impl Medium {
    pub(super) fn busy(&self) -> MutexGuard<'_, HashSet<PathBuf>> {
        self.busy.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a change of the medium, so that listings are read again.
    pub(super) fn changed(&self) {
        self.changes.fetch_add(1, Ordering::Release);
    }

    /// The file that is shown at a place.
    pub(super) fn view(&self, place: &Place) -> Option<&View> {
        let mut shown = self.views.iter().filter(|_| !self.is_disabled(place));
        shown.find(|view| view.is_at(place))
    }

    /// MP7224.0 disables its type: nobody sees it. The PLC's files have no such types.
    pub(super) fn is_disabled(&self, place: &Place) -> bool {
        place.drive() == TNC && self.types.is_disabled(ending(place.name().unwrap_or_default()))
    }

    /// A file of the control with this name has none: MP7222.
    pub(super) fn is_too_long(&self, place: &Place) -> bool {
        let named = place.name().and_then(|name| name.rsplit_once('.'));
        let of_control = |ending: &str| FILE_TYPES.iter().any(|own| own.eq_ignore_ascii_case(ending));
        let long = |stem: &str| self.name_max.is_some_and(|most| stem.chars().count() > most);
        place.drive() == TNC && named.is_some_and(|(stem, ending)| of_control(ending) && long(stem))
    }

    /// MP7224.1 protects its type: nobody changes it.
    pub(super) fn is_protected(&self, place: &Place) -> bool {
        place.drive() == TNC && self.types.is_protected(ending(place.name().unwrap_or_default()))
    }

    /// What is seen of the files in a folder, protected as their types are.
    pub(super) fn seen(&self, folder: &Place, entries: Vec<Entry>) -> Vec<Entry> {
        let mut entries = entries;
        if folder.drive() == TNC {
            entries
                .retain(|entry| entry.attributes.is_folder || !self.types.is_disabled(ending(&entry.name)));
            for entry in &mut entries {
                let by_type = !entry.attributes.is_folder && self.types.is_protected(ending(&entry.name));
                entry.attributes.protected |= by_type;
            }
        }
        entries
    }
}

/// What stands behind the point of a name.
fn ending(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(_, ending)| ending)
}
