//! The spindle led to an angle in every contour cycle: rigid tapping.
//!
//! Decision: In cycles 17 and 18 the loop of the spindle is open while its nominal angle moves; when it stands, the
//! loop brings it to its angle and holds it, fading in and out

use super::settings::SpindleSettings;

use crate::interpolation::{FineInterpolation, Transient};
use crate::timing::Timing;

/// Slower than this the spindle has come to a standstill, rpm (inferred).
const STANDS_RPM: f64 = 1.0;

/// When the loop opens or closes, what it adds fades out or in by this in a servo step, so that the voltage does not
/// jump (inferred).
const FADING: f64 = 0.9;

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
    /// The loop is closed: only while the spindle stands.
    closed: bool,
    /// What the loop adds to the velocity, degrees/min.
    held_deg_min: f64,
}

impl Lead {
    pub(super) fn new(settings: &SpindleSettings, timing: &Timing) -> Lead {
        let settings = &settings.lead;
        Lead {
            fine: FineInterpolation::new(timing.steps()),
            acceleration: Transient::new(timing.steps(), entry(settings.transient)),
            run_in: Transient::new(timing.steps(), entry(settings.run_in_deg_min)),
            velocity_deg_min: 0.0,
            profile_deg_min: 0.0,
            closed: true,
            held_deg_min: 0.0,
        }
    }

    pub(super) fn configure(&mut self, settings: &SpindleSettings, timing: &Timing) {
        let settings = &settings.lead;
        self.acceleration
            .set_entry(timing.steps(), entry(settings.transient));
        self.run_in
            .set_entry(timing.steps(), entry(settings.run_in_deg_min));
    }

    /// Begins at an angle, standing, with the velocity that the loop before put out to hold it, degrees/min.
    pub(super) fn begin(&mut self, angle_deg: f64, held_deg_min: f64) {
        self.fine.set(angle_deg);
        self.acceleration.set(angle_deg);
        self.run_in.set(angle_deg);
        (self.velocity_deg_min, self.profile_deg_min) = (0.0, 0.0);
        (self.closed, self.held_deg_min) = (true, held_deg_min);
    }

    /// The angle for the end of the contour cycle that begins.
    pub(super) fn command(&mut self, angle_deg: f64) {
        self.fine.command(angle_deg);
    }

    /// One servo step from where the spindle is, and how fast; the slope of its loop is kv, 1/min.
    ///
    /// While the nominal angle moves the loop is open [000:6122]: what the drive lags behind the loop would add to the
    /// speed, and the spindle would turn beyond its end, which is to be avoided [000:6128]. When the spindle has come to
    /// a standstill, the loop brings it to its angle and holds it (inferred).
    pub(super) fn step(&mut self, turned_deg: f64, rpm: f64, slope: f64, timing: &Timing) {
        let now = self.run_in.now();
        let rough = self.fine.advance();
        let next = self.run_in.advance(self.acceleration.advance(rough));
        self.profile_deg_min = (next - now) / timing.step_min();
        let stands = self.closed || rpm.abs() < STANDS_RPM;
        self.closed = self.profile_deg_min == 0.0 && stands;
        let wanted = if self.closed {
            slope * (now - turned_deg)
        } else {
            0.0
        };
        self.held_deg_min = wanted + (self.held_deg_min - wanted) * FADING;
        self.velocity_deg_min = self.profile_deg_min + self.held_deg_min;
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
