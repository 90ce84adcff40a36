//! How time passes at a station.

use bahn_host::Clock;

use crate::steps::Steps;

/// By which clock, how fast, and whether it stands.
pub(super) struct Passing {
    /// So many times as fast as on the wall.
    pub speed: f64,
    pub in_real_time: bool,
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
    pub fn clock(&self) -> Clock {
        match self.in_real_time {
            true => Clock::Wall(self.speed),
            false => Clock::Free,
        }
    }

    /// The operator lets it stand, and no cycles are asked for.
    pub fn stands(&self) -> bool {
        self.paused && !self.steps.wait()
    }
}
