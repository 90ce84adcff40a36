//! Compensation of the reversal peaks on circles.

/// A nominal position must come back by more than this to count as turned round, mm: more than what rounding
/// makes of a position that stands, less than any movement.
const TURN_MM: f64 = 1e-6;

/// The direction of the nominal travel.
#[derive(Clone, Debug, Default)]
pub(crate) struct Travel {
    /// +1, -1, or 0 before the first movement.
    direction: f64,
    /// The farthest nominal position in this direction.
    extreme_mm: f64,
}

impl Travel {
    /// Goes on to a nominal position; the new direction when it has changed.
    pub(crate) fn advance(&mut self, nominal_mm: f64) -> Option<f64> {
        let way = nominal_mm - self.extreme_mm;
        if way * self.direction > 0.0 {
            self.extreme_mm = nominal_mm;
        } else if way.abs() > TURN_MM {
            self.extreme_mm = nominal_mm;
            self.direction = way.signum();
            return Some(self.direction);
        }
        None
    }

    /// Begins at another position; the direction stays.
    pub(crate) fn set(&mut self, nominal_mm: f64) {
        self.extreme_mm = nominal_mm;
    }

    pub(crate) fn direction(&self) -> f64 {
        self.direction
    }

    pub(crate) fn shift(&mut self, way: f64) {
        self.extreme_mm += way;
    }
}

/// The distance that is put on top of the nominal position after a reversal: it grows to the height of the peak
/// by a part in each contour cycle [000:3671-3732], and goes back by the same parts (inferred).
#[derive(Clone, Debug, Default)]
pub(crate) struct ReversalPeak {
    value_mm: f64,
    goal_mm: f64,
}

impl ReversalPeak {
    /// The axis has turned round on a circle.
    pub(crate) fn begin(&mut self, direction: f64, height_mm: f64) {
        self.goal_mm = direction * height_mm;
    }

    /// A contour cycle; the distance to put on top at its end, mm.
    pub(crate) fn advance(&mut self, part_mm: f64) -> f64 {
        let part = if part_mm > 0.0 { part_mm } else { f64::INFINITY };
        self.value_mm += (self.goal_mm - self.value_mm).clamp(-part, part);
        if self.value_mm == self.goal_mm {
            self.goal_mm = 0.0;
        }
        self.value_mm
    }

    pub(crate) fn clear(&mut self) {
        *self = ReversalPeak::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_driven_in_parts_and_taken_back() {
        // 3 µm in parts of 1 µm after the reversal to negative.
        let mut peak = ReversalPeak::default();
        assert_eq!(peak.advance(0.001), 0.0);
        peak.begin(-1.0, 0.003);
        let micrometres = |value: f64| (value * 1e6).round() / 1e3;
        let values: Vec<f64> = (0..7).map(|_| micrometres(peak.advance(0.001))).collect();
        assert_eq!(values, [-1.0, -2.0, -3.0, -2.0, -1.0, 0.0, 0.0]);
    }

    #[test]
    fn rounding_does_not_turn_the_travel_round() {
        let mut travel = Travel::default();
        assert_eq!(travel.advance(1e-12), None);
        assert_eq!(travel.advance(0.1), Some(1.0));
        assert_eq!(travel.advance(0.2), None);
        assert_eq!(travel.advance(0.2 - 1e-12), None);
        assert_eq!(travel.advance(0.3), None);
        // However slowly it goes back.
        let back: Vec<f64> = (1..=20)
            .filter_map(|cycle| travel.advance(0.3 - 1e-7 * f64::from(cycle)))
            .collect();
        assert_eq!(back, [-1.0]);
        assert_eq!(travel.direction(), -1.0);
    }
}
