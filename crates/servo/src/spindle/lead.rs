//! The spindle led to an angle in every contour cycle: rigid tapping.

use bahn_parameters::spindle::SpindleParameters;

use crate::interpolation::{FineInterpolation, Transient};
use crate::timing::Timing;

/// Nominal angle and velocity of a spindle that is led. The corners of the velocity are rounded by two means
/// over time, of the run-in MP7130 and of the response on acceleration MP7140, each as MP1520 does it for axes.
/// A mean does not tell accelerating from running in: each rounds both (inferred) [000:6128] [000:6138-6139].
#[derive(Clone, Debug)]
pub(super) struct Lead {
    fine: FineInterpolation,
    acceleration: Transient,
    run_in: Transient,
    velocity_deg_min: f64,
    profile_deg_min: f64,
}

impl Lead {
    pub(super) fn new(parameters: &SpindleParameters, timing: &Timing) -> Lead {
        let tapping = &parameters.tapping;
        Lead {
            fine: FineInterpolation::new(timing.steps()),
            acceleration: Transient::new(timing.steps(), entry(tapping.transient)),
            run_in: Transient::new(timing.steps(), entry(tapping.run_in_deg_min)),
            velocity_deg_min: 0.0,
            profile_deg_min: 0.0,
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &SpindleParameters, timing: &Timing) {
        let tapping = &parameters.tapping;
        self.acceleration
            .set_entry(timing.steps(), entry(tapping.transient));
        self.run_in
            .set_entry(timing.steps(), entry(tapping.run_in_deg_min));
    }

    /// Begins at an angle, standing.
    pub(super) fn begin(&mut self, angle_deg: f64) {
        self.fine.set(angle_deg);
        self.acceleration.set(angle_deg);
        self.run_in.set(angle_deg);
        (self.velocity_deg_min, self.profile_deg_min) = (0.0, 0.0);
    }

    /// The angle for the end of the contour cycle that begins.
    pub(super) fn command(&mut self, angle_deg: f64) {
        self.fine.command(angle_deg);
    }

    /// One servo step from where the spindle is; the slope of its loop is kv, 1/min.
    pub(super) fn step(&mut self, turned_deg: f64, slope: f64, timing: &Timing) {
        let now = self.run_in.now();
        let rough = self.fine.advance();
        let next = self.run_in.advance(self.acceleration.advance(rough));
        self.profile_deg_min = (next - now) / timing.step_min();
        self.velocity_deg_min = self.profile_deg_min + slope * (now - turned_deg);
    }

    /// Where it is led to, degrees.
    pub(super) fn target_deg(&self) -> f64 {
        self.fine.end()
    }

    /// Velocity of the nominal value, degrees/min.
    pub(super) fn velocity_deg_min(&self) -> f64 {
        self.velocity_deg_min
    }

    /// Velocity of the nominal angle, degrees/min.
    pub(super) fn profile_deg_min(&self) -> f64 {
        self.profile_deg_min
    }
}

/// The entry of a transient response; without one it is infinite and rounds nothing.
fn entry(value: f64) -> f64 {
    if value > 0.0 { value } else { f64::INFINITY }
}
