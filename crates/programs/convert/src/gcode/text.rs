//! What writing and reading a text have in common.

use bahn_path::{Axis, Position};

/// The number of turns of an arc, at least 1.
pub(super) fn turns(sweep_deg: f64) -> u32 {
    /// So much more than a full turn is rounding.
    const ROUNDING_DEG: f64 = 1e-6;
    ((sweep_deg.abs() - ROUNDING_DEG) / 360.0).ceil().max(1.0) as u32
}

/// Whether only rotary axes move: F is then in degrees.
pub(super) fn turns_only(start: &Position, end: &Position) -> bool {
    let moved = |axis: &Axis| end[*axis].is_finite() && start[*axis] != end[*axis];
    let moving = || Axis::ALL.into_iter().filter(moved);
    moving().next().is_some() && moving().all(Axis::is_rotary)
}

/// Text without what ends or opens a comment.
pub(super) fn bare(text: &str) -> String {
    let allowed = |c: char| {
        if matches!(c, '(' | ')' | ';' | '%') || c.is_control() {
            ' '
        } else {
            c
        }
    };
    text.chars().map(allowed).collect::<String>().trim().to_owned()
}
