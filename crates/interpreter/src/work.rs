//! Computations that take long: they can be done beside, on a thread of whoever drives the interpreter.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::cycles::{ContourJob, Halt, Watch};
use crate::error::Fault;
use crate::run::Run;
use crate::settings::Settings;

/// How far a computation is that is done beside.
#[derive(Default)]
pub(crate) enum Pending {
    #[default]
    None,
    /// It waits for somebody to do it.
    Waiting(Box<ContourJob>),
    /// Somebody does it.
    Taken(Wanted),
}

/// Tells a computation from others; it is broken off when nobody wants it any more.
pub(crate) struct Wanted(Arc<AtomicBool>);

impl Drop for Wanted {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// A computation of an interpreter, to be done on any thread: the path of an SL cycle.
pub struct Work {
    run: Box<Run>,
    settings: Settings,
    job: Box<ContourJob>,
    given_up: Arc<AtomicBool>,
}

/// What a [`Work`] came to, for the interpreter that it is of.
pub struct Done {
    run: Box<Run>,
    result: Result<(), Halt>,
    given_up: Arc<AtomicBool>,
}

impl Work {
    /// Does it.
    pub fn compute(self) -> Done {
        let Work {
            mut run,
            settings,
            job,
            given_up,
        } = self;
        let result = run.contour_cycle(&job, &settings, &Watch::new(Some(&given_up)));
        Done {
            run,
            result,
            given_up,
        }
    }
}

impl Pending {
    pub fn is_none(&self) -> bool {
        matches!(self, Pending::None)
    }

    pub fn is_of(&self, done: &Done) -> bool {
        matches!(self, Pending::Taken(Wanted(mark)) if Arc::ptr_eq(mark, &done.given_up))
    }

    /// Hands the computation out.
    pub fn take(&mut self, run: &mut Run, settings: &Settings) -> Option<Work> {
        let Pending::Waiting(job) = std::mem::take(self) else {
            return None;
        };
        let given_up = Arc::new(AtomicBool::new(false));
        *self = Pending::Taken(Wanted(Arc::clone(&given_up)));
        let warnings = std::mem::take(&mut run.warnings);
        let copy = Box::new(run.clone());
        run.warnings = warnings;
        Some(Work {
            run: copy,
            settings: settings.clone(),
            job,
            given_up,
        })
    }

    /// Takes what it came to. `None` when it was given up meanwhile.
    pub fn finish(&mut self, done: Done, run: &mut Run) -> Option<Result<(), Fault>> {
        if !self.is_of(&done) {
            return None;
        }
        let result = match done.result {
            Ok(()) => Ok(()),
            Err(Halt::Fault(fault)) => Err(fault),
            Err(Halt::Interrupted) => return None,
        };
        *self = Pending::None;
        let mut warnings = std::mem::take(&mut run.warnings);
        *run = *done.run;
        warnings.append(&mut run.warnings);
        run.warnings = warnings;
        Some(result)
    }
}
