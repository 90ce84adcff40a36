//! The lag of an axis against what its speed makes of it: a limit that goes with the speed.

/// Watches the lag of an axis. What lag it should have follows its nominal speed as a loop of its gain does, so that neither
/// ramp is taken for a fault.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LagWatch {
    expected_mm: f64,
    /// The lag is beyond its limit since so long, s.
    beyond_s: f64,
}

/// What a lag may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LagRule {
    /// Gain of the loop, 1/s.
    pub gain_s: f64,
    /// Part of the speed that is put out in advance.
    pub feed_forward: f64,
    /// So much of the expected lag is allowed above it.
    pub part: f64,
    /// What is always allowed, mm.
    pub least_mm: f64,
    /// So long it may be beyond, s.
    pub time_s: f64,
}

impl LagWatch {
    /// A cycle passes in which the axis moves at a nominal speed, mm/s, with a lag, mm. Whether it was beyond its limit for
    /// longer than it may.
    ///
    /// ```
    /// use bahn_kernel::{LagRule, LagWatch};
    /// let rule = LagRule { gain_s: 16.0, feed_forward: 0.0, part: 0.5, least_mm: 0.03, time_s: 0.05 };
    /// let mut watch = LagWatch::default();
    /// // It has come to 100 mm/s, and lags by 6.25 mm: 9 mm are allowed, 10 mm are not, and that for 50 ms.
    /// assert!((0..1000).all(|_| !watch.passes(&rule, 100.0, 0.0, 0.004)));
    /// assert!((0..1000).all(|_| !watch.passes(&rule, 100.0, 9.0, 0.004)));
    /// let cycles = (1..).find(|_| watch.passes(&rule, 100.0, 10.0, 0.004));
    /// assert_eq!(cycles, Some(13));
    /// ```
    pub fn passes(&mut self, rule: &LagRule, speed_mm_s: f64, lag_mm: f64, time_s: f64) -> bool {
        let wanted = speed_mm_s * (1.0 - rule.feed_forward) / rule.gain_s;
        let left = (-rule.gain_s * time_s).exp();
        self.expected_mm = wanted + (self.expected_mm - wanted) * left;
        let limit = self.expected_mm.abs() * (1.0 + rule.part) + rule.least_mm;
        self.beyond_s = match lag_mm.abs() > limit {
            true => self.beyond_s + time_s,
            false => 0.0,
        };
        self.beyond_s > rule.time_s
    }

    /// The axis begins where it is.
    pub fn reset(&mut self) {
        *self = LagWatch::default();
    }
}
