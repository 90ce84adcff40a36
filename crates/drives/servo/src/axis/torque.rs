//! What an axis with digital speed controller does otherwise: its loop gives torque.
//!
//! Decision: A drive whose motor's encoder is not read closes its speed loop itself: MP1900 does nothing then
//!
//! Decision: A digital axis without feed enable stops with MP1060 and is held, since 0 V would let it run down; in an
//! EMERGENCY STOP its torque ends after MP1980, at once where its speed controller itself has a fault (MP1910,
//! MP1970)

use crate::fault::GrossFault;
use crate::plant::Encoder;
use crate::settings::AxisSettings;
use crate::speed_loop::{SpeedLoop, SpeedState};
use crate::timing::Timing;

/// The digital speed controller (MP1900), if there is one.
#[derive(Clone, Debug)]
pub(super) struct Torque(Option<SpeedLoop>);

/// What the position loop wants of it in a servo step.
pub(super) struct Wanted {
    /// The axis is driven; its loop is closed.
    pub drives: bool,
    pub closed: bool,
    /// Velocity of the nominal value, and of the nominal position with pre-control, mm/min.
    pub velocity_mm_min: f64,
    pub profile_mm_min: Option<f64>,
    /// It moves on a circle.
    pub circular: bool,
    /// With what it brakes, m/s².
    pub acceleration_m_s2: f64,
    pub scale_step_mm: f64,
}

/// What a servo step of it comes to.
pub(super) enum Given {
    /// Nothing: the loop is open.
    Rests,
    /// A voltage, before the converter, V.
    Volts(f64),
    /// It ends with a fault.
    Faulty(GrossFault),
}

impl Torque {
    pub fn of(settings: &AxisSettings, timing: &Timing) -> Torque {
        Torque(SpeedLoop::of(settings, timing))
    }

    pub fn configure(&mut self, settings: &AxisSettings, timing: &Timing) {
        if let Some(speed_loop) = &mut self.0 {
            speed_loop.configure(settings, timing);
        }
    }

    /// There is one.
    #[inline]
    pub fn is_there(&self) -> bool {
        self.0.is_some()
    }

    /// It controls the speed: not where the drive does so itself.
    #[inline]
    pub fn is_active(&self) -> bool {
        self.0.as_ref().is_some_and(SpeedLoop::is_active)
    }

    pub fn measure(&mut self, count: Option<i64>) {
        if let Some(speed_loop) = &mut self.0 {
            speed_loop.measure(count);
        }
    }

    /// The reading that the position counts with.
    #[inline]
    pub fn position(&mut self, encoder: Encoder) -> Encoder {
        match &mut self.0 {
            Some(speed_loop) => speed_loop.position(encoder),
            None => encoder,
        }
    }

    /// The loop is to be closed; whether it may be.
    pub fn restart(&mut self) -> bool {
        self.0.as_mut().is_none_or(SpeedLoop::restart)
    }

    /// The speed loop of a servo step.
    #[inline]
    pub fn control(&mut self, wanted: &Wanted) -> Given {
        let Some(speed_loop) = &mut self.0 else {
            return Given::Rests;
        };
        if speed_loop.shut_down() || !wanted.closed && !speed_loop.is_shutting_down() {
            speed_loop.rest();
            return Given::Rests;
        }
        let (volts, fault) = match wanted.drives {
            true => speed_loop.control(wanted.velocity_mm_min, wanted.profile_mm_min, wanted.circular),
            false => speed_loop.hold(wanted.acceleration_m_s2),
        };
        match fault.or(speed_loop.check_encoders(wanted.scale_step_mm)) {
            Some(fault) => {
                speed_loop.end_torque();
                Given::Faulty(fault)
            }
            None => Given::Volts(volts),
        }
    }

    pub fn begin_shutdown(&mut self) {
        if let Some(speed_loop) = &mut self.0 {
            speed_loop.begin_shutdown();
        }
    }

    pub fn end_shutdown(&mut self) {
        if let Some(speed_loop) = &mut self.0 {
            speed_loop.end_shutdown();
        }
    }

    /// Puts a step of speed out, or ends it; whether one has ended, `None` where no speed is controlled.
    pub fn set_step(&mut self, speed_mm_min: Option<f64>) -> Option<bool> {
        let speed_loop = self.0.as_mut().filter(|speed_loop| speed_loop.is_active())?;
        let ended = speed_loop.step_mm_min().is_some() && speed_mm_min.is_none();
        speed_loop.set_step(speed_mm_min);
        Some(ended)
    }

    #[inline]
    pub fn step_mm_min(&self) -> Option<f64> {
        self.0.as_ref().and_then(SpeedLoop::step_mm_min)
    }

    /// What it does; `None` where the control closes no speed loop.
    pub fn state(&self) -> Option<SpeedState> {
        let active = self.0.as_ref().filter(|speed_loop| speed_loop.is_active());
        active.map(SpeedLoop::state)
    }
}
