//! The time of the simulation: it passes in steps, and now and then there is a tick.

/// Contacts, relays and things move once in so many µs.
pub(crate) const TICK_US: u32 = 1000;

/// How far it is.
#[derive(Clone, Debug)]
pub(crate) struct Clock {
    step_us: u32,
    /// Steps of a whole tick.
    tick_steps: u32,
    /// The length of a step, s.
    pub step_s: f64,
    /// Time since power-on, µs.
    pub time_us: u64,
    /// Time has passed since the encoders were read.
    pub moved_on: bool,
    /// Time that has not filled a step, µs.
    pending_us: u32,
    /// Steps to the next tick.
    until_tick: u32,
}

/// Steps in which the parts of the machine do not see each other, and the ticks after some of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// How many steps.
    pub steps: u32,
    /// The first tick comes after so many of them, each other one so many later.
    pub first: u32,
    pub each: u32,
}

impl Span {
    /// How many ticks.
    pub fn ticks(self) -> u32 {
        match self.steps.checked_sub(self.first) {
            Some(after) => 1 + after / self.each,
            None => 0,
        }
    }
}

impl Clock {
    /// Steps of so many µs, which divide a tick.
    pub fn new(step_us: u32) -> Clock {
        let tick_steps = TICK_US / step_us.max(1);
        Clock {
            step_us,
            tick_steps,
            step_s: f64::from(step_us) * 1e-6,
            time_us: 0,
            moved_on: true,
            pending_us: 0,
            until_tick: tick_steps,
        }
    }

    /// So much time passes, µs.
    pub fn add(&mut self, micros: u32) {
        self.moved_on |= micros > 0;
        self.time_us += u64::from(micros);
        self.pending_us = self.pending_us.saturating_add(micros);
    }

    /// The steps that are due, up to so many ticks, one at least.
    pub fn next_span(&mut self, ticks: u32) -> Option<Span> {
        if self.pending_us < self.step_us {
            return None;
        }
        let (first, each) = (self.until_tick, self.tick_steps);
        let steps = (self.pending_us / self.step_us).min(first + (ticks - 1) * each);
        self.pending_us -= steps * self.step_us;
        self.until_tick = match steps.checked_sub(first) {
            Some(after) => each - after % each,
            None => first - steps,
        };
        Some(Span { steps, first, each })
    }

    /// Time that waits for a step, µs.
    pub fn pending_us(&self) -> u32 {
        self.pending_us
    }
}
