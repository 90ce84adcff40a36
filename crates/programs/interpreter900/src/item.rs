//! What a run hands out.

use bahn_path::{Barrier, PathElement};

/// Of the path, or what the run waits for.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Element(PathElement),
    Barrier(Barrier),
}
