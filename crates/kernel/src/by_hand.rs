//! Single axes by hand: what is told of their software limits.

use crate::axis::{AxisId, Direction};

/// An axis comes to its software limit, or leaves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AtLimit {
    /// It stands at it.
    Reached(AxisId, Direction),
    /// It stands there no more.
    Left(AxisId, Direction),
}
