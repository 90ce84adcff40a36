//! What passes between control and machine.

use bahn_servo::{Commands, Measured};

/// What the machine was told last, and what it answered.
#[derive(Clone, Default)]
pub(crate) struct Seam {
    pub commands: Commands,
    pub measured: Measured,
}
