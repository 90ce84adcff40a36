//! What follows from the settings of an axis and its method alone.

use crate::settings::AxisSettings;
use crate::timing::Timing;

/// Counting steps in a contour cycle, and steps of the converter, up to which an axis cannot be told from one that
/// stands (inferred).
const STANDING_STEPS: f64 = 1.5;

/// What follows from settings and method alone, so that no servo step has to find it again.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fixed {
    /// Voltage of a velocity, V/(mm/min).
    pub volts_per_mm_min: f64,
    /// What a step leaves of a velocity that runs down with the lag.
    pub decay: f64,
    /// The velocity that a loop at rest goes to and fro with, for neither encoder nor converter is finer, mm/min.
    pub standing_mm_min: f64,
}

impl Fixed {
    /// Of an axis whose characteristic has a slope, 1/min, and whose encoder a measuring step, mm.
    pub fn of(settings: &AxisSettings, timing: &Timing, slope: f64, measuring_step_mm: f64) -> Fixed {
        let rapid = settings.motion.rapid_mm_min;
        let volts = settings.output.rapid_volts;
        let seen = measuring_step_mm / timing.contour_min();
        // A digital drive is not told a voltage: MP1050 is inactive [000:18360-18362].
        let resolved = match settings.digital {
            Some(_) => 0.0,
            None => timing.resolution_volts() * (rapid / volts),
        };
        Fixed {
            volts_per_mm_min: volts / rapid,
            decay: (1.0 - slope * timing.step_min()).max(0.0),
            standing_mm_min: STANDING_STEPS * seen.max(resolved),
        }
    }
}
