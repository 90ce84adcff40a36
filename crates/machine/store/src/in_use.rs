//! Files that are left as they are because the machine has them in use.

use std::fmt;

use super::Place;

/// What is to become of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It gets another content.
    Content,
    /// There is no file of its name any more.
    Name,
}

/// Says of a file whether the machine has it in use, so that this cannot be done to it now.
pub struct InUse(pub Box<Question>);

/// Whether a file must stay as it is: this change cannot be made now.
type Question = dyn Fn(&Place, Change) -> bool + Send + Sync;

impl InUse {
    /// Of files that no machine has.
    pub fn never() -> InUse {
        InUse(Box::new(|_, _| false))
    }
}

impl fmt::Debug for InUse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("InUse")
    }
}
