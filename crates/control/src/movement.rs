//! What moves in a contour cycle, by operating mode.

use crate::axes::Mover;
use crate::command::Mode;
use crate::control::Control;
use crate::restore::Restore;
use crate::run::RunState;

impl Control {
    /// Finds the nominal positions of all axes for the end of the contour cycle. `false` as long as the
    /// operating mode waits for axes to come to a standstill: NC start then counts later.
    pub(crate) fn move_axes(&mut self) -> bool {
        self.count_display_axes();
        let handwheel = self.measured.operator.handwheel_count;
        if self.mode != Mode::Handwheel {
            // What is turned in another mode moves nothing later.
            self.manual.forget_turns(handwheel);
        }
        let automatic = self.mode.is_automatic();
        let rigid = self.taps_rigidly();
        let mut ready = true;
        for unit in &mut self.axes {
            ready &= unit.choose_method(automatic && !self.reference.is_running(), rigid);
        }
        let waits = automatic && !ready && !self.run.is_active();
        match self.mode {
            // What the mode before moved comes to a standstill first.
            _ if waits => {}
            Mode::Manual | Mode::Handwheel => {
                if self.start_pressed && !self.stop_given() {
                    self.output_entered();
                }
                self.move_manually(handwheel);
            }
            Mode::Reference => self.move_reference(),
            Mode::Mdi | Mode::SingleBlock | Mode::FullSequence => {
                if self.manual_operation_is_on() && !self.path.is_coupled() {
                    self.move_manually(handwheel);
                } else {
                    self.move_path();
                }
                self.move_restore();
            }
        }
        self.move_for_plc();
        self.move_plc_axes();
        self.move_rotation();
        for unit in self.axes.iter_mut() {
            if unit.mover == Mover::None && !unit.stands() && unit.coupling.is_none() {
                // Nobody moves it any more: down to a standstill.
                let rapid = unit.parameters.motion.rapid_mm_min;
                unit.drive(
                    f64::from(self.timing.contour_us()) * 1e-6,
                    bahn_motion::Aim::Feed(0.0),
                    rapid,
                );
            }
            if unit.coupling.is_none() {
                unit.servo.command(unit.nominal);
            }
        }
        crate::gantry::command(&mut self.axes);
        if self.run.state == RunState::Idle || self.run.broken {
            for unit in &mut self.axes {
                unit.left_at = None;
                if unit.mover == Mover::None && unit.stands() {
                    unit.wrap();
                }
            }
        }
        !waits
    }

    /// After a stop in which axes lost their nominal positions (EMERGENCY STOP, POSITIONING ERROR) they go
    /// back to where the path left them before it goes on (inferred).
    pub(crate) fn return_to_path(&mut self) {
        let mut target = self.machine_position();
        let mut away = false;
        for unit in &mut self.axes {
            if let Some(left_at) = unit.left_at.take() {
                target[unit.axis] = left_at;
                away |= left_at != unit.nominal;
            }
        }
        if away && self.run.restore.is_none() {
            self.run.restore = Some(Restore::Moving { target });
        }
    }
}
