//! Files of a drive that lie elsewhere: the tool table of a machine as `TNC:\TOOL.T`, in the form of the control. They are
//! read and copied, nothing else.
//!
//! Decision: Tool and pocket table of machine.toml are shown to hosts as `TNC:\TOOL.T` and `TNC:\TOOL_P.TCH`, to be
//! read only: their form there is that of the control (also `service/src/tables.rs`)

use std::fmt;
use std::path::PathBuf;
use std::time::SystemTime;

use super::{Attributes, Place};

/// A file that is shown where it does not lie. A file of the same name on the drive itself comes first.
pub struct View {
    /// Where it is shown.
    pub place: Place,
    /// The file that it shows, for its time.
    pub source: PathBuf,
    /// Its bytes as they are now; `None` when there is none.
    pub bytes: Box<dyn Fn() -> Option<Vec<u8>> + Send + Sync>,
}

impl fmt::Debug for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.place, self.source.display())
    }
}

impl View {
    pub(super) fn attributes(&self) -> Option<Attributes> {
        let modified = std::fs::metadata(&self.source).and_then(|file| file.modified());
        Some(Attributes {
            size: (self.bytes)()?.len() as u64,
            modified: modified.unwrap_or(SystemTime::UNIX_EPOCH),
            protected: true,
            is_folder: false,
        })
    }

    /// It is what is meant by a place.
    pub(super) fn is_at(&self, place: &Place) -> bool {
        let same = |(one, other): (&String, &String)| one.eq_ignore_ascii_case(other);
        let names = (self.place.names(), place.names());
        self.place.drive() == place.drive()
            && names.0.len() == names.1.len()
            && names.0.iter().zip(names.1).all(same)
    }
}
