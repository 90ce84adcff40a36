//! What holds for all that is done in a contour cycle.

use crate::command::Mode;
use bahn_kernel::{Direction, Wheels};
use bahn_parameters::PerPlcAxis;

/// What the machine side says of now.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facts {
    /// The contour cycle, s.
    pub time_s: f64,
    /// Time since power-on, µs.
    pub us: u64,
    /// The control voltage is on.
    pub ready: bool,
    /// The loops were closed since it came on.
    pub loops_closed: bool,
    /// A flashing message is shown, or a loop of the channel has a fault.
    pub fault: bool,
}

/// What holds for all that is done in a contour cycle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now {
    /// The contour cycle, s.
    pub time_s: f64,
    /// Time since power-on, µs.
    pub us: u64,
    pub mode: Mode,
    /// NC start was pressed and not yet used.
    pub start: bool,
    /// NC stop is given by the PLC, the circuit, a flashing message or a fault of an axis.
    pub stop: bool,
    /// A flashing message is shown, or a loop of the channel has a fault.
    pub fault: bool,
    /// The PLC gives NC stop (M2488 = 0).
    pub stop_pressed: bool,
    /// The control voltage is on: nothing is stopped for good.
    pub ready: bool,
    /// The loops were closed since the control voltage came on.
    pub loops_closed: bool,
    /// Feed override, %: for itself, and as it acts on programs.
    pub feed_percent: f64,
    pub program_percent: f64,
    /// The direction keys that are pressed, by axis index.
    pub axis_keys: PerPlcAxis<Option<Direction>>,
    /// What the handwheel was turned for M118 in this cycle, by axis index, mm.
    pub wheel_mm: PerPlcAxis<f64>,
    /// Rapid traverse as PLC and probe limit it, mm/min.
    pub rapid_limit_mm_min: f64,
}

impl Now {
    /// What leads the axes beside the path.
    pub fn wheels(&self) -> Wheels<'_> {
        Wheels {
            turned_mm: &self.wheel_mm,
            rapid_limit_mm_min: self.rapid_limit_mm_min,
            time_s: self.time_s,
            fault: self.fault,
        }
    }
}
