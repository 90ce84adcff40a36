//! What a key did.

use bahn_parameters::MessageId;
use bahn_path::Axis;

/// What a key did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// What is shown has changed, the program has not.
    Shown,
    /// The program has changed.
    Edited,
    /// The key was refused with a message, which is shown.
    Refused(MessageId),
    /// The actual position is wanted; [`Editor::capture`] or [`Editor::capture_block`] gives it.
    Position(Wanted),
    /// The editor does not use the key.
    Passed,
}

/// Which actual position is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// That of an axis, for the coordinate that is being entered.
    Axis(Axis),
    /// That of the tool axis, for a length.
    ToolAxis,
    /// Those of the axes chosen by MOD, for a new L block [003:2260-2321].
    Block,
}
