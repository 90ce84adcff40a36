//! How the stylus of a measuring probe follows a surface: it stays deflected [000:7882-7958].
//!
//! Decision: A TM 110 scans with MP6360; its depth is put right with 5 1/s, and MP6362 leaves a twentieth of the feed
//! at least. MP6322 that is 0 for all axes leaves each its own (also `parameters/src/settings/machining.rs`)

use bahn_path::{MeasuringRules, ScanPoint};

use super::stylus::{Felt, Followed, Tracking, Wish};

/// How fast a wrong depth of deflection is put right, 1/s: slower than position loops are with a kv factor of 1
/// (inferred).
const GAIN_PER_S: f64 = 5.0;
/// Part of the feed that MP6362 leaves at least (inferred).
const SLOWEST: f64 = 0.05;

fn dot(a: ScanPoint, b: ScanPoint) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A stylus that stays in contact.
#[derive(Clone, Debug)]
pub(super) struct Glide {
    rules: MeasuringRules,
    /// Off the surface, along and off in the plane of the scan.
    normal: [f64; 2],
}

impl Glide {
    pub fn new(rules: MeasuringRules) -> Glide {
        Glide {
            rules,
            normal: [0.0, 1.0],
        }
    }

    /// The plane has changed.
    pub fn begin(&mut self) {
        self.normal = [0.0, 1.0];
    }

    /// Along the surface: the deflection says in which direction that is, and its depth is held. A point is taken before it
    /// would lie farther than the interval from the last one.
    pub fn cycle(&mut self, felt: &Felt, tracking: &Tracking, last: ScanPoint, interval_mm: f64) -> Followed {
        let deflection = [
            dot(felt.deflection, tracking.along),
            dot(felt.deflection, tracking.off),
        ];
        let in_plane = deflection[0].hypot(deflection[1]);
        if in_plane > 0.0 {
            self.normal = deflection.map(|part| part / in_plane);
        }
        let depth = dot(felt.deflection, felt.deflection).sqrt();
        let missing = self.rules.depth_mm - depth;
        let full = self.rules.feed_mm_min / 60.0;
        let feed = match self.rules.slows {
            true => full * (1.0 - missing.abs() / self.rules.depth_mm).clamp(SLOWEST, 1.0),
            false => full,
        };
        let tip: ScanPoint = std::array::from_fn(|k| felt.at[k] + felt.deflection[k]);
        let distance = (0..3).map(|k| (tip[k] - last[k]).powi(2)).sum::<f64>().sqrt();
        if in_plane > 0.0 && distance + full * felt.time_s > interval_mm {
            return Followed::Touched(tip, self.wish(tracking, feed, missing, full));
        }
        Followed::Moves(self.wish(tracking, feed, missing, full))
    }

    fn wish(&self, tracking: &Tracking, feed: f64, missing: f64, full: f64) -> Wish {
        let [along, off] = self.normal;
        let inwards = (GAIN_PER_S * missing).clamp(-full, full);
        // The direction along the surface stands at right angles to its normal.
        let plane = [feed * off - inwards * along, -feed * along - inwards * off];
        Wish {
            velocity: std::array::from_fn(|k| plane[0] * tracking.along[k] + plane[1] * tracking.off[k]),
            end: None,
        }
    }
}
