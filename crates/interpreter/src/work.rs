//! Computations that take long: they can be done beside, on a thread of whoever drives the interpreter.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::Interpreter;
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

impl Interpreter {
    /// Leaves long computations to whoever drives: while one is pending the next step is
    /// [`Step::Starved`], see [`Interpreter::take_work`].
    pub fn defer_work(&mut self) {
        self.defers = true;
    }

    /// A long computation to be done beside; [`Interpreter::finish_work`] takes what it comes to. When it is
    /// dropped instead, the next step finds that out, and it can be taken again.
    pub fn take_work(&mut self) -> Option<Work> {
        self.pending
            .take(&mut self.run, &self.settings, self.interrupt.as_ref())
    }

    /// Gives a computation up that is pending: its block is executed anew when the run goes on.
    pub fn give_up_work(&mut self) {
        self.pending = Pending::None;
    }

    /// The run waits for a computation that is done, or to be done, beside.
    pub fn is_computing(&self) -> bool {
        !self.pending.is_none() && !self.pending.is_lost()
    }

    /// Whether this computation is what the run waits for.
    pub fn waits_for(&self, done: &Done) -> bool {
        self.pending.is_of(done)
    }

    /// Goes on with what a computation came to; without effect when it was given up meanwhile.
    pub fn finish_work(&mut self, done: Done) {
        match self.pending.finish(done, &mut self.run) {
            Some(Ok(())) => self.run.at.block += 1,
            Some(Err(Halt::Fault(fault))) => self.fail(fault, self.run.pen.block),
            // Its block is executed anew when the run goes on.
            Some(Err(Halt::Interrupted)) | None => {}
        }
    }

    /// Runs an SL cycle, or leaves it to whoever drives.
    pub(crate) fn contour_cycle(&mut self) -> Result<(), Halt> {
        let job = self.record_contours()?;
        if self.defers {
            self.pending = Pending::Waiting(Box::new(job));
            return Ok(());
        }
        let watch = Watch::new([self.interrupt.as_deref(), None]);
        self.run.contour_cycle(&job, &self.settings, &watch)?;
        self.run.at.block += 1;
        Ok(())
    }
}
