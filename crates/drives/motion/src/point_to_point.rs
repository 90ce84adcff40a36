//! One axis by itself: jog, reference run, positioning by the PLC.

use crate::limits::mm_s2;
use crate::ramp::{Driven, Ramp};

/// What part of its braking distance, and of the size of positions, may be missing by rounding alone.
const ROUNDING: f64 = 1e-12;

/// Moves one axis with its own ramps: as fast as its acceleration (MP1060) and a speed limit allow, to a
/// target or at a feed that may both change at any moment. It lands on its target to the bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointToPoint {
    position: f64,
    /// Speed with its sign, mm/s.
    speed: f64,
}

/// Where an axis is to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// To a position, mm or degrees, and stand there. Without overshoot, unless the axis is already
    /// too fast for its distance: then it comes back.
    Position(f64),
    /// On and on at a feed, mm/min or degrees/min, negative backwards; 0 stops.
    Feed(f64),
}

impl PointToPoint {
    /// An axis that stands at a position, mm or degrees.
    pub fn new(position: f64) -> PointToPoint {
        PointToPoint { position, speed: 0.0 }
    }

    /// An axis that already moves, mm/s: it is taken over from the path or the handwheel.
    pub fn moving(position: f64, speed_mm_s: f64) -> PointToPoint {
        PointToPoint {
            position,
            speed: speed_mm_s,
        }
    }

    /// Nominal position, mm or degrees.
    pub fn position(&self) -> f64 {
        self.position
    }

    /// Nominal speed, mm/s or degrees/s, with its sign.
    pub fn speed_mm_s(&self) -> f64 {
        self.speed
    }

    /// Whether the axis stands at a position.
    pub fn is_at(&self, position: f64) -> bool {
        self.speed == 0.0 && self.position == position
    }

    /// Moves for a time, s, not faster than `greatest_feed_mm_min` once it is braked to that, with the
    /// acceleration of the machine parameters in m/s²; the new position. What is not a number
    /// counts as 0, as a target it means stop.
    pub fn cycle(&mut self, time_s: f64, aim: Aim, greatest_feed_mm_min: f64, acceleration_m_s2: f64) -> f64 {
        let time = if time_s > 0.0 { time_s } else { 0.0 };
        let limit = if greatest_feed_mm_min > 0.0 {
            greatest_feed_mm_min / 60.0
        } else {
            0.0
        };
        let acceleration = mm_s2(acceleration_m_s2);
        match aim {
            Aim::Position(target) if target.is_finite() => self.approach(time, target, limit, acceleration),
            Aim::Position(_) => {
                self.change_to(0.0, time, acceleration);
            }
            Aim::Feed(feed) => {
                let feed = if feed.is_nan() { 0.0 } else { feed / 60.0 };
                let left = self.change_to(feed.clamp(-limit, limit), time, acceleration);
                self.position += self.speed * left;
            }
        }
        self.position
    }

    /// Drives to a target; turns back first where it runs away from it or past it.
    fn approach(&mut self, mut time: f64, target: f64, limit: f64, acceleration: f64) {
        let mut distance = target - self.position;
        // Positions are known to some parts in 1e16 of their size.
        let rounding = ROUNDING * (target.abs() + self.position.abs() + distance.abs());
        let braking = 0.5 * self.speed * self.speed / acceleration;
        if self.speed * distance < 0.0 || braking > distance.abs() + rounding {
            time = self.change_to(0.0, time, acceleration);
            if self.speed != 0.0 {
                return;
            }
            distance = target - self.position;
        }
        let ramp = Ramp {
            speed: self.speed.abs().min((2.0 * acceleration * distance.abs()).sqrt()),
            rest: distance.abs(),
            acceleration,
            limit,
            exit_squared: 0.0,
        };
        match ramp.drive(time) {
            Driven::Arrived { .. } => (self.position, self.speed) = (target, 0.0),
            Driven::OnTheWay { speed, rest } => {
                self.speed = speed.copysign(distance);
                // An axis that stands must not creep by rounding.
                if rest < ramp.rest {
                    self.position = target - rest.copysign(distance);
                }
            }
        }
    }

    /// Changes the speed for a time at most; the time that is left once it is reached, s.
    fn change_to(&mut self, speed: f64, time: f64, acceleration: f64) -> f64 {
        let needed = (speed - self.speed).abs() / acceleration;
        let (end, spent) = if time < needed {
            let change = (acceleration * time).copysign(speed - self.speed);
            (self.speed + change, time)
        } else {
            (speed, needed)
        };
        self.position += 0.5 * (self.speed + end) * spent;
        self.speed = end;
        time - spent
    }
}
