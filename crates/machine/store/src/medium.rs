//! What a store has its files on.

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::views::View;
use super::{InUse, Place};

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
        self.views.iter().find(|view| view.is_at(place))
    }
}
