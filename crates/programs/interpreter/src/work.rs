//! Computations that take long: they can be done beside, on a thread of whoever drives the interpreter.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::cycles::{ContourJob, Halt, Watch};
use crate::run::Run;
use crate::settings::Settings;

/// How far a computation is that is done beside.
#[derive(Clone, Default)]
pub(crate) enum Pending {
    #[default]
    None,
    /// It waits for somebody to do it.
    Waiting(Box<ContourJob>),
    /// Somebody does it, and sends what was wanted.
    Taken(Wanted),
}

/// What may be done at once, and what is left to whoever drives.
#[derive(Clone, Default)]
pub(crate) struct Effort {
    /// Work that may still be done before [`Step::Starved`](bahn_path::Step::Starved); `None` for any amount.
    pub work: Option<u32>,
    /// Long computations are left to whoever drives.
    pub defers: bool,
    /// The one that is pending.
    pub pending: Pending,
}

/// Tells a computation from others, and that nobody wants it any more: dropped, it ends it.
pub(crate) struct Wanted(Arc<AtomicBool>);

/// A copy of the interpreter finds its computation lost and has it done again.
impl Clone for Wanted {
    fn clone(&self) -> Wanted {
        Wanted(Arc::default())
    }
}

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
    interrupt: Option<Arc<AtomicBool>>,
    given_up: Arc<AtomicBool>,
}

/// What a [`Work`] came to, for the interpreter that it is of.
pub struct Done {
    run: Box<Run>,
    result: Result<(), Halt>,
    given_up: Arc<AtomicBool>,
}

impl Work {
    /// Does it. It ends soon when the interpreter gives it up meanwhile, or is dropped.
    pub fn compute(self) -> Done {
        let Work {
            mut run,
            settings,
            job,
            interrupt,
            given_up,
        } = self;
        let watch = Watch::new([interrupt.as_deref(), Some(&given_up)]);
        let result = run.contour_cycle(&job, &settings, &watch);
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

    /// Whether it was taken and can come back no more: the [`Work`] or the [`Done`] was dropped.
    pub fn is_lost(&self) -> bool {
        matches!(self, Pending::Taken(wanted) if Arc::strong_count(&wanted.0) == 1)
    }

    pub fn is_of(&self, done: &Done) -> bool {
        matches!(self, Pending::Taken(wanted) if Arc::ptr_eq(&wanted.0, &done.given_up))
    }

    /// Hands the computation out, once.
    pub fn take(
        &mut self,
        run: &mut Run,
        settings: &Settings,
        interrupt: Option<&Arc<AtomicBool>>,
    ) -> Option<Work> {
        let job = match std::mem::take(self) {
            Pending::Waiting(job) => job,
            other => {
                *self = other;
                return None;
            }
        };
        let given_up = Arc::new(AtomicBool::new(false));
        *self = Pending::Taken(Wanted(Arc::clone(&given_up)));
        // The copy goes on from what was said; its warnings are its own.
        let warnings = run.reported.take_warnings();
        let copy = Box::new(run.clone());
        run.reported.put_before(warnings);
        Some(Work {
            run: copy,
            settings: settings.clone(),
            job,
            interrupt: interrupt.cloned(),
            given_up,
        })
    }

    /// Takes what it came to. `None` when it was given up meanwhile.
    pub fn finish(&mut self, done: Done, run: &mut Run) -> Option<Result<(), Halt>> {
        if !self.is_of(&done) {
            return None;
        }
        *self = Pending::None;
        let warnings = run.reported.take_warnings();
        *run = *done.run;
        run.reported.put_before(warnings);
        Some(done.result)
    }
}
