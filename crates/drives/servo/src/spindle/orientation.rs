//! The position loop of the spindle [000:5851-5931].

/// Turning on, the orientation waits for its speed; then it runs to its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Phase {
    /// Along the ramp to the speed of the orientation, and on until the reference mark is known.
    Approach,
    /// The position loop holds it at the target.
    Controlled {
        /// On the scale of [`SpindleEncoder::turned_deg`](super::encoder::SpindleEncoder::turned_deg).
        target_deg: f64,
    },
}

/// An orientation that was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Orientation {
    pub angle_deg: f64,
    pub rpm: f64,
    /// +1 M03, -1 M04, 0 the shorter way.
    pub direction: f64,
    pub phase: Phase,
    pub reached: bool,
    /// Servo steps since the window was reached.
    pub steps: u32,
}

/// How the spindle comes to a target.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dynamics {
    /// Speed of the orientation, degrees/min.
    pub speed: f64,
    /// Slope of the loop, 1/min.
    pub slope: f64,
    /// Deceleration along the ramp, degrees/min²; infinite without ramp.
    pub deceleration: f64,
}

impl Dynamics {
    /// The velocity at a distance from the target, degrees/min: kv, at most the speed of the orientation, and no
    /// more than the ramp can brake.
    pub(super) fn velocity(&self, turn_deg: f64) -> f64 {
        let brakes = (2.0 * self.deceleration * turn_deg.abs()).sqrt();
        let amount = (self.slope * turn_deg.abs()).min(brakes).min(self.speed);
        amount.copysign(turn_deg)
    }

    /// Distance in which the spindle comes to its target from a speed in degrees/min: of the ramp and of kv.
    fn stopping_deg(&self, speed: f64) -> f64 {
        speed * speed / (2.0 * self.deceleration) + speed / self.slope
    }

    /// The distance to an angle, degrees, from an angle at a velocity (degrees/min, 0 at standstill) and in a
    /// direction: +1, -1, or 0 for the shorter way.
    pub(super) fn turn_deg(&self, from_deg: f64, to_deg: f64, velocity: f64, direction: f64) -> f64 {
        let forward = (to_deg - from_deg).rem_euclid(360.0);
        if direction == 0.0 {
            return if forward > 180.0 { forward - 360.0 } else { forward };
        }
        let ahead = if direction > 0.0 {
            forward
        } else {
            (from_deg - to_deg).rem_euclid(360.0)
        };
        let missing = self.stopping_deg(velocity.abs()) - ahead;
        let turns = (missing / 360.0).ceil().max(0.0);
        direction * (ahead + turns * 360.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DYNAMICS: Dynamics = Dynamics {
        speed: 36_000.0,
        slope: 1000.0,
        deceleration: 3.6e6,
    };

    #[test]
    fn the_way_goes_in_its_direction() {
        let standing = |from, to, direction| DYNAMICS.turn_deg(from, to, 0.0, direction);
        assert_eq!(standing(10.0, 350.0, 0.0), -20.0);
        assert_eq!(standing(350.0, 10.0, 0.0), 20.0);
        assert_eq!(standing(10.0, 350.0, 1.0), 340.0);
        assert_eq!(standing(350.0, 10.0, -1.0), -340.0);
        assert_eq!(standing(20.0, 20.0, 1.0), 0.0);
    }

    #[test]
    fn a_turning_spindle_needs_room_to_stop() {
        // 36 000 degrees/min: 36 000²/(2 · 3.6e6) = 180 degrees by the ramp, and 36 by kv.
        let turning = |to| DYNAMICS.turn_deg(0.0, to, 36_000.0, 1.0);
        assert_eq!(turning(217.0), 217.0);
        assert_eq!(turning(215.0), 575.0);
    }
}
