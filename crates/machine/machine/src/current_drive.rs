//! A drive that follows its voltage as torque, and the encoder of its motor: what a TNC 425 closes the speed loop of
//! [000:18329-18333].
//!
//! Decision: A drive that goes on without control voltage does so only while the control is ready: without it nobody
//! gives torque, and its brake closes

use bahn_servo::Encoder;
use bahn_servo::rounding::floor_to_i64;

use crate::reader::Section;

/// Volts at which the drive gives its greatest current.
const FULL_VOLTS: f64 = 10.0;

/// A drive by current: the section `[axis.X.current_drive]`.
#[derive(Clone, Debug)]
pub(crate) struct CurrentDrive {
    /// Force of the axis for 1 V, N or Nm.
    force_per_volt: f64,
    /// Mass that the rotor adds to the axis, kg or kg m².
    pub mass: f64,
    /// Share of the difference that the current makes up in a step.
    follows: f64,
    /// Counting steps of the motor's encoder for 1 mm or degree.
    steps_per_unit: f64,
    /// So long it goes on without control voltage, ms, and what is left of it.
    off_delay_ms: u32,
    left_ms: u32,
    force: f64,
}

impl CurrentDrive {
    /// Reads the table; `rotary` axes have degrees for mm.
    pub fn read(section: &Section, rotary: bool, step_s: f64) -> CurrentDrive {
        let pitch = section.needed_number("pitch", 0.001..=100_000.0);
        // Turns of the motor for the unit of force: N m of work in a metre, or in a radian.
        let ratio = if rotary {
            360.0 / pitch
        } else {
            std::f64::consts::TAU / (pitch * 1e-3)
        };
        let constant = section.needed_number("torque_constant", 1e-6..=1e6);
        let current = section.needed_number("current", 1e-3..=1e5);
        let inertia = section.number("inertia", 0.0..=1e6).unwrap_or(0.0);
        let time = section.number("time_constant_ms", 0.0..=1000.0).unwrap_or(0.0) / 1000.0;
        let lines = section.needed_number("lines", 1.0..=1e6);
        let sense = |key| {
            if section.flag(key).unwrap_or(false) {
                -1.0
            } else {
                1.0
            }
        };
        CurrentDrive {
            force_per_volt: sense("reversed") * constant * current * ratio / FULL_VOLTS,
            mass: inertia * ratio * ratio,
            follows: 1.0 - (-step_s / time).exp(),
            steps_per_unit: sense("encoder_reversed") * lines * Encoder::MOTOR_STEPS as f64 / pitch,
            off_delay_ms: section.number("off_delay_ms", 0.0..=10_000.0).unwrap_or(0.0) as u32,
            left_ms: 0,
            force: 0.0,
        }
    }

    /// Whether it has power in this millisecond: for a while without control voltage, as long as the control is ready.
    pub fn holds(&mut self, powered: bool, control_ready: bool) -> bool {
        self.left_ms = match (powered, control_ready) {
            (true, _) => self.off_delay_ms,
            (false, true) => self.left_ms.saturating_sub(1),
            (false, false) => 0,
        };
        powered || self.left_ms > 0
    }

    /// No power: no current.
    pub fn rest(&mut self) {
        self.force = 0.0;
    }

    /// The force after a step, N or Nm.
    #[inline]
    pub fn force(&mut self, volts: f64) -> f64 {
        let wanted = volts.clamp(-FULL_VOLTS, FULL_VOLTS) * self.force_per_volt;
        self.force += (wanted - self.force) * self.follows;
        self.force
    }

    /// The travel of the motor at which its encoder has counted so much, mm or degrees.
    pub fn travel(&self, count: i64) -> f64 {
        count as f64 / self.steps_per_unit
    }

    /// What the motor's encoder has counted at a travel of the motor, mm or degrees.
    pub fn count(&self, travel: f64) -> i64 {
        floor_to_i64(travel * self.steps_per_unit)
    }
}
