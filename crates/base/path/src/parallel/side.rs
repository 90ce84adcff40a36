//! The side of a tool.

use crate::Sense;

/// Side of the tool, seen in the direction of travel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The centre of the tool is on the contour.
    #[default]
    Off,
    /// To the left of it.
    Left,
    /// To the right of it.
    Right,
}

impl Side {
    /// +1 left, -1 right, 0 off.
    pub fn sign(self) -> f64 {
        match self {
            Side::Off => 0.0,
            Side::Left => 1.0,
            Side::Right => -1.0,
        }
    }

    /// The sense of an arc about a point on this side.
    pub fn sense(self) -> Sense {
        Sense::of_sweep(self.sign())
    }

    /// The side in a mirrored system.
    #[must_use]
    pub fn mirrored(self) -> Side {
        match self {
            Side::Off => Side::Off,
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }
}
