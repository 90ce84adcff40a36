//! What holds for all that moves axes in a contour cycle.

use bahn_parameters::PerPlcAxis;
use bahn_path::Direction;

use crate::superimposing::Wheels;

/// What holds for all that is done in a contour cycle.
#[derive(Clone, Copy, Debug)]
pub struct Now {
    /// The contour cycle, s.
    pub time_s: f64,
    /// Time since power-on, µs.
    pub us: u64,
    /// NC start was pressed and not yet used.
    pub start: bool,
    /// NC stop is given: by the operator, the circuit, a message that stops the machine or a fault of an axis.
    pub stop: bool,
    /// A message that stops the machine is shown, or a loop of the channel has a fault.
    pub fault: bool,
    /// The operator gives NC stop.
    pub stop_pressed: bool,
    /// The control voltage is on: nothing is stopped for good.
    pub ready: bool,
    /// The loops were closed since the control voltage came on.
    pub loops_closed: bool,
    /// Feed override, %: for itself.
    pub feed_percent: f64,
    /// Feed override as it acts on programs, %.
    pub program_percent: f64,
    /// Programs run at rapid traverse, whatever their feed.
    pub program_rapid: bool,
    /// The direction keys that are pressed, by axis index.
    pub axis_keys: PerPlcAxis<Option<Direction>>,
    /// What the handwheel was turned in this cycle to lead axes beside the path, by axis index, mm.
    pub wheel_mm: PerPlcAxis<f64>,
    /// Rapid traverse as it is limited now, mm/min.
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
