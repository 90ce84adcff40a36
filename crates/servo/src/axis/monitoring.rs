//! What is monitored of an axis.

use super::Axis;
use crate::fault::Fault;
use crate::monitor::Sample;

impl Axis {
    /// Switches the monitoring of lag, voltage, movement and standstill on or off: M2688 to M2692, MP4130
    /// [000:5162-5188].
    pub fn set_monitored(&mut self, monitored: bool) {
        self.monitored = monitored;
    }

    /// Its monitoring is not suppressed.
    pub fn is_monitored(&self) -> bool {
        self.monitored
    }

    /// A servo step: what the way, mm, and the voltage, V, show is raised.
    pub(super) fn watch(&mut self, standing: bool, way_mm: f64, volts: f64) {
        if let Some(fault) = self.offset.fault() {
            self.raise(Fault::Gross(fault));
        }
        self.residual_steps = self.residual_steps.saturating_sub(1);
        if !self.monitored {
            self.monitor.reset();
            return;
        }
        let sample = Sample {
            actual_mm: self.actual_mm,
            lag_mm: self.lag_mm(),
            way_mm,
            standing,
            in_position: self.in_position,
            velocity_mm_min: self.velocity_mm_min,
            volts,
            enabled: self.drives(),
        };
        let found = self
            .monitor
            .check(&sample, self.method, &self.parameters, &self.timing);
        if let Some(fault) = found {
            self.raise(fault);
        }
    }
}
