//! Long computations of the control on a thread of their own: the machine goes on, or Ctrl-C counts, meanwhile.
//!
//! Decision: A contour that takes long is computed on a thread of whoever drives the control; in simulation time the
//! machine stands still meanwhile

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, sync_channel};
use std::thread::Builder;
use std::time::Duration;

use bahn_tnc::{Control, Done, Work};

use super::reading::Reading;

/// How often it is looked whether the run is to end.
const PATIENCE: Duration = Duration::from_millis(50);

/// What computes and reads beside.
#[derive(Default)]
pub(crate) struct Background {
    result: Option<Receiver<Done>>,
    reading: Option<Reading>,
}

impl Background {
    /// Part programs are read on a thread of their own from now on, or with every preparation again.
    pub fn read_beside(&mut self, control: &mut Control, on: bool) {
        self.settle(control);
        self.reading = if on { Reading::start() } else { None };
        control.read_beside(self.reading.is_some());
    }

    /// Waits until everything that is read beside is back.
    pub fn settle(&mut self, control: &mut Control) {
        if let Some(reading) = &mut self.reading {
            reading.settle(control);
        }
    }

    /// Lets the control interpret and plan ahead, and hands over what is to be read beside.
    pub fn prepare(&mut self, control: &mut Control, realtime: bool, break_off: &AtomicBool) {
        if let Some(reading) = &mut self.reading {
            reading.collect(control);
        }
        self.compute(control, realtime, break_off);
        if let Some(reading) = &mut self.reading {
            reading.hand_over(control);
        }
    }

    /// Lets the control interpret and plan ahead. In real time the machine goes on while
    /// something is computed; otherwise time stands still, so that every run is the same, but for a run that is
    /// to be broken off.
    fn compute(&mut self, control: &mut Control, realtime: bool, break_off: &AtomicBool) {
        loop {
            control.prepare();
            if self.result.is_none()
                && let Some(work) = control.take_work()
            {
                match worker() {
                    Some((giver, result)) => {
                        // It waits for it.
                        let _ = giver.send(work);
                        self.result = Some(result);
                    }
                    // Without another thread the machine waits.
                    None => control.finish_work(work.compute()),
                }
            }
            let Some(result) = &self.result else { return };
            let done = if realtime {
                match result.try_recv() {
                    Err(TryRecvError::Empty) => return,
                    other => other.ok(),
                }
            } else {
                match result.recv_timeout(PATIENCE) {
                    Err(RecvTimeoutError::Timeout) if break_off.load(Ordering::Relaxed) => return,
                    Err(RecvTimeoutError::Timeout) => continue,
                    other => other.ok(),
                }
            };
            self.result = None;
            match done {
                Some(done) => control.finish_work(done),
                None => return,
            }
        }
    }
}

/// A thread for one computation; `None` when there is none to be had.
fn worker() -> Option<(SyncSender<Work>, Receiver<Done>)> {
    let (giver, taker) = sync_channel::<Work>(1);
    let (sender, receiver) = sync_channel(1);
    let compute = move || {
        if let Ok(work) = taker.recv() {
            // The run may be over before the result is there: then nobody takes it.
            let _ = sender.send(work.compute());
        }
    };
    Builder::new().spawn(compute).ok()?;
    Some((giver, receiver))
}
