//! Compensation of stiction [000:3935-3965].

use crate::settings::AxisSettings;
use crate::timing::Timing;

/// Counting steps of a grating period in which MP1512 counts [000:3957].
const STICTION_STEPS: f64 = 256.0;

/// What is added against stiction in a contour cycle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stiction {
    /// The velocity, mm/min.
    pub mm_min: f64,
    /// The lag at the beginning of the cycle.
    lag_mm: f64,
}

impl Stiction {
    /// A contour cycle begins with a lag. Additional velocity, mm/min: change of the lag in a cycle / cycle · kv · MP1511.
    /// "Feed" is read as the nominal velocity of the axis (inferred), the profile; without pre-control there is none.
    pub fn begin_cycle(
        &mut self,
        lag_mm: f64,
        (profile_mm_min, slope): (Option<f64>, f64),
        settings: &AxisSettings,
        timing: &Timing,
    ) {
        let change_mm = lag_mm - self.lag_mm;
        self.lag_mm = lag_mm;
        let compensation = &settings.compensation;
        let slow = |profile: f64| profile.abs() < compensation.stiction_feed_mm_min;
        if compensation.stiction_us == 0.0 || !profile_mm_min.is_some_and(slow) {
            self.mm_min = 0.0;
            return;
        }
        let encoder = &settings.encoder;
        let grating_mm = encoder.signal_period_um * f64::from(encoder.interpolation.max(1)) * 1e-3;
        let limit = compensation.stiction_limit_steps * grating_mm / STICTION_STEPS;
        let factor = compensation.stiction_us / f64::from(timing.contour_us());
        self.mm_min = change_mm.clamp(-limit, limit) * slope * factor;
    }
}
