//! What a line for LinuxCNC can say.

use bahn_path::{Curve, FeedRate, Position, SpindleOrder, Switch};

/// One thing that a line says.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Said {
    /// A line or an arc.
    Move {
        curve: Curve,
        start: Position,
        end: Position,
        feed: FeedRate,
    },
    /// A movement that follows the spindle; a tap comes back.
    Thread {
        start: Position,
        end: Position,
        pitch_mm: f64,
        returns: bool,
    },
    Dwell(f64),
    /// The tool that comes next.
    Next(u32),
    /// The tool is changed.
    Change,
    Speed(f64),
    Spindle(SpindleOrder),
    Coolant(Switch),
    Orient(f64),
    /// Whether the overrides act.
    Overrides(Switch),
    Stop {
        optional: bool,
    },
    Print(String),
    /// A function of LinuxCNC's user, M100 to M199.
    User(u16),
    /// What cannot be said: the program stops there.
    Refused(String),
    End,
}

impl Said {
    /// Whether the machine may stand elsewhere after it: at its tool changer, or where somebody has moved it.
    pub fn may_move_the_machine(&self) -> bool {
        matches!(
            self,
            Said::Change | Said::Stop { .. } | Said::User(_) | Said::Refused(_)
        )
    }
}
