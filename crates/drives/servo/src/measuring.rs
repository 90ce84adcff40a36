//! From the count of an encoder to the position of the axis.

use crate::settings::AxisSettings;

use crate::fault::EncoderFault;
use crate::marks::DistanceCode;
use crate::plant::Encoder;

/// A reference mark that was crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// The count at the mark.
    pub count: i64,
    /// Where the mark is on the scale, mm from the scale datum: 0 for a single mark, of distance-coded
    /// marks known from the second one on [000:4549-4551].
    pub scale_mm: Option<f64>,
}

/// An encoder and what is known of the way from it to the table.
#[derive(Clone, Debug)]
pub(crate) struct MeasuringSystem {
    step_mm: f64,
    /// Counting steps of a measuring step.
    measuring_steps: i64,
    code: Option<DistanceCode>,
    linear_factor: f64,
    backlash_mm: f64,
    count: i64,
    measured_once: bool,
    /// The count that stands for `datum_mm` on the scale.
    datum_count: i64,
    datum_mm: f64,
    /// Side of the play on which the table lies, +1 or 0: half of a whole backlash is no side.
    play: f64,
    datum_play: f64,
    error_mm: f64,
    tracking_mm: f64,
    mark: Option<Mark>,
    last_mark: Option<i64>,
    /// The count of the scale datum, once referenced by distance-coded marks.
    scale_zero: Option<i64>,
    referenced_zero: Option<i64>,
}

impl MeasuringSystem {
    pub(crate) fn new(settings: &AxisSettings) -> MeasuringSystem {
        let mut new = MeasuringSystem {
            step_mm: 0.0,
            measuring_steps: 1,
            code: None,
            linear_factor: 1.0,
            backlash_mm: 0.0,
            count: 0,
            measured_once: false,
            datum_count: 0,
            datum_mm: 0.0,
            play: 0.0,
            datum_play: 0.0,
            error_mm: 0.0,
            tracking_mm: 0.0,
            mark: None,
            last_mark: None,
            scale_zero: None,
            referenced_zero: None,
        };
        new.configure(settings);
        new
    }

    pub(crate) fn configure(&mut self, settings: &AxisSettings) {
        let encoder = &settings.encoder;
        let period_um = encoder.signal_period_um;
        let sign = if encoder.counts_negative { -1.0 } else { 1.0 };
        self.step_mm = sign * period_um * 1e-3 / Encoder::STEPS as f64;
        self.measuring_steps = match encoder.square_wave {
            true => Encoder::SQUARE_WAVE_STEPS,
            false => 1,
        };
        let interpolation = encoder.interpolation.max(1);
        let grating_mm = period_um * 1e-3 * f64::from(interpolation);
        self.code = settings.marks.kind.is_coded().then(|| DistanceCode {
            interval: (settings.marks.spacing_mm / grating_mm).round() as i64,
            period_steps: Encoder::STEPS * i64::from(interpolation),
        });
        let compensation = &settings.compensation;
        self.linear_factor = if compensation.nonlinear {
            1.0
        } else {
            1.0 + compensation.linear_mm_m * 1e-3
        };
        self.backlash_mm = compensation.backlash_mm;
    }

    /// Distance of a counting step, mm, with the sense of counting.
    pub(crate) fn step_mm(&self) -> f64 {
        self.step_mm
    }

    /// The least distance that is seen, mm.
    pub(crate) fn measuring_step_mm(&self) -> f64 {
        self.step_mm.abs() * self.measuring_steps as f64
    }

    /// Takes what the encoder gives in this servo step; `Some` when its signals are faulty.
    pub(crate) fn read(&mut self, encoder: Encoder, settings: &AxisSettings) -> Option<EncoderFault> {
        let encoder = match settings.encoder.square_wave {
            true => encoder.fourfold(),
            false => encoder,
        };
        if !self.measured_once {
            self.measured_once = true;
            self.datum_count = encoder.count;
        }
        self.count = encoder.count;
        let checks = &settings.encoder;
        let contradiction = encoder.mark.is_some_and(|mark| self.cross(mark));
        if encoder.amplitude_low && checks.check_amplitude {
            Some(EncoderFault::Amplitude)
        } else if encoder.edges_too_close && checks.check_edges {
            Some(EncoderFault::Edges)
        } else if contradiction && checks.check_distance_code {
            Some(EncoderFault::Position)
        } else {
            None
        }
    }

    /// Evaluates a mark; true when it contradicts the marks before.
    fn cross(&mut self, count: i64) -> bool {
        let Some(code) = self.code else {
            self.mark = Some(Mark {
                count,
                scale_mm: Some(0.0),
            });
            return false;
        };
        let last = self.last_mark.replace(count);
        let Some(last) = last.filter(|last| last.abs_diff(count) > code.period_steps.unsigned_abs()) else {
            // The first mark, or the same one again after a reversal.
            self.mark = Some(Mark {
                count,
                scale_mm: None,
            });
            return false;
        };
        let steps = code.locate(last, count);
        self.mark = Some(Mark {
            count,
            scale_mm: steps.map(|steps| steps as f64 * self.step_mm),
        });
        self.scale_zero = steps.map(|steps| count.wrapping_sub(steps));
        match (self.scale_zero, self.referenced_zero) {
            (None, _) => true,
            (Some(zero), Some(known)) => zero.abs_diff(known) > code.period_steps.unsigned_abs() / 2,
            (Some(_), None) => false,
        }
    }

    /// Where the table is, mm: the distance of the encoder by its signal period, the linear error (positive
    /// where the table travels too far) [000:3736], the error of the tables, the play, and without the
    /// tracked offset, which moves the machine but not the display [000:3902-3904].
    pub(crate) fn actual_mm(&self) -> f64 {
        let scale = self.scale_mm(self.count);
        let play = self.backlash_mm * (self.play - self.datum_play);
        scale * self.linear_factor + self.error_mm - play - self.tracking_mm
    }

    /// The count that stands for a place of the table so far from where it is, mm, in parts of a step.
    pub(crate) fn steps_after(&self, distance_mm: f64) -> f64 {
        self.count as f64 + distance_mm / (self.step_mm * self.linear_factor)
    }

    /// A count as position of the scale, mm.
    pub(crate) fn scale_mm(&self, count: i64) -> f64 {
        count.wrapping_sub(self.datum_count) as f64 * self.step_mm + self.datum_mm
    }

    /// The nominal direction of travel says on which side of the play the table lies [000:3654].
    pub(crate) fn set_direction(&mut self, positive: bool) {
        self.play = f64::from(u8::from(positive));
    }

    pub(crate) fn set_error(&mut self, error_mm: f64) {
        self.error_mm = error_mm;
    }

    /// Moves the tracked offset towards a value by at most a step, mm.
    pub(crate) fn track(&mut self, towards_mm: f64, step_mm: f64) {
        let way = towards_mm - self.tracking_mm;
        self.tracking_mm += way.clamp(-step_mm.abs(), step_mm.abs());
    }

    pub(crate) fn count(&self) -> i64 {
        self.count
    }

    pub(crate) fn take_mark(&mut self) -> Option<Mark> {
        self.mark.take()
    }

    pub(crate) fn forget_marks(&mut self) {
        self.mark = None;
        self.last_mark = None;
        self.scale_zero = None;
    }

    /// Every count is a position farther on by a distance, mm.
    pub(crate) fn shift(&mut self, distance_mm: f64) {
        self.datum_mm += distance_mm / self.linear_factor;
    }

    /// A count is a position from now on.
    pub(crate) fn set_datum(&mut self, count: i64, position_mm: f64) {
        self.datum_count = count;
        self.datum_mm = position_mm;
        self.datum_play = self.play;
        self.measured_once = true;
        self.referenced_zero = self.scale_zero;
    }
}
