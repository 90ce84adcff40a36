//! A copy of a machine's folder, for the tests of this crate and of those above it.

use std::path::Path;

/// Copies a folder, without what a control in it remembers.
#[allow(
    clippy::unwrap_used,
    reason = "what fails in the support of tests fails the test"
)]
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true if entry.file_name() == "state" => {}
            true => copy(&entry.path(), &target),
            false => drop(std::fs::copy(entry.path(), target).unwrap()),
        }
    }
}
