//! What ends a run before its end.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Ends one run: somebody wants it, or its time is over.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    flag: Arc<AtomicBool>,
    late: Arc<AtomicBool>,
    over: Arc<AtomicBool>,
}

impl Stop {
    /// The run ends when a flag is set.
    pub fn by(flag: Arc<AtomicBool>) -> Stop {
        Stop {
            flag,
            late: Arc::default(),
            over: Arc::default(),
        }
    }

    /// Ends the run when this time has passed.
    pub fn after(&self, limit: Duration) {
        let stop = self.clone();
        std::thread::spawn(move || {
            std::thread::sleep(limit);
            stop.end_late();
        });
    }

    /// Asks the run to end, as Ctrl-C does.
    pub fn end(&self) {
        self.flag.store(true, Ordering::Relaxed);
    }

    /// The run has ended: no time limit counts any more.
    pub fn run_is_over(&self) {
        self.over.store(true, Ordering::Relaxed);
    }

    /// Whether the run has ended.
    pub fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    /// Ends the run because its time is over.
    pub fn end_late(&self) {
        if self.is_over() {
            return;
        }
        self.late.store(true, Ordering::Relaxed);
        self.end();
    }

    /// Whether the run shall end.
    #[inline]
    pub fn is_requested(&self) -> bool {
        self.flag.load(Ordering::Relaxed)
    }

    /// Whether its time is over.
    pub fn is_late(&self) -> bool {
        self.late.load(Ordering::Relaxed)
    }

    /// The flag, for rooms that watch it themselves.
    pub fn flag(&self) -> Arc<AtomicBool> {
        self.flag.clone()
    }
}
