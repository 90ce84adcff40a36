//! The offsets of the drives, adjusted by the cycle and by the operator [000:5002-5072] [001:2573-2610].

use bahn_servo::OffsetInterval;

use crate::axes::Axes;
use crate::axis::AxisUnit;

/// The offsets of the drives.
#[derive(Clone, Debug)]
pub struct DriveOffsets {
    /// When they are adjusted next (MP1220).
    interval: OffsetInterval,
    /// All axes have passed their marks.
    referenced: bool,
    /// Code number 75 368 shows them.
    pub shown: bool,
}

impl DriveOffsets {
    /// Offsets that are adjusted each interval, s; 0 for never.
    pub fn new(interval_s: f64) -> DriveOffsets {
        DriveOffsets {
            interval: OffsetInterval::new(interval_s),
            referenced: false,
            shown: false,
        }
    }

    /// The interval has changed, s.
    pub fn set_interval(&mut self, interval_s: f64) {
        self.interval = OffsetInterval::new(interval_s);
    }

    /// The cyclic offset adjustment: all axes stand in their loops, the spindle is off. An axis with
    /// integral factor does without [000:5012] [000:5022-5037]. Controls with patience adjust outside the window, too,
    /// and once the axes have passed their marks [001:2600-2606].
    pub fn adjust_cyclically(&mut self, cycle_us: u32, spindle_off: bool, axes: &mut Axes) {
        let settled = |unit: &AxisUnit| {
            let stood_s = f64::from(unit.stood_cycles) * f64::from(cycle_us) * 1e-6;
            let patience = unit.parameters.offset_patience_s;
            unit.servo.in_position() || patience.is_some_and(|patience_s| stood_s > patience_s)
        };
        let controlled = || axes.iter().filter(|unit| unit.parameters.controlled);
        let permitted =
            spindle_off && controlled().all(|unit| unit.servo.closed() && unit.stands() && settled(unit));
        let referenced = controlled().all(|unit| unit.referenced);
        let passed = referenced && !std::mem::replace(&mut self.referenced, referenced);
        if passed && controlled().all(|unit| unit.parameters.offset_patience_s.is_some()) {
            self.interval.come();
        }
        if !self.interval.pass(cycle_us, permitted) {
            return;
        }
        for unit in axes.iter_mut() {
            if unit.parameters.controlled && unit.parameters.output.integral_factor == 0.0 {
                unit.servo.adjust_offset();
            }
        }
    }

    /// Answers to code number 75 368: compensates the offsets of the axes, or switches the automatic
    /// adjustment off [000:5014-5020]. `false` when they are not shown.
    pub fn answer(&mut self, adjust: bool, axes: &mut Axes) -> bool {
        if !std::mem::take(&mut self.shown) {
            return false;
        }
        for unit in axes.iter_mut() {
            if adjust {
                unit.servo.compensate_offset();
            } else {
                unit.servo.set_offset_compensation(0.0);
            }
        }
        if !adjust {
            self.interval = OffsetInterval::new(0.0);
        }
        true
    }
}
