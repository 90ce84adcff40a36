//! What the channel does at places of the path beside functions.

use crate::report::Fault;

/// What is done at a place.
#[derive(Clone, Debug)]
pub(crate) enum Own {
    /// An axis starts on its own.
    Independent(Box<bahn_din::Independent>),
    /// The path stands until all axes have ended that move on their own.
    AllEnded,
    /// The program cannot go on.
    Fault(Box<Fault>),
    /// The program is at its end.
    End,
}
