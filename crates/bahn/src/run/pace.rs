//! Keeps pace with the clock on the wall.

use std::time::{Duration, Instant};

/// Waits are slept through up to this before their end.
const SPIN: Duration = Duration::from_micros(200);

/// How well the pace was kept.
#[derive(Clone, Copy, Debug, Default, serde::Serialize)]
pub(super) struct Lateness {
    pub cycles: u64,
    /// Cycles that ended after their time.
    pub late_cycles: u64,
    pub worst_lateness_ms: f64,
}

pub(super) struct Pace {
    started: Instant,
    pub lateness: Lateness,
}

impl Pace {
    pub fn new() -> Pace {
        Pace {
            started: Instant::now(),
            lateness: Lateness::default(),
        }
    }

    /// A contour cycle is done whose time has ended: waits for it, or notes that it is over.
    pub fn cycle(&mut self, time_us: u64) {
        let due = Duration::from_micros(time_us);
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
