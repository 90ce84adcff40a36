//! Movement monitoring of a spindle that is led: whether it turns as it is told.
//!
//! The manual monitors axes alone [000:5266-5287]. In a thread the tool axis goes wherever the spindle turns, and so does what
//! a drive or an encoder does wrong: it is monitored there, too (inferred). Its loop is open [000:6122], and how much the drive
//! lags nobody knows; but a drive without overshoot turns no faster than the fastest that it was told lately, and no slower
//! than the slowest. One whose ramp is steeper than its drive can follow does, and that is what commissioning looks at
//! [000:6128]: while it goes on towards the speed that it is told, it is not at fault.
//!
//! Decision: A spindle that is led along a thread is monitored as an axis is by MP1140, for the tool axis goes
//! wherever it turns: GROSS POSITIONING ERROR C of S when it has turned by MP1110 of the tool axis beside what a
//! drive does with a time constant of 0.1 s on the ramp MP3410.3, half as fast again or half as slow; not in an
//! EMERGENCY STOP, and not where the PLC suppresses the monitoring of the tool axis (also `kernel/src/thread.rs`)

use crate::monitor::{MOVEMENT_TOLERANCE, MOVEMENT_WINDOW_S};
use crate::timing::Timing;

/// A drive goes on towards its speed when it would reach it within this time, s (inferred).
const REACHED_WITHIN_S: f64 = 5.0;
/// Over this time the acceleration is taken, s: several contour cycles, since the speed is that of one.
const ACCELERATION_S: f64 = 0.02;

/// Speeds between which a sound spindle turns, degrees/min, and how far it is beside them.
#[derive(Clone, Debug, Default)]
pub(super) struct Movement {
    least: f64,
    greatest: f64,
    beside_deg: f64,
    /// The speed of the step before, and how fast it changes, degrees/min and degrees/min for each s.
    actual: f64,
    acceleration: f64,
}

impl Movement {
    /// Begins anew with a spindle that turns at a speed, degrees/min.
    pub(super) fn begin(&mut self, actual: f64) {
        (self.least, self.greatest, self.beside_deg) = (actual, actual, 0.0);
        (self.actual, self.acceleration) = (actual, 0.0);
    }

    /// A servo step with the speed that is told and the actual one, degrees/min. How far the spindle has turned beside what
    /// it was told, degrees: a time constant of [`MOVEMENT_WINDOW_S`], the `ramp` of rigid tapping (degrees/min², 0 for none) and
    /// [`MOVEMENT_TOLERANCE`] are its own.
    pub(super) fn step(&mut self, commanded: f64, actual: f64, ramp: f64, timing: &Timing) -> f64 {
        let step_min = timing.step_min();
        let part = step_min * 60.0 / MOVEMENT_WINDOW_S;
        let most = if ramp > 0.0 {
            ramp * step_min
        } else {
            f64::INFINITY
        };
        self.greatest = commanded.max(self.greatest - ((self.greatest - commanded) * part).min(most));
        self.least = commanded.min(self.least + ((commanded - self.least) * part).min(most));
        let least = self.least - self.least.abs() * MOVEMENT_TOLERANCE;
        let greatest = self.greatest + self.greatest.abs() * MOVEMENT_TOLERANCE;
        let beside = actual - actual.clamp(least, greatest);
        let changed = (actual - self.actual) / (step_min * 60.0);
        self.acceleration += (changed - self.acceleration) * step_min * 60.0 / ACCELERATION_S;
        self.actual = actual;
        let off = commanded - actual;
        let goes_on = self.acceleration * off.signum() * REACHED_WITHIN_S >= off.abs();
        self.beside_deg = match beside == 0.0 || goes_on {
            true => 0.0,
            false => self.beside_deg + beside * step_min,
        };
        self.beside_deg.abs()
    }
}
