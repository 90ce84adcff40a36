//! The speed of a spindle whose angle is counted in whole steps.
//!
//! Decision: The speed of the spindle is taken over the longest of the last 16 contour cycles whose counts, 4096
//! steps of a turn, are those of a steady speed; trembling about the edge of a step is standstill. The encoder input
//! of the spindle is for square-wave signals on a TNC 360, too, whose manual does not say (also
//! `servo/src/spindle/encoder.rs`)

use crate::plant::Encoder;

/// Contour cycles over which the speed is taken at most (inferred).
const CYCLES: usize = 16;

/// The counts of the last contour cycles, the newest first.
///
/// A step of the encoder in a contour cycle is 2.4 rpm in 6 ms and 4.9 rpm in 3 ms. So the speed is taken over the longest of the
/// last cycles whose counts are those of a steady speed (adaptive windowing, inferred). At a steady speed and at standstill a
/// step is divided among all of them; on a ramp the last cycle alone counts, as if there were no others.
#[derive(Clone, Debug, Default)]
pub(super) struct Pace {
    counts: [i64; CYCLES + 1],
}

impl Pace {
    /// It stands at a count.
    pub(super) fn at(count: i64) -> Pace {
        Pace {
            counts: [count; CYCLES + 1],
        }
    }

    /// The count at the end of a contour cycle; the speed, counts in a cycle.
    pub(super) fn next(&mut self, count: i64) -> f64 {
        const STEP: f64 = Encoder::SQUARE_WAVE_STEPS as f64;
        // A spindle that trembles about the edge of a step stands: what is counted has a play of a step.
        let [last, ..] = self.counts;
        let count = last.clamp(count.saturating_sub(Encoder::SQUARE_WAVE_STEPS), count);
        self.counts.copy_within(..CYCLES, 1);
        let [newest, ..] = &mut self.counts;
        *newest = count;
        // Within a step of each other two counts fit to any steady speed between these.
        let (mut least, mut greatest) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut speed = 0.0;
        for (first, from) in self.counts.iter().enumerate().skip(1) {
            for (last, to) in self.counts.iter().enumerate().take(first) {
                let (way, cycles) = (to.wrapping_sub(*from) as f64, (first - last) as f64);
                least = f64::max(least, (way - STEP) / cycles);
                greatest = f64::min(greatest, (way + STEP) / cycles);
            }
            if least >= greatest {
                break;
            }
            speed = 0.5 * (least + greatest);
        }
        speed
    }
}
