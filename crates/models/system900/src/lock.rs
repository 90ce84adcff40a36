//! What locks close.

use std::fmt;

use crate::name::Name;
use crate::numbers::ACTIVE_LOCKS;

/// Something that a lock closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lock {
    /// Parameters that have this lock in their status, 1 to 4.
    Parameters(u8),
    /// The NC memory.
    Programs,
    /// The cycles in it.
    Cycles,
    /// Editing of values.
    Values,
    /// Editing of statuses.
    Statuses,
    /// Editing of the data of axes, spindles and couplings.
    Axes,
    /// Editing of zero points.
    ZeroPoints,
    /// Editing of tools.
    Tools,
    /// The editor cannot be left.
    Editor,
}

impl Lock {
    /// All of them.
    pub const ALL: [Lock; 12] = [
        Lock::Parameters(1),
        Lock::Parameters(2),
        Lock::Parameters(3),
        Lock::Parameters(4),
        Lock::Programs,
        Lock::Cycles,
        Lock::Values,
        Lock::Statuses,
        Lock::Axes,
        Lock::ZeroPoints,
        Lock::Tools,
        Lock::Editor,
    ];

    /// Its bit in the word of a definition [002:5318-5365]; its active lock is the parameter as far behind P11020
    /// [002:5370-5417].
    pub(crate) fn bit(self) -> u32 {
        match self {
            Lock::Parameters(lock) => u32::from(lock.clamp(1, 4)) - 1,
            Lock::Programs => 16,
            Lock::Cycles => 17,
            Lock::Values => 24,
            Lock::Statuses => 25,
            Lock::Axes => 26,
            Lock::ZeroPoints => 27,
            Lock::Tools => 28,
            Lock::Editor => 29,
        }
    }

    /// The parameter that says whether it is active: P11020 to P11049.
    pub fn parameter(self) -> Name {
        Name::P(1, ACTIVE_LOCKS + self.bit())
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Lock::Parameters(1) => "parameter lock 1",
            Lock::Parameters(2) => "parameter lock 2",
            Lock::Parameters(3) => "parameter lock 3",
            Lock::Parameters(_) => "parameter lock 4",
            Lock::Programs => "the lock of the NC memory",
            Lock::Cycles => "the lock of the cycles",
            Lock::Values => "the editing lock of values",
            Lock::Statuses => "the editing lock of statuses",
            Lock::Axes => "the editing lock of axes, spindles and couplings",
            Lock::ZeroPoints => "the editing lock of zero points",
            Lock::Tools => "the editing lock of tools",
            Lock::Editor => "the lock of the editor",
        }
    }
}

impl fmt::Display for Lock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}
