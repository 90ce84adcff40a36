//! Keeps pace with real time.
//!
//! Decision: A cycle that needs more processor time than it has is an overrun; what else is late is the operating
//! system's or a medium's doing

use std::time::{Duration, Instant};

/// Waits are slept through up to this before their end.
const SPIN: Duration = Duration::from_micros(200);

/// How fast a machine runs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Clock {
    /// As fast as it can: the same commands at the same times give the same bits.
    #[default]
    Free,
    /// So many times as fast as real time.
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
    /// Late cycles by how late they were, in ms: at most so much, and more than the one before.
    pub late_by: [Late; 5],
    /// Cycles that needed more of the processor than the time they had. What else is late is so because the operating
    /// system let something else run, or a medium was slow.
    pub overrun_cycles: u64,
    /// Processor time of the longest cycle.
    pub longest_ms: f64,
}

/// Cycles that were late by at most so much.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Late {
    /// ms; `None` for any more.
    pub at_most_ms: Option<f64>,
    /// Number of cycles that were so late.
    pub cycles: u64,
}

impl Lateness {
    fn new() -> Lateness {
        let late = |at_most_ms| Late {
            at_most_ms,
            cycles: 0,
        };
        Lateness {
            late_by: [Some(0.1), Some(1.0), Some(10.0), Some(100.0), None].map(late),
            ..Lateness::default()
        }
    }

    fn add(&mut self, late_ms: f64) {
        self.late_cycles += 1;
        self.worst_lateness_ms = self.worst_lateness_ms.max(late_ms);
        let fits = |late: &&mut Late| late.at_most_ms.is_none_or(|most| late_ms <= most);
        if let Some(late) = self.late_by.iter_mut().find(fits) {
            late.cycles += 1;
        }
    }
}

impl Clock {
    /// It is the one on the wall, at a factor by which time passes.
    pub(crate) fn is_paced(self) -> bool {
        matches!(self, Clock::Wall(factor) if factor.is_finite() && factor > 0.0)
    }
}

pub(crate) struct Pace {
    started: Instant,
    /// Time of the machine then, µs.
    origin_us: u64,
    factor: f64,
    /// Time of the machine at the end of the cycle before, µs, and processor time of the thread after it.
    before: (u64, Duration),
    /// When the time of the cycle before is over, since it started.
    due: Duration,
    pub lateness: Lateness,
}

/// Processor time of this thread.
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(time).unwrap_or_default()
}

impl Pace {
    /// The pace of a clock from now on; none where the machine runs freely.
    pub fn of(clock: Clock, time_us: u64) -> Option<Pace> {
        match clock {
            Clock::Wall(factor) if clock.is_paced() => Some(Pace {
                started: Instant::now(),
                origin_us: time_us,
                factor,
                before: (time_us, processor_time()),
                due: Duration::ZERO,
                lateness: Lateness::new(),
            }),
            _ => None,
        }
    }

    /// A contour cycle is done whose time has ended: notes when it is over, and by how much it is late.
    pub fn note(&mut self, time_us: u64) {
        let (before_us, used) = self.before;
        let used = processor_time().saturating_sub(used);
        let cycle_ms = time_us.saturating_sub(before_us) as f64 * 1e-3 / self.factor;
        let used_ms = used.as_secs_f64() * 1e3;
        self.lateness.overrun_cycles += u64::from(used_ms > cycle_ms);
        self.lateness.longest_ms = self.lateness.longest_ms.max(used_ms);
        let passed_us = time_us.saturating_sub(self.origin_us);
        self.due =
            Duration::try_from_secs_f64(passed_us as f64 * 1e-6 / self.factor).unwrap_or(Duration::MAX);
        self.lateness.cycles += 1;
        if let Some(late) = self.started.elapsed().checked_sub(self.due) {
            self.lateness.add(late.as_secs_f64() * 1e3);
        }
        self.before = (time_us, processor_time());
    }

    /// How long it is until the time of the cycle that was noted is over.
    pub fn rest(&self) -> Duration {
        self.due.saturating_sub(self.started.elapsed())
    }

    /// Waits until the cycle is due; the last part without sleep.
    pub fn wait(&mut self) {
        if let Some(sleep) = self.rest().checked_sub(SPIN) {
            std::thread::sleep(sleep);
        }
        while self.started.elapsed() < self.due {
            std::hint::spin_loop();
        }
        self.before.1 = processor_time();
    }
}

/// By which clock a machine runs, and how it keeps it.
#[derive(Default)]
pub(crate) struct Pacing {
    clock: Clock,
    pace: Option<Pace>,
    /// Whoever lets cycles pass waits for the clock.
    outside: bool,
    /// Also in real time nothing is read or computed beside.
    exact: bool,
}

impl Pacing {
    /// The clock begins now, at a time of the machine, µs.
    pub fn begin(&mut self, clock: Clock, now_us: u64) {
        self.clock = clock;
        self.pace = Pace::of(clock, now_us);
    }

    pub fn clock(&self) -> Clock {
        self.clock
    }

    pub fn wait_outside(&mut self) {
        self.outside = true;
    }

    pub fn be_exact(&mut self) {
        self.exact = true;
    }

    /// Programs are read, and long computations done, on a thread of their own.
    pub fn works_beside(&self) -> bool {
        self.pace.is_some() && !self.exact
    }

    /// A cycle has ended at a time, µs: it waits until that has passed.
    pub fn keep(&mut self, now_us: u64) {
        if let Some(pace) = &mut self.pace {
            pace.note(now_us);
            if !self.outside {
                pace.wait();
            }
        }
    }

    pub fn rest(&self) -> Duration {
        self.pace.as_ref().map_or(Duration::ZERO, Pace::rest)
    }

    pub fn lateness(&self) -> Option<Lateness> {
        self.pace.as_ref().map(|pace| pace.lateness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_cycles_are_counted_by_how_late_they_are() {
        let mut lateness = Lateness::new();
        for late_ms in [0.05, 0.1, 0.5, 30.0, 2000.0] {
            lateness.add(late_ms);
        }
        assert_eq!(lateness.late_by.map(|late| late.cycles), [2, 1, 0, 1, 1]);
        assert_eq!((lateness.late_cycles, lateness.worst_lateness_ms), (5, 2000.0));
    }

    /// 10 ms of work for a cycle of 3 ms are too much; what is waited for is no work.
    #[test]
    fn a_cycle_that_needs_more_than_its_time_is_an_overrun() {
        let mut pace = Pace::of(Clock::Wall(1.0), 0).expect("the clock is on the wall");
        let busy = Instant::now();
        let used = processor_time();
        while processor_time() - used < Duration::from_millis(10) && busy.elapsed() < Duration::from_secs(60)
        {
        }
        pace.note(3_000);
        pace.wait();
        for cycle in 1..=20 {
            pace.note(100_000 + cycle * 3_000);
            pace.wait();
        }
        assert_eq!(pace.lateness.overrun_cycles, 1);
        assert!(pace.lateness.longest_ms >= 10.0);
        assert_eq!(pace.lateness.cycles, 21);
    }
}
