//! How time passes at a station.

use bahn_host::Clock;

use crate::input::Refusal;
use crate::steps::Steps;

/// Factors by which time may pass.
const SPEEDS: std::ops::RangeInclusive<f64> = 0.1..=100.0;

/// By which clock, how fast, and whether it stands.
pub struct Passing {
    speed: f64,
    /// It passes by the clock on the wall.
    pub in_real_time: bool,
    /// The operator lets it stand.
    pub paused: bool,
    /// Cycles that are asked for while it is paused.
    pub steps: Steps,
}

impl Default for Passing {
    fn default() -> Passing {
        Passing {
            speed: 1.0,
            in_real_time: false,
            paused: false,
            steps: Steps::default(),
        }
    }
}

impl Passing {
    /// The clock by which the machine runs.
    pub fn clock(&self) -> Clock {
        match self.in_real_time {
            true => Clock::Wall(self.speed),
            false => Clock::Free,
        }
    }

    /// So many times as fast as on the wall.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Time passes so many times as fast from now on.
    ///
    /// # Errors
    /// In words, when it is none of 0.1 to 100.
    pub fn set_speed(&mut self, factor: f64) -> Result<(), Refusal> {
        if !SPEEDS.contains(&factor) {
            return Err(Refusal(format!(
                "time passes {} to {} times as fast, not {factor}",
                SPEEDS.start(),
                SPEEDS.end()
            )));
        }
        self.speed = factor;
        Ok(())
    }

    /// The operator lets it stand, and no cycles are asked for.
    pub fn stands(&self) -> bool {
        self.paused && !self.steps.wait()
    }
}
