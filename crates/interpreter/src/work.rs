//! Computations that take long: they can be done beside, on a thread of whoever drives the interpreter.

use std::sync::Arc;

use crate::cycles::ContourJob;
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
    /// Somebody does it; the mark tells it from others.
    Taken(Arc<()>),
}

/// A computation of an interpreter, to be done on any thread: the path of an SL cycle.
pub struct Work {
    run: Box<Run>,
    settings: Settings,
    job: Box<ContourJob>,
    mark: Arc<()>,
}

/// What a [`Work`] came to, for the interpreter that it is of.
pub struct Done {
    run: Box<Run>,
    result: Result<(), Fault>,
    mark: Arc<()>,
}

impl Work {
    /// Does it.
    pub fn compute(self) -> Done {
        let Work {
            mut run,
            settings,
            job,
            mark,
        } = self;
        let result = run.contour_cycle(&job, &settings);
        Done { run, result, mark }
    }
}

impl Pending {
    pub fn is_none(&self) -> bool {
        matches!(self, Pending::None)
    }

    pub fn is_of(&self, done: &Done) -> bool {
        matches!(self, Pending::Taken(mark) if Arc::ptr_eq(mark, &done.mark))
    }

    /// Hands the computation out.
    pub fn take(&mut self, run: &mut Run, settings: &Settings) -> Option<Work> {
        let Pending::Waiting(job) = std::mem::take(self) else {
            return None;
        };
        let mark = Arc::new(());
        *self = Pending::Taken(Arc::clone(&mark));
        let warnings = std::mem::take(&mut run.warnings);
        let copy = Box::new(run.clone());
        run.warnings = warnings;
        Some(Work {
            run: copy,
            settings: settings.clone(),
            job,
            mark,
        })
    }

    /// Takes what it came to. `None` when it was given up meanwhile.
    pub fn finish(&mut self, done: Done, run: &mut Run) -> Option<Result<(), Fault>> {
        if !self.is_of(&done) {
            return None;
        }
        *self = Pending::None;
        let mut warnings = std::mem::take(&mut run.warnings);
        *run = *done.run;
        warnings.append(&mut run.warnings);
        run.warnings = warnings;
        Some(done.result)
    }
}
