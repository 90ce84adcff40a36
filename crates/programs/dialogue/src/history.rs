//! Undo and redo, which the control does not have.

use std::sync::Arc;

use bahn_program::Program;

/// Most steps that are kept. Versions share what stays the same.
const STEPS_MAX: usize = 1000;

/// A version of a program with the block at the cursor.
type Version = (Arc<Program>, u32);

/// Versions before and after the one at hand.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    before: Vec<Version>,
    after: Vec<Version>,
}

impl History {
    /// Keeps a version that is about to change.
    pub(crate) fn keep(&mut self, program: &Arc<Program>, cursor: u32) {
        if self.before.len() >= STEPS_MAX {
            self.before.remove(0);
        }
        self.before.push((Arc::clone(program), cursor));
        self.after.clear();
    }

    /// The version before, in exchange for the one at hand.
    pub(crate) fn undo(&mut self, program: &Arc<Program>, cursor: u32) -> Option<Version> {
        let version = self.before.pop()?;
        self.after.push((Arc::clone(program), cursor));
        Some(version)
    }

    /// The version that was undone last, in exchange for the one at hand.
    pub(crate) fn redo(&mut self, program: &Arc<Program>, cursor: u32) -> Option<Version> {
        let version = self.after.pop()?;
        self.before.push((Arc::clone(program), cursor));
        Some(version)
    }
}
