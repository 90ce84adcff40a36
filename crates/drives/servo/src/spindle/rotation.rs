//! In which direction the spindle turns.

/// Direction of the spindle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotation {
    /// Clockwise: M2485.
    M3,
    /// Counterclockwise: M2486.
    M4,
    /// Off: M2487.
    M5,
}

impl Rotation {
    /// Its sign: positive clockwise.
    pub(super) fn sign(self) -> f64 {
        match self {
            Rotation::M3 => 1.0,
            Rotation::M4 => -1.0,
            Rotation::M5 => 0.0,
        }
    }
}
