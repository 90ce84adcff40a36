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
///
/// A pair of counts says between which two speeds a steady one lies. The pairs of a window are those of the window of the
/// cycle before that ended a cycle earlier, and those with the newest count: so each cycle looks at 16 pairs, not at 136.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    counts: [i64; CYCLES + 1],
    /// What the pairs of the last 1, 2, .. 16 cycles say, counts in a cycle.
    windows: [Bounds; CYCLES],
}

/// Between which two speeds a steady one lies, counts in a cycle.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    least: f64,
    greatest: f64,
}

impl Bounds {
    /// Nothing is known.
    const NONE: Bounds = Bounds {
        least: f64::NEG_INFINITY,
        greatest: f64::INFINITY,
    };

    /// What both say.
    fn and(self, other: Bounds) -> Bounds {
        Bounds {
            least: self.least.max(other.least),
            greatest: self.greatest.min(other.greatest),
        }
    }

    /// What two counts say: within a step of each other they fit to any steady speed between these.
    fn of(way: i64, cycles: usize) -> Bounds {
        const STEP: f64 = Encoder::SQUARE_WAVE_STEPS as f64;
        let (way, cycles) = (way as f64, cycles as f64);
        Bounds {
            least: (way - STEP) / cycles,
            greatest: (way + STEP) / cycles,
        }
    }
}

impl Default for Pace {
    fn default() -> Pace {
        Pace::at(0)
    }
}

impl Pace {
    /// It stands at a count.
    pub(super) fn at(count: i64) -> Pace {
        let mut pace = Pace {
            counts: [count; CYCLES + 1],
            windows: [Bounds::NONE; CYCLES],
        };
        for _ in 0..CYCLES {
            pace.look();
        }
        pace
    }

    /// The count at the end of a contour cycle; the speed, counts in a cycle.
    pub(super) fn next(&mut self, count: i64) -> f64 {
        // A spindle that trembles about the edge of a step stands: what is counted has a play of a step.
        let [last, ..] = self.counts;
        let count = last.clamp(count.saturating_sub(Encoder::SQUARE_WAVE_STEPS), count);
        // Where nothing has turned for all cycles, one more changes nothing.
        if self.counts == [count; CYCLES + 1] {
            return 0.0;
        }
        self.counts.copy_within(..CYCLES, 1);
        let [newest, ..] = &mut self.counts;
        *newest = count;
        self.look();
        let steady = self
            .windows
            .iter()
            .take_while(|window| window.least < window.greatest);
        steady
            .last()
            .map_or(0.0, |window| 0.5 * (window.least + window.greatest))
    }

    /// The windows of the cycle before, and the pairs with the newest count.
    fn look(&mut self) {
        let [newest, before @ ..] = &self.counts;
        let (mut pairs, mut earlier) = (Bounds::NONE, Bounds::NONE);
        for ((cycles, from), window) in (1..).zip(before).zip(&mut self.windows) {
            pairs = pairs.and(Bounds::of(newest.wrapping_sub(*from), cycles));
            earlier = std::mem::replace(window, pairs.and(earlier));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The speed by all pairs of counts, as it is defined.
    fn by_all_pairs(counts: &[i64]) -> f64 {
        let (mut bounds, mut speed) = (Bounds::NONE, 0.0);
        for first in 1..counts.len() {
            for last in 0..first {
                bounds = bounds.and(Bounds::of(counts[last] - counts[first], first - last));
            }
            if bounds.least >= bounds.greatest {
                break;
            }
            speed = 0.5 * (bounds.least + bounds.greatest);
        }
        speed
    }

    #[test]
    fn the_windows_say_what_all_pairs_say() {
        let mut pace = Pace::at(7);
        let (mut count, mut speed, mut dice) = (7, 0, 12345_u64);
        for cycle in 0..20_000 {
            dice = dice
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let random = (dice >> 33) as i64;
            // Standstill that trembles, steady speeds and ramps of both senses.
            match cycle / 50 % 4 {
                0 => count += random % 3 - 1,
                1 => count += speed + random % 2,
                2 => {
                    speed += random % 7;
                    count += speed;
                }
                _ => {
                    speed -= random % 9;
                    count += speed;
                }
            }
            let said = pace.next(count);
            assert_eq!(
                said.to_bits(),
                by_all_pairs(&pace.counts).to_bits(),
                "cycle {cycle}"
            );
        }
    }
}
