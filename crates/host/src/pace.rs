//! Keeps pace with the clock on the wall.

use std::time::{Duration, Instant};

/// Waits are slept through up to this before their end.
const SPIN: Duration = Duration::from_micros(200);

/// How fast a machine runs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Clock {
    /// As fast as it can: the same commands at the same times give the same bits.
    #[default]
    Free,
    /// So many times as fast as the clock on the wall; 1 is real time.
    Wall(f64),
}

/// How well the pace was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Lateness {
    /// Cycles that were driven by the clock.
    pub cycles: u64,
    /// Cycles that ended after their time.
    pub late_cycles: u64,
    /// By how much the worst one did.
    pub worst_lateness_ms: f64,
}

pub(crate) struct Pace {
    started: Instant,
    /// Time of the machine then, µs.
    origin_us: u64,
    factor: f64,
    pub lateness: Lateness,
}

impl Pace {
    /// The pace of a clock from now on; none where the machine runs freely.
    pub fn of(clock: Clock, time_us: u64) -> Option<Pace> {
        match clock {
            Clock::Wall(factor) if factor.is_finite() && factor > 0.0 => Some(Pace {
                started: Instant::now(),
                origin_us: time_us,
                factor,
                lateness: Lateness::default(),
            }),
            _ => None,
        }
    }

    /// A contour cycle is done whose time has ended: waits for it, or notes that it is over.
    pub fn cycle(&mut self, time_us: u64) {
        let passed_us = time_us.saturating_sub(self.origin_us);
        let due = Duration::try_from_secs_f64(passed_us as f64 * 1e-6 / self.factor).unwrap_or(Duration::MAX);
        let now = self.started.elapsed();
        self.lateness.cycles += 1;
        match due.checked_sub(now) {
            Some(rest) => {
                if let Some(sleep) = rest.checked_sub(SPIN) {
                    std::thread::sleep(sleep);
                }
                while self.started.elapsed() < due {
                    std::hint::spin_loop();
                }
            }
            None => {
                let late_ms = (now - due).as_secs_f64() * 1e3;
                self.lateness.late_cycles += 1;
                self.lateness.worst_lateness_ms = self.lateness.worst_lateness_ms.max(late_ms);
            }
        }
    }
}
