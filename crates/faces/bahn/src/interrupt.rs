//! Ctrl-C: the first one ends a run with the report so far; the second one ends the process when it does not
//! react; the third one ends it at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

use bahn_report::Stop;

use crate::{Outcome, files};

/// How long a run may take to notice that it is to end, when it is asked twice.
const PATIENCE: Duration = Duration::from_secs(2);

/// How often a run with a time of its own looks for Ctrl-C.
const WATCH: Duration = Duration::from_millis(50);

/// Whether somebody wants the run to end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt {
    requested: Arc<AtomicBool>,
    /// The run has seen it: it is on its way to the report.
    noticed: Arc<AtomicBool>,
}

impl Interrupt {
    /// Takes over Ctrl-C (SIGINT), and SIGTERM likewise.
    pub fn on_ctrl_c() -> Interrupt {
        let interrupt = Interrupt::default();
        let handled = interrupt.clone();
        let count = AtomicU32::new(0);
        // Without a handler Ctrl-C ends the process at once, which is no worse than before.
        let _ = ctrlc::set_handler(move || {
            handled.requested.store(true, Ordering::Relaxed);
            match count.fetch_add(1, Ordering::Relaxed) {
                0 => {}
                1 => {
                    let noticed = handled.noticed.clone();
                    let watch = std::thread::Builder::new().spawn(move || {
                        std::thread::sleep(PATIENCE);
                        if !noticed.load(Ordering::Relaxed) {
                            exit();
                        }
                    });
                    // Without a thread the third one ends it.
                    drop(watch);
                }
                _ => exit(),
            }
        });
        interrupt
    }

    /// Whether Ctrl-C has come since the start.
    #[inline]
    pub fn is_requested(&self) -> bool {
        let requested = self.requested.load(Ordering::Relaxed);
        if requested {
            self.noticed.store(true, Ordering::Relaxed);
        }
        requested
    }

    /// The flag, for rooms that watch it themselves.
    pub fn flag(&self) -> Arc<AtomicBool> {
        self.requested.clone()
    }

    /// A flag for what is written after the run: what an interrupted run left is written all the same, as a
    /// second Ctrl-C ends the process.
    pub fn after_run(&self) -> Arc<AtomicBool> {
        if self.is_requested() {
            Arc::default()
        } else {
            self.flag()
        }
    }

    /// Ctrl-C ends the run.
    pub fn stop(&self) -> Stop {
        Stop::by(self.flag())
    }

    /// Ends one of several runs: by Ctrl-C, or when its own time has passed.
    pub fn stop_of_one(&self, limit: Option<Duration>) -> Stop {
        let Some(limit) = limit else {
            return self.stop();
        };
        let stop = Stop::default();
        stop.after(limit);
        let (watching, interrupt) = (stop.clone(), self.clone());
        std::thread::spawn(move || {
            while !watching.is_requested() && !watching.is_over() {
                std::thread::sleep(WATCH);
                if interrupt.is_requested() {
                    watching.end();
                }
            }
        });
        stop
    }
}

/// Ends the process, without half-written files.
fn exit() {
    files::remove_temporaries();
    std::process::exit(i32::from(Outcome::Interrupted.code()));
}
