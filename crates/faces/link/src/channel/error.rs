//! Why a channel cannot be opened, and its speed when none is said.

use std::io;

use super::spec::Line;

/// Baud rate of a serial port when none is said, that of LSV/2 [000:17514-17540].
pub(super) const BAUD: u32 = 9600;

/// Why a channel cannot be opened.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}: {what}")]
pub struct ChannelError {
    /// What was to be opened.
    pub line: String,
    /// What the operating system says.
    pub what: String,
    /// Somebody else has it.
    pub is_taken: bool,
}

impl ChannelError {
    pub(super) fn of_system(line: &Line, error: &io::Error) -> ChannelError {
        ChannelError {
            line: line.to_string(),
            what: error.to_string(),
            is_taken: matches!(
                error.kind(),
                io::ErrorKind::AddrInUse | io::ErrorKind::ResourceBusy
            ),
        }
    }
}
