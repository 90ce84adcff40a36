//! What moves in a contour cycle, by operating mode.

use bahn_servo::Plant;

use crate::axes::Mover;
use crate::command::Mode;
use crate::control::Control;

impl Control {
    /// Finds the nominal positions of all axes for the end of the contour cycle.
    pub(crate) fn move_axes(&mut self, plant: &mut dyn Plant) {
        let handwheel = plant.operator().handwheel_count;
        match self.mode {
            Mode::Manual | Mode::Handwheel => {
                if self.start_pressed && !self.stop_given() {
                    self.output_entered();
                }
                self.move_manually(handwheel);
            }
            Mode::Reference => self.move_reference(),
            Mode::Mdi | Mode::SingleBlock | Mode::FullSequence => {
                if self.manual_operation_is_on() {
                    self.move_manually(handwheel);
                } else {
                    self.move_path(plant);
                }
                self.move_restore();
            }
        }
        self.move_for_plc();
        self.move_plc_axes();
        self.move_rotation();
        for unit in self.axes.iter_mut() {
            if unit.mover == Mover::None && !unit.stands() {
                // Nobody moves it any more: down to a standstill.
                let rapid = unit.parameters.motion.rapid_mm_min;
                unit.drive(
                    f64::from(self.timing.contour_us()) * 1e-6,
                    bahn_motion::Aim::Feed(0.0),
                    rapid,
                );
            }
            unit.servo.command(unit.nominal);
        }
        self.note_deviation();
    }

    /// The distance of the actual position from the nominal path: the part of the lag that is across the
    /// direction of travel, axis by axis. Along the path the lag is no error of the contour.
    fn note_deviation(&mut self) {
        let path = |unit: &&crate::axes::AxisUnit| unit.mover == Mover::Path && !unit.axis.is_rotary();
        let (mut along, mut square) = (0.0, 0.0);
        for unit in self.axes.iter().filter(path) {
            along += unit.servo.lag_mm() * unit.speed;
            square += unit.speed * unit.speed;
        }
        if square <= 0.0 {
            return;
        }
        let factor = along / square;
        for unit in self.axes.iter_mut().filter(|unit| path(&&**unit)) {
            let across = unit.servo.lag_mm() - factor * unit.speed;
            unit.max_deviation = unit.max_deviation.max(across.abs());
        }
    }
}
