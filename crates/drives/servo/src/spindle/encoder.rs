//! The angle of the spindle.

use super::pace::Pace;
use super::settings::SpindleSettings;

use crate::fault::EncoderFault;
use crate::plant::Encoder;
use crate::timing::Timing;

/// Lines of the spindle's encoder: the window MP3420 counts in 360/4096 degree [000:5877].
const LINES: i64 = 1024;
/// Counting steps of a turn.
const TURN_STEPS: i64 = LINES * Encoder::STEPS;

/// Counts and speed of the spindle's encoder at its square-wave input, which evaluates it fourfold: 4096 steps of a turn
/// [000:5877] [001:450-454]; positive is M03.
#[derive(Clone, Debug, Default)]
pub(super) struct SpindleEncoder {
    count: i64,
    mark: Option<i64>,
    steps: u32,
    pace: Pace,
    rpm: f64,
    read_once: bool,
}

impl SpindleEncoder {
    /// Takes a reading; a fault that is to be looked for.
    pub(super) fn read(
        &mut self,
        encoder: Encoder,
        settings: &SpindleSettings,
        timing: &Timing,
    ) -> Option<EncoderFault> {
        let sign = if settings.counts_negative { -1 } else { 1 };
        let encoder = encoder.fourfold();
        self.count = encoder.count.wrapping_mul(sign);
        if !self.read_once {
            self.read_once = true;
            self.pace = Pace::at(self.count);
        }
        // The first mark is kept until it is asked for again [000:5881].
        let mark = encoder.mark.map(|mark| mark.wrapping_mul(sign));
        self.mark = self.mark.or(mark);
        self.steps += 1;
        if self.steps >= timing.steps() {
            self.rpm = self.pace.next(self.count) / TURN_STEPS as f64 / timing.contour_min();
            self.steps = 0;
        }
        if encoder.amplitude_low && settings.check_amplitude {
            Some(EncoderFault::Amplitude)
        } else if encoder.edges_too_close && settings.check_edges {
            Some(EncoderFault::Edges)
        } else {
            None
        }
    }

    /// Angle since power-on, degrees, not reduced to a turn.
    pub(super) fn turned_deg(&self) -> f64 {
        let turns = self.count.div_euclid(TURN_STEPS) as f64;
        let part = self.count.rem_euclid(TURN_STEPS) as f64 / TURN_STEPS as f64;
        (turns + part) * 360.0
    }

    /// Angle from the zero of the spindle, 0 up to 360 degrees; the reference mark stands at a preset angle.
    pub(super) fn angle_deg(&self, mark_deg: f64) -> Option<f64> {
        let steps = self.count.wrapping_sub(self.mark?).rem_euclid(TURN_STEPS);
        let angle = steps as f64 * 360.0 / TURN_STEPS as f64 + mark_deg;
        Some(angle.rem_euclid(360.0))
    }

    pub(super) fn forget_mark(&mut self) {
        self.mark = None;
    }

    pub(super) fn rpm(&self) -> f64 {
        self.rpm
    }
}
