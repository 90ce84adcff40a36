//! The digital speed controller of a TNC 425: nominal speed in, torque out [000:18117-18521].
//!
//! Decision: MP1940 counts 20 times what MP1920 does; MP1925 is the time constant with which the sum of the integral
//! part forgets; MP1960 is put into that sum

use crate::settings::{AxisSettings, SpeedLoopSettings};

use crate::fault::GrossFault;
use crate::plant::Encoder;
use crate::rounding::round;
use crate::timing::{OUTPUT_VOLTS, Timing};

/// What a counting step in the sum of the integral part gives for 1 in MP1920, V [000:18387-18391].
const VOLTS_PER_STEP: f64 = 9.7e-6;
/// So many times that is what a counting step of speed error gives for 1 in MP1940 (inferred: no manual names the unit;
/// with it the recommended 50 to 200 suit drives of some 10 m/s² at 10 V).
const PROPORTIONAL_WEIGHT: f64 = 20.0;
/// The limit that the manual puts into MP1910, V [000:18552-18558]; it holds where MP1920 is 0 and gives none.
const LIMIT_VOLTS: f64 = 15.0;

/// The speed loop as it is in a servo step, mm/min (degrees/min for rotary axes): what the oscilloscope shows of it
/// [000:18646-18654].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpeedState {
    /// N NOMINAL: what the position loop asks for, or the step of the oscilloscope.
    pub nominal_mm_min: f64,
    /// N ACTUAL: the distance of the motor's encoder in the last step.
    pub actual_mm_min: f64,
    /// N INT: their difference.
    pub difference_mm_min: f64,
}

/// A PI controller in servo steps. Its speeds are counting steps of the motor's encoder for each step, so the integral
/// part is a sum of ways, and 1 in it is one counting step that the motor stays behind.
#[derive(Clone, Debug)]
pub(crate) struct SpeedLoop {
    settings: SpeedLoopSettings,
    step_min: f64,
    /// Distance of a counting step of the motor's encoder, mm, in the sense of the axis (MP1040), and the speed of one for
    /// each servo step, mm/min.
    step_mm: f64,
    per_step: f64,
    /// From here on MP1910 finds a fault, V.
    limit_volts: f64,
    /// Counting steps of the position encoder for one of the motor's, with its sense MP210.
    position_steps: f64,
    /// Part of the sum that is left after a step: MP1925.
    kept: f64,
    shutdown_steps: u32,
    /// The last count; none before the first reading, and on drives that control their speed themselves.
    count: Option<i64>,
    way_steps: f64,
    /// What the position encoder counted itself.
    scale_count: i64,
    /// Counts of motor and position encoder at which the two were found together.
    together: Option<(i64, i64)>,
    sum_steps: f64,
    /// The nominal distance of the last step.
    asked_steps: f64,
    profile_mm_min: f64,
    direction: f64,
    state: SpeedState,
    /// Speed that is put in instead of the position loop's.
    step_mm_min: Option<f64>,
    /// Steps after which the torque ends.
    ends_in: Option<u32>,
}

impl SpeedLoop {
    /// The loop of an axis with digital speed controller.
    pub fn of(settings: &AxisSettings, timing: &Timing) -> Option<SpeedLoop> {
        let digital = settings.digital?;
        let mut new = SpeedLoop {
            settings: digital,
            step_min: timing.step_min(),
            step_mm: 1.0,
            per_step: 1.0,
            limit_volts: LIMIT_VOLTS,
            position_steps: 1.0,
            kept: 1.0,
            shutdown_steps: 0,
            count: None,
            way_steps: 0.0,
            scale_count: 0,
            together: None,
            sum_steps: 0.0,
            asked_steps: 0.0,
            profile_mm_min: 0.0,
            direction: 0.0,
            state: SpeedState::default(),
            step_mm_min: None,
            ends_in: None,
        };
        new.configure(settings, timing);
        Some(new)
    }

    /// Takes changed settings over; what it has summed up stays.
    pub fn configure(&mut self, settings: &AxisSettings, timing: &Timing) {
        let Some(digital) = settings.digital else {
            return;
        };
        self.settings = digital;
        let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
        // The grating of the motor's encoder, seen at the table [000:18478-18483].
        let ratio = if digital.encoder_ratio > 0.0 {
            digital.encoder_ratio
        } else {
            1.0
        };
        let period_mm = settings.encoder.signal_period_um * 1e-3 / ratio;
        let motor = sign(settings.output.polarity_negative);
        self.step_mm = motor * period_mm / Encoder::MOTOR_STEPS as f64;
        self.per_step = self.step_mm / self.step_min;
        self.limit_volts = match digital.integral {
            integral if integral > 0.0 => digital.monitoring_steps * integral * VOLTS_PER_STEP,
            _ => LIMIT_VOLTS,
        };
        let steps = Encoder::STEPS as f64 / Encoder::MOTOR_STEPS as f64 / ratio;
        self.position_steps = motor * sign(settings.encoder.counts_negative) * steps;
        // Which limit MP1925 is, no manual says: the sum forgets with this time constant (inferred).
        let step_s = f64::from(timing.step_us()) * 1e-6;
        self.kept = match digital.integral_limit_s {
            limit if limit > step_s => 1.0 - step_s / limit,
            _ => 1.0,
        };
        self.shutdown_steps = timing.steps_of(digital.emergency_stop_s);
    }

    /// Takes the motor's encoder in. Without one the drive controls its speed itself.
    pub fn measure(&mut self, count: Option<i64>) {
        self.way_steps = match (self.count, count) {
            (Some(before), Some(now)) => now.wrapping_sub(before) as f64,
            _ => 0.0,
        };
        self.count = count;
    }

    /// The control closes the speed loop.
    pub fn is_active(&self) -> bool {
        self.count.is_some()
    }

    /// What the position loop reads: the position encoder, or with MP1951 the motor's, in steps of the position encoder
    /// and with its marks.
    pub fn position(&mut self, scale: Encoder) -> Encoder {
        self.scale_count = scale.count;
        let Some(motor) = self.count.filter(|_| self.settings.motor_encoder) else {
            return scale;
        };
        let count = round(motor as f64 * self.position_steps) as i64;
        let there = count.wrapping_sub(scale.count);
        Encoder {
            count,
            mark: scale.mark.map(|mark| mark.wrapping_add(there)),
            ..scale
        }
    }

    /// The two encoders are together here: MP1970 counts from now on.
    pub fn set_together(&mut self) {
        self.together = self.count.map(|count| (count, self.scale_count));
    }

    /// Difference of the ways of the two encoders, mm, for counting steps of the position encoder of so many mm
    /// [000:18485-18506].
    fn difference_mm(&self, scale_step_mm: f64) -> f64 {
        let (Some(count), Some((motor, scale))) = (self.count, self.together) else {
            return 0.0;
        };
        let by_motor = count.wrapping_sub(motor) as f64 * self.step_mm;
        let by_scale = self.scale_count.wrapping_sub(scale) as f64 * scale_step_mm;
        by_scale - by_motor
    }

    /// MP1970: position and speed encoder say the same.
    pub fn check_encoders(&self, scale_step_mm: f64) -> Option<GrossFault> {
        let limit = self.settings.difference_mm?;
        (self.difference_mm(scale_step_mm).abs() > limit).then_some(GrossFault::Movement)
    }

    /// A step with the speed that the position loop asks for, mm/min; `profile_mm_min` is that of the nominal position
    /// with pre-control. The torque signal before the converter, V, and the fault of MP1910.
    pub fn control(
        &mut self,
        nominal_mm_min: f64,
        profile_mm_min: Option<f64>,
        circular: bool,
    ) -> (f64, Option<GrossFault>) {
        let nominal_mm_min = self.step_mm_min.unwrap_or(nominal_mm_min);
        let per_step = self.per_step;
        // What was asked for in the last step is what was measured at its end.
        let asked = std::mem::replace(&mut self.asked_steps, nominal_mm_min / per_step);
        let error_steps = asked - self.way_steps;
        self.state = SpeedState {
            nominal_mm_min,
            actual_mm_min: self.way_steps * per_step,
            difference_mm_min: error_steps * per_step,
        };
        self.sum_steps = self.sum_steps * self.kept + error_steps;
        let acceleration = self.follow_profile(profile_mm_min, circular);
        let digital = &self.settings;
        let digital_volts =
            digital.integral * self.sum_steps + digital.proportional * PROPORTIONAL_WEIGHT * error_steps;
        let volts = digital_volts * VOLTS_PER_STEP
            + digital.acceleration_v_m_s2 * acceleration * self.step_mm.signum();
        // What is calculated is monitored, what is put out is limited [000:18387-18391].
        let fault = (volts.abs() > self.limit_volts).then_some(GrossFault::SpeedController);
        let turned = if digital.polarity_negative { -volts } else { volts };
        (turned.clamp(-OUTPUT_VOLTS, OUTPUT_VOLTS), fault)
    }

    /// A step in which the axis comes to a standstill with MP1060, m/s², and is held there (inferred: 0 V, which stop a
    /// drive with a speed controller, would let it run down).
    pub fn hold(&mut self, acceleration_m_s2: f64) -> (f64, Option<GrossFault>) {
        let slower = acceleration_m_s2 * 60e3 * self.step_min * 60.0;
        let before = self.state.nominal_mm_min;
        let nominal = before - before.clamp(-slower, slower);
        self.control(nominal, None, false)
    }

    /// The acceleration of the nominal position, m/s², with pre-control; on circles the reversal of friction at its
    /// turning points is put into the sum: a peak of MP1960 mm is so many steps that the sum lacks (inferred from
    /// [000:18463-18476]).
    fn follow_profile(&mut self, profile_mm_min: Option<f64>, circular: bool) -> f64 {
        let Some(profile) = profile_mm_min.filter(|_| self.step_mm_min.is_none()) else {
            self.profile_mm_min = 0.0;
            return 0.0;
        };
        let before = std::mem::replace(&mut self.profile_mm_min, profile);
        if profile * self.direction < 0.0 && circular {
            self.sum_steps += profile.signum() * self.settings.reversal_mm / self.step_mm;
        }
        if profile != 0.0 {
            self.direction = profile.signum();
        }
        (profile - before) / (self.step_min * 60.0) / 60e3
    }

    /// The torque is off.
    pub fn rest(&mut self) {
        self.sum_steps = 0.0;
        self.asked_steps = 0.0;
        self.profile_mm_min = 0.0;
        let per_step = self.per_step;
        self.state = SpeedState {
            actual_mm_min: self.way_steps * per_step,
            ..SpeedState::default()
        };
    }

    pub fn state(&self) -> SpeedState {
        self.state
    }

    /// Puts a speed in, mm/min: the step output of the oscilloscope, with the position loop off [000:18747-18756].
    pub fn set_step(&mut self, speed_mm_min: Option<f64>) {
        self.step_mm_min = speed_mm_min;
    }

    pub fn step_mm_min(&self) -> Option<f64> {
        self.step_mm_min
    }

    /// An EMERGENCY STOP: the torque ends after MP1980; what it does until then brakes [000:18508-18521].
    pub fn begin_shutdown(&mut self) {
        self.ends_in.get_or_insert(self.shutdown_steps);
    }

    /// A fault of the speed loop itself: it gives no torque any more, and does not brake in an EMERGENCY STOP either, until the
    /// control voltage is back (inferred: then the brakes of the machine have to [000:18636]).
    pub fn end_torque(&mut self) {
        self.ends_in = Some(0);
    }

    /// A step of the shutdown; whether the torque has ended.
    pub fn shut_down(&mut self) -> bool {
        match &mut self.ends_in {
            Some(0) => true,
            Some(steps) => {
                *steps -= 1;
                false
            }
            None => false,
        }
    }

    /// A shutdown runs, or is done.
    pub fn is_shutting_down(&self) -> bool {
        self.ends_in.is_some()
    }

    /// The control voltage is back: the next shutdown has its whole time.
    pub fn end_shutdown(&mut self) {
        self.ends_in = None;
    }

    /// The loop closes again; not during a shutdown.
    pub fn restart(&mut self) -> bool {
        let may = self.ends_in.is_none();
        if may {
            self.step_mm_min = None;
            self.rest();
            self.set_together();
        }
        may
    }
}
