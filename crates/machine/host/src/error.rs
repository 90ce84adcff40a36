//! What cannot be done, and why.

use bahn_tnc::ChannelError;
use thiserror::Error;

/// Why something cannot be done.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum HostError {
    /// The folder of a state that another process has.
    #[error("{0}: the machine is switched on already")]
    SwitchedOn(String),
    /// The channels cannot be put together.
    #[error("the channels of the machine do not fit: {0}")]
    Channels(#[from] ChannelError),
    /// Of so many channels beside the first one the machine knows so many at power-on.
    #[error("the machine has {0} channels beside the first one, and {1} of them are switched on")]
    ChannelsMissing(usize, usize),
    /// The folder describes no simulated machine, and no other plant was given.
    #[error("{0}: the folder describes no simulated machine (`plant` in machine.toml)")]
    NotSimulated(String),
    /// Too many orders wait.
    #[error("too many orders wait")]
    Busy,
    /// What survives power-off cannot be stored; why.
    #[error("{0}")]
    NotStored(String),
    /// The machine cannot do what it is told; why.
    #[error("{0}")]
    Impossible(String),
    /// A run that is logged goes forward only.
    #[error("a run that is logged does not go back")]
    Logged,
    /// A plant without copies stays where it is.
    #[error("this machine does not go back: it is no simulated one")]
    StaysWhereItIs,
    /// What was done since a saved state is not known any more.
    #[error("what was done since is not known any more")]
    Forgotten,
    /// Something urgent broke off what was repeated: the machine is at an earlier moment than was asked for.
    #[error("what was to be repeated was broken off")]
    BrokenOff,
    /// A file cannot be read, written or used; which one and why.
    #[error("{0}")]
    File(String),
}

impl HostError {
    /// A file cannot be used; in words.
    pub(crate) fn new(text: impl Into<String>) -> HostError {
        HostError::File(text.into())
    }
}
