//! Long computations of a run that whoever drives it may do beside.

use crate::Interpreter;
use crate::cycles::{Halt, Watch};
use crate::work::{Done, Pending, Work};

impl Interpreter {
    /// Leaves long computations to whoever drives: while one is pending the next step is
    /// [`Step::Starved`], see [`Interpreter::take_work`].
    pub fn defer_work(&mut self) {
        self.effort.defers = true;
    }

    /// A long computation to be done beside; [`Interpreter::finish_work`] takes what it comes to. When it is
    /// dropped instead, the next step finds that out, and it can be taken again.
    pub fn take_work(&mut self) -> Option<Work> {
        self.effort
            .pending
            .take(&mut self.run, &self.settings, self.interrupt.as_ref())
    }

    /// Gives a computation up that is pending: its block is executed anew when the run goes on.
    pub fn give_up_work(&mut self) {
        self.effort.pending = Pending::None;
    }

    /// The run waits for a computation that is done, or to be done, beside.
    pub fn is_computing(&self) -> bool {
        !self.effort.pending.is_none() && !self.effort.pending.is_lost()
    }

    /// Whether this computation is what the run waits for.
    pub fn waits_for(&self, done: &Done) -> bool {
        self.effort.pending.is_of(done)
    }

    /// Goes on with what a computation came to; without effect when it was given up meanwhile.
    pub fn finish_work(&mut self, done: Done) {
        match self.effort.pending.finish(done, &mut self.run) {
            Some(Ok(())) => self.run.at.block += 1,
            Some(Err(Halt::Fault(fault))) => self.fail(fault, self.run.pen.block),
            // Its block is executed anew when the run goes on.
            Some(Err(Halt::Interrupted)) | None => {}
        }
    }

    /// Runs an SL cycle, or leaves it to whoever drives.
    pub(crate) fn contour_cycle(&mut self) -> Result<(), Halt> {
        let job = self.record_contours()?;
        if self.effort.defers {
            self.effort.pending = Pending::Waiting(Box::new(job));
            return Ok(());
        }
        let watch = Watch::new([self.interrupt.as_deref(), None]);
        self.run.contour_cycle(&job, &self.settings, &watch)?;
        self.run.at.block += 1;
        Ok(())
    }
}
