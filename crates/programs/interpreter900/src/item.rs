//! What a run hands out.

use bahn_path::{Barrier, PathElement};

/// Holds and stops that may wait after a movement for what comes next; when more come, it is handed out (inferred).
pub(crate) const WAITING_MAX: usize = 500;

/// Of the path, or what the run waits for.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Element(PathElement),
    Barrier(Barrier),
}
