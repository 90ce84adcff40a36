//! The time of the simulation: it passes in steps, and now and then there is a tick.

/// Contacts, relays and things move once in so many µs.
pub(crate) const TICK_US: u32 = 1000;

/// How far it is.
#[derive(Clone, Debug)]
pub(crate) struct Clock {
    step_us: u32,
    /// The length of a step, s.
    pub step_s: f64,
    /// Time since power-on, µs.
    pub time_us: u64,
    /// Time has passed since the encoders were read.
    pub moved_on: bool,
    /// Time that has not filled a step, and steps that have not filled a tick, µs.
    pending_us: u32,
    tick_us: u32,
}

impl Clock {
    /// Steps of so many µs, which divide a tick.
    pub fn new(step_us: u32) -> Clock {
        Clock {
            step_us,
            step_s: f64::from(step_us) * 1e-6,
            time_us: 0,
            moved_on: true,
            pending_us: 0,
            tick_us: 0,
        }
    }

    /// So much time passes, µs.
    pub fn add(&mut self, micros: u32) {
        self.moved_on |= micros > 0;
        self.time_us += u64::from(micros);
        self.pending_us = self.pending_us.saturating_add(micros);
    }

    /// How many steps are due at once: up to a tick the parts do not see each other.
    pub fn next_steps(&mut self) -> Option<u32> {
        if self.pending_us < self.step_us {
            return None;
        }
        let steps = (self.pending_us / self.step_us).min((TICK_US - self.tick_us) / self.step_us);
        let length_us = steps * self.step_us;
        self.pending_us -= length_us;
        self.tick_us += length_us;
        Some(steps)
    }

    /// These steps have filled a tick.
    pub fn ticks(&mut self) -> bool {
        let ticks = self.tick_us >= TICK_US;
        if ticks {
            self.tick_us = 0;
        }
        ticks
    }

    /// Time that waits for a step, µs.
    pub fn pending_us(&self) -> u32 {
        self.pending_us
    }
}
