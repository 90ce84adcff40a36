//! Part programs of the control are read on a thread of their own, while its cycles go on.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::Builder;

use bahn_tnc::{Control, ReadAhead};

/// The thread, and what is there. Each channel hands over one program at most.
pub(crate) struct Reading {
    give: SyncSender<ReadAhead>,
    take: Receiver<ReadAhead>,
    handed_over: usize,
}

/// Programs that wait for the thread at most: one of each channel.
const CHANNELS: usize = 8;

impl Reading {
    /// Starts the thread; `None` when there is none to be had. It ends when this is dropped.
    pub fn start() -> Option<Reading> {
        let (give, programs) = sync_channel::<ReadAhead>(CHANNELS);
        let (done, take) = sync_channel(CHANNELS);
        let read = move || {
            for mut program in programs {
                program.read();
                if done.send(program).is_err() {
                    return;
                }
            }
        };
        let thread = Builder::new().name("bahn read ahead".into());
        thread.spawn(read).ok()?;
        Some(Reading {
            give,
            take,
            handed_over: 0,
        })
    }

    /// Takes back what is read; does not wait.
    pub fn collect(&mut self, control: &mut Control) {
        while self.handed_over > 0
            && let Ok(read) = self.take.try_recv()
        {
            self.handed_over -= 1;
            control.take_back(read);
        }
    }

    /// Gives out what is to be read.
    pub fn hand_over(&mut self, control: &mut Control) {
        while self.handed_over < CHANNELS
            && let Some(program) = control.hand_over_reading()
        {
            match self.give.try_send(program) {
                Ok(()) => self.handed_over += 1,
                // The thread is gone: the control reads itself.
                Err(error) => {
                    let (std::sync::mpsc::TrySendError::Full(program)
                    | std::sync::mpsc::TrySendError::Disconnected(program)) = error;
                    control.take_back(program);
                    control.read_beside(false);
                }
            }
        }
    }

    /// Waits until everything is back: what one program reads at once takes less than a contour cycle, unless a
    /// program that it calls is read from the medium.
    pub fn settle(&mut self, control: &mut Control) {
        while self.handed_over > 0 {
            self.handed_over -= 1;
            match self.take.recv() {
                Ok(read) => control.take_back(read),
                Err(_) => return,
            }
        }
    }
}
