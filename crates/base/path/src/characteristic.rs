//! A voltage by the velocity.

/// Points of a characteristic at most [000:9866].
const POINTS: usize = 4;

/// Which voltage belongs to which velocity: up to four points, linear between them [000:9862-9874].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Characteristic {
    points: [[f64; 2]; POINTS],
    count: usize,
}

impl Characteristic {
    /// Its points so far: velocity in mm/min and volts.
    pub fn points(&self) -> &[[f64; 2]] {
        self.points.get(..self.count).unwrap_or_default()
    }

    /// Adds a point of a greater velocity, mm/min, with its voltage, V; a fifth one is not taken.
    pub fn push(&mut self, mm_min: f64, volts: f64) {
        if let Some(place) = self.points.get_mut(self.count) {
            *place = [mm_min, volts];
            self.count += 1;
        }
    }

    /// The voltage at a velocity, mm/min; beyond the last point its voltage (inferred), without points 0 V.
    pub fn volts(&self, mm_min: f64) -> f64 {
        let points = self.points();
        let after = points.iter().position(|point| point[0] > mm_min);
        let after = after.unwrap_or(points.len());
        match (points.get(after.wrapping_sub(1)), points.get(after)) {
            (Some(from), Some(to)) => from[1] + (to[1] - from[1]) * (mm_min - from[0]) / (to[0] - from[0]),
            (Some(only), None) | (None, Some(only)) => only[1],
            (None, None) => 0.0,
        }
    }
}
