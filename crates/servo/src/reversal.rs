//! Compensation of the reversal peaks on circles.

/// The way that is put on top of the nominal position after a reversal: it grows to the height of the peak
/// by a part in each contour cycle [000:3671-3732], and goes back by the same parts (inferred).
#[derive(Clone, Debug, Default)]
pub(crate) struct ReversalPeak {
    direction: f64,
    value_mm: f64,
    goal_mm: f64,
}

impl ReversalPeak {
    /// A contour cycle with a nominal way; the way to put on top at its end, mm.
    pub(crate) fn advance(&mut self, way_mm: f64, circular: bool, height_mm: f64, part_mm: f64) -> f64 {
        if way_mm != 0.0 {
            let direction = way_mm.signum();
            if circular && direction == -self.direction && part_mm > 0.0 {
                self.goal_mm = direction * height_mm;
            }
            self.direction = direction;
        }
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
        assert_eq!(peak.advance(0.1, true, 0.003, 0.001), 0.0);
        let values: Vec<f64> = (0..7)
            .map(|_| (peak.advance(-0.1, true, 0.003, 0.001) * 1e6).round() / 1e3)
            .collect();
        assert_eq!(values, [-1.0, -2.0, -3.0, -2.0, -1.0, 0.0, 0.0]);
    }

    #[test]
    fn on_straight_lines_and_without_entry_nothing_is_added() {
        let mut peak = ReversalPeak::default();
        for (circular, height, part) in [(false, 0.003, 0.001), (true, 0.0, 0.001), (true, 0.003, 0.0)] {
            for way in [0.1, -0.1, -0.1, 0.0, 0.1] {
                assert_eq!(peak.advance(way, circular, height, part), 0.0);
            }
        }
    }
}
