//! The velocity that a lag asks for.

use crate::settings::LagSettings;

/// kv 1 (m/min)/mm as velocity in mm/min for a lag of 1 mm.
pub(crate) const KV_PER_MIN: f64 = 1000.0;

/// Velocity over lag: kv up to the kink point, above it kv times a factor [000:4898-4925].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Characteristic {
    /// Slope up to the kink, 1/min.
    slope: f64,
    /// Lag at the kink, mm.
    kink_mm: f64,
    /// Factor of the slope above it.
    factor: f64,
}

impl Characteristic {
    /// With a kink at MP1830 percent of rapid traverse (mm/min), kv in (m/min)/mm: MP1810, after M105
    /// MP1815.
    pub fn with_kink(kv: f64, lag: &LagSettings, rapid_mm_min: f64) -> Characteristic {
        let slope = kv * KV_PER_MIN;
        Characteristic {
            slope,
            kink_mm: lag.kink_percent / 100.0 * rapid_mm_min / slope,
            factor: lag.kink_factor,
        }
    }

    /// Without kink, kv in (m/min)/mm: the control part with pre-control.
    pub fn straight(kv: f64) -> Characteristic {
        Characteristic {
            slope: kv * KV_PER_MIN,
            kink_mm: f64::INFINITY,
            factor: 1.0,
        }
    }

    /// The velocity for a lag in mm, mm/min.
    pub fn velocity_mm_min(&self, lag_mm: f64) -> f64 {
        let steep = lag_mm.clamp(-self.kink_mm, self.kink_mm);
        (steep + (lag_mm - steep) * self.factor) * self.slope
    }

    /// The lag at a steady velocity in mm/min, mm: `v/kv · [kink + (1 - kink)/factor]` [000:4898-4907].
    pub fn lag_mm(&self, velocity_mm_min: f64) -> f64 {
        let straight = velocity_mm_min / self.slope;
        let steep = straight.clamp(-self.kink_mm, self.kink_mm);
        steep + (straight - steep) / self.factor
    }

    /// The slope at standstill, 1/min.
    pub(crate) fn slope(&self) -> f64 {
        self.slope
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that unwraps nothing fails")]
    use super::*;
    use proptest::prelude::*;

    fn characteristic(kv: f64, rapid: f64, factor: f64, percent: f64) -> Characteristic {
        let lag = LagSettings {
            kv,
            kv_m105: kv,
            kink_factor: factor,
            kink_percent: percent,
            feed_forward: 0.0,
            monitoring_mm: 3.0,
            emergency_mm: 3.5,
        };
        Characteristic::with_kink(kv, &lag, rapid)
    }

    #[test]
    fn rapid_traverse_of_5_m_min_at_kv_2_lags_2_5_mm() {
        // s = v/kv = 5 / 2 [000:4881-4887].
        assert_eq!(characteristic(2.0, 5000.0, 1.0, 100.0).lag_mm(5000.0), 2.5);
    }

    #[test]
    fn above_the_kink_the_lag_grows() {
        // 2.5 · (0.4 + 60/(0.5 · 100)) = 2.5 · 1.6 = 4.0 mm [000:4898-4907].
        let kinked = characteristic(2.0, 5000.0, 0.5, 40.0);
        assert!((kinked.lag_mm(5000.0) - 4.0).abs() < 1e-12);
        // Up to 40 % of 5000 = 2000 mm/min the lag is v/kv.
        assert_eq!(kinked.lag_mm(2000.0), 1.0);
    }

    proptest! {
        #[test]
        fn lag_is_the_inverse_of_velocity(
            kv in 0.1f64..20.0, factor in 0.001f64..1.0, percent in 0f64..100.0, v in -300_000f64..300_000.0,
        ) {
            let kinked = characteristic(kv, 10_000.0, factor, percent);
            let back = kinked.velocity_mm_min(kinked.lag_mm(v));
            prop_assert!((back - v).abs() <= 1e-9 * (1.0 + v.abs()));
            prop_assert_eq!(kinked.velocity_mm_min(-1.5), -kinked.velocity_mm_min(1.5));
        }
    }
}
