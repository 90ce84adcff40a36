//! How far the current element is executed.

use crate::gate::Gate;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Phase {
    /// Its functions at the start are still to be output.
    Begin,
    /// The path waits at a gate.
    Gate(Gate),
    Move,
    /// Dwell to go, s.
    Dwell(f64),
    /// Its functions at the end are still to be output.
    Finish,
    /// The element is executed.
    Done,
    /// Executed; single block waits.
    BlockEnd,
    /// Executed, and single block does not wait any more.
    Over,
}

impl Phase {
    /// Nothing of the element is left.
    pub(super) fn is_executed(self) -> bool {
        matches!(self, Phase::Done | Phase::BlockEnd | Phase::Over)
    }
}
