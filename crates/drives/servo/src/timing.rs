//! What the servo needs to know of the control: its cycles and its output converter.

use crate::rounding::round;

/// Greatest voltage of a nominal value output, V [000:4863].
pub const OUTPUT_VOLTS: f64 = 10.0;
/// Microseconds of a minute.
const MINUTE_US: f64 = 60e6;

/// Cycles and output resolution of a control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    contour_us: u32,
    steps: u32,
    step_us: u32,
    /// What follows from these, since every servo step of every axis asks for it.
    resolution_volts: f64,
    step_min: f64,
    contour_min: f64,
}

impl Timing {
    /// A contour cycle of so many microseconds in so many servo steps, and a converter of so many
    /// bits for 10 V of either sign.
    pub fn new(contour_us: u32, steps: u32, output_bits: u8) -> Timing {
        let steps = steps.max(1);
        Timing {
            contour_us,
            steps,
            step_us: contour_us / steps,
            resolution_volts: OUTPUT_VOLTS / f64::from(1u32 << output_bits.min(30)),
            step_min: f64::from(contour_us / steps) / MINUTE_US,
            contour_min: f64::from(contour_us) / MINUTE_US,
        }
    }

    /// The contour cycle, µs.
    pub fn contour_us(&self) -> u32 {
        self.contour_us
    }

    /// A servo step, µs.
    pub fn step_us(&self) -> u32 {
        self.step_us
    }

    /// Servo steps of a contour cycle.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    /// Smallest step of the output voltage, V: 0.15 mV with 16 bits, 0.6 mV with 14 [000:4863].
    pub fn resolution_volts(&self) -> f64 {
        self.resolution_volts
    }

    /// The unit in which offsets are shown, V: 0.15 mV [000:5016]; a step of the converter, 2.44 mV, where that has 12 bits
    /// [001:2577].
    pub fn offset_unit_volts(&self) -> f64 {
        const FINE_VOLTS: f64 = OUTPUT_VOLTS / 65_536.0;
        const COARSE_VOLTS: f64 = OUTPUT_VOLTS / 4096.0;
        match self.resolution_volts >= COARSE_VOLTS {
            true => self.resolution_volts,
            false => FINE_VOLTS,
        }
    }

    /// The voltage that the converter makes of a nominal value, V: a multiple of the resolution, at most
    /// 10 V of either sign; 0 V for what is no number.
    pub fn convert(&self, volts: f64) -> f64 {
        if volts.is_nan() {
            return 0.0;
        }
        round(volts.clamp(-OUTPUT_VOLTS, OUTPUT_VOLTS) / self.resolution_volts) * self.resolution_volts
    }

    pub(crate) fn step_min(&self) -> f64 {
        self.step_min
    }

    pub(crate) fn contour_min(&self) -> f64 {
        self.contour_min
    }

    /// Servo steps of a time in s.
    pub(crate) fn steps_of(&self, seconds: f64) -> u32 {
        (seconds * 1e6 / f64::from(self.step_us())).round() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_converter_steps_as_the_manual_says() {
        // 10 V / 65 536 = 0.15 mV, 10 V / 16 384 = 0.6 mV [000:4863].
        let tnc415 = Timing::new(3000, 5, 16);
        assert!((tnc415.resolution_volts() * 1e3 - 0.1526).abs() < 1e-4);
        let tnc407 = Timing::new(6000, 1, 14);
        assert!((tnc407.resolution_volts() * 1e3 - 0.6104).abs() < 1e-4);
        assert_eq!(tnc407.convert(0.000_3), 0.0);
        assert_eq!(tnc407.convert(-0.000_4), -tnc407.resolution_volts());
        assert_eq!(tnc415.convert(12.0), 10.0);
        assert_eq!((tnc415.steps(), tnc415.step_us()), (5, 600));
        assert_eq!((tnc407.steps(), tnc407.step_us()), (1, 6000));
    }
}
