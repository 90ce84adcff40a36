//! What an axis with digital speed controller does otherwise: its loop gives torque.

use super::Axis;
use crate::fault::Fault;
use crate::method::Method;
use crate::speed_loop::{SpeedLoop, SpeedState};

impl Axis {
    /// Whether the axis has a digital speed controller (MP1900) and wants the count of the motor's encoder.
    #[inline]
    pub fn is_digital(&self) -> bool {
        self.speed_loop.is_some()
    }

    /// Takes the count of the motor's encoder in, before [`Axis::measure`]; `None` from a drive that controls its speed
    /// itself: it gets the voltage of an axis without MP1900 (inferred).
    pub fn measure_motor(&mut self, count: Option<i64>) {
        if let Some(speed_loop) = &mut self.speed_loop {
            speed_loop.measure(count);
        }
    }

    /// The speed loop of a servo step: the torque signal, V. It has the counting sense of the motor's encoder, which
    /// MP1040 gives to the nominal speed and MP1950 to the torque [000:18453-18454]. Without feed enable the axis stops and
    /// is held.
    pub(super) fn torque_volts(&mut self) -> f64 {
        let (drives, closed) = (self.drives(), self.closed());
        let profile = (self.method == Method::Precontrol).then_some(self.profile_mm_min);
        let (velocity, circular) = (self.velocity_mm_min, self.circular);
        let acceleration = self.settings.motion.acceleration_m_s2;
        let scale_step_mm = self.measuring.step_mm();
        let Some(speed_loop) = &mut self.speed_loop else {
            return 0.0;
        };
        if speed_loop.shut_down() || !closed && !speed_loop.is_shutting_down() {
            speed_loop.rest();
            self.closed = false;
            self.drove = false;
            return 0.0;
        }
        let (volts, fault) = match drives {
            true => speed_loop.control(velocity, profile, circular),
            false => speed_loop.hold(acceleration),
        };
        if let Some(step) = speed_loop.step_mm_min() {
            self.velocity_mm_min = step;
        }
        let fault = fault.or(speed_loop.check_encoders(scale_step_mm));
        self.drove = true;
        if let Some(fault) = fault {
            speed_loop.end_torque();
            self.raise(Fault::Gross(fault));
            self.drove = false;
            return 0.0;
        }
        self.timing.convert(volts)
    }

    /// An EMERGENCY STOP: a digital speed controller ends its torque after MP1980, at once with 0; any other loop stays
    /// as it is [000:18508-18521].
    pub fn begin_shutdown(&mut self) {
        if let Some(speed_loop) = &mut self.speed_loop {
            speed_loop.begin_shutdown();
        }
    }

    /// The control voltage is back: the loop may close.
    pub fn end_shutdown(&mut self) {
        if let Some(speed_loop) = &mut self.speed_loop {
            speed_loop.end_shutdown();
        }
    }

    /// Puts a step of speed out, mm/min, in place of what the position loop asks for; `None` closes the position loop
    /// again where the axis is. `false` without digital speed controller [000:18747-18756].
    pub fn set_speed_step(&mut self, speed_mm_min: Option<f64>) -> bool {
        let Some(speed_loop) = self
            .speed_loop
            .as_mut()
            .filter(|speed_loop| speed_loop.is_active())
        else {
            return false;
        };
        let ended = speed_loop.step_mm_min().is_some() && speed_mm_min.is_none();
        speed_loop.set_step(speed_mm_min);
        if ended {
            self.transfer();
            // The speed goes on without a jump.
            self.changed = true;
        }
        true
    }

    /// The speed of the step that is put out, mm/min.
    pub fn speed_step_mm_min(&self) -> Option<f64> {
        self.speed_loop.as_ref().and_then(SpeedLoop::step_mm_min)
    }

    /// What the speed loop does; `None` where the control closes none.
    pub fn speed(&self) -> Option<SpeedState> {
        let active = self
            .speed_loop
            .as_ref()
            .filter(|speed_loop| speed_loop.is_active());
        active.map(SpeedLoop::state)
    }
}
