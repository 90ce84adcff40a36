//! The position loop of an axis.

use bahn_parameters::AxisParameters;

use crate::characteristic::Characteristic;
use crate::fault::{Fault, GrossFault};
use crate::interpolation::{FineInterpolation, Transient};
use crate::measuring::{Mark, MeasuringSystem};
use crate::plant::Encoder;
use crate::timing::Timing;

/// How an axis is positioned [000:4714-4733].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// With servo lag: the velocity is kv times the lag [000:4735-4776].
    Lag,
    /// With feed pre-control: the velocity of the nominal position, and kv times what lag is left
    /// [000:4929-4975].
    Precontrol,
}

/// The position loop of one axis: nominal position in, voltage out.
///
/// In each contour cycle [`Axis::command`] says where the axis shall be at its end; in each servo step
/// [`Axis::measure`] takes the encoder in and [`Axis::step`] gives the voltage that holds until the next
/// one. Positions are mm (degrees for rotary axes) in machine coordinates, once [`Axis::set_datum`] has
/// told them; until then they count from where the axis stood at power-on. Nothing here allocates.
///
/// The loop is open after power-on: [`Axis::close`] closes it.
#[derive(Clone, Debug)]
pub struct Axis {
    parameters: AxisParameters,
    timing: Timing,
    measuring: MeasuringSystem,
    interpolation: FineInterpolation,
    transient: Transient,
    characteristic: Characteristic,
    method: Method,
    second_set: bool,
    closed: bool,
    enabled: bool,
    nominal_mm: f64,
    actual_mm: f64,
    velocity_mm_min: f64,
    volts: f64,
    fault: Option<Fault>,
}

impl Axis {
    /// An axis with open loop, at position 0.
    pub fn new(parameters: AxisParameters, timing: Timing) -> Axis {
        let mut axis = Axis {
            parameters,
            timing,
            measuring: MeasuringSystem::new(&parameters),
            interpolation: FineInterpolation::new(timing.steps()),
            transient: Transient::new(timing.steps(), parameters.precontrol.transient_m_min),
            characteristic: Characteristic::straight(1.0),
            method: Method::Lag,
            second_set: false,
            closed: false,
            enabled: true,
            nominal_mm: 0.0,
            actual_mm: 0.0,
            velocity_mm_min: 0.0,
            volts: 0.0,
            fault: None,
        };
        axis.choose_characteristic();
        axis
    }

    /// Takes an encoder reading; once in each servo step, before [`Axis::step`].
    pub fn measure(&mut self, encoder: Encoder) {
        if let Some(fault) = self.measuring.read(encoder, &self.parameters) {
            self.raise(Fault::MeasuringSystem(fault));
        }
        self.actual_mm = self.measuring.actual_mm();
    }

    /// The position for the end of the contour cycle that begins, mm. A value that is no number leaves the
    /// axis where it is.
    pub fn command(&mut self, nominal_mm: f64) {
        if !nominal_mm.is_finite() {
            return;
        }
        let way = nominal_mm - self.interpolation.now();
        if way != 0.0 {
            self.measuring.set_direction(way > 0.0);
        }
        self.interpolation.command(nominal_mm);
    }

    /// One servo step: the voltage for the nominal value output, V.
    pub fn step(&mut self) -> f64 {
        let rough_now = self.interpolation.now();
        let smooth_now = self.transient.now();
        let rough_next = self.interpolation.advance();
        let smooth_next = self.transient.advance(rough_next);
        let (now, next) = match self.method {
            Method::Lag => (rough_now, rough_next),
            Method::Precontrol => (smooth_now, smooth_next),
        };
        self.nominal_mm = now;
        let control = self.characteristic.velocity_mm_min(now - self.actual_mm);
        self.velocity_mm_min = match self.method {
            Method::Lag => control,
            Method::Precontrol => control + (next - now) / self.timing.step_min(),
        };
        self.volts = if self.closed && self.enabled {
            let output = &self.parameters.output;
            let polarity = if output.polarity_negative { -1.0 } else { 1.0 };
            let full = output.rapid_volts / self.parameters.motion.rapid_mm_min;
            self.timing.convert(polarity * self.velocity_mm_min * full)
        } else {
            0.0
        };
        self.volts
    }

    /// Closes the loop. The nominal position stays what it was: see [`Axis::transfer`].
    pub fn close(&mut self) {
        self.closed = true;
    }

    /// Opens the loop: 0 V [000:5403-5421].
    pub fn open(&mut self) {
        self.closed = false;
    }

    /// Makes the actual position the nominal one [000:5423-5434].
    pub fn transfer(&mut self) {
        self.interpolation.set(self.actual_mm);
        self.transient.set(self.actual_mm);
        self.nominal_mm = self.actual_mm;
    }

    /// Gives or withdraws the feed enable; without it the output is 0 V at once [000:5352].
    pub fn set_enabled(&mut self, enabled: bool) {
        self.enabled = enabled;
    }

    /// Chooses the method of positioning.
    pub fn set_method(&mut self, method: Method) {
        self.method = method;
        self.choose_characteristic();
    }

    /// Chooses the second set of kv, M105, or the first, M106 [000:4975].
    pub fn set_second_set(&mut self, second: bool) {
        self.second_set = second;
        self.choose_characteristic();
    }

    fn choose_characteristic(&mut self) {
        let (lag, precontrol) = (&self.parameters.lag, &self.parameters.precontrol);
        let choose = |first, second| if self.second_set { second } else { first };
        self.characteristic = match self.method {
            Method::Lag => Characteristic::with_kink(
                choose(lag.kv, lag.kv_m105),
                lag,
                self.parameters.motion.rapid_mm_min,
            ),
            Method::Precontrol => Characteristic::straight(choose(precontrol.kv, precontrol.kv_m105)),
        };
    }

    /// Takes the last reference mark that was crossed.
    pub fn take_mark(&mut self) -> Option<Mark> {
        self.measuring.take_mark()
    }

    /// Says at which position a count is, mm: the reference mark's, or for a display axis that of
    /// [`Axis::count`]. Nominal and actual position shift alike, by the value returned, mm.
    pub fn set_datum(&mut self, count: i64, position_mm: f64) -> f64 {
        self.measuring.set_datum(count, position_mm);
        let shift = self.measuring.actual_mm() - self.actual_mm;
        self.actual_mm += shift;
        self.nominal_mm += shift;
        self.interpolation.shift(shift);
        self.transient.shift(shift);
        shift
    }

    /// Forgets the marks that were crossed, at the start of a reference run.
    pub fn forget_marks(&mut self) {
        self.measuring.forget_marks();
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

    /// The count of the last reading.
    pub fn count(&self) -> i64 {
        self.measuring.count()
    }

    /// Actual position, mm.
    pub fn actual_mm(&self) -> f64 {
        self.actual_mm
    }

    /// Nominal position at the last step, mm: it belongs to the actual position read before it.
    pub fn nominal_mm(&self) -> f64 {
        self.nominal_mm
    }

    /// Where the axis will be at the end of the contour cycle, mm.
    pub fn target_mm(&self) -> f64 {
        self.interpolation.end()
    }

    /// Nominal less actual position, mm.
    pub fn lag_mm(&self) -> f64 {
        self.nominal_mm - self.actual_mm
    }

    /// Velocity that the loop asks for, mm/min.
    pub fn velocity_mm_min(&self) -> f64 {
        self.velocity_mm_min
    }

    /// Voltage of the output, V.
    pub fn volts(&self) -> f64 {
        self.volts
    }

    /// Whether the loop is closed.
    pub fn closed(&self) -> bool {
        self.closed
    }

    /// Whether the axis stands in its positioning window MP1030 [000:5302-5318].
    pub fn in_position(&self) -> bool {
        self.interpolation.now() == self.interpolation.end()
            && (self.interpolation.end() - self.actual_mm).abs() <= self.parameters.monitoring.window_mm
    }

    /// The fault that monitoring has found and that was not cleared.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    fn raise(&mut self, fault: Fault) {
        if self.fault.is_none_or(Fault::cancellable) {
            self.fault = Some(fault);
        }
        if matches!(fault, Fault::Gross(GrossFault::Movement)) {
            self.open();
        }
    }

    /// The key CE: clears a fault that can be cleared.
    pub fn acknowledge(&mut self) {
        if self.fault.is_some_and(Fault::cancellable) {
            self.fault = None;
            self.transfer();
        }
    }
}
