//! The offset voltage of a drive and its compensation, in all its forms [000:5002-5072].

use crate::fault::GrossFault;
use crate::timing::Timing;

/// From here on an offset is an error, V [000:5006].
const OFFSET_MAX_VOLTS: f64 = 0.1;
/// The offset in which the cyclic adjustment takes its large step, V [000:5032].
const LARGE_STEP_VOLTS: f64 = 0.001;
/// The integral factor that takes over the whole voltage of the loop in one contour cycle (inferred: the
/// unit of MP1080 is not given; 100 to start with takes it over in about two seconds).
const INTEGRAL_UNIT: f64 = 65_536.0;

/// What an axis knows of its drive's offset.
#[derive(Clone, Debug, Default)]
pub(crate) struct Offset {
    /// By code number or cycle.
    compensation_volts: f64,
    /// By integral factor; it holds while the axis moves.
    integral_volts: f64,
    /// What the loop puts out at rest, so what is not compensated yet.
    residual_volts: f64,
}

impl Offset {
    /// A contour cycle at rest, in which the loop puts a voltage out. A voltage that cannot be an offset, as
    /// of a clamped axis, is not integrated (inferred).
    pub(crate) fn rest(&mut self, loop_volts: f64, integral_factor: f64) {
        let part = if loop_volts.abs() < OFFSET_MAX_VOLTS {
            loop_volts * integral_factor / INTEGRAL_UNIT
        } else {
            0.0
        };
        self.integral_volts += part;
        self.residual_volts = loop_volts - part;
    }

    /// The voltage that the compensation adds, V.
    pub(crate) fn volts(&self) -> f64 {
        self.compensation_volts + self.integral_volts
    }

    pub(crate) fn compensation_volts(&self) -> f64 {
        self.compensation_volts
    }

    pub(crate) fn set_compensation(&mut self, volts: f64) {
        self.compensation_volts = volts;
    }

    /// The offset in units as it is shown.
    pub(crate) fn units(&self, timing: &Timing) -> i32 {
        (self.residual_volts / timing.offset_unit_volts()).round() as i32
    }

    /// Compensates all that is seen, unless the converter cannot resolve it.
    pub(crate) fn compensate(&mut self, timing: &Timing) {
        let step = timing.resolution_volts();
        if self.residual_volts.abs() >= step {
            self.add((self.residual_volts / step).round() * step);
        }
    }

    /// One adjustment: 1 mV when the offset is larger, else one step of the converter; one of 2.44 mV of a TNC 151/155
    /// always [001:2606].
    pub(crate) fn adjust(&mut self, timing: &Timing) {
        let resolution = timing.resolution_volts();
        let step = if self.residual_volts.abs() > LARGE_STEP_VOLTS {
            LARGE_STEP_VOLTS.max(resolution)
        } else {
            resolution
        };
        if self.residual_volts.abs() >= step {
            self.add(step.copysign(self.residual_volts));
        }
    }

    fn add(&mut self, volts: f64) {
        self.compensation_volts += volts;
        self.residual_volts -= volts;
    }

    pub(crate) fn fault(&self) -> Option<GrossFault> {
        (self.volts().abs() >= OFFSET_MAX_VOLTS).then_some(GrossFault::Offset)
    }
}

/// When the cyclic offset adjustment is due: each MP1220 seconds, if all axes stand, the spindle is off and
/// no axis is clamped; later if not (inferred) [000:5022-5037].
#[derive(Clone, Copy, Debug)]
pub struct OffsetInterval {
    interval_us: u64,
    elapsed_us: u64,
}

impl OffsetInterval {
    /// An interval in s; 0 never comes.
    pub fn new(interval_s: f64) -> OffsetInterval {
        OffsetInterval {
            interval_us: (interval_s * 1e6).round() as u64,
            elapsed_us: 0,
        }
    }

    /// The time has come, as soon as an adjustment is permitted: the axes have passed their marks [001:2602].
    pub fn come(&mut self) {
        self.elapsed_us = self.elapsed_us.max(self.interval_us);
    }

    /// Lets time pass, µs. True when all axes shall do [`Axis::adjust_offset`](crate::Axis::adjust_offset).
    pub fn pass(&mut self, micros: u32, permitted: bool) -> bool {
        self.elapsed_us = self.elapsed_us.saturating_add(micros.into());
        let due = self.interval_us > 0 && self.elapsed_us >= self.interval_us && permitted;
        if due {
            self.elapsed_us %= self.interval_us;
        }
        due
    }
}
