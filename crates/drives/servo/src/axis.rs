//! The position loop of an axis.

mod bias;
mod faults;
mod fixed;
mod stiction;
mod torque;

use crate::settings::AxisSettings;

use crate::characteristic::Characteristic;
use crate::fault::{EncoderFault, Fault, GrossFault};
use crate::interpolation::{FineInterpolation, Transient};
use crate::measuring::{Mark, MeasuringSystem};
use crate::method::Method;
use crate::monitor::{Monitor, Sample};
use crate::offset::Offset;
use crate::plant::{AxisCommand, Encoder};
use crate::reversal::{ReversalPeak, Travel};
use crate::run_up::RunUp;
use crate::speed_loop::SpeedState;
use crate::timing::{OUTPUT_VOLTS, Timing};
use bias::Bias;
use faults::Faults;
use fixed::Fixed;
use stiction::Stiction;
use torque::{Given, Torque, Wanted};

/// Time constants of the loop after which an axis whose nominal position stands is at rest (inferred).
const REST_TIME_CONSTANTS: f64 = 5.0;

/// No machine is larger, mm: farther commands are not taken.
const POSITION_MAX_MM: f64 = 1e9;

/// A nominal distance of a servo step that is rounding and not movement, mm.
const STANDING_MM: f64 = 1e-9;
/// So far may the nominal position of an axis in position go without being a movement, mm.
const REST_MM: f64 = 1e-6;

/// The position loop of one axis: nominal position in, voltage out.
///
/// In each contour cycle [`Axis::command`] says where the axis shall be at its end; in each servo step
/// [`Axis::measure`] takes the encoder in and [`Axis::step`] gives the voltage that holds until the next
/// one. Positions are mm (degrees for rotary axes) in machine coordinates, once [`Axis::set_datum`] has
/// told them; until then they count from where the axis stood at power-on. Nothing here allocates.
///
/// The loop is open after power-on: [`Axis::close`] closes it. A fault other than POSITIONING ERROR opens it
/// for good.
#[derive(Clone, Debug)]
pub struct Axis {
    settings: AxisSettings,
    timing: Timing,
    measuring: MeasuringSystem,
    interpolation: FineInterpolation,
    transient: Transient,
    run_up: RunUp,
    travel: Travel,
    reversal: ReversalPeak,
    characteristic: Characteristic,
    fixed: Fixed,
    offset: Offset,
    torque: Torque,
    monitor: Monitor,
    method: Method,
    second_set: bool,
    circular: bool,
    closed: bool,
    enabled: bool,
    monitored: bool,
    window_mm: Option<f64>,
    /// Nominal position of the contour cycle without the reversal peak.
    commanded_mm: f64,
    /// The commanded position at which the window was reached last.
    rest_mm: f64,
    nominal_mm: f64,
    /// Nominal position at the end of the step.
    next_mm: f64,
    actual_mm: f64,
    /// A contour cycle has begun and its first step is not done.
    cycle_begins: bool,
    cycle_actual_mm: f64,
    actual_mm_min: f64,
    stiction: Stiction,
    /// Velocity of the nominal position with pre-control.
    profile_mm_min: f64,
    /// Velocity of the nominal value.
    velocity_mm_min: f64,
    bias: Bias,
    /// The last step put a voltage out.
    drove: bool,
    volts: f64,
    standing_steps: u32,
    in_position: bool,
    faults: Faults,
}

impl Axis {
    /// An axis with open loop, at position 0.
    pub fn new(settings: AxisSettings, timing: Timing) -> Axis {
        let mut axis = Axis {
            settings,
            timing,
            measuring: MeasuringSystem::new(&settings),
            interpolation: FineInterpolation::new(timing.steps()),
            transient: Transient::new(timing.steps(), settings.precontrol.transient_m_min),
            run_up: RunUp::default(),
            travel: Travel::default(),
            reversal: ReversalPeak::default(),
            characteristic: Characteristic::straight(1.0),
            fixed: Fixed::default(),
            offset: Offset::default(),
            torque: Torque::of(&settings, &timing),
            monitor: Monitor::new(&timing),
            method: Method::Lag,
            second_set: false,
            circular: false,
            closed: false,
            enabled: true,
            monitored: true,
            window_mm: None,
            commanded_mm: 0.0,
            rest_mm: 0.0,
            nominal_mm: 0.0,
            next_mm: 0.0,
            actual_mm: 0.0,
            cycle_begins: false,
            cycle_actual_mm: 0.0,
            actual_mm_min: 0.0,
            stiction: Stiction::default(),
            profile_mm_min: 0.0,
            velocity_mm_min: 0.0,
            bias: Bias::default(),
            drove: false,
            volts: 0.0,
            standing_steps: 0,
            in_position: false,
            faults: Faults::default(),
        };
        axis.choose_characteristic();
        axis
    }

    /// Takes changed settings over (those that the PLC may change); state and positions stay.
    pub fn configure(&mut self, settings: AxisSettings) {
        self.settings = settings;
        self.measuring.configure(&settings);
        self.torque.configure(&settings, &self.timing);
        self.transient
            .set_entry(self.timing.steps(), settings.precontrol.transient_m_min);
        self.choose_characteristic();
    }

    /// What the loop works with now, as it was set last.
    pub fn settings(&self) -> &AxisSettings {
        &self.settings
    }

    /// Takes an encoder reading; once in each servo step, before [`Axis::step`].
    #[inline]
    pub fn measure(&mut self, encoder: Encoder) {
        let encoder = self.torque.position(encoder);
        if let Some(fault) = self.measuring.read(encoder, &self.settings) {
            self.raise(Fault::MeasuringSystem(fault));
        }
        self.actual_mm = self.measuring.actual_mm();
    }

    /// The position for the end of the contour cycle that begins, mm; once in each contour cycle, before its
    /// first servo step. What is no position of any machine leaves the axis where it is.
    pub fn command(&mut self, nominal_mm: f64) {
        self.cycle_begins = true;
        if nominal_mm.is_nan() || nominal_mm.abs() > POSITION_MAX_MM {
            return;
        }
        self.commanded_mm = nominal_mm;
        if (nominal_mm - self.rest_mm).abs() > REST_MM {
            self.in_position = false;
        }
        let set = usize::from(self.second_set);
        let compensation = &self.settings.compensation;
        let (height, part) = (compensation.reversal_mm[set], compensation.reversal_step_mm[set]);
        let before = self.travel.direction();
        if let Some(direction) = self.travel.advance(nominal_mm) {
            self.measuring.set_direction(direction > 0.0);
            self.actual_mm = self.measuring.actual_mm();
            if self.circular && before != 0.0 && part > 0.0 {
                self.reversal.begin(direction, height);
            }
        }
        let peak = self.reversal.advance(part);
        self.interpolation.command(nominal_mm + peak);
    }

    /// One servo step: the voltage for the nominal value output, V.
    pub fn step(&mut self) -> f64 {
        if self.faults.is_released() || self.speed_step_mm_min().is_some() {
            self.follow_actual();
        }
        let rough_now = self.interpolation.now();
        let smooth_now = self.transient.now();
        let rough_next = self.interpolation.advance();
        let smooth_next = self.transient.advance(rough_next);
        let (now, next) = match self.method {
            Method::Lag => (rough_now, rough_next),
            Method::Precontrol => (smooth_now, smooth_next),
        };
        self.nominal_mm = now;
        self.next_mm = next;
        if std::mem::take(&mut self.cycle_begins) {
            self.begin_cycle();
        }

        let left = (next - now).abs().max((self.interpolation.end() - next).abs());
        let standing = left <= STANDING_MM;
        self.standing_steps = if standing {
            self.standing_steps.saturating_add(1)
        } else {
            0
        };
        self.update_velocity(next - now);
        let by_torque = self.torque.is_active();
        // What concerns the voltage of a speed is not monitored then: MP1140 is inactive [000:18360-18365].
        let wanted = if by_torque {
            0.0
        } else {
            self.velocity_mm_min * self.fixed.volts_per_mm_min + self.offset.volts()
        };
        if standing && self.is_in_window() {
            self.in_position = true;
            self.rest_mm = self.commanded_mm;
        }
        if self.closed {
            self.watch(standing, next - now, wanted);
        }
        self.drove = self.drives();
        self.volts = if by_torque {
            self.torque_volts()
        } else if self.drove {
            let polarity = if self.settings.output.polarity_negative {
                -1.0
            } else {
                1.0
            };
            polarity * self.timing.convert(wanted)
        } else {
            0.0
        };
        self.volts
    }

    /// What the last step says to the drive.
    #[inline]
    pub fn output(&self) -> AxisCommand {
        let distance_mm = self.next_mm - self.actual_mm;
        let by_torque = self.torque.is_active();
        AxisCommand {
            enabled: self.drove,
            volts: self.volts,
            speed_per_min: if self.drove { self.velocity_mm_min } else { 0.0 },
            torque: by_torque.then_some(self.volts / OUTPUT_VOLTS),
            position_steps: Some(self.measuring.steps_after(distance_mm))
                .filter(|steps| self.closed() && steps.is_finite()),
        }
    }

    /// Takes the fault word of a drive: another than 0 opens the loop for good.
    #[inline]
    pub fn take_drive_fault(&mut self, word: u16) {
        if word != 0 && self.closed {
            self.raise(Fault::Gross(GrossFault::Movement));
        }
    }

    /// What is done once in a contour cycle, with the lag at its beginning.
    fn begin_cycle(&mut self) {
        let lag = self.lag_mm();
        self.actual_mm_min = (self.actual_mm - self.cycle_actual_mm) / self.timing.contour_min();
        self.cycle_actual_mm = self.actual_mm;
        let profile = (self.method == Method::Precontrol).then_some(self.profile_mm_min);
        let slope = self.characteristic.slope();
        self.stiction
            .begin_cycle(lag, (profile, slope), &self.settings, &self.timing);
        let time_constants =
            f64::from(self.standing_steps) * self.characteristic.slope() * self.timing.step_min();
        let rest = time_constants >= REST_TIME_CONSTANTS;
        // A digital speed loop has no offset [000:18147].
        if rest && self.drives() && self.settings.digital.is_none() {
            let loop_volts = self.velocity_mm_min * self.fixed.volts_per_mm_min;
            self.offset.rest(loop_volts, self.settings.output.integral_factor);
        }
    }

    /// Velocity of the nominal value for a nominal distance in this step.
    fn update_velocity(&mut self, distance_mm: f64) {
        self.profile_mm_min = distance_mm / self.timing.step_min();
        let control = self.characteristic.velocity_mm_min(self.lag_mm());
        let velocity = match self.method {
            Method::Lag => {
                self.run_up.follow(self.profile_mm_min);
                self.settings.lag.in_advance(control, self.profile_mm_min)
            }
            Method::Precontrol => {
                let damping = self.settings.precontrol.damping;
                control + self.run_up.advance(self.profile_mm_min, damping) + self.stiction.mm_min
            }
        };
        let before = self.drove.then_some(self.velocity_mm_min);
        self.velocity_mm_min = self.bias.added(velocity, self.fixed.decay, before);
    }

    fn watch(&mut self, standing: bool, distance_mm: f64, volts: f64) {
        if let Some(fault) = self.offset.fault() {
            self.raise(Fault::Gross(fault));
        }
        self.faults.pass();
        if !self.monitored {
            self.monitor.reset();
            return;
        }
        let sample = Sample {
            actual_mm: self.actual_mm,
            lag_mm: self.lag_mm(),
            distance_mm,
            standing,
            in_position: self.in_position,
            velocity_mm_min: self.velocity_mm_min,
            volts,
            enabled: self.drives(),
        };
        let monitor = &mut self.monitor;
        if let Some(fault) = monitor.check(&sample, self.method, &self.settings, &self.timing) {
            self.raise(fault);
        }
    }

    /// Whether the actual position is within the window; with pre-control only when the axis itself is slower than
    /// MP1525 [000:813] [000:5304-5318].
    fn is_in_window(&self) -> bool {
        let standing = self.fixed.standing_mm_min;
        let slow = self.actual_mm_min.abs() < self.settings.precontrol.window_mm_min.max(standing);
        let window = self.window_mm.unwrap_or(self.settings.monitoring.window_mm);
        (slow || self.method == Method::Lag) && self.lag_mm().abs() <= window
    }

    /// Whether a voltage is put out at all.
    fn drives(&self) -> bool {
        self.closed() && self.enabled && !self.faults.is_released()
    }

    /// Closes the loop. The nominal position stays what it was: see [`Axis::transfer`].
    pub fn close(&mut self) {
        if !self.torque.restart() {
            return;
        }
        self.closed = true;
        self.in_position = self.is_in_window();
        self.monitor.reset();
    }

    /// Closes the loop of an axis that stood in position when it was opened: moved farther than MP1110 meanwhile, it has
    /// a gross positioning error [000:5289-5293].
    pub fn close_again(&mut self) {
        self.close();
        self.monitor.rest();
    }

    /// Opens the loop: 0 V [000:5403-5421].
    pub fn open(&mut self) {
        self.closed = false;
        self.volts = 0.0;
    }

    /// Enters a fault: what monitoring found, or a slave too far from its master.
    pub(crate) fn raise(&mut self, fault: Fault) {
        let residual_steps = self.timing.steps_of(self.settings.monitoring.residual_voltage_s);
        self.faults.raise(fault, residual_steps);
    }

    /// The key CE: clears a fault that can be cleared, switches the residual voltage off and makes the
    /// actual position the nominal one [000:5240-5242].
    pub fn acknowledge(&mut self) {
        if self.faults.clear() {
            self.transfer();
        }
    }

    /// The fault that monitoring has found and that was not cleared.
    pub fn fault(&self) -> Option<Fault> {
        self.faults.found()
    }

    /// Whether the axis has a digital speed controller (MP1900) and wants the count of the motor's encoder.
    #[inline]
    pub fn is_digital(&self) -> bool {
        self.torque.is_there()
    }

    /// Takes the count of the motor's encoder in, before [`Axis::measure`]; `None` from a drive that controls its speed
    /// itself: it gets the voltage of an axis without MP1900 (inferred).
    pub fn measure_motor(&mut self, count: Option<i64>) {
        self.torque.measure(count);
    }

    /// The speed loop of a servo step: the torque signal, V. It has the counting sense of the motor's encoder, which
    /// MP1040 gives to the nominal speed and MP1950 to the torque [000:18453-18454]. Without feed enable the axis stops and
    /// is held.
    fn torque_volts(&mut self) -> f64 {
        let given = self.torque.control(&Wanted {
            drives: self.drives(),
            closed: self.closed(),
            velocity_mm_min: self.velocity_mm_min,
            profile_mm_min: (self.method == Method::Precontrol).then_some(self.profile_mm_min),
            circular: self.circular,
            acceleration_m_s2: self.settings.motion.acceleration_m_s2,
            scale_step_mm: self.measuring.step_mm(),
        });
        let rests = matches!(given, Given::Rests);
        self.closed &= !rests;
        if let Some(step) = self.torque.step_mm_min().filter(|_| !rests) {
            self.velocity_mm_min = step;
        }
        self.drove = matches!(given, Given::Volts(_));
        match given {
            Given::Volts(volts) => return self.timing.convert(volts),
            Given::Faulty(fault) => self.raise(Fault::Gross(fault)),
            Given::Rests => {}
        }
        0.0
    }

    /// An EMERGENCY STOP: a digital speed controller ends its torque after MP1980, at once with 0; any other loop stays
    /// as it is [000:18508-18521].
    pub fn begin_shutdown(&mut self) {
        self.torque.begin_shutdown();
    }

    /// The control voltage is back: the loop may close.
    pub fn end_shutdown(&mut self) {
        self.torque.end_shutdown();
    }

    /// Puts a step of speed out, mm/min, in place of what the position loop asks for; `None` closes the position loop
    /// again where the axis is. `false` without digital speed controller [000:18747-18756].
    pub fn set_speed_step(&mut self, speed_mm_min: Option<f64>) -> bool {
        let ended = self.torque.set_step(speed_mm_min);
        if ended == Some(true) {
            self.transfer();
            // The speed goes on without a jump.
            self.bias.change();
        }
        ended.is_some()
    }

    /// The speed of the step that is put out, mm/min.
    pub fn speed_step_mm_min(&self) -> Option<f64> {
        self.torque.step_mm_min()
    }

    /// What the speed loop does; `None` where the control closes none.
    pub fn speed(&self) -> Option<SpeedState> {
        self.torque.state()
    }

    /// Makes the actual position the nominal one [000:5423-5434].
    pub fn transfer(&mut self) {
        self.monitor.transfer();
        self.follow_actual();
    }

    /// The nominal position goes where the axis is.
    fn follow_actual(&mut self) {
        self.interpolation.set(self.actual_mm);
        self.transient.set(self.actual_mm);
        self.reversal.clear();
        self.travel.set(self.actual_mm);
        self.commanded_mm = self.actual_mm;
        self.rest_mm = self.actual_mm;
        self.nominal_mm = self.actual_mm;
        self.next_mm = self.actual_mm;
        self.bias.clear();
    }

    /// Gives or withdraws the feed enable; without it the output is 0 V at once [000:5352]. The nominal
    /// position stays: what lag is left then is driven out when the enable comes back.
    pub fn set_enabled(&mut self, enabled: bool) {
        self.enabled = enabled;
    }

    /// Switches the monitoring of lag, voltage, movement and standstill on or off: M2688 to M2692, MP4130
    /// [000:5162-5188].
    pub fn set_monitored(&mut self, monitored: bool) {
        self.monitored = monitored;
    }

    /// Its monitoring is not suppressed.
    pub fn is_monitored(&self) -> bool {
        self.monitored
    }

    /// Chooses the method of positioning. In motion the velocity goes on without a jump.
    pub fn set_method(&mut self, method: Method) {
        if method != self.method {
            self.method = method;
            self.choose_characteristic();
        }
    }

    /// Chooses the second set of kv and reversal peaks, M105, or the first, M106 [000:4975].
    pub fn set_second_set(&mut self, second: bool) {
        if second != self.second_set {
            self.second_set = second;
            self.choose_characteristic();
        }
    }

    fn choose_characteristic(&mut self) {
        let (lag, precontrol) = (&self.settings.lag, &self.settings.precontrol);
        let choose = |first, second| if self.second_set { second } else { first };
        self.characteristic = match self.method {
            Method::Lag => Characteristic::with_kink(
                choose(lag.kv, lag.kv_m105),
                lag,
                self.settings.motion.rapid_mm_min,
            ),
            Method::Precontrol => Characteristic::straight(choose(precontrol.kv, precontrol.kv_m105)),
        };
        let (slope, step_mm) = (self.characteristic.slope(), self.measuring.measuring_step_mm());
        self.fixed = Fixed::of(&self.settings, &self.timing, slope, step_mm);
        self.bias.change();
    }

    /// Says whether the axis moves on a circle, where reversal peaks are compensated [000:3663-3709].
    pub fn set_circular(&mut self, circular: bool) {
        self.circular = circular;
    }

    /// Replaces the positioning window, mm: MP7150 in cycle 17 [000:6128]; `None` is MP1030 again.
    pub fn set_window(&mut self, window_mm: Option<f64>) {
        self.window_mm = window_mm;
    }

    /// Takes the last reference mark that was crossed.
    pub fn take_mark(&mut self) -> Option<Mark> {
        self.measuring.take_mark()
    }

    /// Forgets the marks that were crossed, at the start of a reference run.
    pub fn forget_marks(&mut self) {
        self.measuring.forget_marks();
    }

    /// The marks say a place where the axis cannot be: they are forgotten, and with MP30 the scale is defective (inferred).
    pub fn refuse_marks(&mut self) {
        self.measuring.forget_marks();
        if self.settings.encoder.check_distance_code {
            self.raise(Fault::MeasuringSystem(EncoderFault::Position));
        }
    }

    /// Says at which position a count is, mm: the reference mark's, or for a display axis that of
    /// [`Axis::count`]. Nominal and actual position shift alike, by the value returned, mm.
    pub fn set_datum(&mut self, count: i64, position_mm: f64) -> f64 {
        self.measuring.set_datum(count, position_mm);
        let shift = self.measuring.actual_mm() - self.actual_mm;
        self.shift_positions(shift);
        shift
    }

    /// Counts from elsewhere: nominal and actual position shift by a distance, mm, and nothing moves. A rotary
    /// axis that has turned goes on within one turn.
    pub fn shift(&mut self, distance_mm: f64) {
        self.measuring.shift(distance_mm);
        self.shift_positions(distance_mm);
    }

    fn shift_positions(&mut self, shift: f64) {
        self.actual_mm += shift;
        self.cycle_actual_mm += shift;
        self.nominal_mm += shift;
        self.commanded_mm += shift;
        self.rest_mm += shift;
        self.travel.shift(shift);
        self.interpolation.shift(shift);
        self.transient.shift(shift);
        self.monitor.shift(shift);
    }

    /// The error of the axis at the present position after the error tables, mm: positive where the table
    /// travels too far [000:3736]. See [`ErrorTable`](crate::ErrorTable).
    pub fn set_error(&mut self, error_mm: f64) {
        self.measuring.set_error(error_mm);
    }

    /// Lag tracking: moves the machine towards an offset (W576 to W584) by at most a step (MP4070), mm,
    /// without a change of the actual position; once in each PLC cycle [000:3902-3912].
    pub fn track(&mut self, offset_mm: f64, step_mm: f64) {
        self.measuring.track(offset_mm, step_mm);
    }

    /// The offset that the drive shows at rest, as code number 75 368 shows it, in units of
    /// [`Timing::offset_unit_volts`] [000:5014-5016] [001:2575-2581].
    pub fn offset_units(&self) -> i32 {
        self.offset.units(&self.timing)
    }

    /// Compensates the offset that is shown: ENT after code number 75 368; on a TNC 407 from 0.6 mV on
    /// [000:5018].
    pub fn compensate_offset(&mut self) {
        self.offset.compensate(&self.timing);
    }

    /// One cyclic adjustment: 1 mV, below that one step of the converter [000:5032-5034]. See
    /// [`OffsetInterval`](crate::OffsetInterval).
    pub fn adjust_offset(&mut self) {
        self.offset.adjust(&self.timing);
    }

    /// The compensation by code number and cycle, V: what must survive power-off [000:5020].
    pub fn offset_compensation_volts(&self) -> f64 {
        self.offset.compensation_volts()
    }

    /// Sets the compensation, V; 0 switches it off (NO ENT) [000:5018].
    pub fn set_offset_compensation(&mut self, volts: f64) {
        self.offset.set_compensation(volts);
    }

    /// The count of the last reading.
    pub fn count(&self) -> i64 {
        self.measuring.count()
    }

    /// Actual position by the encoder, mm or degrees.
    pub fn actual_mm(&self) -> f64 {
        self.actual_mm
    }

    /// Nominal position at the last step, mm: it belongs to the actual position read before it.
    pub fn nominal_mm(&self) -> f64 {
        self.nominal_mm
    }

    /// The position that was commanded last, mm.
    pub fn target_mm(&self) -> f64 {
        self.commanded_mm
    }

    /// Nominal less actual position, mm.
    pub fn lag_mm(&self) -> f64 {
        self.nominal_mm - self.actual_mm
    }

    /// Velocity of the nominal value, mm/min.
    pub fn velocity_mm_min(&self) -> f64 {
        self.velocity_mm_min
    }

    /// Velocity of the nominal position, mm/min; its sign is the direction of travel (M2160).
    pub fn profile_mm_min(&self) -> f64 {
        self.profile_mm_min
    }

    /// Velocity of the actual position over the last contour cycle, mm/min.
    pub fn actual_velocity_mm_min(&self) -> f64 {
        self.actual_mm_min
    }

    /// Velocity that stiction compensation adds, mm/min.
    pub fn stiction_mm_min(&self) -> f64 {
        self.stiction.mm_min
    }

    /// Voltage of the output, V.
    pub fn volts(&self) -> f64 {
        self.volts
    }

    /// Whether the loop is closed; not with a fault that cannot be cleared.
    #[inline]
    pub fn closed(&self) -> bool {
        self.closed && self.faults.is_sound()
    }

    /// So much later than it was commanded the axis is at a position in uniform motion with pre-control, s.
    pub fn delay_s(&self) -> f64 {
        self.transient.delay_steps() * self.timing.step_min() * 60.0
    }

    /// With servo lag or with feed pre-control.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Whether the axis has reached its positioning window MP1030 after the last movement [000:5302-5318].
    pub fn in_position(&self) -> bool {
        self.in_position
    }
}
